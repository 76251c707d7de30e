#include "fit/level/hum_search.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <utility>

#include "core/fit_thresholds.hpp"
#include "fit/level/add_hum.hpp"
#include "fit/level/stick_ripple.hpp"
#include "signal/mains.hpp"
#include "signal/transform.hpp"

namespace slipfit::fit {
namespace {

/// Samples [begin, end) of neighbouring cycles.
struct Run {
  std::size_t begin = 0;
  std::size_t end = 0;
  [[nodiscard]] double size() const { return static_cast<double>(end - begin); }
};

/// Residuals on an even clock.
struct Rest {
  std::vector<double> values;
  std::vector<Run> runs;
  double step_s = 0.0;
};

/// Neighbours are those between which fewer cycles than a run's are missing.
std::vector<Run> runs_of(const Recording& recording, const BlockFit& fit) {
  const auto time_s = recording.time_s();
  const auto index_at = [&](double t_s) {
    return static_cast<std::size_t>(std::lower_bound(time_s.begin(), time_s.end(), t_s) - time_s.begin());
  };
  std::vector<Run> runs;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const std::size_t end = index_at(fit.data(i).window_end_s);
    if (i == 0 || fit.data(i).slip - fit.data(i - 1).slip > kCyclesOfRun) {
      runs.push_back({index_at(fit.data(i).window_begin_s), end});
    }
    runs.back().end = end;
  }
  return runs;
}

Rest rest_of(const Recording& recording, const BlockFit& fit, std::vector<double> residuals) {
  const double step_s = recording.duration_s() / static_cast<double>(recording.size() - 1);
  return {std::move(residuals), runs_of(recording, fit), step_s};
}

/// Sums over samples of one frequency, phase counted from the first sample of the recording. Residuals of 0 are no
/// samples.
struct Correlation {
  double used = 0.0, cc = 0.0, cs = 0.0, rc = 0.0, rs = 0.0;

  /// Amplitude^2 of the least-squares sine.
  [[nodiscard]] double power() const {
    const double ss = used - cc;
    const double determinant = cc * ss - cs * cs;
    if (!(determinant > 0.0)) return 0.0;
    return (std::pow(rc * ss - rs * cs, 2) + std::pow(rs * cc - rc * cs, 2)) / (determinant * determinant);
  }
};

/// The phasor turns by a fixed step from sample to sample, four of them side by side.
void add(const double* values, std::size_t count, double phase, double step, Correlation& sums) {
  using Lanes = Eigen::Array4d;
  const double turn_c = std::cos(4.0 * step);
  const double turn_s = std::sin(4.0 * step);
  const Lanes phases = phase + step * Lanes(0.0, 1.0, 2.0, 3.0);
  Lanes c = phases.cos(), s = phases.sin();
  Lanes sum_cc = Lanes::Zero(), sum_cs = Lanes::Zero(), sum_rc = Lanes::Zero(), sum_rs = Lanes::Zero();
  Lanes sum_used = Lanes::Zero();
  for (std::size_t i = 0; i < count; i += 4) {
    Lanes r = Lanes::Zero();
    std::copy_n(values + i, std::min<std::size_t>(4, count - i), r.data());
    const Lanes present = (r.abs() * 1e300).min(1.0);  // r != 0, for which Eigen has no vector instruction
    sum_used += present;
    sum_cc += present * c * c;
    sum_cs += present * c * s;
    sum_rc += r * c;
    sum_rs += r * s;
    const Lanes next = c * turn_c - s * turn_s;
    s = c * turn_s + s * turn_c;
    c = next;
  }
  sums.used += sum_used.sum();
  sums.cc += sum_cc.sum();
  sums.cs += sum_cs.sum();
  sums.rc += sum_rc.sum();
  sums.rs += sum_rs.sum();
}

/// Amplitude^2 of the least-squares sine of this frequency.
double power_at(const Rest& rest, double frequency_Hz) {
  const double step = 2.0 * std::numbers::pi * frequency_Hz * rest.step_s;
  Correlation sums;
  for (const Run& run : rest.runs) {
    add(&rest.values[run.begin], run.end - run.begin, step * static_cast<double>(run.begin), step, sums);
  }
  return sums.power();
}

/// Half a resolution on either side in steps of a quarter, then the vertex of a parabola through the best three.
double refine(const Rest& rest, double frequency_Hz, double resolution_Hz) {
  constexpr int kSteps = 2;
  std::vector<double> powers;
  for (int i = -kSteps; i <= kSteps; ++i) powers.push_back(power_at(rest, frequency_Hz + 0.25 * i * resolution_Hz));
  const auto best = static_cast<std::size_t>(std::max_element(powers.begin(), powers.end()) - powers.begin());
  double offset = static_cast<double>(best) - kSteps;
  if (best > 0 && best + 1 < powers.size()) {
    const double curvature = powers[best - 1] - 2.0 * powers[best] + powers[best + 1];
    if (curvature < 0.0) offset += 0.5 * (powers[best - 1] - powers[best + 1]) / curvature;
  }
  return frequency_Hz + 0.25 * offset * resolution_Hz;
}

/// Of the lines that the fit has, where the rest with its hum put back has them.
std::vector<double> refine_all(const Recording& recording, const BlockFit& fit, Rest rest) {
  for (const Run& run : rest.runs) add_hum(recording, fit, run.begin, run.end, 1.0, rest.values);
  std::vector<double> frequencies_Hz;
  for (const double known_Hz : fit.level().lines_Hz) {
    frequencies_Hz.push_back(refine(rest, known_Hz, 1.0 / recording.duration_s()));
  }
  return frequencies_Hz;
}

/// Amplitude^2 samples / (2 variance), which noise brings above x once in exp(x / 2).
struct Prominence {
  double used = 0.0;
  double square = 0.0;

