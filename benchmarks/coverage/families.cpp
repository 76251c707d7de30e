#include "families.hpp"

#include <algorithm>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <utility>

#include "slipfit/model/simulation.hpp"

namespace coverage {
namespace {

using slipfit::ForceView;

/// Boost's distributions give the same numbers with every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : generator_(seed) {}
  double uniform(double low, double high) {
    return boost::random::uniform_real_distribution<double>(low, high)(generator_);
  }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  double normal() { return boost::random::normal_distribution<double>()(generator_); }
  std::size_t below(std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(uniform(0.0, static_cast<double>(count))));
  }

 private:
  std::mt19937_64 generator_;
};

/// The ranges are those of recordings of soft contacts in the laboratory: see docs/validation.md.
struct Draw {
  double stiffness_N_per_m, omega_rad_per_s, zeta, lambda, kinetic_N, difference_N, speed_m_per_s;
  double samples_per_slip, cycles;
  double spread = 0.0;  // of the static friction, in F_s - F_k
  double noise = 0.0;   // in F_s - F_k
  ForceView view = ForceView::Spring;
};

constexpr double kMostSamples = 20000.0;
constexpr double kFewestCycles = 10.0;

Draw draw_scene(const std::string& family, Dice& dice) {
  Draw d{};
  d.stiffness_N_per_m = dice.log_uniform(200.0, 45000.0);
  d.omega_rad_per_s = dice.log_uniform(40.0, 3600.0);
  d.zeta = dice.uniform(0.005, 0.12);
  d.lambda = dice.log_uniform(family == "sparse" ? 20.0 : 2.0, family == "sparse" ? 180.0 : 110.0);
  const double limit = slipfit::critical_lambda(d.zeta);
  if (family == "boundary") d.lambda = limit * dice.uniform(1.03, 1.3);
  if (family == "ringdown") d.lambda = limit * dice.uniform(0.4, 0.97);
  d.lambda = std::max(d.lambda, family == "ringdown" ? 0.0 : 1.02 * limit);
  d.kinetic_N = dice.log_uniform(0.3, 25.0);
  d.difference_N = d.kinetic_N * dice.log_uniform(0.1, 1.0);
  d.speed_m_per_s = d.omega_rad_per_s * d.difference_N / (d.stiffness_N_per_m * d.lambda);
  d.samples_per_slip = family == "sparse" ? dice.log_uniform(0.5, 3.0) : dice.log_uniform(20.0, 60.0);
  d.cycles = family == "sparse" ? dice.uniform(30.0, 75.0) : dice.log_uniform(12.0, 60.0);
  d.noise = dice.log_uniform(0.002, 0.04);
  return d;
}

/// Empty below the limit of stick-slip.
std::optional<slipfit::LimitCycle> cycle_of(const Draw& d) {
  const auto slider = slipfit::Slider::create(d.stiffness_N_per_m, d.omega_rad_per_s, d.zeta).value();
  const auto friction = slipfit::Friction::create(d.kinetic_N + d.difference_N, d.kinetic_N).value();
  return slipfit::damped_motion(slider, friction, d.speed_m_per_s).cycle;
}

struct Trace {
  std::vector<double> time_s;
  std::vector<double> force_N;
  std::vector<double> clean_N;  ///< before noise
};

/// From a random phase of the second cycle on: a recording seldom begins at rest.
Trace simulate_trace(const Draw& d, double noise_N, std::uint64_t seed, Dice& dice) {
  const auto slider = slipfit::Slider::create(d.stiffness_N_per_m, d.omega_rad_per_s, d.zeta).value();
  const auto friction = slipfit::Friction::create(d.kinetic_N + d.difference_N, d.kinetic_N).value();
  const auto cycle = cycle_of(d);
  const double slip_s = cycle ? cycle->slip_s : 2.0 * std::numbers::pi / d.omega_rad_per_s;
  slipfit::SimulationOptions options;
  options.sample_rate_Hz = d.samples_per_slip / slip_s;
  options.force_view = d.view;
  options.static_friction_sd_N = d.spread * d.difference_N;
  options.seed = seed;
  const double rate_N_per_s = d.stiffness_N_per_m * d.speed_m_per_s;
  // Below the limit: the end of the first ramp, one slip, steady sliding.
  const double begin_s = cycle ? friction.static_N() / rate_N_per_s + cycle->period_s * dice.uniform(0.1, 1.1)
                               : (friction.kinetic_N() - 0.2 * d.difference_N) / rate_N_per_s;
  const double length_s = cycle ? cycle->period_s * d.cycles : 1600.0 / options.sample_rate_Hz;
  options.duration_s = begin_s + length_s;
  const slipfit::SimulatedTrace simulated = slipfit::simulate(slider, friction, d.speed_m_per_s, options);
  Trace trace;
  for (std::size_t i = 0; i < simulated.time_s.size(); ++i) {
    if (simulated.time_s[i] < begin_s) continue;
    trace.time_s.push_back(simulated.time_s[i] - begin_s);
    trace.clean_N.push_back(simulated.force_N[i]);
    trace.force_N.push_back(simulated.force_N[i] + noise_N * dice.normal());
  }
  return trace;
}

