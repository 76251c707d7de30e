#include "fit/level/hum.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/thresholds.hpp"
#include "fit/cycle/cycle_data.hpp"
#include "fit/level/level_terms.hpp"
#include "signal/mains.hpp"
#include "signal/smoothing.hpp"
#include "signal/transform.hpp"

namespace slipfit::fit {

namespace {

/// Samples [begin, end) of neighbouring cycles.
struct CycleRun {
  std::size_t begin = 0;
  std::size_t end = 0;
  [[nodiscard]] double size() const { return static_cast<double>(end - begin); }
};

/// Residuals at equal steps of time; 0 where there is none.
struct EvenRest {
  std::vector<double> own;  ///< of an uneven clock only
  std::span<const double> values;
  std::vector<CycleRun> runs;
  double step_s = 0.0;
};

/// Neighbours are those between which fewer cycles than a run's are missing.
std::vector<CycleRun> runs_of(const Recording& recording, const BlockFit& fit) {
  const auto time_s = recording.time_s();
  std::vector<CycleRun> runs;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const std::size_t end = index_at(time_s, fit.data(i).window_end_s);
    if (i == 0 || fit.data(i).slip - fit.data(i - 1).slip > kCyclesOfRun) {
      runs.push_back({index_at(time_s, fit.data(i).window_begin_s), end});
    }
    runs.back().end = end;
  }
  return runs;
}

/// Sums over samples of one frequency, phase counted from the first sample of the recording.
struct ToneSums {
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
void add_even(const double* values, std::size_t count, double phase, double step, ToneSums& sums) {
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

void add_uneven(const double* values, const double* time_s, std::size_t count, double begin_s, double omega,
                ToneSums& sums) {
  for (std::size_t i = 0; i < count; ++i) {
    if (values[i] == 0.0) continue;
    const double c = std::cos(omega * (time_s[i] - begin_s));
    const double s = std::sin(omega * (time_s[i] - begin_s));
    sums.used += 1.0;
    sums.cc += c * c;
    sums.cs += c * s;
    sums.rc += values[i] * c;
    sums.rs += values[i] * s;
  }
}

/// Returns the step of the even clock that replaces an uneven one, in s. It is the mean step, or the usual one where
/// there are long gaps.
double even_step_s(const Recording& recording) {
  const auto size = static_cast<double>(recording.size());
  const double usual_s = std::min(recording.sample_interval_s(), recording.duration_s() / (size - 1.0));
  return std::max(usual_s, recording.duration_s() / (2.0 * size));  // gaps must not fill the memory
}

/// Holds what a fit leaves of the samples of its cycles. Residuals of 0 count as absent samples.
class Rest {
 public:
  /// `residuals`: one a sample of the recording, which must outlive this.
  Rest(const Recording& recording, const BlockFit& fit, std::vector<double> residuals);

  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  [[nodiscard]] const std::vector<CycleRun>& runs() const { return runs_; }
  /// 1 / duration.
  [[nodiscard]] double resolution_Hz() const { return 1.0 / recording_.duration_s(); }

  /// Amplitude^2 of the sine of this frequency that fits best by least squares, at the true times of the samples.
  [[nodiscard]] double power_at(double frequency_Hz) const;
  /// The frequency of the largest power within half a resolution.
  [[nodiscard]] double refined(double frequency_Hz) const;

  /// Returns the residuals for the Fourier transform. On an uneven clock each sample is moved to the nearest step of an
  /// even one, by half a step at most: exact enough to find a line, not to fit it. The values of an even clock are not
  /// copied.
  [[nodiscard]] EvenRest on_even_clock() const;

  /// Adds the fitted interference back.
  void add_interference(const BlockFit& fit);

 private:
  const Recording& recording_;
  std::vector<double> values_;
  std::vector<CycleRun> runs_;
};

Rest::Rest(const Recording& recording, const BlockFit& fit, std::vector<double> residuals)
    : recording_(recording), values_(std::move(residuals)), runs_(runs_of(recording, fit)) {}

double Rest::power_at(double frequency_Hz) const {
  const double omega = 2.0 * std::numbers::pi * frequency_Hz;
  const double step = omega * (recording_.duration_s() / static_cast<double>(values_.size() - 1));
  const auto time_s = recording_.time_s();
  ToneSums sums;
  for (const CycleRun& run : runs_) {
    const std::size_t count = run.end - run.begin;
    if (count == 0) continue;
    if (recording_.clock_is_even()) {
      add_even(&values_[run.begin], count, step * static_cast<double>(run.begin), step, sums);
    } else {
      add_uneven(&values_[run.begin], &time_s[run.begin], count, time_s.front(), omega, sums);
    }
  }
  return sums.power();
}

/// Searches in steps of a quarter of a resolution, then takes the vertex of a parabola through the best three.
double Rest::refined(double frequency_Hz) const {
  constexpr int kSteps = 2;
  const double step_Hz = 0.25 * resolution_Hz();
  std::vector<double> powers;
  for (int i = -kSteps; i <= kSteps; ++i) powers.push_back(power_at(frequency_Hz + i * step_Hz));
  const auto best = static_cast<std::size_t>(std::max_element(powers.begin(), powers.end()) - powers.begin());
  double offset = static_cast<double>(best) - kSteps;
  if (best > 0 && best + 1 < powers.size()) {
    const double curvature = powers[best - 1] - 2.0 * powers[best] + powers[best + 1];
    if (curvature < 0.0) offset += 0.5 * (powers[best - 1] - powers[best + 1]) / curvature;
  }
  return frequency_Hz + offset * step_Hz;
}

EvenRest Rest::on_even_clock() const {
  if (recording_.clock_is_even()) {
    return {{}, values_, runs_, recording_.duration_s() / static_cast<double>(values_.size() - 1)};
  }
  const auto time_s = recording_.time_s();
  EvenRest even;
  even.step_s = even_step_s(recording_);
  const auto cell_of = [&](std::size_t sample) {
    return static_cast<std::size_t>(std::lround((time_s[sample] - time_s.front()) / even.step_s));
  };
  even.own.assign(cell_of(values_.size() - 1) + 1, 0.0);
  for (const CycleRun& run : runs_) {
    for (std::size_t i = run.begin; i < run.end; ++i) even.own[cell_of(i)] += values_[i];
    if (run.end > run.begin) even.runs.push_back({cell_of(run.begin), cell_of(run.end - 1) + 1});
  }
  even.values = even.own;
  return even;
}

void Rest::add_interference(const BlockFit& fit) {
  for (const CycleRun& run : runs_) add_hum(recording_, fit, run.begin, run.end, 1.0, values_);
}

/// Returns the frequencies of the lines that the fit has, as the rest shows them with its hum added back.
std::vector<double> refine_all(const BlockFit& fit, Rest rest) {
  rest.add_interference(fit);
  std::vector<double> frequencies_Hz;
  for (const double known_Hz : fit.level().lines_Hz) frequencies_Hz.push_back(rest.refined(known_Hz));
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

/// Length of the mean of the unit vectors of a line's phases at the onsets of the slips: 1 where all are equal, 1 /
/// sqrt(cycles) where they have nothing to do with the slips.
double phase_coherence(const BlockFit& fit, double frequency_Hz) {
  std::complex<double> sum;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    sum += std::polar(1.0, 2.0 * std::numbers::pi * frequency_Hz * (fit.state(i).onset_s - fit.state(0).onset_s));
  }
  return std::abs(sum) / static_cast<double>(fit.size());
}

/// A line that has the same phase at the onset of every slip cannot be distinguished from the shape of the cycles.
bool is_in_step(const BlockFit& fit, double frequency_Hz) {
  return phase_coherence(fit, frequency_Hz) > thresholds::kInStep;
}

/// Returns whether sampling at this rate shows a frequency in step with the slips where the line is. Such frequencies
/// are harmonics above the Nyquist frequency. Those from farther than twice the rate are never the strongest.
bool may_be_folded(const BlockFit& fit, double frequency_Hz, double rate_Hz) {
  constexpr int kFolds = 2;
  for (int fold = 1; fold <= kFolds; ++fold) {
    for (const double sign : {-1.0, 1.0}) {
      if (phase_coherence(fit, fold * rate_Hz + sign * frequency_Hz) > thresholds::kNoPhase) return true;
    }
  }
  return false;
}

/// Computes the spectrum of the rest. Each of several runs has a window of its own, without which a line would leak
/// into all of the spectrum.
class RestSpectrum {
 public:
  explicit RestSpectrum(const EvenRest& rest) {
    const std::size_t length = signal::good_length(rest.values.size());
    rate_Hz_ = 1.0 / rest.step_s;
    bin_Hz_ = rate_Hz_ / static_cast<double>(length);
    double samples = 0.0;
    for (const CycleRun& run : rest.runs) samples += run.size();
    reach_Hz_ = 2.0 * static_cast<double>(rest.runs.size()) / (samples * rest.step_s);
    const bool is_in_parts = rest.runs.size() > 1;
    power_ = is_in_parts ? signal::hann_power(tapered(rest), length) : signal::hann_power(rest.values, length);
  }

  [[nodiscard]] std::vector<signal::MainsLine> mains(double resolution_Hz, std::span<const double> known_Hz) const {
    return signal::find_mains(power_, bin_Hz_, resolution_Hz, known_Hz);
  }
  /// The strongest line at this frequency or above, whatever its frequency.
  [[nodiscard]] std::optional<double> strongest(double lowest_Hz, double resolution_Hz) const {
    return signal::strongest_line(power_, bin_Hz_, resolution_Hz, lowest_Hz);
  }
  /// Returns the rate of the samples.
  [[nodiscard]] double rate_Hz() const { return rate_Hz_; }
  /// Distance up to which the window of a run spreads a line.
  [[nodiscard]] double reach_Hz() const { return reach_Hz_; }
  /// Returns the largest power at a distance of at most `distance_Hz` from the frequency.
  [[nodiscard]] double largest_near(double frequency_Hz, double distance_Hz) const {
    const auto at = [&](double f_Hz) {
      const auto bin = static_cast<std::size_t>(std::max(0.0, f_Hz / bin_Hz_));
      return power_.begin() + static_cast<std::ptrdiff_t>(std::min(bin, power_.size() - 1));
    };
    return *std::max_element(at(frequency_Hz - distance_Hz), at(frequency_Hz + distance_Hz) + 1);
  }

 private:
  static std::vector<double> tapered(const EvenRest& rest) {
    std::vector<double> values(rest.values.size(), 0.0);
    for (const CycleRun& run : rest.runs) {
      const double turn = 2.0 * std::numbers::pi / run.size();
      for (std::size_t i = run.begin; i < run.end; ++i) {
        values[i] = rest.values[i] * (0.5 - 0.5 * std::cos(turn * (static_cast<double>(i - run.begin) + 0.5)));
      }
    }
    return values;
  }

  std::vector<double> power_;
  double rate_Hz_ = 0.0;
  double bin_Hz_ = 0.0;
  double reach_Hz_ = 0.0;
};

/// The residuals without what repeats from cycle to cycle, which is the shape of the cycles and no line: their mean
/// over all cycles at each time from the onset of the slip.
std::vector<double> without_repeats(const Recording& recording, const BlockFit& fit, std::vector<double> residuals) {
  const auto time_s = recording.time_s();
  const double step_s = recording.sample_interval_s();
  double longest_s = 0.0;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const double onset_s = fit.state(i).onset_s;
    longest_s = std::max({longest_s, onset_s - fit.data(i).window_begin_s, fit.data(i).window_end_s - onset_s});
  }
  const auto half = static_cast<std::ptrdiff_t>(std::ceil(longest_s / step_s)) + 1;
  std::vector<double> sums(static_cast<std::size_t>(2 * half + 1), 0.0);
  std::vector<double> counts(sums.size(), 0.0);
  const auto for_each_sample = [&](const auto& f) {
    for (std::size_t i = 0; i < fit.size(); ++i) {
      const double onset_s = fit.state(i).onset_s;
      const CycleData& cycle = fit.data(i);
      for (std::size_t at = index_at(time_s, cycle.window_begin_s);
           at < time_s.size() && time_s[at] < cycle.window_end_s; ++at) {
        const auto place = static_cast<std::ptrdiff_t>(std::lround((time_s[at] - onset_s) / step_s)) + half;
        if (residuals[at] != 0.0 && place >= 0 && place <= 2 * half) f(at, static_cast<std::size_t>(place));
      }
    }
  };
  for_each_sample([&](std::size_t at, std::size_t place) {
    sums[place] += residuals[at];
    counts[place] += 1.0;
  });
  for_each_sample([&](std::size_t at, std::size_t place) { residuals[at] -= sums[place] / counts[place]; });
  return residuals;
}

/// New lines in what a fit leaves.
class NewLines {
 public:
  NewLines(const Recording& recording, const BlockFit& fit, const Rest& rest)
      : known_Hz_(fit.level().lines_Hz), resolution_Hz_(rest.resolution_Hz()), spectrum_(rest.on_even_clock()) {
    const Prominence prominence(rest.values());
    const auto is_new = [&](double f_Hz) { return !is_near_one_of(f_Hz, known_Hz_) && !is_in_step(fit, f_Hz); };
    // find_mains compares a line with its surroundings, which are too low where the fitted cycles have removed noise
    // near their harmonics: a line must also be improbable against the noise of all residuals.
    for (const signal::MainsLine& line : spectrum_.mains(resolution_Hz_, known_Hz_)) {
      const double f_Hz = line.frequency_Hz;
      if (is_new(f_Hz) && prominence.of(rest.power_at(f_Hz)) > thresholds::kSureHum) seen_Hz_.push_back(f_Hz);
    }
    const std::optional<double> other_Hz = line_in_residuals(fit, rest);
    if (other_Hz && is_new(*other_Hz) && !is_near_one_of(*other_Hz, seen_Hz_)) {
      const double square = rest.power_at(*other_Hz);
      // Weaker ones may be of slips that a drive moves, or of rounding.
      const bool is_large = square > fit.scales().noise * fit.scales().noise;
      const bool is_line = is_large && prominence.of(square) > thresholds::kSureLine;
      if (is_line && is_unlike_cycles(recording, fit, rest, *other_Hz)) seen_Hz_.push_back(*other_Hz);
    }
  }

