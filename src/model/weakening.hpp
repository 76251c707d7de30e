#pragma once

#include <ceres/jet.h>

#include "model/slip.hpp"
#include "model/slip_series.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit::model {

/// A point of a cycle under friction that weakens over a slip distance.
struct WeakeningPoint : WavePoint {
  double d_distance = 0.0;
};

/// One slip under friction F_k + (F_s - F_k) (1 - s / D_c) while the slip s is below D_c, and F_k from there on, in the
/// units of model/slip.hpp: docs/model.md section 9. `distance` is D_c w_n / V.
class WeakeningSlip {
 public:
  /// Needs z0 + 2 zeta > 0, |zeta| < 1 and distance > 0.
  WeakeningSlip(double z0, double zeta, double distance, ForceView view = ForceView::Spring);

  /// When the slip is D_c long, and its speed then over V; infinite and 0 where it sticks before.
  [[nodiscard]] double weakened_tau() const { return weakened_.tau.a; }
  [[nodiscard]] double weakened_speed() const { return 1.0 - weakened_.dz.a; }
  /// End of slip; where it never sticks again: the minimum of the sliding speed.
  [[nodiscard]] double tau_end() const { return tau_end_; }
  [[nodiscard]] bool resticks() const { return resticks_; }
  /// Force above F_k at tau = 0 of the stick that follows.
  [[nodiscard]] double intercept() const { return end_.z.a - tau_end_; }

  /// The force in this view at any tau.
  [[nodiscard]] WeakeningPoint at(double tau) const;
  /// Returns the mean of the force over a time around tau, which is `average` long at this w_n.
  [[nodiscard]] WeakeningPoint mean_at(double tau, double average) const;
  /// The integral of what `at` gives, and of its derivatives, from the onset to any time; `d_tau` is the force itself.
  [[nodiscard]] WeakeningPoint integral_to(double tau) const;
  /// The parts of the slip, of what `at` gives; the numbers of the law are the distance and none.
  [[nodiscard]] std::vector<SlipPart> parts() const;

 private:
  friend class WeakeningTrack;

  /// Derivatives with respect to z0, zeta, distance.
  using Jet = ceres::Jet<double, 3>;

  /// Force of the spring with its first two derivatives and its integral from the onset on.
  struct State {
    Jet tau, z, dz, ddz, integral;
  };

  [[nodiscard]] State weakening_at(const Jet& tau) const;
  [[nodiscard]] State weakened_at(const Jet& tau) const;
  [[nodiscard]] State state_at(double tau) const;
  [[nodiscard]] State shown_at(double tau) const;
  [[nodiscard]] double time_to_weaken() const;
  void end_while_weakening();
  [[nodiscard]] SlipPart part_from(const State& begin, double length, bool weakens) const;
  void end_when_weakened();

  Jet z0_, zeta_, distance_, stiffening_;
  ForceView view_;
  State weakened_{};
  double tau_end_ = 0.0;
  bool resticks_ = true;
  State end_{};
  Jet before_, after_;  ///< in the view, of the sticks on either side of the slip, continued to tau = 0
};

}  // namespace slipfit::model
