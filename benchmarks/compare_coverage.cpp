// Pairs of groups of simulated recordings, with and without a true difference: how often `compare` finds one that is
// not there, and how often its intervals hold the true difference and ratio. Beside it, other ways to join repeats.
// docs/validation.md quotes what it prints.
//   compare_coverage [PAIRS [SEED [JOBS]]]

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "in_parallel.hpp"
#include "slipfit/compare.hpp"
#include "slipfit/model/motion.hpp"
#include "slipfit/model/simulation.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/report/json.hpp"

namespace {

using slipfit::ComparedFit;
using slipfit::Estimate;

constexpr std::size_t kMostRepeats = 5;
constexpr std::array<const char*, 6> kKeys{"stiffness_N_per_m", "friction_difference_N", "natural_frequency_rad_per_s",
                                           "damping_ratio",     "frequency_Hz",          "pattern_spacing_m"};

/// What a recording is made of; of a test also the mean over its repeats.
struct Body {
  double stiffness = 0.0, difference = 0.0, omega = 0.0, zeta = 0.0;
};

/// A pair's rig: the same for both sides.
struct Rig {
  double speed = 0.0, kinetic = 0.0, noise_share = 0.0, jitter_share = 0.0, cycles = 0.0, samples_per_cycle = 0.0;
};

using Dice = std::mt19937_64;
double uniform(Dice& dice, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(dice);
}
double around(Dice& dice, double mean, double relative_sd) {
  return mean * std::max(0.1, 1.0 + relative_sd * std::normal_distribution<double>()(dice));
}

/// One repeat: 3 % in k, 2 % in w_n, 15 % in zeta, 5 % in F_s - F_k; times `scatter`.
Body repeat_of(const Body& mean, double scatter, Dice& dice) {
  return {around(dice, mean.stiffness, 0.03 * scatter), around(dice, mean.difference, 0.05 * scatter),
          around(dice, mean.omega, 0.02 * scatter), around(dice, mean.zeta, 0.15 * scatter)};
}

std::optional<slipfit::LimitCycle> cycle_of(const Body& body, const Rig& rig) {
  const auto slider = slipfit::Slider::create(body.stiffness, body.omega, body.zeta);
  const auto friction = slipfit::Friction::create(rig.kinetic + body.difference, rig.kinetic);
  return damped_motion(slider.value(), friction.value(), rig.speed).cycle;
}

/// In the order of kKeys; means over repeats, because the frequency is not linear in what scatters.
std::array<double, kKeys.size()> truth_of(const Body& mean, double scatter, const Rig& rig, Dice dice) {
  const int draws = scatter > 0.0 ? 400 : 1;
  std::array<double, kKeys.size()> truth{mean.stiffness, mean.difference, mean.omega, mean.zeta, 0.0, 0.0};
  for (int i = 0; i < draws; ++i) {
    const double period = cycle_of(repeat_of(mean, scatter, dice), rig)->period_s;
    truth[4] += 1.0 / period / draws;
    truth[5] += rig.speed * period / draws;
  }
  return truth;
}

ComparedFit fitted(const Body& body, const Rig& rig, std::uint64_t seed) {
  const slipfit::LimitCycle cycle = *cycle_of(body, rig);
  slipfit::SimulationOptions options;
  options.duration_s = (rig.cycles + 2.0) * cycle.period_s;
  options.sample_rate_Hz = rig.samples_per_cycle / cycle.period_s;
  options.static_friction_sd_N = rig.jitter_share * body.difference;
  options.noise_rms_N = rig.noise_share * body.difference;
  options.seed = seed;
  const auto slider = slipfit::Slider::create(body.stiffness, body.omega, body.zeta);
  const auto friction = slipfit::Friction::create(rig.kinetic + body.difference, rig.kinetic);
  slipfit::SimulatedTrace trace = simulate(slider.value(), friction.value(), rig.speed, options);
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = rig.speed;
  conditions.sensor_average_s = 0.0;
  const auto recording = slipfit::Recording::create(std::move(trace.time_s), std::move(trace.force_N), conditions);
  return slipfit::compared_fit(to_json(recording.value(), analyze_and_fit(recording.value()))).value();
}

/// Rates over the pairs in which a quantity is known.
struct Tally {
  std::size_t known = 0, alarms = 0, difference_held = 0, ratio_held = 0, ratios = 0;
  std::map<std::string, std::size_t> others;  ///< alarms of other ways to join repeats

