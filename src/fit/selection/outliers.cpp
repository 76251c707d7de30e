#include "fit/selection/outliers.hpp"

#include <algorithm>
#include <cmath>

#include "core/fit_thresholds.hpp"
#include "signal/robust.hpp"

namespace slipfit::fit {
namespace {

/// Median size of the residuals in one phase, of every stride-th where they are many.
double median_size(const Residuals& residuals, Phase phase) {
  const auto count = static_cast<std::size_t>(std::count(residuals.phase.begin(), residuals.phase.end(), phase));
  const std::size_t stride = signal::stride_for(count);
  std::vector<double> sizes;
  sizes.reserve(count / stride + 1);
  std::size_t until_next = 1;
  for (std::size_t i = 0; i < residuals.value.size(); ++i) {
    if (residuals.phase[i] != phase || --until_next > 0) continue;
    sizes.push_back(std::abs(residuals.value[i]));
    until_next = stride;
  }
  return signal::median(std::move(sizes));
}

}  // namespace

Residuals residuals_of(const Recording& recording, const BlockFit& fit, const std::vector<std::size_t>& excluded) {
  const auto time_s = recording.time_s();
  const auto force = recording.force();
  Residuals residuals{std::vector<double>(recording.size(), 0.0), std::vector<Phase>(recording.size(), Phase::None)};
  const auto index_at = [&](double t_s) {
    return static_cast<std::size_t>(std::lower_bound(time_s.begin(), time_s.end(), t_s) - time_s.begin());
  };
  const double* level = fit.level_data();
  for (std::size_t c = 0; c < fit.size(); ++c) {
    const CycleModel& model = fit.model(c);
    const CycleState state = fit.state(c);
    const double* local = fit.parameters.cycles[c].data();
    const auto fill = [&](std::size_t begin, std::size_t end, Phase phase, const auto& force_at) {
      for (std::size_t i = begin; i < end; ++i) residuals.value[i] = force[i] - force_at(time_s[i]);
      std::fill_n(residuals.phase.begin() + static_cast<std::ptrdiff_t>(begin), end - begin, phase);
    };
    const auto shown = [&](double t_s) { return model.level_at(t_s, level, local) + state.force_at(t_s); };
    const auto stick = [&, rate = state.force_scale * state.omega_rad_per_s](double above) {
      return [&, rate, above](double t_s) {
        return model.level_at(t_s, level, local) + above + rate * (t_s - state.onset_s);
      };
    };
    const std::size_t begin = index_at(fit.data(c).window_begin_s);
    const std::size_t end = std::max(begin, index_at(fit.data(c).window_end_s));
    const std::size_t slip_begin = std::clamp(index_at(state.onset_s), begin, end);
    const std::size_t slip_end = std::clamp(index_at(state.onset_s + state.slip_s()), slip_begin, end);
    const double before = state.force_scale * state.motion.before_slip(0.0).z;
    const double after = state.force_scale * state.motion.after_slip(0.0).z;
    fill(begin, slip_begin, Phase::Stick, stick(before));
    fill(slip_begin, slip_end, Phase::Slip, shown);
    fit.scales().sensor_lag_s > 0.0 ? fill(slip_end, end, Phase::Stick, shown)  // the sensor still shows the slip
                                    : fill(slip_end, end, Phase::Stick, stick(after));
    if (fit.level().lines_Hz.empty()) continue;
    for (std::size_t i = begin; i < end; ++i) residuals.value[i] -= model.hum_at(time_s[i], level);
  }
  for (const std::size_t sample : excluded) {
    residuals.value[sample] = 0.0;
    residuals.phase[sample] = Phase::None;
  }
  return residuals;
}

std::vector<std::size_t> find_outliers(const Residuals& residuals, double noise) {
  std::vector<std::size_t> outliers;
  for (std::size_t i = 0; i < residuals.value.size(); ++i) {
    if (std::abs(residuals.value[i]) > thresholds::kOutlierSigmas * noise) outliers.push_back(i);
  }
  if (outliers.empty()) return outliers;
  const auto bound_in = [&](Phase phase) {
    return thresholds::kOutlierSigmas * std::max(1.4826 * median_size(residuals, phase), noise);
  };
  const double stick_bound = bound_in(Phase::Stick);
  const double slip_bound = bound_in(Phase::Slip);
  std::erase_if(outliers, [&](std::size_t i) {
    return std::abs(residuals.value[i]) <= (residuals.phase[i] == Phase::Slip ? slip_bound : stick_bound);
  });
  return outliers;
}

std::vector<std::size_t> unexplained_slips(const BlockFit& fit) {
  std::vector<double> mean_squares;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    mean_squares.push_back(fit.cycle_sum_of_squares(i) / static_cast<double>(fit.data(i).residuals()));
  }
  const double bound = thresholds::kUnexplainedRatio * std::max(1.0, signal::median(mean_squares));
  std::vector<std::size_t> bad;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    if (!(mean_squares[i] <= bound)) bad.push_back(fit.data(i).slip);
  }
  return bad;
}

}  // namespace slipfit::fit
