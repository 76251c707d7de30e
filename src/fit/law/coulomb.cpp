#include "fit/law/coulomb.hpp"

#include "model/weakening.hpp"

namespace slipfit::fit {

std::vector<model::SlipPart> CoulombMotion::parts() const {
  using model::PartJet;
  const PartJet z0(wave_.slip.z0, 0);
  const PartJet zeta(wave_.slip.zeta, 1);
  if (!(tau_end() < CoulombWave::kLongest)) return {};
  const double count = std::ceil(tau_end());  // in steps of a radian: kSeriesOrder
  const double length = tau_end() / count;
  std::vector<model::SlipPart> parts;
  for (double i = 0.0; i < count; ++i) {
    const model::SlipPoint<PartJet> at = model::slip_point(z0, zeta, PartJet(i * length));
    parts.push_back(model::linear_part({i * length, length}, at.z, at.dz, {}, zeta, wave_.is_transmitted));
  }
  return parts;
}

}  // namespace slipfit::fit