  void add(const Tally& tally) {
    known += tally.known;
    alarms += tally.alarms;
    difference_held += tally.difference_held;
    ratio_held += tally.ratio_held;
    ratios += tally.ratios;
    for (const auto& [name, count] : tally.others) others[name] += count;
  }
};
using Tallies = std::array<Tally, kKeys.size() + 1>;  // the last: any quantity, p by Holm

// Other ways to join the repeats of a side: a mean with its variance and degrees of freedom.
struct Joined {
  double mean = 0.0, variance = 0.0, freedom = 1e9;
};

Joined weighted(const std::vector<Estimate>& values, double between) {
  double sum = 0.0;
  Joined joined;
  for (const Estimate& value : values) sum += 1.0 / (between + *value.standard_error * *value.standard_error);
  for (const Estimate& value : values) {
    joined.mean += *value.value / (between + *value.standard_error * *value.standard_error) / sum;
  }
  joined.variance = 1.0 / sum;
  return joined;
}

/// DerSimonian and Laird's variance between recordings.
double between_variance(const std::vector<Estimate>& values) {
  const Joined fixed = weighted(values, 0.0);
  double q = 0.0, sum = 0.0, squares = 0.0;
  for (const Estimate& value : values) {
    const double weight = 1.0 / (*value.standard_error * *value.standard_error);
    q += weight * std::pow(*value.value - fixed.mean, 2);
    sum += weight;
    squares += weight * weight;
  }
  return std::max(0.0, (q - static_cast<double>(values.size() - 1)) / (sum - squares / sum));
}

Joined knapp_hartung(const std::vector<Estimate>& values) {
  const double between = between_variance(values);
  Joined joined = weighted(values, between);
  double q = 0.0;
  for (const Estimate& value : values) {
    q += std::pow(*value.value - joined.mean, 2) / (between + *value.standard_error * *value.standard_error);
  }
  joined.freedom = static_cast<double>(values.size() - 1);
  joined.variance *= q / joined.freedom;
  return joined;
}

Joined plain(const std::vector<Estimate>& values) {
  Joined joined;
  const auto count = static_cast<double>(values.size());
  for (const Estimate& value : values) joined.mean += *value.value / count;
  for (const Estimate& value : values) joined.variance += std::pow(*value.value - joined.mean, 2);
  joined.variance /= count * (count - 1.0);
  joined.freedom = count - 1.0;
  return joined;
}

bool is_alarm(const Joined& a, const Joined& b) {
  const double variance = a.variance + b.variance;
  const double freedom =
      variance * variance / (a.variance * a.variance / a.freedom + b.variance * b.variance / b.freedom);
  const boost::math::students_t_distribution<double> student(std::clamp(freedom, 1.0, 1e6));
  return std::abs(b.mean - a.mean) > quantile(student, 0.975) * std::sqrt(variance);
}

std::vector<Estimate> values_in(const std::vector<ComparedFit>& fits, std::size_t quantity) {
  std::vector<Estimate> values;
  for (const ComparedFit& fit : fits) {
    const Estimate& value = fit.values[quantity].estimate;
    if (value.value && value.standard_error && *value.standard_error > 0.0) values.push_back(value);
  }
  return values;
}

void add_others(const std::vector<ComparedFit>& a, const std::vector<ComparedFit>& b, const std::string& key,
                Tally& tally) {
  const auto quantities = slipfit::compared_quantities();
  const auto at = std::find_if(quantities.begin(), quantities.end(), [&key](const auto& q) { return q.key == key; });
  const auto values_a = values_in(a, static_cast<std::size_t>(at - quantities.begin()));
  const auto values_b = values_in(b, static_cast<std::size_t>(at - quantities.begin()));
  if (values_a.size() < 2 || values_b.size() < 2) return;
  const auto random = [](const std::vector<Estimate>& v) { return weighted(v, between_variance(v)); };
  tally.others["standard_errors_alone"] += is_alarm(weighted(values_a, 0.0), weighted(values_b, 0.0)) ? 1U : 0U;
  tally.others["dersimonian_laird"] += is_alarm(random(values_a), random(values_b)) ? 1U : 0U;
  tally.others["knapp_hartung"] += is_alarm(knapp_hartung(values_a), knapp_hartung(values_b)) ? 1U : 0U;
  tally.others["welch_plain"] += is_alarm(plain(values_a), plain(values_b)) ? 1U : 0U;
}

struct Setting {
  std::size_t repeats_a = 1, repeats_b = 1;
  double scatter = 0.0;  ///< of repeats, times the usual one
  bool differs = false;
};

/// A rig and a body that slides as testers' do: lambda 3 to 12.
struct Scene {
  Rig rig;
  Body mean;
};

Scene draw_scene(Dice& dice) {
  Scene scene;
  Body& body = scene.mean;
  body = {std::exp(uniform(dice, 6.2, 8.5)), uniform(dice, 0.5, 5.0), uniform(dice, 100.0, 400.0),
          uniform(dice, 0.03, 0.12)};
  const double lambda = uniform(dice, 3.0, 12.0);
  scene.rig = {body.omega * body.difference / (lambda * body.stiffness),
               uniform(dice, 2.0, 8.0),
               std::exp(uniform(dice, std::log(0.005), std::log(0.05))),
               std::exp(uniform(dice, std::log(0.005), std::log(0.1))),
               uniform(dice, 15.0, 50.0),
               uniform(dice, 60.0, 140.0)};
  return scene;
}

Tallies compare_pair(const Setting& setting, std::uint64_t seed) {
  Dice dice(seed);
  const Scene scene = draw_scene(dice);
  const Body& a = scene.mean;
  const Body b = setting.differs ? Body{1.1 * a.stiffness, 1.15 * a.difference, 0.95 * a.omega, 1.3 * a.zeta} : a;
  slipfit::ComparisonSide side_a{"a", {}};
  slipfit::ComparisonSide side_b{"b", {}};
  for (std::size_t i = 0; i < kMostRepeats; ++i) {
    const Body repeat_a = repeat_of(a, setting.scatter, dice);
    const Body repeat_b = repeat_of(b, setting.scatter, dice);
    if (i < setting.repeats_a) side_a.fits.push_back(fitted(repeat_a, scene.rig, dice()));
    if (i < setting.repeats_b) side_b.fits.push_back(fitted(repeat_b, scene.rig, dice()));
  }
  const auto truth_a = truth_of(a, setting.scatter, scene.rig, Dice(1));
  const auto truth_b = truth_of(b, setting.scatter, scene.rig, Dice(1));
  const slipfit::Comparison comparison = slipfit::compare(side_a, side_b);
  Tallies tallies;
  tallies.back().known = 1;
  for (const slipfit::QuantityComparison& quantity : comparison.quantities) {
    if (quantity.differs()) tallies.back().alarms = 1;
    const auto* const key = std::find(kKeys.begin(), kKeys.end(), quantity.quantity.key);
    if (key == kKeys.end() || !quantity.p_value) continue;
    const auto i = static_cast<std::size_t>(key - kKeys.begin());
    Tally& tally = tallies[i];
    const auto holds = [](const Estimate& estimate, double truth) {
      return estimate.ci95->low <= truth && truth <= estimate.ci95->high;
    };
    tally.known = 1;
    tally.alarms = *quantity.p_value < 0.05 ? 1 : 0;
    tally.difference_held = holds(quantity.difference, truth_b[i] - truth_a[i]) ? 1 : 0;
    tally.ratios = quantity.ratio.value ? 1 : 0;
    tally.ratio_held = quantity.ratio.value && holds(quantity.ratio, truth_b[i] / truth_a[i]) ? 1 : 0;
    add_others(side_a.fits, side_b.fits, *key, tally);
  }
  return tallies;
}

Tallies run(const Setting& setting, std::size_t pairs, std::uint64_t seed, unsigned jobs) {
  const auto parts = in_parallel(pairs, jobs, [&](std::size_t i) { return compare_pair(setting, seed + i); });
  Tallies sum;
  for (const Tallies& part : parts) {
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k].add(part[k]);
  }
  return sum;
}

