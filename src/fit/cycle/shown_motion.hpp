#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "fit/cycle/sensor.hpp"

namespace slipfit::fit {

/// Any motion as a sensor shows it that filters, averages, or does both. A Motion has, in the view of the sensor, the
/// force `at` any tau, its `integral_to` any tau from the onset (d_tau: the force itself), the `tau_end` of its slip,
/// and as `parts` the polynomials of the slip and of the stick after it where that is curved. docs/model.md section 7
template <class Motion>
class ShownMotion {
 public:
  /// Times of the sensor in units of 1 / w_n.
  ShownMotion(Motion motion, const Sensor& sensor)
      : motion_(std::move(motion)), half_window_(0.5 * sensor.average_tau) {
    if (!(sensor.lag_tau > 0.0)) return;
    std::vector<model::SlipPart> parts = motion_.parts();
    if (parts.empty()) return;  // no slip: the force of such a motion is no number
    filter_.emplace(motion_.at(0.0), motion_.at(-sensor.lag_tau), std::move(parts), sensor.order, sensor.lag_tau);
  }

  /// Returns the motion without the sensor.
  [[nodiscard]] const Motion& motion() const { return motion_; }
  [[nodiscard]] double lag_tau() const { return filter_ ? filter_->delay_tau() : 0.0; }

  [[nodiscard]] ShownPoint at(double tau) const {
    // The mean of a straight line is its middle.
    const bool is_straight =
        Motion::kStraightSticks && (tau + half_window_ <= 0.0 || (!filter_ && tau - half_window_ >= motion_.tau_end()));
    return half_window_ == 0.0 || is_straight ? instant_at(tau) : mean_around(tau);
  }

 private:
  /// Returns the force that the sensor shows without the average. Before the slip it is the force a delay earlier:
  /// exact of a straight stick, and of one that bends little within a delay.
  [[nodiscard]] ShownPoint instant_at(double tau) const {
    if (!filter_) return ShownPoint{motion_.at(tau)};
    if (tau > 0.0) return filter_->at(motion_.at(tau), tau);
    ShownPoint point{motion_.at(tau - lag_tau())};
    point.d_log_omega = -lag_tau() * point.d_tau;
    return point;
  }

  /// Returns what the filter holds back, as FilterResponse::memory_at.
  [[nodiscard]] ShownPoint memory_at(double tau) const {
    if (!filter_) return {};
    if (tau > 0.0) return filter_->memory_at(motion_.at(tau), tau);
    // Of a line: a delay times the force so much earlier, which is written as at the onset by the force at two times.
    const double delay = lag_tau();
    const double earlier = filter_->memory_delay_tau();
    const MotionPoint now = motion_.at(tau);
    const MotionPoint delayed = motion_.at(tau - delay);
    ShownPoint point;
    add(now, delay - earlier, point);
    add(delayed, earlier, point);
    point.d_log_omega = point.z - delay * earlier * delayed.d_tau;
    point.d_tau = (delay - earlier) * now.d_tau + earlier * delayed.d_tau;
    return point;
  }

  /// The mean over the window around tau.
  [[nodiscard]] ShownPoint mean_around(double tau) const {
    const double first = tau - half_window_;
    const double last = tau + half_window_;
    const double length = last - first;
    const MotionPoint to_last = motion_.integral_to(last);
    const MotionPoint to_first = motion_.integral_to(first);
    const ShownPoint held_last = memory_at(last);
    const ShownPoint held_first = memory_at(first);
    ShownPoint mean{to_last};
    add(to_first, -1.0, mean);
    add(held_last, -1.0, mean);
    add(held_first, 1.0, mean);
    mean.d_log_omega = held_first.d_log_omega - held_last.d_log_omega;
    for (double* const value : {&mean.z, &mean.d_z0, &mean.d_zeta, &mean.d_log_omega}) *value /= length;
    for (double& value : mean.d_law) value /= length;
    const double at_last = to_last.d_tau - held_last.d_tau;
    const double at_first = to_first.d_tau - held_first.d_tau;
    mean.d_tau = (at_last - at_first) / length;
    mean.d_log_average = 0.5 * (at_first + at_last) - mean.z;
    mean.d_log_omega += mean.d_log_average;  // the window is w_n W long
    return mean;
  }

  static void add(const MotionPoint& point, double weight, MotionPoint& sum) {
    sum.z += weight * point.z;
    sum.d_z0 += weight * point.d_z0;
    sum.d_zeta += weight * point.d_zeta;
    for (std::size_t i = 0; i < sum.d_law.size(); ++i) sum.d_law[i] += weight * point.d_law[i];
  }

  Motion motion_;
  double half_window_;  ///< of the average
  std::optional<FilterResponse> filter_;
};

/// A cycle at samples in ascending order, by a law that gains nothing from their order.
template <class Cycle>
class SamplesOneByOne {
 public:
  SamplesOneByOne(const Cycle& cycle, double /*step_tau*/) : cycle_(cycle) {}
  [[nodiscard]] ShownPoint at(double tau) const { return cycle_.at(tau); }

 private:
  const Cycle& cycle_;
};

}  // namespace slipfit::fit
