#pragma once

#include <algorithm>
#include <vector>

#include "core/quantile.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/fit/result.hpp"

namespace slipfit::predict {

/// The cycles at one speed of the models that the covariance of `model` allows.
class CyclesOfDraws {
 public:
  struct Cycle {
    double slip_s, stick_s, micro_vibration_m;
    [[nodiscard]] double period_s() const { return slip_s + stick_s; }
  };

  CyclesOfDraws(const ModelEstimate& model, double speed_m_per_s);

  /// Returns the share of the models that stick.
  [[nodiscard]] double share() const { return share_; }
  /// Gives the interval over those that stick, `value_of` a cycle being what is estimated.
  template <class ValueOf>
  void give_interval(Estimate& estimate, const ValueOf& value_of) const {
    constexpr double kTail = 0.025;
    std::vector<double> values;
    for (const Cycle& cycle : cycles_) values.push_back(value_of(cycle));
    const double low = std::min(quantile_of(values, kTail), *estimate.value);
    const double high = std::max(quantile_of(values, 1.0 - kTail), *estimate.value);
    estimate.ci95 = Interval{low, high};
    estimate.standard_error = 0.5 * (high - low) / quantile_;
  }

 private:
  double quantile_;
  double share_ = 0.0;
  std::vector<Cycle> cycles_;
};

}  // namespace slipfit::predict