/// A long period is sampled less finely, or fewer cycles of it are recorded, to hold the cap on the samples.
void hold_cap(Draw& d) {
  const auto cycle = cycle_of(d);
  if (!cycle) return;
  const double per_cycle = d.samples_per_slip * cycle->period_s / cycle->slip_s;
  d.cycles = std::max(kFewestCycles, std::min(d.cycles, kMostSamples / per_cycle));
  if (d.cycles * per_cycle > kMostSamples) d.samples_per_slip *= kMostSamples / (d.cycles * per_cycle);
}

void add_dropout(Trace& trace, const Draw&, Dice& dice) {
  const std::size_t length = trace.time_s.size() / 10;
  const std::size_t begin = static_cast<std::size_t>(dice.uniform(0.2, 0.7) * static_cast<double>(trace.time_s.size()));
  for (auto* values : {&trace.time_s, &trace.force_N}) {
    const auto at = values->begin() + static_cast<std::ptrdiff_t>(begin);
    values->erase(at, at + static_cast<std::ptrdiff_t>(length));
  }
}

void clip(Trace& trace, const Draw& d, Dice& dice) {
  const double ceiling_N = d.kinetic_N + d.difference_N * dice.uniform(0.6, 0.95);
  for (double& f : trace.force_N) f = std::min(f, ceiling_N);
}

void add_impulses(Trace& trace, const Draw& d, Dice& dice) {
  for (double& f : trace.force_N) {
    if (dice.uniform(0.0, 1.0) < 0.0025) f += d.difference_N * dice.uniform(-8.0, 8.0);
  }
}

void quantise(Trace& trace, const Draw& d, Dice& dice) {
  const double step_N = d.difference_N * dice.log_uniform(0.02, 0.15);
  for (double& f : trace.force_N) f = step_N * std::round(f / step_N);
}

void add_drift(Trace& trace, const Draw& d, Dice& dice) {
  const double size_N = d.difference_N * dice.uniform(1.0, 4.0);
  const double bend = dice.uniform(-1.0, 1.0);
  for (std::size_t i = 0; i < trace.time_s.size(); ++i) {
    const double x = trace.time_s[i] / trace.time_s.back();
    trace.force_N[i] += size_N * (x + bend * x * (1.0 - x));
  }
}

void lose_numbers(Trace& trace, const Draw&, Dice& dice) {
  Trace kept;
  for (std::size_t i = 0; i < trace.time_s.size(); ++i) {
    if (dice.uniform(0.0, 1.0) < 0.0025) continue;  // the reader leaves such rows out
    kept.time_s.push_back(trace.time_s[i]);
    kept.force_N.push_back(trace.force_N[i]);
  }
  trace = std::move(kept);
}

/// The stamps are off by a quarter of a step from when the samples were taken.
void shake_clock(Trace& trace, const Draw&, Dice& dice) {
  const double step_s = trace.time_s[1] - trace.time_s[0];
  double last_s = -step_s;
  for (double& t : trace.time_s) {
    t = std::max(last_s, t + step_s * std::clamp(0.18 * dice.normal(), -0.45, 0.45));
    last_s = t;
  }
}

void add_hum(Trace& trace, const Draw& d, Dice& dice) {
  const double line_Hz = dice.uniform(0.0, 1.0) < 0.5 ? 50.0 : 60.0;
  const double size_N = d.difference_N * dice.log_uniform(0.05, 0.5);
  const double phase = dice.uniform(0.0, 2.0 * std::numbers::pi);
  for (std::size_t i = 0; i < trace.time_s.size(); ++i) {
    trace.force_N[i] += size_N * std::sin(2.0 * std::numbers::pi * line_Hz * trace.time_s[i] + phase);
  }
}

using Damage = std::function<void(Trace&, const Draw&, Dice&)>;
const std::vector<std::pair<std::string, Damage>>& damages() {
  static const std::vector<std::pair<std::string, Damage>> all{
      {"dropout", add_dropout}, {"clipped", clip},      {"impulses", add_impulses}, {"quantised", quantise},
      {"drift", add_drift},     {"nans", lose_numbers}, {"uneven", shake_clock},    {"hum", add_hum}};
  return all;
}

