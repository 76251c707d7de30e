#include "fit/law/coulomb.hpp"

namespace slipfit::fit {

CoulombMotion::CoulombMotion(const model::Slip& slip, const model::StickLine& after, ForceView view)
    : slip_(slip),
      after_(after),
      is_transmitted_(view == ForceView::Transmitted),
      force_(slip, after, 1.0, is_transmitted_) {}

MotionPoint CoulombMotion::at(double tau) const {
  if (tau > 0.0 && tau <= slip_.tau_end) {
    const double decay = std::exp(-slip_.zeta * tau);
    const double c = decay * std::cos(slip_.b * tau);
    const double s = decay * std::sin(slip_.b * tau) / slip_.b;
    const model::WavePoint p =
        is_transmitted_ ? model::transmitted_wave(slip_, tau, c, s) : model::slip_wave(slip_, tau, c, s);
    return {p.z, p.d_tau, p.d_z0, p.d_zeta};
  }
  MotionPoint stick = tau <= 0.0 ? MotionPoint{slip_.z0 + tau, 1.0, 1.0, 0.0}
                                 : MotionPoint{after_.intercept + tau, 1.0, after_.d_z0, after_.d_zeta};
  if (is_transmitted_) {
    stick.z += 2.0 * slip_.zeta;
    stick.d_zeta += 2.0;
  }
  return stick;
}

/// The power series of z'' + 2 zeta z' + z = 0 and of its derivatives by z0 and zeta, in steps of at most a radian.
std::vector<model::SlipPart> CoulombMotion::parts() const {
  using Terms = std::array<double, 3>;  // z, d z0, d zeta
  constexpr std::size_t kOrder = model::kSeriesOrder;
  const double zeta = slip_.zeta;
  const double count = std::ceil(slip_.tau_end);
  const double length = slip_.tau_end / count;
  Terms begin{slip_.z0, 1.0, 0.0};
  Terms slope{1.0, 0.0, 0.0};
  std::vector<model::SlipPart> parts;
  for (double i = 0.0; i < count; ++i) {
    std::array<Terms, kOrder + 2> z{begin, slope};  // a term more, for the drag
    for (std::size_t n = 0; n < kOrder; ++n) {
      const auto order = static_cast<double>(n);
      for (std::size_t c = 0; c < begin.size(); ++c) {
        double sum = z[n][c] + 2.0 * zeta * (order + 1.0) * z[n + 1][c];
        if (c == 2) sum += 2.0 * (order + 1.0) * z[n + 1][0];
        z[n + 2][c] = -sum / ((order + 1.0) * (order + 2.0));
      }
    }
    model::SlipPart part{i * length, length, {}};
    for (std::size_t n = 0; n <= kOrder; ++n) {
      for (std::size_t c = 0; c < begin.size(); ++c) part.terms[n][c] = z[n][c];
      if (!is_transmitted_) continue;
      const double by_slope = static_cast<double>(n) + 1.0;
      for (std::size_t c = 0; c < begin.size(); ++c) part.terms[n][c] += 2.0 * zeta * by_slope * z[n + 1][c];
      part.terms[n][2] += 2.0 * by_slope * z[n + 1][0];
    }
    parts.push_back(part);
    begin = slope = {};
    for (std::size_t n = kOrder + 1; n > 0; --n) {
      for (std::size_t c = 0; c < begin.size(); ++c) {
        begin[c] = begin[c] * length + z[n][c];
        slope[c] = slope[c] * length + static_cast<double>(n) * z[n][c];
      }
    }
    for (std::size_t c = 0; c < begin.size(); ++c) begin[c] = begin[c] * length + z[0][c];
  }
  return parts;
}

}  // namespace slipfit::fit
