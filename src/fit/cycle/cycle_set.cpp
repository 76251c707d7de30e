#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "fit/cycle/cycle_model.hpp"
#include "fit/cycle/side_by_side.hpp"

namespace slipfit::fit {

void legendre(double x, std::size_t terms, double* values, double* derivatives) {
  for (std::size_t n = 0; n < terms; ++n) {
    const auto order = static_cast<double>(n);
    values[n] = n == 0   ? 1.0
                : n == 1 ? x
                         : ((2.0 * order - 1.0) * x * values[n - 1] - (order - 1.0) * values[n - 2]) / order;
    // P'_n = P'_(n-2) + (2n - 1) P_(n-1)
    derivatives[n] = n == 0 ? 0.0 : (2.0 * order - 1.0) * values[n - 1] + (n >= 2 ? derivatives[n - 2] : 0.0);
  }
}

namespace {

constexpr double kLeastTolerance = 1e-9;  // of a step: what is left of binary fractions

/// The step of times that are even to `tolerance_s`, some of which may be left out; 0 of others: an uneven clock.
double even_step_of(const std::vector<double>& time_s, double tolerance_s) {
  if (time_s.size() < 2) return 0.0;
  const double span_s = time_s.back() - time_s.front();
  double smallest_s = span_s;
  for (std::size_t i = 1; i < time_s.size(); ++i) smallest_s = std::min(smallest_s, time_s[i] - time_s[i - 1]);
  if (!(smallest_s > 0.0)) return 0.0;
  // From neighbour to neighbour: over the whole span what times are rounded by may add up to a step.
  std::vector<double> steps{0.0};
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    steps.push_back(steps.back() + std::round((time_s[i] - time_s[i - 1]) / smallest_s));
  }
  const double step_s = span_s / steps.back();
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const double off_s = time_s[i] - time_s.front() - step_s * steps[i];
    if (std::abs(off_s) > std::max(kLeastTolerance * step_s, tolerance_s)) return 0.0;
  }
  return step_s;
}

/// What written times are rounded by changes the force on the steepest part of a slip by this little of the noise.
double tolerated_rounding_s(const Scales& scales) {
  constexpr double kOfNoise = 0.01;
  return kOfNoise * scales.noise / scales.force * scales.half_period_s / std::numbers::pi;
}

double* put_share(const RiseAfterSlip::Share& share, const LevelModel& level, double* out) {
  *out++ = share.value;
  if (level.reloading->is_free) *out++ = share.by_log_length;
  return out;
}

/// The level's functions at every residual row of a cycle.
std::vector<double> basis_of(const CycleData& data, const LevelModel& level, const Scales& scales) {
  std::vector<double> basis(data.residuals() * level.columns());
  if (level.columns() == 0) return basis;
  std::vector<double> values(level.terms);
  std::vector<double> slopes(level.terms);
  const double span_s = scales.time_end_s - scales.time_begin_s;
  double* out = basis.data();
  const auto polynomial_at = [&](double time_s) {
    legendre(2.0 * (time_s - scales.time_begin_s) / span_s - 1.0, level.terms, values.data(), slopes.data());
  };
  for (const double time_s : data.time_s) {
    polynomial_at(time_s);
    out = std::copy(values.begin(), values.end(), out);
    if (level.reloading) out = put_share(level.reloading->at(data.slip, time_s), level, out);
    for (const double line_Hz : level.lines_Hz) {
      const double phase = 2.0 * std::numbers::pi * line_Hz * (time_s - scales.time_begin_s);
      *out++ = std::cos(phase);
      *out++ = std::sin(phase);
    }
  }
  for (const auto* bins : {&data.bins_before, &data.bins_after}) {
    for (const StickBin& bin : *bins) {
      polynomial_at(bin.time_s);
      const RiseAfterSlip::Line rise = level.reloading ? level.reloading->over(data.slip, bin) : RiseAfterSlip::Line{};
      out = std::copy(values.begin(), values.end(), out);
      if (level.reloading) out = put_share(rise.mean, level, out);
      for (const LineInBin& line : bin.lines) out = std::copy_n(line.mean.data(), 2, out);
      for (const double slope : slopes) *out++ = 2.0 / span_s * slope;
      if (level.reloading) out = put_share(rise.slope, level, out);
      for (const LineInBin& line : bin.lines) out = std::copy_n(line.slope.data(), 2, out);
    }
  }
  return basis;
}

}  // namespace

CycleSet::CycleSet(std::vector<CycleData> of_cycles, std::vector<double> of_reference_s, LevelModel of_level,
                   const Scales& scales)
    : cycles(std::move(of_cycles)), reference_s(std::move(of_reference_s)), level(std::move(of_level)) {
  std::size_t samples = 0;
  for (const CycleData& cycle : cycles) samples += cycle.time_s.size();
  basis.resize(cycles.size());
  even_step_s.resize(cycles.size());
  for_cycles(cycles.size(), samples, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      basis[i] = basis_of(cycles[i], level, scales);
      even_step_s[i] = even_step_of(cycles[i].time_s, tolerated_rounding_s(scales));
    }
  });
}

}  // namespace slipfit::fit