  explicit Prominence(const std::vector<double>& residuals) {
    for (const double r : residuals) {
      used += r != 0.0 ? 1.0 : 0.0;
      square += r * r;
    }
  }
  [[nodiscard]] double of(double amplitude_squared) const { return 0.5 * amplitude_squared * used * used / square; }
};

/// A line that has the same phase at the onset of every slip cannot be told from the shape of the cycles: the length of
/// the mean of the phases' unit vectors is then 1, of phases that have nothing to do with the slips 1 / sqrt(cycles).
bool is_in_step(const BlockFit& fit, double frequency_Hz) {
  std::complex<double> sum;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    sum += std::polar(1.0, 2.0 * std::numbers::pi * frequency_Hz * (fit.state(i).onset_s - fit.state(0).onset_s));
  }
  return std::abs(sum) > thresholds::kInStep * static_cast<double>(fit.size());
}

/// Of the rest: each of several runs under a window of its own, without which a line would leak into all of the
/// spectrum.
class RestSpectrum {
 public:
  explicit RestSpectrum(const Rest& rest) {
    const std::size_t length = signal::good_length(rest.values.size());
    bin_Hz_ = 1.0 / (static_cast<double>(length) * rest.step_s);
    double samples = 0.0;
    for (const Run& run : rest.runs) samples += run.size();
    reach_Hz_ = 2.0 * static_cast<double>(rest.runs.size()) / (samples * rest.step_s);
    power_ = signal::hann_power(rest.runs.size() > 1 ? tapered(rest) : rest.values, length);
  }

  [[nodiscard]] std::vector<signal::MainsLine> mains(double resolution_Hz, std::span<const double> known_Hz) const {
    return signal::find_mains(power_, bin_Hz_, resolution_Hz, known_Hz);
  }
  /// Distance up to which the window of a run spreads a line.
  [[nodiscard]] double reach_Hz() const { return reach_Hz_; }
  /// No farther from the frequency than so much.
  [[nodiscard]] double largest_near(double frequency_Hz, double distance_Hz) const {
    const auto at = [&](double f_Hz) {
      const auto bin = static_cast<std::size_t>(std::max(0.0, f_Hz / bin_Hz_));
      return power_.begin() + static_cast<std::ptrdiff_t>(std::min(bin, power_.size() - 1));
    };
    return *std::max_element(at(frequency_Hz - distance_Hz), at(frequency_Hz + distance_Hz) + 1);
  }

 private:
  static std::vector<double> tapered(const Rest& rest) {
    std::vector<double> values(rest.values.size(), 0.0);
    for (const Run& run : rest.runs) {
      const double turn = 2.0 * std::numbers::pi / run.size();
      for (std::size_t i = run.begin; i < run.end; ++i) {
        values[i] = rest.values[i] * (0.5 - 0.5 * std::cos(turn * (static_cast<double>(i - run.begin) + 0.5)));
      }
    }
    return values;
  }

