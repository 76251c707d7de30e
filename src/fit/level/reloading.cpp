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

  [[nodiscard]] LengthJet at(double time_s) const { return 1.0 - exp(-(time_s - begin_s) / scale_s) - risen; }
  [[nodiscard]] LengthJet integral(double from_s, double to_s) const {
    const LengthJet decayed = exp(-(from_s - begin_s) / scale_s) - exp(-(to_s - begin_s) / scale_s);
    return (1.0 - risen) * (to_s - from_s) - scale_s * decayed;
  }
};

}  // namespace

RiseAfterSlip::Share RiseAfterSlip::at(std::size_t slip, double time_s) const {
  const LengthJet scale_s(length_m / speed_m_per_s, 0);
  const double begin_s = slip_begin_s[slip];
  const double end_s = slip_end_s[slip];
  const RisingStick after{end_s, scale_s, LengthJet(0.0)};
  RisingStick before{slip > 0 ? slip_end_s[slip - 1] : begin_s, scale_s, LengthJet(0.0)};
  before.risen = before.at(begin_s);
  LengthJet share(0.0);
  if (!(average_s > 0.0)) {
    if (time_s < begin_s && slip > 0) share = before.at(std::max(time_s, before.begin_s));
    if (time_s > end_s) share = after.at(time_s);
  } else {
    const double from_s = time_s - 0.5 * average_s;
    const double to_s = time_s + 0.5 * average_s;
    if (slip > 0 && from_s < begin_s) {
      share += before.integral(std::max(from_s, before.begin_s), std::min(to_s, begin_s)) / average_s;
    }
    if (to_s > end_s) share += after.integral(std::max(from_s, end_s), to_s) / average_s;
  }
  return {share.a, share.v[0] * scale_s.a};
}

RiseAfterSlip::Line RiseAfterSlip::over(std::size_t slip, const StickBin& bin) const {
  if (bin.count < 2.0 || !(bin.time_spread > 0.0)) return {at(slip, bin.time_s), {}};
  // Gauss's nodes and weights over a width whose centred square is that of the samples
  constexpr std::array kNodes{0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr std::array kWeights{0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const double half_s = std::sqrt(3.0 * bin.time_spread / bin.count);
  const Share middle = at(slip, bin.time_s);
  Line line{{0.5 * kWeights[0] * middle.value, 0.5 * kWeights[0] * middle.by_log_length}, {}};
  for (std::size_t i = 1; i < kNodes.size(); ++i) {
    const Share early = at(slip, bin.time_s - half_s * kNodes[i]);
    const Share late = at(slip, bin.time_s + half_s * kNodes[i]);
    const double of_mean = 0.5 * kWeights[i];
    const double of_slope = 1.5 * kWeights[i] * kNodes[i] / half_s;
    line.mean.value += of_mean * (early.value + late.value);
    line.mean.by_log_length += of_mean * (early.by_log_length + late.by_log_length);
    line.slope.value += of_slope * (late.value - early.value);
    line.slope.by_log_length += of_slope * (late.by_log_length - early.by_log_length);
  }
  return line;
}

}  // namespace slipfit::fit
