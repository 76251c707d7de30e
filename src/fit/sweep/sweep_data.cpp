#include "fit/sweep/sweep_data.hpp"

#include <algorithm>
#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/polygamma.hpp>
#include <boost/math/special_functions/trigamma.hpp>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "fit/inference/intervals.hpp"
#include "signal/smoothing.hpp"

namespace slipfit::fit {

namespace {

double spread_of_levels(const DampedFit& fit) {
  std::vector<double> levels;
  for (const Local& local : fit.blocks.parameters.cycles) levels.push_back(local[2]);
  return fit.blocks.scales().force * describe(levels).sd;
}

/// Returns the approximate time from the end of a slip to the next onset.
double typical_stick_s(const BlockFit& blocks) {
  const double period_s = median_period_s(blocks);
  const CycleState state = blocks.state(blocks.size() / 2);
  return std::max(0.05 * period_s, period_s - state.slip_s());
}

/// Mean of a steady recording; its error from stretches, which see wander as well as noise.
SteadyRun steady_run(const Recording& recording, double load) {
  const auto force = recording.force();
  std::vector<double> means;
  for (std::size_t part = 0; part < kSteadyStretches; ++part) {
    const std::size_t begin = part * force.size() / kSteadyStretches;
    const std::size_t end = (part + 1) * force.size() / kSteadyStretches;
    if (end > begin) means.push_back(slipfit::mean_of(force.subspan(begin, end - begin)));
  }
  const MeanAndSpread of_means = describe(means);
  return {recording.conditions().speed_m_per_s, load, of_means.mean, of_means.sd / std::sqrt(of_means.count)};
}

/// Returns the normal forces of the recordings in N, empty where one is not known. Where the measured ones follow the
/// force as F_n = a + s F, friction of mu F_n is F_k = mu a / (1 - mu s), and the load there is a / (1 - mu s). s and
/// mu s are the means of the recordings, so that their errors make no load differ from another.
std::vector<std::optional<double>> loads_N(std::span<const SweepRecording> recordings,
                                           const std::vector<std::optional<DampedFit>>& fits) {
  std::vector<std::optional<double>> loads;
  std::vector<std::size_t> following;
  std::vector<LoadResponse> responses;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const Recording& recording = recordings[i].recording;
    loads.push_back(recording.conditions().normal_force_N);
    const auto response = fits[i] ? load_response(recording, level_of(*fits[i]), fits[i]->blocks.size()) : std::nullopt;
    if (!response) continue;
    following.push_back(i);
    responses.push_back(*response);
  }
  if (following.empty()) return loads;
  const LoadResponse mean = mean_response(responses);
  for (const std::size_t i : following) {
    const Recording& recording = recordings[i].recording;
    const double intercept_N =
        describe(recording.normal_force_N()).mean - mean.slope * describe(recording.force()).mean;
    loads[i] = intercept_N / (1.0 - mean.share);
  }
  return loads;
}

/// Adds the normal forces of the recordings, if all are known.
void add_loads(std::span<const SweepRecording> recordings, SweepData& data) {
  data.loads.assign(recordings.size(), 1.0);
  std::vector<double> known_N;
  for (const std::optional<double>& load : loads_N(recordings, data.single)) {
    if (!load) return;
    known_N.push_back(*load);
  }
  const double mean = slipfit::mean_of(known_N);
  const auto [low, high] = std::minmax_element(known_N.begin(), known_N.end());
  data.mean_load_N = std::clamp(mean, *low, *high);  // exactly the load where all are the same
  for (std::size_t i = 0; i < recordings.size(); ++i) data.loads[i] = known_N[i] / *data.mean_load_N;
}

/// Scatter of each recording's onset force, moderated: strokes and short runs have three cycles each.
void add_onset_scatter(SweepData& data) {
  std::vector<SampleVariance> samples;
  for (const std::size_t i : data.fitted) {
    const DampedFit& fit = *data.single[i];
    const double mean = std::abs(mean_onset_force(fit));
    // Cycles without any scatter still carry the error of their own onset force.
    const double sd = std::max(fit.uncertainty.onset_force_sd * fit.blocks.scales().force, 1e-5 * mean);
    samples.push_back({std::pow(sd / data.loads[i], 2), fit.blocks.size()});
  }
  const std::vector<double> variances = moderated_variances(samples);
  data.onset_sd.assign(data.single.size(), 0.0);
  for (std::size_t f = 0; f < variances.size(); ++f) {
    data.onset_sd[data.fitted[f]] = std::sqrt(variances[f]) * data.loads[data.fitted[f]];
  }
}

}  // namespace

