#include "fit/observation/lag_response.hpp"

#include <algorithm>
#include <cmath>

namespace slipfit::fit {
namespace {

/// q times the integral over x from 0 to 1 of exp(-q (1 - x)) x^j, for j up to N - 1: the response to x^j.
template <std::size_t N>
std::array<double, N> moments(double q) {
  std::array<double, N> moment{};
  // Upward, a step multiplies the error by j / q; downward by q / j.
  if (q >= 0.5 * static_cast<double>(N)) {
    moment[0] = -std::expm1(-q);
    for (std::size_t j = 1; j < N; ++j) moment[j] = 1.0 - static_cast<double>(j) / q * moment[j - 1];
    return moment;
  }
  // The series for the last one, and downward from it.
  constexpr int kMostTerms = 80;  // 16^80 exp(-16) / 80! is below round-off
  double power = q * std::exp(-q);
  for (int n = 0; n < kMostTerms; ++n) {
    moment[N - 1] += power / (n + static_cast<double>(N));
    power *= q / (n + 1.0);
  }
  for (std::size_t j = N - 1; j > 0; --j) moment[j - 1] = (1.0 - moment[j]) * q / static_cast<double>(j);
  return moment;
}

}  // namespace

LagResponse::LagResponse(const MotionPoint& shown, const std::vector<model::SlipPart>& parts, double lag_tau)
    : tau_end_(parts.back().begin + parts.back().length), kappa_(1.0 / lag_tau) {
  end_ = {column_of(shown), -lag_tau * shown.d_tau};
  for (const model::SlipPart& part : parts) {
    pieces_.push_back({part, end_});
    end_ = response(pieces_.back(), part.length);
  }
}

LagResponse::Response LagResponse::response(const Piece& piece, double time) const {
  constexpr std::size_t kTerms = model::kSeriesOrder + 1;
  const double q = kappa_ * time;
  const std::array<double, kTerms + 1> moment = moments<kTerms + 1>(q);
  const double decay = std::exp(-q);
  Response response;
  for (std::size_t c = 0; c < kColumns; ++c) response.shown[c] = decay * piece.begin.shown[c];
  response.d_log_omega = decay * (piece.begin.d_log_omega + q * piece.begin.shown[0]);
  double power = 1.0;
  for (std::size_t j = 0; j < kTerms; ++j) {
    const Column& terms = piece.motion.terms[j];
    for (std::size_t c = 0; c < kColumns; ++c) response.shown[c] += terms[c] * power * moment[j];
    // kappa, and with it q, goes as 1 / w_n: less q times the derivative of the moment.
    response.d_log_omega -= terms[0] * power * (moment[j] - q * moment[j] + q * moment[j + 1]);
    power *= time;
  }
  return response;
}

LagResponse::Response LagResponse::after_slip(const Column& motion, double tau) const {
  const double since = tau - tau_end_;
  const double decay = std::exp(-kappa_ * since);
  const double lag = lag_tau();
  Response response{motion, 0.0};
  // The line of the stick at the end of the slip.
  Column line = motion;
  line[0] -= since;
  for (std::size_t c = 0; c < kColumns; ++c) response.shown[c] += decay * (end_.shown[c] - line[c]);
  response.shown[0] += lag * (decay - 1.0);
  response.d_log_omega = decay * (end_.d_log_omega + lag + kappa_ * since * (end_.shown[0] - line[0] + lag)) - lag;
  return response;
}

ShownPoint LagResponse::at(const MotionPoint& motion, double tau) const {
  Response y;
  if (tau >= tau_end_) {
    y = after_slip(column_of(motion), tau);
  } else {
    const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), tau,
                                        [](double time, const Piece& piece) { return time < piece.motion.begin; });
    const Piece& piece = *(after - 1);
    y = response(piece, tau - piece.motion.begin);
  }
  ShownPoint point;
  point.z = y.shown[0];
  point.d_tau = kappa_ * (motion.z - y.shown[0]);
  point.d_z0 = y.shown[1];
  point.d_zeta = y.shown[2];
  point.d_law = {y.shown[3], y.shown[4]};
  point.d_log_omega = y.d_log_omega;
  return point;
}

}  // namespace slipfit::fit
