#pragma once

#include <string>

#include "core/unknown.hpp"
#include "predict/draws.hpp"

namespace slipfit::predict {

/// Holds where stick-slip from rest ends. At zeta = 0 it never ends; from zeta = 1 on there is none. The interval of
/// the speed may reach to infinity: it has no value then.
struct CriticalPoint {
  Estimate lambda, speed_m_per_s;

  static CriticalPoint unknown(const std::string& why) { return {slipfit::unknown(why), slipfit::unknown(why)}; }
};

/// Returns the critical point with what a sweep does not determine at speeds outside its own. It is unknown far outside
/// them where the recordings show no trend of static friction, or where it rests on one law of F_k(v) of several that
/// would fit.
CriticalPoint critical_point(const ModelEstimate& model);

/// Returns the highest speed at which a model has stick-slip, to a share of `sharp`; 0 where it has none at any speed
/// looked at, infinite where it has at all.
double end_of_stick_slip_m_per_s(const ModelEstimate& model, double sharp);

}  // namespace slipfit::predict