double mean_onset_force(const DampedFit& fit) {
  double sum = 0.0;
  for (const Local& local : fit.blocks.parameters.cycles) sum += local[1];
  return fit.blocks.scales().force * sum / static_cast<double>(fit.blocks.size());
}

double spread_of_onsets(const DampedFit& fit) {
  return fit.uncertainty.onset_force_sd * fit.blocks.scales().force / std::abs(mean_onset_force(fit));
}

double level_of(const DampedFit& fit) {
  const BlockFit& blocks = fit.blocks;
  if (!blocks.level().per_cycle) return blocks.scales().level + blocks.scales().force * blocks.parameters.level[0];
  double sum = 0.0;
  for (const Local& local : blocks.parameters.cycles) sum += local[2];
  return blocks.scales().level + blocks.scales().force * sum / static_cast<double>(blocks.size());
}

Scales scales_in_sweep(const SweepData& data, std::size_t recording, FrictionLaw law) {
  const DampedFit& fit = *data.single[recording];
  const double load = data.loads[recording];
  Scales scales = fit.blocks.scales();
  scales.noise = fit.uncertainty.noise;
  const bool is_averaged = data.average && fit.average;
  scales.free_time = is_averaged ? FreeTime::Average : FreeTime::None;
  if (is_averaged)
    scales.sensor_time_unit_s = scales.sensor_average_s = data.average->seconds;  // one of all recordings
  scales.law = law;
  if (depends_on_speed(law)) scales.relaxing.reset();
  Population population;
  population.load = load;
  population.force = load * data.units.force;
  population.slip_speed_m_per_s = data.units.slip_speed_m_per_s;
  population.onset_sd = data.onset_sd[recording];
  const double mean = std::abs(mean_onset_force(fit));
  if (fit.blocks.level().per_cycle) {
    // A level that wanders is no independent draw in each cycle: all of them together count as one.
    population.level_sd =
        std::max(spread_of_levels(fit), 1e-5 * mean) * std::sqrt(static_cast<double>(fit.blocks.size()));
  }
  scales.population = population;
  return scales;
}

SweepData prepare_sweep(std::span<const SweepRecording> recordings, const FitOptions& options,
                        const std::optional<FittedAverage>& known) {
  SweepData data;
  static_cast<OwnFits&>(data) = fit_each(recordings, options.held, known);
  data.notify_step = options.notify_step;
  add_loads(recordings, data);
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const SweepRecording& sweep = recordings[i];
    data.steady_of.emplace_back();
    if (sweep.role == SweepRole::Steady) {
      data.steady_of.back() = data.steady.size();
      data.steady.push_back(steady_run(sweep.recording, data.loads[i]));
    }
    if (data.single[i]) data.fitted.push_back(i);
  }
  add_onset_scatter(data);
  std::vector<double> forces;
  std::vector<double> impedances;
  std::vector<double> sticks_s;
  double log_speeds = 0.0;
  for (const std::size_t i : data.fitted) {
    log_speeds += std::log(data.single[i]->blocks.scales().speed_m_per_s);
    sticks_s.push_back(typical_stick_s(data.single[i]->blocks));
    const Coordinates& values = data.single[i]->blocks.parameters.values;
    forces.push_back(std::abs(mean_onset_force(*data.single[i])) / data.loads[i]);
    impedances.push_back(std::exp(values(kLogStiffness) - values(kLogFrequency)));
  }
  if (forces.empty()) return data;
  data.units.force = signal::median(forces);
  data.units.slip_speed_m_per_s = data.units.force / signal::median(impedances);
  data.units.stick_s = signal::median(sticks_s);
  data.units.speed_m_per_s = std::exp(log_speeds / static_cast<double>(data.fitted.size()));
  return data;
}

bool relaxes(const SweepData& data) {
  return std::ranges::any_of(data.fitted,
                             [&](std::size_t i) { return data.single[i]->blocks.scales().relaxing.has_value(); });
}

