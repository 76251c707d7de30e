#include "fit/level/reloading.hpp"

#include <ceres/jet.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace slipfit::fit {
namespace {

using LengthJet = ceres::Jet<double, 1>;

/// The rise over part of a stick, as a share of A: 1 - exp(-t / scale) with t from the end of the slip before it, less
/// `risen`.
struct RisingStick {
  double begin_s = 0.0;
  LengthJet scale_s;
  LengthJet risen;

  [[nodiscard]] LengthJet at(double time_s) const { return 1.0 - exp((begin_s - time_s) / scale_s) - risen; }
  [[nodiscard]] LengthJet integral(double from_s, double to_s) const {
    const LengthJet decayed = exp((begin_s - from_s) / scale_s) - exp((begin_s - to_s) / scale_s);
    return (1.0 - risen) * (to_s - from_s) - scale_s * decayed;
  }
};

/// The sticks before and after a slip that begins at `begin_s`.
struct SticksBeside {
  SticksBeside(const RiseAfterSlip& rise, std::size_t slip, double length_m) : begin_s(rise.slip_begin_s[slip]) {
    LengthJet scale_s(length_m / rise.speed_m_per_s, 0);
    scale_s.v[0] = scale_s.a;  // by ln l
    after = {rise.slip_end_s[slip], scale_s, LengthJet(0.0)};
    before = {slip > 0 ? rise.slip_end_s[slip - 1] : begin_s, scale_s, LengthJet(0.0)};
    before.risen = before.at(begin_s);
  }

  double begin_s;
  RisingStick before, after;
};

}  // namespace

RiseAfterSlip::Share RiseAfterSlip::without_average(std::size_t slip, double time_s, double over_m) const {
  const SticksBeside sticks(*this, slip, over_m);
  LengthJet share(0.0);
  if (time_s < sticks.begin_s && slip > 0) share = sticks.before.at(std::max(time_s, sticks.before.begin_s));
  if (time_s > sticks.after.begin_s) share = sticks.after.at(time_s);
  return {share.a, share.v[0], 0.0};
}

RiseAfterSlip::Share RiseAfterSlip::at(std::size_t slip, double time_s, const Shape& shape) const {
  const double average_s = shape.average_s;
  if (!(average_s > 0.0)) return without_average(slip, time_s, shape.length_m);
  const SticksBeside sticks(*this, slip, shape.length_m);
  const double from_s = time_s - 0.5 * average_s;
  const double to_s = time_s + 0.5 * average_s;
  LengthJet sum(0.0);
  if (slip > 0 && from_s < sticks.begin_s) {
    sum += sticks.before.integral(std::max(from_s, sticks.before.begin_s), std::min(to_s, sticks.begin_s));
  }
  const double end_s = sticks.after.begin_s;
  if (to_s > end_s) sum += sticks.after.integral(std::max(from_s, end_s), to_s);
  const LengthJet mean = sum / average_s;
  const double of_ends =
      without_average(slip, from_s, shape.length_m).value + without_average(slip, to_s, shape.length_m).value;
  return {mean.a, mean.v[0], 0.5 * of_ends - mean.a};
}

RiseAfterSlip::Line RiseAfterSlip::over(std::size_t slip, const StickBin& bin, const Shape& shape) const {
  if (bin.count < 2.0 || !(bin.time_spread > 0.0)) return {at(slip, bin.time_s, shape), {}};
  // Gauss's nodes and weights over a width whose centred square is that of the samples
  constexpr std::array kNodes{0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr std::array kWeights{0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const double half_s = std::sqrt(3.0 * bin.time_spread / bin.count);
  const auto add = [](Share& sum, double weight, const Share& share) {
    sum.value += weight * share.value;
    sum.by_log_length += weight * share.by_log_length;
    sum.by_log_average += weight * share.by_log_average;
  };
  Line line;
  add(line.mean, 0.5 * kWeights[0], at(slip, bin.time_s, shape));
  for (std::size_t i = 1; i < kNodes.size(); ++i) {
    for (const double side : {-1.0, 1.0}) {
      const Share share = at(slip, bin.time_s + side * half_s * kNodes[i], shape);
      add(line.mean, 0.5 * kWeights[i], share);
      add(line.slope, side * 1.5 * kWeights[i] * kNodes[i] / half_s, share);
    }
  }
  return line;
}

}  // namespace slipfit::fit