  std::vector<double> power_;
  double bin_Hz_ = 0.0;
  double reach_Hz_ = 0.0;
};

/// New lines in what a fit leaves.
class NewLines {
 public:
  NewLines(const BlockFit& fit, const Rest& rest, const std::optional<StickRipple>& in_sticks)
      : known_Hz_(fit.level().lines_Hz),
        resolution_Hz_(1.0 / (static_cast<double>(rest.values.size() - 1) * rest.step_s)),
        spectrum_(rest) {
    const Prominence prominence(rest.values);
    const auto is_new = [&](double f_Hz) { return !is_beside(f_Hz, known_Hz_) && !is_in_step(fit, f_Hz); };
    // find_mains compares a line with its surroundings, which are too low where the fitted cycles have removed noise
    // near their harmonics: a line must also be improbable against the noise of all residuals.
    for (const signal::MainsLine& line : spectrum_.mains(resolution_Hz_, known_Hz_)) {
      const double f_Hz = line.frequency_Hz;
      if (is_new(f_Hz) && prominence.of(power_at(rest, f_Hz)) > thresholds::kSureHum) seen_Hz_.push_back(f_Hz);
    }
    if (in_sticks && is_new(in_sticks->frequency_Hz) && !is_beside(in_sticks->frequency_Hz, seen_Hz_)) {
      seen_Hz_.push_back(in_sticks->frequency_Hz);
    }
  }

  [[nodiscard]] std::size_t seen() const { return seen_Hz_.size(); }

  /// Those that are no images of others or of what is left of the known ones.
  [[nodiscard]] std::vector<double> strong() const {
    double strongest = 0.0;
    for (const auto* lines_Hz : {&known_Hz_, &seen_Hz_}) {
      for (const double f_Hz : *lines_Hz) strongest = std::max(strongest, power_of(f_Hz));
    }
    std::vector<double> strong_Hz;
    for (const double f_Hz : seen_Hz_) {
      const double power = power_of(f_Hz);
      const bool is_top = power > 0.5 * spectrum_.largest_near(f_Hz, spectrum_.reach_Hz());
      if (is_top && power > thresholds::kHumImage * strongest) strong_Hz.push_back(f_Hz);
    }
    return strong_Hz;
  }

 private:
  /// The mains wanders.
  [[nodiscard]] double width_Hz(double frequency_Hz) const {
    return std::max(3.0 * resolution_Hz_, 2e-3 * frequency_Hz);
  }
  [[nodiscard]] bool is_beside(double frequency_Hz, const std::vector<double>& lines_Hz) const {
    const auto is_near = [&](double f_Hz) { return std::abs(f_Hz - frequency_Hz) < width_Hz(frequency_Hz); };
    return std::any_of(lines_Hz.begin(), lines_Hz.end(), is_near);
  }
  [[nodiscard]] double power_of(double frequency_Hz) const {
    return spectrum_.largest_near(frequency_Hz, width_Hz(frequency_Hz));
  }

  const std::vector<double>& known_Hz_;
  double resolution_Hz_;
  RestSpectrum spectrum_;
  std::vector<double> seen_Hz_;
};

}  // namespace

std::vector<double> refine_hum(const Recording& recording, const BlockFit& fit, std::vector<double> residuals) {
  return refine_all(recording, fit, rest_of(recording, fit, std::move(residuals)));
}

HumSearch find_hum(const Recording& recording, const BlockFit& fit, std::vector<double> residuals,
                   const std::vector<std::size_t>& outliers, const std::optional<StickRipple>& in_sticks) {
  if (!recording.clock_is_even()) return {};
  for (const std::size_t sample : outliers) residuals[sample] = 0.0;  // they would smear over the spectrum
  Rest rest = rest_of(recording, fit, std::move(residuals));
  std::vector<double> strong_Hz;
  HumSearch found;
  {
    const NewLines lines(fit, rest, in_sticks);
    strong_Hz = lines.strong();
    found.others_wait = !strong_Hz.empty() && strong_Hz.size() < lines.seen();
  }
  // A new line is taken where its peak is; its hum must be fitted before its frequency is worth refining.
  found.lines_Hz = refine_all(recording, fit, std::move(rest));
  found.lines_Hz.insert(found.lines_Hz.end(), strong_Hz.begin(), strong_Hz.end());
  return found;
}

}  // namespace slipfit::fit
