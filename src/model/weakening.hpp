#pragma once

#include <ceres/jet.h>
#include <cmath>
#include <cstddef>
#include <limits>

#include "model/slip.hpp"
#include "model/slip_series.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit::model {

inline double value_of(double x) {
  return x;
}
template <int N>
double value_of(const ceres::Jet<double, N>& x) {
  return x.a;
}

/// Slip x with its first two derivatives and its integral.
template <class T>
struct Slide {
  T x, v, a, integral;
};

/// x'' + 2 zeta x' - g x = tau from rest by the power series of x, where the closed form takes differences of nearly
/// equal numbers: |g| tau^2 <= 1. Its terms alternate as those of exp(-2 zeta tau), to 2e-12 of x at 2 zeta tau = 10.
template <class T>
Slide<T> slide_by_series(const T& g, const T& zeta, const T& tau) {
  using std::abs;
  const double terms = 22.0 + 6.0 * abs(value_of(zeta * tau));  // what is left out is below 1e-18 of x
  Slide<T> slide{T(0.0), T(0.0), T(0.0), T(0.0)};
  T before(0.0);
  T term = tau * tau * tau / 6.0;  // a_n tau^n
  for (int n = 3; n < terms; ++n) {
    slide.x += term;
    slide.v += static_cast<double>(n) * term;
    slide.a += static_cast<double>(n * (n - 1)) * term;
    slide.integral += term / static_cast<double>(n + 1);
    const T next =
        (g * tau * tau * before / static_cast<double>(n) - 2.0 * zeta * tau * term) / static_cast<double>(n + 1);
    before = term;
    term = next;
  }
  if (tau > 0.0) {
    slide.v /= tau;
    slide.a /= tau * tau;
  }
  slide.integral *= tau;
  return slide;
}

/// Returns the slide of the same equation at any tau.
template <class T>
Slide<T> slide_at(const T& g, const T& zeta, const T& tau) {
  using std::abs, std::cos, std::exp, std::sin, std::sqrt;
  if (abs(g) * tau * tau <= 1.0 && abs(zeta) * tau <= 5.0) return slide_by_series(g, zeta, tau);
  const T square = zeta * zeta + g;
  T c, s;  // exp(-zeta tau) cosh(beta tau) and exp(-zeta tau) sinh(beta tau) / beta, beta^2 = zeta^2 + g
  constexpr double kNearlyZero = 1e-4;
  if (abs(square) * tau * tau < kNearlyZero) {
    const T angle = square * tau * tau;
    const T decay = exp(-zeta * tau);
    c = decay * (1.0 + angle * (0.5 + angle / 24.0));
    s = decay * tau * (1.0 + angle * (1.0 / 6.0 + angle / 120.0));
  } else if (square > 0.0) {
    const T beta = sqrt(square);
    const T fast = 0.5 * exp((beta - zeta) * tau);
    const T slow = 0.5 * exp(-(beta + zeta) * tau);
    c = fast + slow;
    s = (fast - slow) / beta;
  } else {
    const T b = sqrt(-square);
    const T decay = exp(-zeta * tau);
    c = decay * cos(b * tau);
    s = decay * sin(b * tau) / b;
  }
  const T v = (c + zeta * s - 1.0) / g;
  const T x = (s + 2.0 * zeta * v - tau) / g;
  return {x, v, s, (v + 2.0 * zeta * x - 0.5 * tau * tau) / g};
}

/// Derivatives with respect to z0, zeta and the first number of the law.
using PartJet = ceres::Jet<double, 3>;

/// Coefficients of z'' + 2 zeta z' = by_z z + constant + by_time (tau - begin); the default is Coulomb friction.
struct LinearForce {
  PartJet by_z{-1.0};
  PartJet constant{0.0};
  PartJet by_time{0.0};
};

/// Start and length of a part of a slip, in tau.
struct PartTimes {
  double begin = 0.0;
  double length = 0.0;
};

/// Returns the power series of the motion from the spring force z and its slope at the start of the part on. Where it
/// is transmitted, the drag is added. docs/model.md sections 4 and 9
SlipPart linear_part(const PartTimes& times, const PartJet& z, const PartJet& slope, const LinearForce& force,
                     const PartJet& zeta, bool is_transmitted);

/// exp(-zeta tau) cos b tau and exp(-zeta tau) sin b tau at even steps: one complex multiplication a sample. It is to
/// be started afresh at every slip, because rounding adds up over the steps.
class Phasor {
 public:
  Phasor(double zeta, double b, double step_tau)
      : zeta_(zeta),
        b_(b),
        turn_c_(std::exp(-zeta * step_tau) * std::cos(b * step_tau)),
        turn_s_(std::exp(-zeta * step_tau) * std::sin(b * step_tau)) {}

  void start(double tau) {
    const double decay = std::exp(-zeta_ * tau);
    c_ = decay * std::cos(b_ * tau);
    s_ = decay * std::sin(b_ * tau);
  }
  void step() {
    const double next = c_ * turn_c_ - s_ * turn_s_;
    s_ = c_ * turn_s_ + s_ * turn_c_;
    c_ = next;
  }
  [[nodiscard]] double c() const { return c_; }
  [[nodiscard]] double s() const { return s_; }

 private:
  double zeta_, b_, turn_c_, turn_s_;
  double c_ = 1.0, s_ = 0.0;
};

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

/// WeakeningSlip::at, or its mean over a time around tau, to rounding, at times in ascending order and at even steps,
/// of which some may be left out: the motion is that of a linear equation, which the same few numbers take from each
/// time to the next.
class WeakeningTrack {
 public:
  /// `step_tau`: above 0. `average`: the time at this w_n that the mean is over; 0: an instant. The slip must outlive
  /// it.
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
