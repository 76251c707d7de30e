#include "model/velocity_slip.hpp"

#include <algorithm>
#include <cmath>

namespace slipfit::model {

namespace {

TrackValue track_value(double value, const ScaledGradient& by) {
  return {value, by[0], by[1], by[2], by[3]};
}

/// 1 - v and -v' are z' and z'': their derivatives are those of v and v' with the other sign.
ScaledGradient negative(ScaledGradient gradient) {
  for (double& derivative : gradient) derivative = -derivative;
  return gradient;
}

/// Adds 2 zeta z', or its integral, with its derivatives: the part of the damper.
void add_drag(const TrackPoint& slope, double zeta, TrackPoint& point) {
  const double drag = 2.0 * zeta;
  point.z += drag * slope.z;
  point.d_z0 += drag * slope.d_z0;
  point.d_zeta += drag * slope.d_zeta + 2.0 * slope.z;
  point.d_slope += drag * slope.d_slope;
  point.d_rate += drag * slope.d_rate;
}

}  // namespace

std::optional<VelocityTrack> VelocityTrack::solve(double z0, double zeta, const ScaledLaw& law) {
  const bool finite = std::isfinite(z0) && std::isfinite(law.slope) && std::isfinite(law.rate);
  if (!finite || !(z0 + 2.0 * zeta > 0.0) || !(std::abs(zeta) < 1.0)) return std::nullopt;
  VelocityTrack track;
  track.slip_ = {z0 + 2.0 * zeta, zeta, law};
  const auto keep = [&track](const SlipWalker<true>& walker) { track.keep(walker.from, walker.series); };
  const SlipEnd end = follow_slip<true>(track.slip_, kForFits, keep);
  if (end.outcome != SlipOutcome::Resticks && end.outcome != SlipOutcome::TurnsBack) return std::nullopt;
  track.resticks_ = end.outcome == SlipOutcome::Resticks;
  track.finish(end.node);
  return track;
}

void VelocityTrack::keep(const SlipNode& begin, const SlipSeries<true>& series) {
  Step step{begin.tau, begin.integral, {}, series};
  if (!steps_.empty()) {
    const Step& before = steps_.back();
    const ScaledGradient part = integral_of(before.series.ds, step.begin - before.begin);
    for (std::size_t p = 0; p < kScaledParameters; ++p) step.integral_of_ds[p] = before.integral_of_ds[p] + part[p];
  }
  steps_.push_back(step);
}

void VelocityTrack::finish(const SlipNode& end) {
  const double rise = 1.0 - end.state.v;  // z'
  const ScaledGradient dv_tau = slope_of(steps_.back().series.dv, end.tau - steps_.back().begin);
  end_.tau = end.tau;
  end_.first = track_value(rise, negative(end.state.dv));
  end_.second = track_value(-end.acceleration, negative(dv_tau));
  end_.third = -rise + (2.0 * slip_.zeta + slip_.law.at(end.state.v).d_speed) * end.acceleration;
  // A slip that sticks joins its ramp with equal slope (z' = 1): the moving end adds nothing to first order. One that
  // does not ends where z'' = 0, which moves with the parameters: the third derivative is -z' there.
  const double moves = resticks_ ? 0.0 : (rise - 1.0) / rise;
  ScaledGradient by{};
  for (std::size_t p = 0; p < kScaledParameters; ++p) by[p] = end.state.ds[p] - moves * dv_tau[p];
  after_ = track_value(end.state.s - 2.0 * slip_.zeta - end.tau, by);
  after_.d_zeta -= 2.0;
}

double VelocityTrack::fastest_tau() const {
  return std::ranges::max_element(steps_, {}, [](const Step& step) { return step.series.v[0]; })->begin;
}

const VelocityTrack::Step& VelocityTrack::step_at(double tau) const {
  const auto after = std::upper_bound(steps_.begin() + 1, steps_.end(), tau,
                                      [](double time, const Step& step) { return time < step.begin; });
  return *(after - 1);
}

TrackPoint VelocityTrack::inside(double tau) const {
  const Step& step = step_at(tau);
  const double time = tau - step.begin;
  const ScaledGradient ds = value_of(step.series.ds, time);
  return {value_of(step.series.s, time) - 2.0 * slip_.zeta,
          1.0 - value_of(step.series.v, time),
          ds[0],
          ds[1] - 2.0,
          ds[2],
          ds[3]};
}

/// z' and its derivatives.
TrackPoint VelocityTrack::slope_inside(double tau) const {
  const Step& step = step_at(tau);
  const double time = tau - step.begin;
  const ScaledGradient dv = value_of(step.series.dv, time);
  return {1.0 - value_of(step.series.v, time), -step.series.acceleration_at(time), -dv[0], -dv[1], -dv[2], -dv[3]};
}

TrackPoint VelocityTrack::at(double tau) const {
  if (tau <= 0.0) return {slip_.lambda - 2.0 * slip_.zeta + tau, 1.0, 1.0, 0.0, 0.0, 0.0};
  if (tau <= end_.tau) return inside(tau);
  return {after_.value + tau, 1.0, after_.d_z0, after_.d_zeta, after_.d_slope, after_.d_rate};
}

TrackPoint VelocityTrack::transmitted_at(double tau) const {
  TrackPoint point = at(tau);
  const bool slips = tau > 0.0 && tau <= end_.tau;
  const TrackPoint slope = slips ? slope_inside(tau) : TrackPoint{1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  add_drag(slope, slip_.zeta, point);
  point.d_tau += 2.0 * slip_.zeta * slope.d_tau;
  return point;
}

TrackPoint VelocityTrack::integral_to(double tau) const {
  const double z0 = slip_.lambda - 2.0 * slip_.zeta;
  if (tau <= 0.0) return {tau * (z0 + 0.5 * tau), z0 + tau, tau, 0.0, 0.0, 0.0};
  const double in_slip = std::min(tau, end_.tau);
  const Step& step = step_at(in_slip);
  const double time = in_slip - step.begin;
  const ScaledGradient part = integral_of(step.series.ds, time);
  ScaledGradient by{};
  for (std::size_t p = 0; p < kScaledParameters; ++p) by[p] = step.integral_of_ds[p] + part[p];
  TrackPoint sum{step.integral + integral_of(step.series.s, time) - 2.0 * slip_.zeta * in_slip,
                 at(tau).z,
                 by[0],
                 by[1] - 2.0 * in_slip,
                 by[2],
                 by[3]};
  const double after = tau - in_slip;
  sum.z += after * (after_.value + in_slip + 0.5 * after);
  sum.d_z0 += after * after_.d_z0;
  sum.d_zeta += after * after_.d_zeta;
  sum.d_slope += after * after_.d_slope;
  sum.d_rate += after * after_.d_rate;
  return sum;
}

TrackPoint VelocityTrack::transmitted_integral_to(double tau) const {
  TrackPoint sum = integral_to(tau);
  // The integral of z' is z less its value at the onset.
  TrackPoint rise = at(tau);
  rise.z -= slip_.lambda - 2.0 * slip_.zeta;
  rise.d_z0 -= 1.0;
  add_drag(rise, slip_.zeta, sum);
  sum.d_tau = transmitted_at(tau).z;
  return sum;
}

std::vector<SlipPart> VelocityTrack::parts(bool transmitted) const {
  std::vector<SlipPart> parts;
  const double drag = transmitted ? 2.0 * slip_.zeta : 0.0;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const SlipSeries<true>& series = steps_[i].series;
    const double end = i + 1 < steps_.size() ? steps_[i + 1].begin : end_.tau;
    SlipPart part{steps_[i].begin, end - steps_[i].begin, {}};
    for (std::size_t n = 0; n <= kSeriesOrder; ++n) {
      const double slope = (n == 0 ? 1.0 : 0.0) - series.v[n];  // of z'
      part.terms[n][0] = series.s[n] + drag * slope;
      for (std::size_t p = 0; p < kScaledParameters; ++p) {
        part.terms[n][p + 1] = series.ds[n][p] - drag * series.dv[n][p];
      }
      if (transmitted) part.terms[n][2] += 2.0 * slope;
    }
    part.terms[0][0] -= 2.0 * slip_.zeta;
    part.terms[0][2] -= 2.0;
    parts.push_back(part);
  }
  return parts;
}

}  // namespace slipfit::model
