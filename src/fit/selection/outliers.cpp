#include "fit/selection/outliers.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "core/thresholds.hpp"
#include "fit/cycle/cycle_data.hpp"
#include "fit/level/level_terms.hpp"
#include "signal/smoothing.hpp"

namespace slipfit::fit {

namespace {

/// Median size of the residuals in one part of the cycles, of every stride-th where they are many.
double median_size(const Residuals& residuals, CyclePart part) {
  const auto count = static_cast<std::size_t>(std::count(residuals.part.begin(), residuals.part.end(), part));
  const std::size_t stride = signal::stride_for(count);
  std::vector<double> sizes;
  sizes.reserve(count / stride + 1);
  std::size_t until_next = 1;
  for (std::size_t i = 0; i < residuals.value.size(); ++i) {
    if (residuals.part[i] != part || --until_next > 0) continue;
    sizes.push_back(std::abs(residuals.value[i]));
    until_next = stride;
  }
  return signal::median(std::move(sizes));
}

/// Computes data minus model, cycle by cycle. In stick the model is a straight line next to the level.
class ResidualsOfCycles {
 public:
  ResidualsOfCycles(const Recording& recording, const BlockFit& fit)
      : recording_(recording), fit_(fit), result_{std::vector<double>(recording.size(), 0.0), {}} {
    result_.part.assign(recording.size(), CyclePart::None);
    for_cycles(fit.size(), recording.size(), [&](std::size_t begin, std::size_t end) {  // no two share a sample
      for (std::size_t c = begin; c < end; ++c) add(c);
    });
  }

  [[nodiscard]] Residuals take() { return std::move(result_); }

 private:
  [[nodiscard]] std::size_t index_at(double t_s) const { return fit::index_at(recording_.time_s(), t_s); }

  void add(std::size_t cycle) {
    const CycleState state = fit_.state(cycle);
    const std::size_t begin = index_at(fit_.data(cycle).window_begin_s);
    const std::size_t end = std::max(begin, index_at(fit_.data(cycle).window_end_s));
    const double reach_s = 0.5 * fit_.sensor().average_s;  // over which an average shows the slip outside it
    const std::size_t slip_begin = std::clamp(index_at(state.onset_s - reach_s), begin, end);
    const std::size_t slip_end = std::clamp(index_at(state.onset_s + state.slip_s() + reach_s), slip_begin, end);
    const double rate = state.force_scale * state.omega_rad_per_s;
    const auto slip = [&state](double t_s) { return state.force_at(t_s); };
    const auto stick = [&state, rate](double at_s) {
      return [at_s, rate, force = state.force_at(at_s)](double t_s) { return force + rate * (t_s - at_s); };
    };
    fill(cycle, begin, slip_begin, CyclePart::Stick, stick(fit_.data(cycle).window_begin_s));
    fill(cycle, slip_begin, slip_end, CyclePart::Slip, slip);
    fit_.scales().sensor_lag_s > 0.0  // the sensor still shows the slip
        ? fill(cycle, slip_end, end, CyclePart::Stick, slip)
        : fill(cycle, slip_end, end, CyclePart::Stick, stick(fit_.data(cycle).window_end_s));
  }

  template <class Force>
  void fill(std::size_t cycle, std::size_t begin, std::size_t end, CyclePart part, const Force& force_at) {
    const CycleModel& model = fit_.model(cycle);
    const double* const level = fit_.level_data();
    const double* const local = fit_.parameters.cycles[cycle].data();
    const StickBend bend = model.bend(fit_.parameters.values);
    for (std::size_t i = begin; i < end; ++i) {
      const double t_s = recording_.time_s()[i];
      result_.value[i] = recording_.force()[i] - (model.level_at(t_s, level, local) + force_at(t_s) + bend.at(t_s));
      result_.part[i] = part;
    }
    add_hum(recording_, fit_, begin, end, -1.0, result_.value);
  }

  const Recording& recording_;
  const BlockFit& fit_;
  Residuals result_;
};

}  // namespace

Residuals residuals_of(const Recording& recording, const BlockFit& fit) {
  return ResidualsOfCycles(recording, fit).take();
}

Residuals without(Residuals residuals, const std::vector<std::size_t>& excluded) {
  for (const std::size_t sample : excluded) {
    residuals.value[sample] = 0.0;
    residuals.part[sample] = CyclePart::None;
  }
  return residuals;
}

std::vector<std::size_t> find_outliers(const Residuals& residuals, double noise) {
  std::vector<std::size_t> outliers;
  for (std::size_t i = 0; i < residuals.value.size(); ++i) {
    if (std::abs(residuals.value[i]) > thresholds::kOfManySigmas * noise) outliers.push_back(i);
  }
  if (outliers.empty()) return outliers;
  const auto bound_in = [&](CyclePart part) {
    return thresholds::kOfManySigmas * std::max(signal::kMedianToSigma * median_size(residuals, part), noise);
  };
  const double stick_bound = bound_in(CyclePart::Stick);
  const double slip_bound = bound_in(CyclePart::Slip);
  std::erase_if(outliers, [&](std::size_t i) {
    return std::abs(residuals.value[i]) <= (residuals.part[i] == CyclePart::Slip ? slip_bound : stick_bound);
  });
  return outliers;
}

std::vector<std::size_t> unexplained_slips(const BlockFit& fit) {
  std::vector<double> mean_squares = fit.sums_of_squares();
  for (std::size_t i = 0; i < fit.size(); ++i) mean_squares[i] /= static_cast<double>(fit.data(i).residuals());
  const double bound = thresholds::kUnexplainedRatio * std::max(1.0, signal::median(mean_squares));
  std::vector<std::size_t> bad;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    if (!(mean_squares[i] <= bound)) bad.push_back(fit.data(i).slip);
  }
  return bad;
}

std::vector<std::size_t> united(const std::vector<std::size_t>& first, const std::vector<std::size_t>& second) {
  std::vector<std::size_t> all;
  all.reserve(first.size() + second.size());
  std::set_union(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(all));
  return all;
}

std::vector<std::size_t> initial_exclusions(const Recording& recording, const Quality& quality) {
  std::vector<std::size_t> impulses;
  signal::for_each_set(quality.impulse_mask, [&](std::size_t i) { impulses.push_back(i); });
  if (!quality.clip_high && !quality.clip_low) return impulses;
  std::vector<std::size_t> clipped;
  const std::span<const double> force = recording.force();
  for (std::size_t i = 0; i < force.size(); ++i) {
    const bool high = quality.clip_high && force[i] >= *quality.clip_high;
    const bool low = quality.clip_low && force[i] <= *quality.clip_low;
    if (high || low) clipped.push_back(i);
  }
  return united(impulses, clipped);
}

std::vector<std::size_t> beyond_clip(const Recording& recording, const Quality& quality, const Residuals& residuals,
                                     double noise) {
  constexpr double kReach = 3.0;  // of the noise
  std::vector<std::size_t> beyond;
  if (!quality.clip_high && !quality.clip_low) return beyond;
  for (std::size_t i = 0; i < recording.size(); ++i) {
    if (residuals.part[i] == CyclePart::None) continue;
    const double model = recording.force()[i] - residuals.value[i];
    const bool above = quality.clip_high && model > *quality.clip_high - kReach * noise;
    const bool below = quality.clip_low && model < *quality.clip_low + kReach * noise;
    if (above || below) beyond.push_back(i);
  }
  return beyond;
}

}  // namespace slipfit::fit