void add_correlated_noise(Trace& trace, double noise_N, Dice& dice) {
  constexpr double kCorrelation = 0.9;
  double value = dice.normal();
  for (double& f : trace.force_N) {
    f += noise_N * value;
    value = kCorrelation * value + std::sqrt(1.0 - kCorrelation * kCorrelation) * dice.normal();
  }
}

/// White noise, hum or a random walk about the kinetic friction: no stick-slip at all.
Trace steady_trace(const Draw& d, const std::string& note, Dice& dice) {
  const double rate_Hz = dice.log_uniform(500.0, 10000.0);
  const double line_Hz = dice.uniform(0.0, 1.0) < 0.5 ? 50.0 : 60.0;
  const double hum_N = d.difference_N * dice.log_uniform(0.05, 1.0);
  const double step_N = d.difference_N * dice.log_uniform(0.005, 0.1);
  Trace trace;
  double walk_N = 0.0;
  for (std::size_t i = 0; i < 8000; ++i) {
    const double t = static_cast<double>(i) / rate_Hz;
    trace.time_s.push_back(t);
    double force_N = d.kinetic_N + 0.04 * d.difference_N * dice.normal();
    if (note == "hum") force_N += hum_N * std::sin(2.0 * std::numbers::pi * line_Hz * t);
    if (note == "wander") force_N += (walk_N += step_N * dice.normal());
    trace.force_N.push_back(force_N);
  }
  return trace;
}

slipfit::Recording record(const Trace& trace, const Draw& d) {
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = d.speed_m_per_s;
  conditions.force_view = d.view;
  return slipfit::Recording::create(trace.time_s, trace.force_N, conditions).value();
}

std::uint64_t seed_of(const std::string& family, std::uint64_t index, std::uint64_t seed) {
  std::uint64_t hash = 1469598103934665603ULL ^ seed;  // FNV-1a, so that families differ
  for (const char c : family) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash + 1000003ULL * index;
}

/// What distinguishes the recordings of one family.
std::string choose_note(const std::string& family, std::uint64_t index, Draw& d, Dice& dice) {
  if (family == "jitter" || family == "ar1") d.spread = dice.log_uniform(0.02, 0.15);
  if (family == "sparse") {
    d.spread = index % 2 == 0 ? 0.0 : dice.log_uniform(0.02, 0.15);
    return d.spread > 0.0 ? "jittered" : "regular";
  }
  if (family == "view") {
    d.view = index % 2 == 0 ? ForceView::Transmitted : ForceView::Contact;
    return index % 2 == 0 ? "transmitted" : "contact";
  }
  if (family == "defect") return damages()[index % damages().size()].first;
  if (family == "steady") return std::vector<std::string>{"white", "hum", "wander"}[index % 3];
  return {};
}

}  // namespace

const std::vector<std::string>& family_names() {
  static const std::vector<std::string> names{"clean",  "jitter", "sparse", "boundary", "ringdown",
                                              "steady", "view",   "defect", "ar1"};
  return names;
}

bool is_stick_slip(const std::string& family) {
  return family != "ringdown" && family != "steady";
}

Scene make_scene(const std::string& family, std::uint64_t index, std::uint64_t seed) {
  const std::uint64_t scene_seed = seed_of(family, index, seed);
  Dice dice(scene_seed);
  Draw d = draw_scene(family, dice);
  const std::string note = choose_note(family, index, d, dice);
  hold_cap(d);
  const double noise_N = d.noise * d.difference_N;
  const bool correlated = family == "ar1";
  Trace trace = family == "steady" ? steady_trace(d, note, dice)
                                   : simulate_trace(d, correlated ? 0.0 : noise_N, scene_seed, dice);
  std::vector<double> nearly_noiseless_N;
  if (family == "clean") {
    for (std::size_t i = 0; i < trace.time_s.size(); ++i) {
      nearly_noiseless_N.push_back(trace.clean_N[i] + 0.03 * (trace.force_N[i] - trace.clean_N[i]));
    }
  }
  if (correlated) add_correlated_noise(trace, noise_N, dice);
  if (family == "defect") damages()[index % damages().size()].second(trace, d, dice);
  const auto cycle = cycle_of(d);
  const double spacing_m = cycle ? cycle->periodic_displacement_m : 0.0;
  const Truth truth{d.stiffness_N_per_m, d.omega_rad_per_s, d.zeta, d.difference_N, spacing_m};
  return {family, note, scene_seed, truth, record(trace, d), noise_N, std::move(nearly_noiseless_N)};
}

}  // namespace coverage
