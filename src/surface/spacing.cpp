#include "surface/spacing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "signal/events.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/signal/spectrum.hpp"
#include "surface/filter.hpp"

namespace slipfit::surface {

namespace {

/// 1 + 2 rho: what is left of the variance of a mean of many distances whose neighbours have the correlation rho. The
/// first is that of a clock: places about even marks, the mean of whose distances they know best.
constexpr std::array kRemainders = {0.0, 0.03, 0.06, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0};

/// Half for a clock, the other half even over the rest.
double prior_of(std::size_t i) {
  if (i == 0) return 0.5;
  const double low = i == 1 ? 0.0 : 0.5 * (kRemainders[i - 1] + kRemainders[i]);
  const double high = i + 1 == kRemainders.size() ? kRemainders[i] : 0.5 * (kRemainders[i] + kRemainders[i + 1]);
  return 0.5 * (high - low) / kRemainders.back();
}

/// Student's t of the mean at one correlation, and how well that correlation explains the data.
struct Component {
  double centre = 0.0;
  double width = 0.0;
  double log_evidence = 0.0;
  double weight = 0.0;
};

/// Generalised least squares with the covariance tridiagonal (rho, 1, rho), factorised on the way.
Component component(std::span<const double> distances, double rho, double origin, double floor) {
  double pivot = 1.0;
  double ones = 1.0;
  double data = distances[0] - origin;
  double one_one = 0.0;
  double one_data = 0.0;
  double data_data = 0.0;
  double log_determinant = 0.0;
  for (std::size_t i = 0;; ++i) {
    one_one += ones * ones / pivot;
    one_data += ones * data / pivot;
    data_data += data * data / pivot;
    log_determinant += std::log(pivot);
    if (i + 1 == distances.size()) break;
    const double factor = rho / pivot;
    pivot = 1.0 - rho * factor;
    ones = 1.0 - factor * ones;
    data = distances[i + 1] - origin - factor * data;
  }
  const auto n = static_cast<double>(distances.size());
  const double rest = std::max(floor, data_data - one_data * one_data / one_one);
  return {origin + one_data / one_one, std::sqrt(rest / ((n - 2.0) * one_one)),
          -0.5 * (log_determinant + std::log(one_one) + (n - 2.0) * std::log(rest)), 0.0};
}

/// One for each remainder, their weights adding up to 1. Without a clock in the spectrum there is none in the places.
std::vector<Component> mixture_of(std::span<const double> distances, const std::optional<Clock>& clock,
                                  double miscount) {
  const auto n = static_cast<double>(distances.size());
  double origin = 0.0;
  for (const double d : distances) origin += d / n;
  const double floor = n * 1e-12 * origin * origin;
  std::vector<Component> mixture;
  double best = -std::numeric_limits<double>::infinity();
  for (const double remainder : kRemainders) {
    mixture.push_back(component(distances, 0.5 * (remainder - 1.0), origin, floor));
    best = std::max(best, mixture.back().log_evidence);
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < mixture.size(); ++i) {
    const bool is_possible = i > 0 || clock;
    mixture[i].weight = is_possible ? prior_of(i) * std::exp(mixture[i].log_evidence - best) : 0.0;
    mixture[i].width = std::hypot(mixture[i].width, miscount);
    sum += mixture[i].weight;
  }
  for (Component& c : mixture) c.weight /= sum;
  if (clock) {
    mixture.front().centre = clock->spacing;
    mixture.front().width = clock->standard_error;
  }
  return mixture;
}

double student_below(double t, double freedom) {
  const double tail = 0.5 * t_chance(t, freedom);
  return t < 0.0 ? tail : 1.0 - tail;
}

double quantile(const std::vector<Component>& mixture, double freedom, double probability) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Component& c : mixture) {
    low = std::min(low, c.centre - 100.0 * c.width);
    high = std::max(high, c.centre + 100.0 * c.width);
  }
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    double below = 0.0;
    for (const Component& c : mixture) {
      if (c.weight > 1e-9) below += c.weight * student_below((middle - c.centre) / c.width, freedom);
    }
    (below < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::optional<MeanSpacing> mean_spacing(std::span<const double> distances, const std::optional<Clock>& clock,
                                        double miscount) {
  if (distances.size() < 4) return std::nullopt;
  const std::vector<Component> mixture = mixture_of(distances, clock, miscount);
  const double freedom = static_cast<double>(distances.size()) - 2.0;
  MeanSpacing mean;
  for (const Component& c : mixture) mean.value += c.weight * c.centre;
  mean.clock_share = mixture.front().weight;
  mean.ci95 = {quantile(mixture, freedom, 0.025), quantile(mixture, freedom, 0.975)};
  mean.standard_error = 0.5 * (mean.ci95.high - mean.ci95.low) / kNormalQuantile;
  return mean;
}

namespace {

/// The profile between two cut-offs, on blocks a sixteenth of the shorter.
struct Band {
  double block = 1.0;
  std::vector<double> values;

  [[nodiscard]] double place(double index) const { return (index + 0.5) * block - 0.5; }
};

Band band_of(std::span<const double> heights, double short_cutoff, double long_cutoff) {
  const auto block = std::max<std::size_t>(1, static_cast<std::size_t>(short_cutoff / 16.0));
  Band band{static_cast<double>(block), block_means(heights, block)};
  band.values = gaussian_mean(band.values, std::max(1.0, short_cutoff / band.block));
  const std::vector<double> waves = waviness(band.values, long_cutoff / band.block);
  for (std::size_t i = 0; i < waves.size(); ++i) band.values[i] -= waves[i];
  return band;
}

/// Half of the range that holds the middle four fifths of the values, as a swing: a scratch does not count.
double usual_swing(const std::vector<double>& values) {
  return quantile_of(values, 0.9) - quantile_of(values, 0.1);
}

/// Returns the position at which the values cross the midpoint of two turning points.
double crossing(const std::vector<double>& values, std::size_t from, std::size_t to) {
  const double middle = 0.5 * (values[from] + values[to]);
  const bool falls = values[from] > values[to];
  std::size_t i = from;
  while (i + 1 < to && (values[i + 1] > middle) == falls) ++i;
  const double step = values[i + 1] - values[i];
  return static_cast<double>(i) + (step == 0.0 ? 0.5 : std::clamp((middle - values[i]) / step, 0.0, 1.0));
}

/// Returns the maximum of the parabola through three values.
double top(const std::vector<double>& values, std::size_t i) {
  if (i == 0 || i + 1 >= values.size()) return static_cast<double>(i);
  const double bend = values[i - 1] - 2.0 * values[i] + values[i + 1];
  if (bend == 0.0) return static_cast<double>(i);
  return static_cast<double>(i) + std::clamp(0.5 * (values[i - 1] - values[i + 1]) / bend, -0.5, 0.5);
}

/// Finds ridges in `heights` without form. Turning points count from 0.3 of the usual amplitude on; ridges cut by the
/// ends of the profile are left out. `smoothed_over` and
/// `waves_above` are the cut-offs of the Gaussian filters that take the roughness, and form and waviness.
Ridges find_ridges(std::span<const double> heights, double smoothed_over, double waves_above) {
  Ridges ridges;
  ridges.smoothed_over = smoothed_over;
  const Band band = band_of(heights, smoothed_over, waves_above);
  if (band.values.size() < 8) return ridges;
  signal::TurningPoints turning(thresholds::kRidgeSwing * usual_swing(band.values));
  for (std::size_t i = 0; i < band.values.size(); ++i) turning.add(i, band.values[i]);
  const auto& falls = turning.falls();
  for (std::size_t j = 0; j < falls.size(); ++j) {
    if (falls[j].peak == 0 || falls[j].trough + 1 == band.values.size()) continue;
    ridges.peaks.push_back(band.place(top(band.values, falls[j].peak)));
    ridges.valleys.push_back(band.place(top(band.values, falls[j].trough)));
    ridges.falls.push_back(band.place(crossing(band.values, falls[j].peak, falls[j].trough)));
    ridges.heights.push_back(band.values[falls[j].peak] - band.values[falls[j].trough]);
    if (j + 1 < falls.size()) {
      ridges.rises.push_back(band.place(crossing(band.values, falls[j].trough, falls[j + 1].peak)));
    }
  }
  return ridges;
}

}  // namespace

std::vector<double> distances(std::span<const double> places) {
  std::vector<double> result;
  for (std::size_t i = 1; i < places.size(); ++i) result.push_back(places[i] - places[i - 1]);
  return result;
}

double variation(std::span<const double> values) {
  const MeanAndSpread found = describe(values);
  return values.size() < 2 ? 0.0 : found.sd / std::abs(found.mean);
}

namespace {

/// The feature whose distances are second in regularity (the first of four is so by luck, too), and what chance has to
/// do with it.
Pattern pattern_of(Ridges ridges) {
  Pattern pattern;
  std::vector<std::pair<double, const std::vector<double>*>> features;
  for (const auto* places : {&ridges.peaks, &ridges.falls, &ridges.valleys, &ridges.rises}) {
    if (places->size() >= thresholds::kFewestRidges - 1) features.emplace_back(variation(distances(*places)), places);
  }
  if (features.size() >= 2) {
    std::ranges::sort(features);
    pattern.variation = features[1].first;
    pattern.places = *features[1].second;
    const double freedom = static_cast<double>(pattern.places.size()) - 2.0;
    const double ratio = std::clamp(std::pow(pattern.variation / thresholds::kRandomVariation, 2.0), 1e-8, 1.0);
    // Chernoff's bound of the lower tail of chi-squared.
    pattern.log_chance = 0.5 * freedom * (1.0 - ratio + std::log(ratio));
  }
  pattern.ridges = std::move(ridges);
  return pattern;
}

/// Over scales in equal ratios; where ridges of one distance show at several scales, the most regular.
std::vector<Pattern> scan(std::span<const double> heights) {
  std::vector<Pattern> found;
  for (double scale = static_cast<double>(heights.size()) / 8.0; scale >= 2.0; scale /= 1.3) {
    Pattern pattern = pattern_of(find_ridges(heights, scale, 8.0 * scale));
    const double distance = mean_distance(pattern);
    if (pattern.log_chance > thresholds::kPatternChance || distance < thresholds::kShapeSamples) continue;
    const bool is_same = !found.empty() && distance > thresholds::kSameScale * mean_distance(found.back());
    if (!is_same) {
      found.push_back(std::move(pattern));
    } else if (pattern.log_chance < found.back().log_chance) {
      found.back() = std::move(pattern);
    }
  }
  return found;
}

/// Ridges of about this distance at several smoothings, short to long.
std::vector<Pattern> looked_at(std::span<const double> heights, double distance) {
  std::vector<Pattern> looks;
  for (const double share : {0.1, 0.14, 0.2, 0.28, 0.4, 0.55, 0.75}) {
    if (share * distance < 1.5) continue;
    looks.push_back(pattern_of(find_ridges(heights, share * distance, 4.0 * distance)));
  }
  return looks;
}

/// The profile as a trace whose time is counted in samples: nothing in it can be at the frequency of the mains.
std::optional<Recording> trace_of(std::span<const double> heights) {
  std::vector<double> samples(heights.size());
  std::iota(samples.begin(), samples.end(), 0.0);
  Conditions conditions;
  conditions.speed_m_per_s = 1.0;
  auto trace = Recording::create(std::move(samples), {heights.begin(), heights.end()}, conditions);
  if (!trace) return std::nullopt;
  return std::move(trace).value();
}

/// Share of the ridges that may be seen double or not at all: those of a normal distribution of this variation (of the
/// distances over their mean) that are shorter than is surely seen.
double miscounted(double variation) {
  return 0.5 * std::erfc((1.0 - thresholds::kShortestSeen) / (std::numbers::sqrt2 * variation));
}

/// A comb of lines in the spectrum of the profile.
struct CombSpacing {
  double value = 0.0;
  double standard_error = 0.0;
  double chance = 1.0;
  double ridges = 0.0;
  bool is_even = false;  ///< its phase shows no scatter of the distances

  /// Scatter of the distances over their mean, as the wandering of its phase has it.
  [[nodiscard]] double scatter() const { return standard_error / value * std::sqrt(ridges); }
  [[nodiscard]] bool is_sure() const { return chance < thresholds::kSureComb; }
  [[nodiscard]] Clock clock() const {
    const double miscount = is_even ? 0.0 : miscounted(scatter()) * value;
    return {value, std::hypot(standard_error, miscount)};
  }
};

class Combs {
 public:
  explicit Combs(std::span<const double> heights) : trace_(trace_of(heights)) {
    if (trace_) spectrum_ = compute_spectrum(*trace_);
  }
  [[nodiscard]] std::optional<CombSpacing> find(std::optional<double> distance) const {
    if (!trace_) return std::nullopt;
    const std::optional<double> hint = distance ? std::optional(1.0 / *distance) : std::nullopt;
    const SpectralFrequency found = find_frequency(*trace_, spectrum_, hint);
    if (!found.value_Hz || !found.standard_error_Hz) return std::nullopt;
    const double spacing = 1.0 / *found.value_Hz;
    const double ridges = static_cast<double>(trace_->size()) / spacing;
    const double error = *found.standard_error_Hz * spacing * spacing;
    return CombSpacing{spacing, error, found.false_alarm_probability, ridges,
                       found.regular_standard_error_Hz.has_value()};
  }

 private:
  std::optional<Recording> trace_;
  Spectrum spectrum_;
};

/// A comb that is used alone has to appear in both halves of the profile. What their spacings differ by is an error
/// of their mean: a phase concealed by noise may wander more than it appears to.
std::optional<MeanSpacing> mean_of_halves(std::span<const double> heights, const CombSpacing& comb) {
  const std::size_t half = heights.size() / 2;
  std::vector<double> found;
  for (const auto part : {heights.first(half), heights.last(half)}) {
    const auto seen = Combs(part).find(comb.value);
    if (!seen || std::abs(seen->value / comb.value - 1.0) > thresholds::kSameSpacing) return std::nullopt;
    found.push_back(seen->value);
  }
  const auto [value, known] = comb.clock();
  const double error = std::hypot(known, 0.5 * (found[1] - found[0]));
  return MeanSpacing{value, error, {value - kNormalQuantile * error, value + kNormalQuantile * error}, 1.0};
}

/// Upper limit (97.5 %) of the variation of the distances: few are alike by luck. Wilson and Hilferty's approximation
/// of chi-squared.
double largest_variation(const Pattern& pattern) {
  const double freedom = std::max(1.0, static_cast<double>(pattern.places.size()) - 2.0);
  const double spread = 2.0 / (9.0 * freedom);
  return pattern.variation * std::pow(1.0 - spread - kNormalQuantile * std::sqrt(spread), -1.5);
}

/// Long smoothing joins short ridges, short smoothing leaves roughness between them: the shortest at which they are
/// still regular is taken, and the distance to the one at which they are most regular counts as an error.
Pattern choose(std::vector<Pattern> looks, const std::optional<Clock>& clock) {
  const auto by_chance = [](const Pattern& a, const Pattern& b) { return a.log_chance < b.log_chance; };
  const auto best = std::ranges::min_element(looks, by_chance);
  const auto first = std::ranges::find_if(
      looks, [&](const Pattern& p) { return p.log_chance <= thresholds::kKeptChance * best->log_chance; });
  Pattern chosen = *first;
  const double distance = mean_distance(chosen);
  // Anywhere between the two smoothings.
  const double between = (mean_distance(*best) - distance) / std::numbers::sqrt3;
  const double miscount = std::hypot(between, miscounted(largest_variation(chosen)) * distance);
  chosen.spacing = mean_spacing(distances(chosen.places), clock, miscount);
  chosen.is_from_comb = clock && chosen.spacing && chosen.spacing->clock_share > 0.5;
  return chosen;
}

/// One pattern of the scan, measured.
Pattern measured(std::span<const double> heights, const Combs& combs, const Pattern& seen) {
  const double distance = mean_distance(seen);
  std::vector<Pattern> looks = looked_at(heights, distance);
  std::erase_if(
      looks, [&](const Pattern& p) { return std::abs(mean_distance(p) / distance - 1.0) > thresholds::kSameSpacing; });
  const auto comb = combs.find(distance);
  const bool agrees = comb && comb->is_sure() && std::abs(comb->value / distance - 1.0) < thresholds::kSameSpacing;
  std::optional<Clock> clock;
  if (agrees) clock = comb->clock();
  if (looks.empty() && clock) looks = {seen};
  Pattern pattern = looks.empty() ? seen : choose(std::move(looks), clock);
  if (agrees && comb->is_even) {  // what the distances scatter by is roughness, in their places or their count
    if (const auto mean = mean_of_halves(heights, *comb)) {
      pattern.spacing = mean;
      pattern.is_from_comb = true;
    }
  }
  if (!pattern.spacing) pattern.doubt = "the ridges are found at one smoothing width only";
  return pattern;
}

/// The most regular ridges of about this distance, at any smoothing; without places where there are none.
Pattern most_regular(std::span<const double> heights, double distance) {
  Pattern best;
  for (Pattern& look : looked_at(heights, distance)) {
    const bool same = std::abs(mean_distance(look) / distance - 1.0) < thresholds::kSameSpacing;
    if (same && (best.places.empty() || look.log_chance < best.log_chance)) best = std::move(look);
  }
  return best;
}

/// A comb whose ridges roughness conceals: it is accepted if ridges of that distance show at any smoothing, and more
/// plainly than those of twice it (of which it would be every second line).
std::optional<Pattern> by_comb(std::span<const double> heights, const Combs& combs) {
  const auto comb = combs.find(std::nullopt);
  if (!comb || !comb->is_sure() || comb->value < thresholds::kShapeSamples) return std::nullopt;
  Pattern best = most_regular(heights, comb->value);
  const bool shows = !best.places.empty() && best.log_chance < thresholds::kHintOfRidges &&
                     best.log_chance < most_regular(heights, 2.0 * comb->value).log_chance;
  if (!shows) {
    best.doubt = "the spectrum has a significant line, but no ridges have its spacing";
    best.comb_spacing = comb->value;
    return best;
  }
  best.spacing = mean_of_halves(heights, *comb);
  best.is_from_comb = best.spacing.has_value();
  if (!best.spacing) best.doubt = "the halves of the track show different lines of the spectrum";
  return best;
}

double mean_height(const Pattern& pattern) {
  const std::vector<double>& heights = pattern.ridges.heights;
  return std::accumulate(heights.begin(), heights.end(), 0.0) / std::max(1.0, static_cast<double>(heights.size()));
}

/// Edges of a coarser pattern have short waves of their own: a whole number of them for each of its ridges.
bool is_overtone(const Pattern& fine, const Pattern& coarse) {
  const double ratio = mean_distance(coarse) / mean_distance(fine);
  return ratio < thresholds::kFinerPattern ||
         (ratio < thresholds::kHighestOvertone && std::abs(ratio - std::round(ratio)) < thresholds::kOvertoneApart);
}

}  // namespace

double mean_distance(const Pattern& pattern) {
  if (pattern.places.size() < 2) return 0.0;
  return (pattern.places.back() - pattern.places.front()) / static_cast<double>(pattern.places.size() - 1);
}

std::vector<Pattern> find_patterns(std::span<const double> heights) {
  const Combs combs(heights);
  std::vector<Pattern> patterns;
  for (const Pattern& seen : scan(heights)) {
    Pattern pattern = measured(heights, combs, seen);
    // Every third of regular ridges may be significant by chance, and even ridges beat with even samples; but not as
    // high as the ridges themselves.
    const bool is_surer = !patterns.empty() && pattern.spacing &&
                          pattern.log_chance < 2.0 * patterns.front().log_chance &&
                          mean_height(pattern) > thresholds::kHigherRidges * mean_height(patterns.front());
    const bool is_edge = !patterns.empty() && is_overtone(seen, patterns.front());
    if (patterns.empty() || is_surer || (!is_edge && !patterns.front().spacing)) {
      patterns = {std::move(pattern)};
    } else if (!is_edge && pattern.spacing) {
      patterns.push_back(std::move(pattern));
    }
  }
  if (!patterns.empty()) return patterns;
  if (auto pattern = by_comb(heights, combs)) patterns.push_back(std::move(*pattern));
  return patterns;
}

}  // namespace slipfit::surface