namespace {

double degrees_of(const SampleVariance& sample) {
  return std::max(1.0, static_cast<double>(sample.count) - 1.0);
}

/// Mean of the logarithm of a chi-square variable over its degrees of freedom.
double mean_of_log(double degrees) {
  return boost::math::digamma(0.5 * degrees) - std::log(0.5 * degrees);
}

/// y with trigamma(y) = x > 0: Newton's method on 1 / trigamma, which is convex.
double inverse_trigamma(double x) {
  double y = 0.5 + 1.0 / x;
  for (int i = 0; i < 50; ++i) {
    const double value = boost::math::trigamma(y);
    const double step = value * (1.0 - value / x) / boost::math::polygamma(2, y);
    y += step;
    if (std::abs(step) < 1e-8 * y) break;
  }
  return y;
}

/// Holds the variance that the samples have in common, and how many degrees of freedom it counts for; empty: infinitely
/// many.
struct Common {
  double variance = 0.0;
  std::optional<double> degrees;
};

Common common_of(const std::vector<SampleVariance>& samples) {
  const auto count = static_cast<double>(samples.size());
  double mean = 0.0;
  double by_chance = 0.0;
  double weighted = 0.0;
  double weights = 0.0;
  std::vector<double> logs;
  for (const SampleVariance& sample : samples) {
    const double degrees = degrees_of(sample);
    logs.push_back(std::log(sample.variance) - mean_of_log(degrees));
    mean += logs.back() / count;
    by_chance += boost::math::trigamma(0.5 * degrees) / count;
    weighted += degrees * sample.variance;
    weights += degrees;
  }
  double square = 0.0;
  for (const double one : logs) square += (one - mean) * (one - mean);
  const double beyond_chance = square / (count - 1.0) - by_chance;
  if (!(beyond_chance > 0.0)) return {weighted / weights, std::nullopt};
  const double degrees = 2.0 * inverse_trigamma(beyond_chance);
  return {std::exp(mean + mean_of_log(degrees)), degrees};
}

}  // namespace

std::vector<double> moderated_variances(const std::vector<SampleVariance>& samples) {
  std::vector<double> moderated;
  const Common common = samples.size() > 1 ? common_of(samples) : Common{0.0, 0.0};
  for (const SampleVariance& sample : samples) {
    const double own = degrees_of(sample);
    moderated.push_back(common.degrees
                            ? (*common.degrees * common.variance + own * sample.variance) / (*common.degrees + own)
                            : common.variance);
  }
  return moderated;
}

std::optional<LoadResponse> load_response(const Recording& recording, double kinetic_force, std::size_t cycles) {
  constexpr double kLeastError = 1e-6;  // no column is exact
  const std::span<const double> load_N = recording.normal_force_N();
  const std::span<const double> force = recording.force();
  if (load_N.empty() || recording.conditions().quantity != ForceQuantity::Force_N) return std::nullopt;
  const LineSums line = line_sums(
      force.size(), [&](std::size_t i) { return force[i]; }, [&](std::size_t i) { return load_N[i]; });
  if (!(line.square > 0.0) || !(line.at(kinetic_force) > 0.0)) return std::nullopt;
  const double friction_coefficient = kinetic_force / line.at(kinetic_force);
  // What the load does besides is of one cycle: noise, or the texture of the surface.
  const double error = line.slope_error() * std::sqrt(line.count / static_cast<double>(cycles));
  const LoadResponse response{friction_coefficient * line.slope(),
                              std::max(kLeastError, std::abs(friction_coefficient) * error), line.slope()};
  const bool is_clear = std::abs(response.share) > thresholds::kClearSigmas * response.standard_error &&
                        std::abs(response.share) > thresholds::kNegligible && response.share < 1.0;
  return is_clear ? std::optional(response) : std::nullopt;
}

LoadResponse mean_response(const std::vector<LoadResponse>& responses) {
  std::vector<Measured> shares, slopes;
  for (const LoadResponse& one : responses) {
    shares.push_back({one.share, one.standard_error});
    slopes.push_back({one.slope, one.standard_error * std::abs(one.slope / one.share)});
  }
  const WeightedMean share = weighted_mean(shares);
  return {share.value, share.standard_error, weighted_mean(slopes).value};
}

}  // namespace slipfit::fit