  /// Returns the new lines that nothing near exceeds by far.
  [[nodiscard]] std::vector<double> without_images() const {
    std::vector<double> lines_Hz = seen_Hz_;
    std::erase_if(lines_Hz, [&](double f_Hz) {
      return !(spectrum_.largest_near(f_Hz, width_Hz(f_Hz)) > 0.5 * spectrum_.largest_near(f_Hz, spectrum_.reach_Hz()));
    });
    return lines_Hz;
  }

 private:
  /// The mains is where it is; a line elsewhere may be what the model misses of the slips, which scatter.
  static bool is_unlike_cycles(const Recording& recording, const BlockFit& fit, const Rest& rest, double line_Hz) {
    const Rest unlike(recording, fit, without_repeats(recording, fit, rest.values()));
    return unlike.power_at(line_Hz) > thresholds::kUnlikeCycles * rest.power_at(line_Hz);
  }
  /// The strongest line of the rest where the slips have no line: with another phase at the onset of each. Among few
  /// slips this is chance, and between runs of cycles lines have images.
  [[nodiscard]] std::optional<double> line_in_residuals(const BlockFit& fit, const Rest& rest) const {
    if (fit.size() < thresholds::kFewestOfLine || rest.runs().size() > 1) return std::nullopt;
    const double span_s = fit.state(fit.size() - 1).onset_s - fit.state(0).onset_s;
    const double slips_Hz = static_cast<double>(fit.size() - 1) / span_s;
    const std::optional<double> line_Hz = spectrum_.strongest(slips_Hz, resolution_Hz_);
    if (!line_Hz || phase_coherence(fit, *line_Hz) > thresholds::kNoPhase) return std::nullopt;
    if (may_be_folded(fit, *line_Hz, spectrum_.rate_Hz())) return std::nullopt;
    return line_Hz;
  }
  /// The mains wanders.
  [[nodiscard]] double width_Hz(double frequency_Hz) const {
    return std::max(3.0 * resolution_Hz_, 2e-3 * frequency_Hz);
  }
  [[nodiscard]] bool is_near_one_of(double frequency_Hz, const std::vector<double>& lines_Hz) const {
    const auto is_near = [&](double f_Hz) { return std::abs(f_Hz - frequency_Hz) < width_Hz(frequency_Hz); };
    return std::any_of(lines_Hz.begin(), lines_Hz.end(), is_near);
  }
  const std::vector<double>& known_Hz_;
  double resolution_Hz_;
  RestSpectrum spectrum_;
  std::vector<double> seen_Hz_;
};

}  // namespace

std::vector<double> refine_hum(const Recording& recording, const BlockFit& fit, std::vector<double> residuals) {
  return refine_all(fit, Rest(recording, fit, std::move(residuals)));
}

std::vector<double> find_hum(const Recording& recording, const BlockFit& fit, std::vector<double> residuals,
                             const std::vector<std::size_t>& outliers) {
  for (const std::size_t sample : outliers) residuals[sample] = 0.0;  // they would smear over the spectrum
  Rest rest(recording, fit, std::move(residuals));
  const std::vector<double> new_Hz = NewLines(recording, fit, rest).without_images();
  // A new line is taken where its peak is; its hum must be fitted before its frequency is worth refining.
  std::vector<double> lines_Hz = refine_all(fit, std::move(rest));
  lines_Hz.insert(lines_Hz.end(), new_Hz.begin(), new_Hz.end());
  return lines_Hz;
}

namespace {

struct FittedLine {
  double frequency_Hz = 0.0;
  double force = 0.0;  ///< amplitude
  bool is_of_mains = false;
};

std::vector<FittedLine> fitted_lines(const BlockFit& fit) {
  const double resolution_Hz = 1.0 / (fit.scales().time_end_s - fit.scales().time_begin_s);
  std::vector<FittedLine> lines;
  const double* wave = fit.wave_data();
  for (const double frequency_Hz : fit.level().lines_Hz) {
    const double force = fit.scales().force * std::hypot(wave[0], wave[1]);
    lines.push_back({frequency_Hz, force, signal::is_of_mains(frequency_Hz, resolution_Hz)});
    wave += 2;
  }
  return lines;
}

}  // namespace

double slope_by_lines(const BlockFit& fit, double length_s) {
  double slope = 0.0;
  for (const FittedLine& line : fitted_lines(fit)) {
    // A line of least squares through a sin(w t), from -x to x in w t, has the slope 3 a (sin x - x cos x) w / x^3. x
    // is not known to a fraction of a period: |sin x - x cos x| <= sqrt(1 + x^2), and the slope of the sine is at most
    // a w.
    const double omega = 2.0 * std::numbers::pi * line.frequency_Hz;
    const double x = 0.5 * omega * length_s;
    if (x > 0.0) slope += line.force * omega * std::min(1.0, 3.0 * std::hypot(1.0, x) / (x * x * x));
  }
  return slope;
}

double mains_amplitude(const BlockFit& fit) {
  double amplitude = 0.0;
  for (const FittedLine& line : fitted_lines(fit)) {
    if (line.is_of_mains) amplitude = std::hypot(amplitude, line.force);
  }
  return amplitude;
}

std::vector<double> hum_at_other_frequencies(const BlockFit& fit, const std::vector<double>& frequencies_Hz) {
  const double half_s = 0.5 * (fit.scales().time_end_s - fit.scales().time_begin_s);
  std::vector<double> coefficients(2 * frequencies_Hz.size(), 0.0);
  const double* const wave = fit.wave_data();
  const std::size_t known = std::min(frequencies_Hz.size(), fit.level().lines_Hz.size());
  for (std::size_t i = 0; i < known; ++i) {
    const double turn = 2.0 * std::numbers::pi * (fit.level().lines_Hz[i] - frequencies_Hz[i]) * half_s;
    const std::complex<double> line = std::complex(wave[2 * i], -wave[2 * i + 1]) * std::polar(1.0, turn);
    coefficients[2 * i] = line.real();
    coefficients[2 * i + 1] = -line.imag();
  }
  return coefficients;
}

bool is_same_hum(const BlockFit& fit, const std::vector<double>& frequencies_Hz) {
  constexpr double kNothing = 0.02;  // of the noise
  const std::vector<FittedLine> lines = fitted_lines(fit);
  if (lines.empty() || lines.size() != frequencies_Hz.size()) return false;
  const double span_s = fit.scales().time_end_s - fit.scales().time_begin_s;
  double difference = 0.0;  // root of the mean square over the recording, phases equal in its middle
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double turns = (frequencies_Hz[i] - lines[i].frequency_Hz) * span_s;
    difference = std::hypot(difference, lines[i].force * turns * std::numbers::pi / std::sqrt(6.0));
  }
  return difference < kNothing * fit.scales().noise;
}

std::optional<DriveRipple> fitted_ripple(const BlockFit& fit) {
  const double stick_slope = std::exp(fit.parameters.values(kLogStiffness)) * fit.scales().speed_m_per_s;
  std::optional<DriveRipple> largest;
  for (const FittedLine& line : fitted_lines(fit)) {
    const double share = 2.0 * std::numbers::pi * line.frequency_Hz * line.force / stick_slope;
    const bool may_be_of_drive = !line.is_of_mains && share > thresholds::kNegligible && share < 1.0;
    if (!may_be_of_drive || (largest && share < largest->speed_share)) continue;
    largest = DriveRipple{line.frequency_Hz, share};
  }
  return largest;
}

}  // namespace slipfit::fit
