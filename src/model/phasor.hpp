#pragma once

#include <cmath>
#include <cstddef>

namespace slipfit::model {

/// exp(-zeta tau) cos b tau and exp(-zeta tau) sin b tau at even steps: one complex multiplication a sample, to be
/// started afresh at every slip and every kFresh samples, so that rounding adds up over fewer than kFresh steps.
class Phasor {
 public:
  static constexpr std::size_t kFresh = 256;

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

}  // namespace slipfit::model
