#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "core/thresholds.hpp"
#include "signal/comb.hpp"
#include "signal/mains.hpp"
#include "signal/transform.hpp"
#include "slipfit/signal/spectrum.hpp"

namespace slipfit {
namespace {

using signal::BandPower;
using signal::Comb;
using signal::CombGrid;
using signal::CombRange;
using signal::MainsLine;

constexpr double kFineCycles = 24.0;  // up to here on the finely padded spectrum of the thinned trace
constexpr double kManyCycles = 16.0;  // from here on the spectrum as it is
constexpr std::size_t kThinnedSamples = 2048;
constexpr std::size_t kPadding = 8;

/// The spectrum in the two forms that the search needs, mains lines flattened.
struct Bands {
  Spectrum flat;
  BandPower fine;                   ///< thinned trace, padded: few cycles
  BandPower whole;                  ///< the spectrum as computed
  std::vector<MainsLine> unwanted;  ///< no comb may begin at one of these
};

std::vector<double> flattened(std::vector<double> power, double bin_Hz, double resolution_Hz,
                              const std::vector<MainsLine>& lines) {
  for (const MainsLine& line : lines) signal::flatten(power, bin_Hz, resolution_Hz, line);
  return power;
}

BandPower fine_bands(const Recording& recording, const std::vector<bool>& held, double resolution_Hz,
                     const std::vector<MainsLine>& lines) {
  const bool as_it_is = held.empty() && recording.clock_is_even();
  signal::UniformTrace trace{recording.duration_s() / static_cast<double>(recording.size() - 1), {}};
  if (!as_it_is) trace = signal::resample(recording, held);
  const std::span<const double> force = as_it_is ? recording.force() : std::span<const double>(trace.force);
  const std::size_t factor = std::max<std::size_t>(1, force.size() / kThinnedSamples);
  const std::vector<double> thinned = signal::thin(force, factor);
  const std::size_t length = signal::good_length(kPadding * thinned.size());
  const double bin_Hz = 1.0 / (trace.step_s * static_cast<double>(factor * length));
  return {flattened(signal::hann_power(thinned, length), bin_Hz, resolution_Hz, lines), bin_Hz, resolution_Hz};
}

Bands prepare(const Recording& recording, const Spectrum& spectrum, const std::vector<bool>& held,
              const std::vector<MainsLine>& unwanted) {
  const double step_s = recording.duration_s() / static_cast<double>(recording.size() - 1);
  const double resolution_Hz = 1.0 / (recording.duration_s() + step_s);
  Spectrum flat{spectrum.bin_Hz, flattened(spectrum.power, spectrum.bin_Hz, resolution_Hz, unwanted)};
  BandPower whole(flat.power, flat.bin_Hz, resolution_Hz);
  return {std::move(flat), fine_bands(recording, held, resolution_Hz, unwanted), std::move(whole), unwanted};
}

/// All combs worth a look between two frequencies.
std::vector<Comb> search(const Bands& bands, CombRange range) {
  const double bin = bands.whole.resolution_Hz();
  const CombRange few{std::max(range.low_Hz, thresholds::kFewestPeriods * bin),
                      std::min({range.high_Hz, kFineCycles * bin, 0.8 * bands.fine.highest_Hz()})};
  const CombRange many{std::max(range.low_Hz, kManyCycles * bin),
                       std::min(range.high_Hz, 0.8 * bands.whole.highest_Hz())};
  std::vector<Comb> combs = signal::search_combs(bands.fine, few, CombGrid::Fine);
  const bool narrow = many.high_Hz - many.low_Hz < 100.0 * bin;
  const std::vector<Comb> more = signal::search_combs(bands.whole, many, narrow ? CombGrid::Fine : CombGrid::Peaks);
  combs.insert(combs.end(), more.begin(), more.end());
  for (Comb& comb : combs) comb.false_alarm_probability = std::min(1.0, 2.0 * comb.false_alarm_probability);
  std::erase_if(combs, [&](const Comb& comb) {
    return signal::is_on_line(bands.unwanted, comb.frequency_Hz, comb.relative_width * comb.frequency_Hz);
  });
  return combs;
}

/// Returns true if a comb has more than a trace of the power at and above its frequency. A weak line of the electronics
/// that is conspicuous in a long recording only by its sharpness is not a motion of the slider (two recordings of
/// friction without a visible repetition had such lines with 0.04 % of the power).
bool is_visible(const Comb& comb, const Spectrum& spectrum) {
  const std::vector<double>& power = spectrum.power;
  const auto from = std::min(power.size(), static_cast<std::size_t>(0.5 * comb.frequency_Hz / spectrum.bin_Hz));
  const double all = std::accumulate(power.begin() + static_cast<std::ptrdiff_t>(from), power.end(), 0.0);
  const double own = std::accumulate(comb.power.begin(), comb.power.end(), 0.0);
  return own > 0.003 * all;
}

/// Returns the comb that explains most lines, of those that noise does not produce; otherwise the one that is least
/// likely from noise.
Comb choose(const std::vector<Comb>& combs) {
  Comb best;
  for (const Comb& comb : combs) {
    const bool significant = comb.false_alarm_probability <= thresholds::kSignificant;
    const bool best_significant = best.false_alarm_probability <= thresholds::kSignificant;
    const bool better = significant ? !best_significant || comb.score > best.score
                                    : !best_significant && comb.false_alarm_probability < best.false_alarm_probability;
    if (better) best = comb;
  }
  return best;
}

Comb best_visible(const Bands& bands, CombRange range) {
  std::vector<Comb> combs = search(bands, range);
  for (;;) {
    const Comb best = choose(combs);
    if (best.false_alarm_probability > thresholds::kSignificant || is_visible(best, bands.flat)) return best;
    std::erase_if(combs, [&](const Comb& comb) { return comb.frequency_Hz == best.frequency_Hz; });
  }
}

/// A sub-harmonic has every line of the true comb, and chance lines of its own (harmonics that come back from beyond
/// the Nyquist frequency, a few cycles that alternate). The lines of a saw-tooth that are not multiples of an order
/// carry more than half of what the multiples carry, even without the fundamental; with less than a quarter the order
/// is taken out.
Comb without_subharmonic(const BandPower& bands, const Comb& comb) {
  for (const std::size_t order : {5U, 4U, 3U, 2U}) {
    double own = 0.0;
    double shared = 0.0;
    for (std::size_t h = 1; h <= comb.measured; ++h) (h % order == 0 ? shared : own) += comb.power[h - 1];
    if (own > 0.25 * shared || comb.measured < order) continue;
    // Its line need not be where the sub-harmonic would have it to better than a resolution.
    Comb best = signal::best_comb(bands, 10, comb.relative_width, [&](int step) {
      return comb.frequency_Hz * static_cast<double>(order) + 0.2 * step * bands.resolution_Hz();
    });
    best.false_alarm_probability = comb.false_alarm_probability;
    if (best.ratio[0] > 4.0) return best;
  }
  return comb;
}

/// Narrows a broad comb to the maximum of its power.
Comb narrowed(const BandPower& bands, Comb comb) {
  while (comb.relative_width * comb.frequency_Hz > 1.5 * bands.resolution_Hz()) {
    const double width = 0.5 * comb.relative_width;
    const Comb best =
        signal::best_comb(bands, 2, width, [&](int step) { return comb.frequency_Hz * (1.0 + 0.5 * step * width); });
    if (best.score <= 0.0) break;
    comb.frequency_Hz = best.frequency_Hz;
    comb.relative_width = width;
  }
  return comb;
}

/// The number of significant harmonics, counted up to the highest one; no more than the time allowed for one pass over
/// the trace.
std::size_t usable_harmonics(const Comb& comb, std::size_t samples) {
  std::size_t usable = 1;
  for (std::size_t h = 0; h < comb.measured; ++h) {
    if (comb.ratio[h] > 4.0) usable = h + 1;
  }
  const std::size_t affordable = std::max<std::size_t>(2, 1000000 / samples);
  return std::min(usable, affordable);
}

signal::TrackedFrequency refine(const Recording& recording, const Comb& comb, double resolution_Hz) {
  const std::size_t harmonics = usable_harmonics(comb, recording.size());
  const double cycles = comb.frequency_Hz / resolution_Hz;
  if (cycles >= 8.0) {
    const auto tracked = signal::track_frequency(recording, comb.frequency_Hz, harmonics);
    if (tracked && std::abs(tracked->frequency_Hz / comb.frequency_Hz - 1.0) < 0.3) return *tracked;
  }
  if (cycles < 2.0 * kFineCycles) {
    if (const auto fitted = signal::fit_harmonics(recording, comb.frequency_Hz, harmonics)) return *fitted;
  }
  const double error = std::max(0.3 * resolution_Hz, 0.5 * comb.relative_width * comb.frequency_Hz);
  return {comb.frequency_Hz, error, std::nullopt};
}

/// Relative error of the frequency by sampling: harmonics beyond the Nyquist frequency come back next to the lines that
/// are used and turn their phases, slowly where a period is nearly a whole number of samples. Their size is taken from
/// the lines just below the Nyquist frequency.
double aliasing_error(const BandPower& bands, double frequency_Hz) {
  const double lines = std::floor(bands.highest_Hz() / frequency_Hz) - 1.0;
  double sum = 0.0;
  double counted = 0.0;
  const auto line_power = [&](double line) {
    const double reach = std::min(1.5 * bands.resolution_Hz(), 0.2 * frequency_Hz);
    const double beside = 0.5 * (bands.mean(line - 0.6 * frequency_Hz, line - 0.4 * frequency_Hz) +
                                 bands.mean(line + 0.4 * frequency_Hz, line + 0.6 * frequency_Hz));
    return std::max(0.0, bands.mean(line - reach, line + reach) - beside) / line;
  };
  for (double h = std::max(1.0, lines - 20.0); h < lines; h += 1.0) {
    sum += line_power(h * frequency_Hz);
    counted += 1.0;
  }
  const double fundamental = line_power(frequency_Hz);
  if (counted < 1.0 || fundamental <= 0.0) return 0.0;
  const double turned_rad = 0.5 * std::sqrt(sum / counted / fundamental);
  const double cycles = frequency_Hz / bands.resolution_Hz();
  // Evenly spread over +- turned_rad at either end.
  return std::sqrt(2.0 / 3.0) * turned_rad / (2.0 * std::numbers::pi * cycles);
}

/// Returns the centroid of the power of each line of the comb.
std::vector<double> line_centres(const BandPower& bands, const Comb& comb, double frequency_Hz) {
  std::vector<double> centres;
  for (std::size_t h = 0; h < comb.measured; ++h) {
    if (h > 0 && comb.ratio[h] < 3.0) continue;
    const double line = static_cast<double>(h + 1) * frequency_Hz;
    const double half = std::min(std::max(2.0 * bands.resolution_Hz(), comb.relative_width * line), 0.3 * frequency_Hz);
    const double slice = half / 8.0;
    double sum = 0.0;
    double moment = 0.0;
    for (int k = -8; k <= 8; ++k) {
      const double offset = slice * static_cast<double>(k);
      const double power = bands.mean(line + offset - 0.5 * slice, line + offset + 0.5 * slice);
      sum += power;
      moment += power * offset;
    }
    centres.push_back(line + (sum > 0.0 ? moment / sum : 0.0));
  }
  return centres;
}

/// Everything about the comb that was chosen; nothing where it turns out to be mains.
void measure(const Recording& recording, const Bands& bands, const Comb& chosen, SpectralFrequency& found) {
  const double resolution_Hz = bands.whole.resolution_Hz();
  const BandPower& used = chosen.frequency_Hz < kFineCycles * resolution_Hz ? bands.fine : bands.whole;
  const Comb comb = narrowed(used, without_subharmonic(used, chosen));
  const signal::TrackedFrequency refined = refine(recording, comb, resolution_Hz);
  if (signal::is_on_line(bands.unwanted, refined.frequency_Hz, 0.0)) {
    found.false_alarm_probability = 1.0;
    return;
  }
  found.value_Hz = refined.frequency_Hz;
  const double aliasing_Hz = refined.frequency_Hz * aliasing_error(bands.whole, refined.frequency_Hz);
  found.standard_error_Hz = std::hypot(refined.standard_error_Hz, aliasing_Hz);
  if (refined.regular_standard_error_Hz) {
    found.regular_standard_error_Hz = std::hypot(*refined.regular_standard_error_Hz, aliasing_Hz);
  }
  found.harmonics_Hz = line_centres(used, comb, refined.frequency_Hz);
}

/// Returns true if a line is a harmonic of the frequency found.
bool belongs(double line_Hz, const SpectralFrequency& found, double resolution_Hz) {
  const double order = std::round(line_Hz / *found.value_Hz);
  const double off = std::abs(line_Hz - order * *found.value_Hz);
  const double known = std::max(resolution_Hz, 3.0 * order * found.standard_error_Hz.value_or(0.0));
  return order >= 1.0 && off < std::min(known, 0.1 * *found.value_Hz);
}

double swing_of(const Spectrum& spectrum, const MainsLine& line) {
  const double top = static_cast<double>(spectrum.power.size()) - 1.0;
  const double low = std::clamp(std::ceil((line.frequency_Hz - line.width_Hz) / spectrum.bin_Hz), 0.0, top);
  const double high = std::clamp(std::floor((line.frequency_Hz + line.width_Hz) / spectrum.bin_Hz), 0.0, top);
  double power = 0.0;
  for (double i = low; i <= high; i += 1.0) power += spectrum.power[static_cast<std::size_t>(i)];
  return 2.0 * std::sqrt(2.0 * power);
}

std::vector<SuspiciousLine> suspicious(const Spectrum& spectrum, const std::vector<MainsLine>& lines,
                                       const SpectralFrequency& found, double resolution_Hz, double sample_rate_Hz) {
  std::vector<SuspiciousLine> result;
  for (const MainsLine& line : lines) {
    bool own = false;
    if (found.value_Hz) {
      own = belongs(line.frequency_Hz, found, resolution_Hz) ||
            belongs(sample_rate_Hz - line.frequency_Hz, found, resolution_Hz);  // come back from beyond Nyquist
    }
    if (!own) result.push_back({line.frequency_Hz, signal::describe(line), swing_of(spectrum, line)});
  }
  return result;
}

}  // namespace

SpectralFrequency find_frequency(const Recording& recording, const Spectrum& spectrum, std::optional<double> hint_Hz,
                                 const std::vector<bool>& held) {
  SpectralFrequency found;
  if (recording.size() < 16 || spectrum.power.size() < 8) return found;
  const double step_s = recording.duration_s() / static_cast<double>(recording.size() - 1);
  const double resolution_Hz = 1.0 / (recording.duration_s() + step_s);
  std::vector<MainsLine> mains = signal::find_mains(spectrum.power, spectrum.bin_Hz, resolution_Hz);
  if (!mains.empty()) mains = signal::lasting_mains(std::move(mains), signal::resample(recording, held));
  const Bands bands = prepare(recording, spectrum, held, signal::without_hinted(mains, hint_Hz));
  Comb comb;
  if (hint_Hz) comb = best_visible(bands, {0.7 * *hint_Hz, 1.4 * *hint_Hz});
  if (comb.false_alarm_probability > thresholds::kSignificant) {
    comb = best_visible(bands, {0.0, bands.whole.highest_Hz()});
  }
  found.false_alarm_probability = comb.false_alarm_probability;
  if (comb.false_alarm_probability <= thresholds::kSignificant) {
    const std::optional<Recording> even = signal::on_even_clock(recording, held);
    measure(even ? *even : recording, bands, comb, found);
  }
  found.suspicious_lines = suspicious(spectrum, mains, found, resolution_Hz, 1.0 / step_s);
  return found;
}

}  // namespace slipfit
