#pragma once

#include <ceres/jet.h>

#include <limits>

#include "model/phasor.hpp"
#include "model/weakening.hpp"
#include "model/weakening_slide.hpp"

namespace slipfit::model {

/// WeakeningSlip::at and mean_at, to rounding, at times in ascending order and at even steps, of which some may be left
/// out: the motion is that of a linear equation, which the same few numbers take from each time to the next.
class WeakeningTrack {
 public:
  /// `step_tau`: above 0. `average`: of mean_at; 0: an instant. The slip must outlive it.
  WeakeningTrack(const WeakeningSlip& slip, double step_tau, double average = 0.0)
      : slip_(slip), average_(average), first_(slip, step_tau, average > 0.0), last_(first_) {}

  WeakeningPoint at(double tau);

 private:
  using Jet = WeakeningSlip::Jet;
  /// Derivatives with respect to the coefficients of the equation that slides obey while the friction falls,
  /// x'' + 2 zeta x' - g x = tau: g, zeta.
  using Slope = ceres::Jet<double, 2>;

  /// The motion at one time after another.
  class Walker {
   public:
    /// `sums`: its integral is asked for.
    Walker(const WeakeningSlip& slip, double step_tau, bool sums);

    void move_to(double tau);

    /// Force of the spring there, its slope (both with derivatives, too), the slope of that, and its integral from the
    /// onset on.
    [[nodiscard]] double force() const;
    [[nodiscard]] double slope() const;
    [[nodiscard]] Jet z() const;
    [[nodiscard]] Jet dz() const;
    [[nodiscard]] double ddz() const;
    [[nodiscard]] Jet integral() const;

   private:
    enum class Part { Before, Weakening, Weakened, After };

    /// `is_next`: the last time was one step before, in the same part of the slip.
    void weaken(double tau, bool is_next);
    void swing(double tau, bool is_next);
    /// Converts derivatives with respect to g and zeta to those with respect to z0, zeta and the distance.
    [[nodiscard]] Jet chained(const Slope& value) const;

    const WeakeningSlip& slip_;
    double step_tau_;
    bool sums_;
    double tau_ = -std::numeric_limits<double>::infinity();
    Part part_ = Part::Before;
    // While the friction falls:
    Slope g_, zeta_;
    Slide<Slope> step_;  ///< from rest, over one step
    Slope x_by_x_, v_by_x_, v_by_v_, integral_by_x_;
    Slope x_, v_, integral_;
    // From there on:
    double b_;
    Phasor phasor_;
    Jet z_sine_, slope_sine_;
    Jet c_, s_;  ///< exp(-zeta tau) cos b tau and exp(-zeta tau) sin(b tau) / b
    // The stick after it is force + tau:
    Jet after_, integral_after_;
  };

  [[nodiscard]] bool is_transmitted() const { return slip_.view_ == ForceView::Transmitted; }
  [[nodiscard]] WeakeningPoint instant() const;
  [[nodiscard]] WeakeningPoint mean() const;

  const WeakeningSlip& slip_;
  double average_;
  Walker first_, last_;
};

}  // namespace slipfit::model
