#include "surface/spacing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/student.hpp"
#include "core/surface_thresholds.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/signal/spectrum.hpp"

namespace slipfit::surface {
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
    if (pattern.log_chance > thresholds::kPatternChance || distance < thresholds::kFewestRidgeSamples) continue;
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
  if (!comb || !comb->is_sure() || comb->value < thresholds::kFewestRidgeSamples) return std::nullopt;
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