std::string percent(std::size_t count, std::size_t of) {
  return of == 0 ? "-" : fmt::format("{:.1f}", 100.0 * static_cast<double>(count) / static_cast<double>(of));
}

void print(const Setting& setting, const Tallies& tallies) {
  const std::string name = fmt::format("{}_vs_{},{},{}", setting.repeats_a, setting.repeats_b, setting.scatter,
                                       setting.differs ? "differ" : "equal");
  for (std::size_t k = 0; k < tallies.size(); ++k) {
    const Tally& tally = tallies[k];
    fmt::print("{},{},{},{},{},{}", name, k < kKeys.size() ? kKeys[k] : "any_by_holm", tally.known,
               percent(tally.alarms, tally.known), k < kKeys.size() ? percent(tally.difference_held, tally.known) : "-",
               k < kKeys.size() ? percent(tally.ratio_held, tally.ratios) : "-");
    for (const char* const other : {"standard_errors_alone", "dersimonian_laird", "knapp_hartung", "welch_plain"}) {
      const auto found = tally.others.find(other);
      fmt::print(",{}", found == tally.others.end() ? "-" : percent(found->second, tally.known));
    }
    fmt::print("\n");
  }
}

}  // namespace

int main(int count, char** words) {
  const std::size_t pairs = count > 1 ? std::strtoul(words[1], nullptr, 10) : 1000;
  const std::uint64_t seed = count > 2 ? std::strtoul(words[2], nullptr, 10) : 70000;
  const auto jobs = static_cast<unsigned>(count > 3 ? std::strtoul(words[3], nullptr, 10) : 2);
  fmt::print(
      "# alarms: % of the pairs with p below 0.05; held: % of the intervals that hold the truth; the last four: alarms "
      "of other ways to join repeats\n"
      "repeats,scatter,truth,quantity,pairs,alarms,difference_held,ratio_held,standard_errors_alone,dersimonian_laird,"
      "knapp_hartung,welch_plain\n");
  const auto study = [&](const Setting& setting) {
    print(setting, run(setting, pairs, seed, jobs));
    std::fflush(stdout);
  };
  for (const bool differs : {false, true}) {
    study({1, 1, 0.0, differs});
    study({3, 3, 1.0, differs});
    study({5, 5, 1.0, differs});
    study({1, 3, 1.0, differs});
  }
  study({3, 3, 0.0, false});
  study({1, 1, 1.0, false});  // two recordings differ, what they are of does not: scatter_unknown
}
