#include "surface/spacing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "signal/student.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/signal/spectrum.hpp"
#include "surface/filter.hpp"

namespace slipfit::surface {
namespace {

/// Scatter over mean of the distances of ridges on random surfaces (white, Gaussian, exponential, fractal, grooves at
/// random places): 0.39 in the median at every scale, above 0.30 in 95 of 100. The smaller is taken.
constexpr double kRandomVariation = 0.33;
/// A profile is looked at on some 30 scales with four features each.
constexpr double kChance = -7.0;
constexpr double kStillRegular = -3.0;  // at a distance that the scan has shown
constexpr double kKeptChance = 0.3;     // share of the best logarithm
constexpr double kSureComb = 1e-4;
constexpr double kCertainComb = 1e-10;
constexpr double kHintOfRidges = -1.5;
constexpr std::size_t kFewestRidges = 6;
constexpr double kFewestSamples = 6.0;       // of a ridge
constexpr double kFewestCombSamples = 10.0;  // of one that only the spectrum shows
constexpr double kMuchSmoothing = 0.25;

/// The feature whose distances are second in regularity (the first of four is so by luck, too), and what chance has to
/// do with it.
Pattern pattern_of(Ridges ridges) {
  Pattern pattern;
  std::vector<std::pair<double, const std::vector<double>*>> features;
  for (const auto* places : {&ridges.peaks, &ridges.falls, &ridges.valleys, &ridges.rises}) {
    if (places->size() >= kFewestRidges - 1) features.emplace_back(variation(distances(*places)), places);
  }
  if (features.size() >= 2) {
    std::sort(features.begin(), features.end());
    pattern.variation = features[1].first;
    pattern.places = *features[1].second;
    const double freedom = static_cast<double>(pattern.places.size()) - 2.0;
    const double ratio = std::clamp(std::pow(pattern.variation / kRandomVariation, 2.0), 1e-8, 1.0);
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
    if (pattern.log_chance > kChance || distance < kFewestSamples) continue;
    const bool is_same = !found.empty() && distance > 0.6 * mean_distance(found.back());
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

/// A comb of lines in the spectrum of the profile.
struct CombSpacing {
  double value = 0.0;
  double standard_error = 0.0;
  double chance = 1.0;
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
    const double error = *found.standard_error_Hz * spacing * spacing * signal::students_factor(ridges - 2.0);
    return CombSpacing{spacing, error, found.false_alarm_probability};
  }

 private:
  std::optional<Recording> trace_;
  Spectrum spectrum_;
};

MeanSpacing normal_interval(double value, double standard_error) {
  const double half = 1.959963985 * standard_error;
  return {value, standard_error, {value - half, value + half}};
}

/// Long smoothing joins short ridges, short smoothing leaves roughness between them: the shortest at which they are
/// still regular is taken, and the distance to the one at which they are most regular counts as an error.
Pattern choose(std::vector<Pattern> looks) {
  const auto by_chance = [](const Pattern& a, const Pattern& b) { return a.log_chance < b.log_chance; };
  const auto best = std::min_element(looks.begin(), looks.end(), by_chance);
  const auto first = std::find_if(looks.begin(), looks.end(),
                                  [&](const Pattern& p) { return p.log_chance <= kKeptChance * best->log_chance; });
  Pattern chosen = *first;
  chosen.spacing = mean_spacing(distances(chosen.places));
  if (!chosen.spacing) return chosen;
  chosen.is_clocked = chosen.spacing->standard_error < 0.6 * chosen.variation * chosen.spacing->value /
                                                           std::sqrt(static_cast<double>(chosen.places.size()));
  const double apart = std::abs(mean_distance(*best) - mean_distance(*first));
  const MeanSpacing& mean = *chosen.spacing;
  if (apart > 0.1 * mean.standard_error) {
    chosen.spacing = normal_interval(mean.value, std::hypot(mean.standard_error, apart));
  }
  return chosen;
}

/// One pattern of the scan, measured.
Pattern measured(std::span<const double> heights, const Combs& combs, const Pattern& seen) {
  const double distance = mean_distance(seen);
  std::vector<Pattern> looks = looked_at(heights, distance);
  std::erase_if(looks, [&](const Pattern& p) {
    return p.log_chance > kStillRegular || std::abs(mean_distance(p) / distance - 1.0) > 0.3;
  });
  const auto comb = combs.find(distance);
  const bool agrees = comb && comb->chance < kSureComb && std::abs(comb->value / distance - 1.0) < 0.15;
  Pattern pattern = looks.empty() ? seen : choose(std::move(looks));
  if (comb) pattern.comb_chance = comb->chance;
  // Where the ridges are as regular as a clock the phases of the comb know the spacing far better than their places.
  const bool is_sharper =
      agrees && (!pattern.spacing || (pattern.is_clocked && comb->standard_error < pattern.spacing->standard_error));
  if (is_sharper) {
    pattern.spacing = normal_interval(comb->value, comb->standard_error);
    pattern.is_from_comb = true;
  }
  const bool is_hidden = pattern.ridges.smoothed_over > kMuchSmoothing * mean_distance(pattern);
  if (is_hidden && !agrees) {
    pattern.spacing = std::nullopt;
    pattern.doubt = "roughness hides how many ridges there are";
  }
  if (!pattern.spacing && pattern.doubt.empty()) pattern.doubt = "the ridges are seen at one smoothing only";
  return pattern;
}

/// A comb that roughness hides from the count: believed where ridges of that distance show at any smoothing.
std::optional<Pattern> by_comb(std::span<const double> heights, const Combs& combs) {
  const auto comb = combs.find(std::nullopt);
  if (!comb || comb->chance > kSureComb || comb->value < kFewestSamples) return std::nullopt;
  Pattern best;
  for (Pattern& look : looked_at(heights, comb->value)) {
    const bool same = std::abs(mean_distance(look) / comb->value - 1.0) < 0.1;
    const bool is_certain = comb->chance < kCertainComb && comb->value > kFewestCombSamples;
    const bool shows = look.log_chance < kHintOfRidges || is_certain;
    if (same && shows && (best.places.empty() || look.log_chance < best.log_chance)) best = std::move(look);
  }
  best.comb_chance = comb->chance;
  if (best.places.empty()) {
    best.doubt = "a line of the spectrum stands out, but no ridges are seen at its spacing";
    best.comb_spacing = comb->value;
    return best;
  }
  best.spacing = normal_interval(comb->value, comb->standard_error);
  best.is_from_comb = true;
  return best;
}

/// Edges of a coarser pattern have short waves of their own: a whole number of them for each of its ridges.
bool is_overtone(const Pattern& fine, const Pattern& coarse) {
  const double ratio = mean_distance(coarse) / mean_distance(fine);
  return ratio < 2.5 || (ratio < 12.5 && std::abs(ratio - std::round(ratio)) < 0.15);
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
    if (!patterns.empty() && is_overtone(seen, patterns.front())) {
      // Every third of regular ridges may stand out by chance.
      const bool is_surer = pattern.spacing && pattern.log_chance < 2.0 * patterns.front().log_chance;
      if (is_surer) patterns = {std::move(pattern)};
    } else if (patterns.empty() || !patterns.front().spacing) {
      patterns = {std::move(pattern)};
    } else if (pattern.spacing) {
      patterns.push_back(std::move(pattern));
    }
  }
  if (!patterns.empty()) return patterns;
  if (auto pattern = by_comb(heights, combs)) patterns.push_back(std::move(*pattern));
  return patterns;
}

}  // namespace slipfit::surface
