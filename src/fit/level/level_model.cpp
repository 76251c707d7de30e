#include "fit/level/level_model.hpp"

#include <algorithm>
#include <cmath>

#include "fit/cycle/cycle_data.hpp"

namespace slipfit::fit {

RiseAroundSlip::LengthJet RiseAroundSlip::Stick::at(double time_s) const {
  return 1.0 - exp((begin_s - time_s) / scale_s) - risen;
}

RiseAroundSlip::RiseAroundSlip(const RiseAfterSlip& rise, std::size_t slip, double length_m, double average_s)
    : has_before_(slip > 0), average_s_(average_s), onset_s_(rise.slip_begin_s[slip]) {
  LengthJet scale_s(length_m / rise.speed_m_per_s, 0);
  scale_s.v[0] = scale_s.a;  // by ln l
  after_ = {rise.slip_end_s[slip], scale_s, LengthJet(0.0)};
  before_ = {has_before_ ? rise.slip_end_s[slip - 1] : onset_s_, scale_s, LengthJet(0.0)};
  before_.risen = before_.at(onset_s_);
}

RiseAroundSlip::LengthJet RiseAroundSlip::without_average(double time_s) const {
  if (time_s < onset_s_ && has_before_) return before_.at(std::max(time_s, before_.begin_s));
  return time_s > after_.begin_s ? after_.at(time_s) : LengthJet(0.0);
}

RiseAfterSlip::Share RiseAroundSlip::at(double time_s) const {
  if (!(average_s_ > 0.0)) {
    const LengthJet share = without_average(time_s);
    return {share.a, share.v[0], 0.0};
  }
  const double from_s = time_s - 0.5 * average_s_;
  const double to_s = time_s + 0.5 * average_s_;
  LengthJet sum(0.0);
  double of_ends = 0.0;  // the share is 0 from the onset to the end of the slip
  const auto add = [&](const Stick& stick, double first_s, double last_s) {
    const LengthJet first = stick.at(first_s);
    const LengthJet last = stick.at(last_s);
    // The integral of exp(-t / scale) is scale times what it falls by.
    sum += (1.0 - stick.risen) * (last_s - first_s) - stick.scale_s * (last - first);
    of_ends += first.a + last.a;
  };
  if (has_before_ && from_s < onset_s_) add(before_, std::max(from_s, before_.begin_s), std::min(to_s, onset_s_));
  if (to_s > after_.begin_s) add(after_, std::max(from_s, after_.begin_s), to_s);
  const LengthJet mean = sum / average_s_;
  return {mean.a, mean.v[0], 0.5 * of_ends - mean.a};
}

RiseAfterSlip::Line RiseAroundSlip::over(const StickBin& bin) const {
  const auto add = [](RiseAfterSlip::Share& sum, double weight, const RiseAfterSlip::Share& share) {
    sum.value += weight * share.value;
    sum.by_log_length += weight * share.by_log_length;
    sum.by_log_average += weight * share.by_log_average;
  };
  RiseAfterSlip::Line line;
  const BinNodes in_bin(bin);
  for (const BinNodes::Node& node : in_bin.nodes()) {
    const RiseAfterSlip::Share share = at(node.time_s);
    add(line.mean, node.mean, share);
    add(line.slope, node.slope_per_s, share);
  }
  return line;
}

}  // namespace slipfit::fit
