#pragma once

#include <limits>

#include "model/phasor.hpp"
#include "model/slip.hpp"

namespace slipfit::fit {

/// A slip as an instrument shows it that averages over w_n W around the time stamp: the integral of the force is in
/// closed form. docs/model.md section 7
class AveragedSlip {
 public:
  /// `transmitted`: view.
  AveragedSlip(const model::Slip& slip, const model::StickLine& after, double average_tau, bool transmitted);

  /// At any tau.
  [[nodiscard]] model::WavePoint at(double tau) const;

  /// The same at samples in ascending order, those between onset and end at even steps, of which some may be left out.
  class Samples {
   public:
    Samples(const AveragedSlip& slip, double step_tau)
        : slip_(slip), step_tau_(step_tau), first_(slip.zeta_, slip.b_, step_tau), last_(first_) {}

    model::WavePoint at(double tau);

   private:
    const AveragedSlip& slip_;
    double step_tau_;
    double next_tau_ = -std::numeric_limits<double>::infinity();
    model::Phasor first_, last_;  ///< where the average begins and ends
  };

 private:
  /// Force, and its integral from the onset on with derivatives with respect to z0 and zeta. Or what each of them has
  /// of a function of tau.
  struct Force {
    double z = 0.0, integral = 0.0, d_z0 = 0.0, d_zeta = 0.0;
  };
  /// Linear in c = exp(-zeta tau) cos b tau and s = exp(-zeta tau) sin b tau, the derivative to zeta in tau c and tau s
  /// as well.
  struct Slide {
    Force constant, by_c, by_s;
    double d_zeta_by_tau_c = 0.0, d_zeta_by_tau_s = 0.0;
  };
  /// z = constant.z + tau, and its integral.
  struct Stick {
    Force constant;
    double d_z0_by_tau = 0.0, d_zeta_by_tau = 0.0;
  };

  static Slide slide_of(const model::Slip& slip);
  void transmit(const model::Slip& slip, const model::StickLine& after);
  [[nodiscard]] bool slides_at(double tau) const { return tau > 0.0 && tau <= tau_end_; }
  [[nodiscard]] Force sliding_at(double tau, double c, double s) const;
  [[nodiscard]] Force sticking_at(double tau) const;
  [[nodiscard]] Force force_at(double tau) const;
  [[nodiscard]] model::WavePoint between(const Force& first, const Force& last) const;

  double zeta_, b_, tau_end_;
  double half_;        ///< of the average
  double by_average_;  ///< 1 / average
  Slide slide_;
  Stick before_, after_;  ///< the slip
};

}  // namespace slipfit::fit
