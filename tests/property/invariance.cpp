#include "invariance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "slipfit/io/recording_reader.hpp"

using namespace slipfit;

namespace test {
namespace {

void scale(std::optional<double>& quantity, double factor) {
  if (quantity) *quantity *= factor;
}

Scene with_force(Scene scene, double factor, double offset) {
  for (double& force : scene.force_N) force = factor * force + offset;
  return scene;
}

double mean_size(const Scene& scene) {
  double sum = 0.0;
  for (const double force : scene.force_N) sum += std::abs(force);
  return sum / static_cast<double>(scene.force_N.size());
}

/// An unknown zero: a stated one would be wrong now.
Scene with_zero_moved(Scene scene, double means) {
  scene.conditions.zero_force_N.reset();
  const double offset = means * mean_size(scene);
  return with_force(std::move(scene), 1.0, offset);
}

/// The smallest force is then a tenth of the range of all.
Scene with_zero_near(Scene scene) {
  scene.conditions.zero_force_N.reset();
  const auto [low, high] = std::minmax_element(scene.force_N.begin(), scene.force_N.end());
  const double offset = 0.1 * (*high - *low) - *low;
  return with_force(std::move(scene), 1.0, offset);
}

Scene in_unit(Scene scene, double factor) {
  Conditions& conditions = scene.conditions;
  for (auto* quantity : {&conditions.normal_force_N, &conditions.zero_force_N, &conditions.mass_kg,
                         &conditions.mass_standard_error_kg}) {
    scale(*quantity, factor);
  }
  return with_force(std::move(scene), factor, 0.0);
}

/// All that happens takes `factor` times as long, over the same path.
Scene with_clock(Scene scene, double factor, double start_s) {
  for (double& time : scene.time_s) time = start_s + factor * time;
  Conditions& conditions = scene.conditions;
  conditions.speed_m_per_s /= factor;
  scale(conditions.speed_standard_error_m_per_s, 1.0 / factor);
  scale(conditions.sensor_bandwidth_Hz, 1.0 / factor);
  scale(conditions.sensor_resonance_Hz, 1.0 / factor);
  scale(conditions.sensor_average_s, factor);
  scale(conditions.drive_period_s, factor);
  scale(conditions.mass_kg, factor * factor);
  scale(conditions.mass_standard_error_kg, factor * factor);
  return scene;
}

/// The first and the last sample stay: they are the ends of the clock.
template <class IsLost>
Scene without_samples(const Scene& scene, const IsLost& is_lost) {
  Scene kept{scene.described, {}, {}, scene.conditions};
  for (std::size_t i = 0; i < scene.time_s.size(); ++i) {
    if (i > 0 && i + 1 < scene.time_s.size() && is_lost(i)) continue;
    kept.time_s.push_back(scene.time_s[i]);
    kept.force_N.push_back(scene.force_N[i]);
  }
  return kept;
}

Scene without_one(const Scene& scene, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  const std::size_t lost = 1 + generator() % (scene.time_s.size() - 2);
  return without_samples(scene, [lost](std::size_t i) { return i == lost; });
}

Scene without_a_thousandth(const Scene& scene, std::uint64_t seed) {
  std::mt19937_64 generator(seed + 1);
  return without_samples(scene, [&generator](std::size_t) { return generator() % 1000 == 0; });
}

Transform of_clock(const std::string& name, double factor) {
  return {name,
          [factor](Scene scene) { return with_clock(std::move(scene), factor, 0.0); },
          {{"natural_frequency_rad_per_s", 1.0 / factor}, {"frequency_Hz", 1.0 / factor}}};
}

using Number = std::pair<std::string, Estimate>;

std::vector<Number> numbers_of(const Analysis& analysis) {
  std::vector<Number> numbers{{"frequency_Hz", analysis.frequency.quoted},
                              {"pattern_spacing_m", analysis.derived.pattern_spacing_m}};
  constexpr std::array<ParameterId, 4> kParameters{ParameterId::Stiffness, ParameterId::FrictionDifference,
                                                   ParameterId::NaturalFrequency, ParameterId::DampingRatio};
  for (const ParameterId id : kParameters) {
    numbers.emplace_back(info(id).key, Estimate{});
    if (!analysis.fit) continue;
    for (const Parameter& parameter : analysis.fit->parameters) {
      if (parameter.id == id) numbers.back().second = parameter.estimate;
    }
  }
  return numbers;
}

/// Standard error; where there is none, a quarter of the interval.
std::optional<double> error_of(const Estimate& estimate) {
  if (estimate.standard_error) return estimate.standard_error;
  if (estimate.ci95) return 0.25 * (estimate.ci95->high - estimate.ci95->low);
  return std::nullopt;
}

}  // namespace

std::string Differences::text() const {
  std::string text = in_motion ? "kind of motion" : "";
  for (const auto* list : {&in_numbers, &in_knowledge}) {
    for (const std::string& entry : *list) text += (text.empty() ? "" : "; ") + entry;
  }
  return text;
}

std::vector<Transform> invariances(std::uint64_t seed) {
  constexpr double kUnit = 4448.0;
  const Factors in_other_unit{{"stiffness_N_per_m", kUnit}, {"friction_difference_N", kUnit}};
  return {
      {"zero moved up", [](Scene scene) { return with_zero_moved(std::move(scene), 5.0); }, {}},
      {"zero moved near the force", [](Scene scene) { return with_zero_near(std::move(scene)); }, {}},
      {"zero moved beyond the force",
       [](Scene scene) { return with_zero_moved(std::move(scene), -5.0); },
       {},
       0.3,
       false},
      {"sign turned",
       [](Scene scene) {
         scale(scene.conditions.zero_force_N, -1.0);
         return with_force(std::move(scene), -1.0, 0.0);
       },
       {}},
      {"other unit of force", [](Scene scene) { return in_unit(std::move(scene), kUnit); }, in_other_unit},
      of_clock("clock times 1.17", 1.17),
      of_clock("clock times 0.83", 0.83),
      {"clock starts later", [](Scene scene) { return with_clock(std::move(scene), 1.0, 1234.5); }, {}},
      {"one sample lost", [seed](const Scene& scene) { return without_one(scene, seed); }, {}, 1.0},
      {"0.1 % of the samples lost", [seed](const Scene& scene) { return without_a_thousandth(scene, seed); }, {}, 1.0}};
}

Differences differences(const Analysis& before, const Analysis& after, const Transform& transform) {
  Differences differences;
  differences.in_motion = before.motion != after.motion;
  const std::vector<Number> first = numbers_of(before);
  const std::vector<Number> second = numbers_of(after);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto& [name, expected] = first[i];
    const Estimate& found = second[i].second;
    if (expected.value.has_value() != found.value.has_value()) {
      differences.in_knowledge.push_back(fmt::format("{} {}", name, expected.value ? "lost" : "gained"));
      continue;
    }
    const std::optional<double> error = error_of(expected);
    if (!expected.value || !error) continue;
    const auto known = transform.factors.find(name);
    const double factor = known == transform.factors.end() ? 1.0 : known->second;
    const double off = std::abs(*found.value / factor - *expected.value);
    if (off <= transform.allowed_errors * *error) continue;
    differences.in_numbers.push_back(
        fmt::format("{} {:.6g} -> {:.6g} ({:.2g} se)", name, *expected.value, *found.value / factor, off / *error));
  }
  return differences;
}

Analysis analyse_as_read(const Scene& scene) {
  const auto pieces = read_samples({"scene", scene.time_s, scene.force_N}, scene.conditions);
  if (!pieces) throw std::runtime_error(pieces.error().message);
  return analyze_and_fit(pieces.value().front().recording);
}

}  // namespace test
