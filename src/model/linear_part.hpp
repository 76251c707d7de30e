#pragma once

#include <ceres/jet.h>

#include "model/slip_series.hpp"

namespace slipfit::model {

/// Derivatives with respect to z0, zeta and the first number of the law.
using PartJet = ceres::Jet<double, 3>;

/// Coefficients of z'' + 2 zeta z' = by_z z + constant + by_time (tau - begin); the default is Coulomb friction.
struct LinearForce {
  PartJet by_z{-1.0};
  PartJet constant{0.0};
  PartJet by_time{0.0};
};

/// Begin and length of a part of a slip, in tau.
struct PartTimes {
  double begin = 0.0;
  double length = 0.0;
};

/// Returns the power series of the motion from the spring force z and its slope at the begin of the part on. Where it
/// is transmitted, the drag is added. docs/model.md sections 4 and 9
SlipPart linear_part(const PartTimes& times, const PartJet& z, const PartJet& slope, const LinearForce& force,
                     const PartJet& zeta, bool is_transmitted);

}  // namespace slipfit::model
