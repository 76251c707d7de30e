#include "fit/level/hum_search.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "core/fit_thresholds.hpp"
#include "fit/level/rest.hpp"
#include "fit/level/stick_ripple.hpp"
#include "signal/mains.hpp"
#include "signal/transform.hpp"

namespace slipfit::fit {
namespace {

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

/// New lines in what a fit leaves.
class NewLines {
 public:
  NewLines(const BlockFit& fit, const Rest& rest, const std::optional<StickRipple>& in_sticks)
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
      if (is_large && prominence.of(square) > thresholds::kSureLine) seen_Hz_.push_back(*other_Hz);
    }
    if (in_sticks && is_new(in_sticks->frequency_Hz) && !is_near_one_of(in_sticks->frequency_Hz, seen_Hz_)) {
      seen_Hz_.push_back(in_sticks->frequency_Hz);
    }
  }

  [[nodiscard]] std::size_t seen() const { return seen_Hz_.size(); }

  /// Returns the new lines that are no images of others or of what is left of the known ones.
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
  return refine_all(fit, Rest(recording, fit, std::move(residuals)));
}

HumSearch find_hum(const Recording& recording, const BlockFit& fit, std::vector<double> residuals,
                   const std::vector<std::size_t>& outliers, const std::optional<StickRipple>& in_sticks) {
  for (const std::size_t sample : outliers) residuals[sample] = 0.0;  // they would smear over the spectrum
  Rest rest(recording, fit, std::move(residuals));
  std::vector<double> strong_Hz;
  HumSearch found;
  {
    const NewLines lines(fit, rest, in_sticks);
    strong_Hz = lines.strong();
    found.others_wait = !strong_Hz.empty() && strong_Hz.size() < lines.seen();
  }
  // A new line is taken where its peak is; its hum must be fitted before its frequency is worth refining.
  found.lines_Hz = refine_all(fit, std::move(rest));
  found.lines_Hz.insert(found.lines_Hz.end(), strong_Hz.begin(), strong_Hz.end());
  return found;
}

}  // namespace slipfit::fit
