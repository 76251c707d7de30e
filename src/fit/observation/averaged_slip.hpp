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
        : slip_(slip), step_tau_(step_tau), first_(slip.slip_.zeta, slip.slip_.b, step_tau), last_(first_) {}

    model::WavePoint at(double tau);

   private:
    const AveragedSlip& slip_;
    double step_tau_;
    double next_tau_ = -std::numeric_limits<double>::infinity();
    model::Phasor first_, last_;  ///< where the average begins and ends
  };

 private:
  /// Integral of the force from the onset on, and its derivatives with respect to z0 and zeta.
  struct Integral {
    double value = 0.0, d_z0 = 0.0, d_zeta = 0.0;
  };
  struct Force {
    double z = 0.0;
    Integral integral;
  };

  [[nodiscard]] bool slides_at(double tau) const { return tau > 0.0 && tau <= slip_.tau_end; }
  [[nodiscard]] Force force_at(double tau) const;
  /// From exp(-zeta tau) cos b tau and exp(-zeta tau) sin b tau.
  [[nodiscard]] Force sliding_at(double tau, double c, double bs) const;
  [[nodiscard]] Force sticking_at(double tau) const;
  [[nodiscard]] Force shown(const model::WavePoint& spring, Integral integral) const;
  [[nodiscard]] model::WavePoint between(const Force& first, const Force& last) const;

  model::Slip slip_;
  model::StickLine after_;
  Integral until_after_;  ///< of the stick after the slip, continued to tau = 0
  double half_;           ///< of the average
  double by_b_;           ///< 1 / b
  double drag_ = 0.0;     ///< 2 zeta of the transmitted view
  double drag_by_zeta_ = 0.0;
};

}  // namespace slipfit::fit
