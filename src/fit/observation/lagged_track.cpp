#include "fit/observation/lagged_track.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace slipfit::fit {
namespace {

/// q times the integral over x from 0 to 1 of exp(-q (1 - x)) x^j, for j up to N - 1: the response to x^j.
template <std::size_t N>
std::array<double, N> moments(double q) {
  std::array<double, N> moment{};
  if (q >= 1.0) {
    moment[0] = -std::expm1(-q);
    for (std::size_t j = 1; j < N; ++j) moment[j] = 1.0 - static_cast<double>(j) / q * moment[j - 1];
    return moment;
  }
  // The recursion upward loses digits where q is small: the series for the last one, and downward from it.
  constexpr int kMostTerms = 20;  // 1 / 20! is below round-off
  double power = q * std::exp(-q);
  for (int n = 0; n < kMostTerms; ++n) {
    moment[N - 1] += power / (n + static_cast<double>(N));
    power *= q / (n + 1.0);
  }
  for (std::size_t j = N - 1; j > 0; --j) moment[j - 1] = (1.0 - moment[j]) * q / static_cast<double>(j);
  return moment;
}

/// From values at N even places of [0, 1], both ends included, to coefficients of powers.
template <int N>
Eigen::Matrix<double, N, N> interpolation() {
  Eigen::Matrix<double, N, N> powers;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) powers(i, j) = std::pow(static_cast<double>(i) / (N - 1), j);
  }
  return powers.inverse();
}

}  // namespace

LaggedTrack::LaggedTrack(const model::VelocityTrack& track, bool transmitted, double lag_tau)
    : transmitted_(transmitted), kappa_(1.0 / lag_tau) {
  const std::vector<double> knots = track.knots();
  // A straight ramp lags by T.
  end_ = {motion_at(track, 0.0), -lag_tau};
  end_.shown[0] -= lag_tau;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    Piece piece = piece_between(track, knots[i], knots[i + 1]);
    piece.shown = end_.shown;
    piece.d_log_omega = end_.d_log_omega;
    end_ = response(piece, 1.0);
    pieces_.push_back(piece);
  }
}

LaggedTrack::Column LaggedTrack::motion_at(const model::VelocityTrack& track, double tau) const {
  const model::TrackPoint z = transmitted_ ? track.transmitted_at(tau) : track.at(tau);
  return {z.z, z.d_z0, z.d_zeta, z.d_slope, z.d_rate};
}

LaggedTrack::Piece LaggedTrack::piece_between(const model::VelocityTrack& track, double begin, double end) const {
  static const Eigen::Matrix<double, kTerms, kTerms> kInterpolation = interpolation<kTerms>();
  Eigen::Matrix<double, kTerms, kColumns> values;
  for (std::size_t i = 0; i < kTerms; ++i) {
    const double share = static_cast<double>(i) / (kTerms - 1);
    const Column here = motion_at(track, i + 1 < kTerms ? begin + share * (end - begin) : end);
    for (std::size_t c = 0; c < kColumns; ++c)
      values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) = here[c];
  }
  const Eigen::Matrix<double, kTerms, kColumns> terms = kInterpolation * values;
  Piece piece{begin, end - begin, {}, {}, 0.0};
  for (std::size_t j = 0; j < kTerms; ++j) {
    for (std::size_t c = 0; c < kColumns; ++c)
      piece.terms[j][c] = terms(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(c));
  }
  return piece;
}

LaggedTrack::Response LaggedTrack::response(const Piece& piece, double share) const {
  const double q = kappa_ * piece.length * share;
  const std::array<double, kTerms + 1> moment = moments<kTerms + 1>(q);
  const double decay = std::exp(-q);
  Response response;
  for (std::size_t c = 0; c < kColumns; ++c) response.shown[c] = decay * piece.shown[c];
  response.d_log_omega = decay * (piece.d_log_omega + q * piece.shown[0]);
  double power = 1.0;
  for (std::size_t j = 0; j < kTerms; ++j) {
    for (std::size_t c = 0; c < kColumns; ++c) response.shown[c] += piece.terms[j][c] * power * moment[j];
    // kappa, and with it q, goes as 1 / w_n: less q times the derivative of the moment.
    response.d_log_omega -= piece.terms[j][0] * power * (moment[j] - q * moment[j] + q * moment[j + 1]);
    power *= share;
  }
  return response;
}

LaggedTrack::Response LaggedTrack::after_slip(const model::VelocityTrack& track, double tau) const {
  const double since = tau - track.tau_end();
  const double decay = std::exp(-kappa_ * since);
  const double lag = 1.0 / kappa_;
  Response response{motion_at(track, tau), 0.0};
  // The line of the stick at the end of the slip.
  Column line = response.shown;
  line[0] -= since;
  for (std::size_t c = 0; c < kColumns; ++c) response.shown[c] += decay * (end_.shown[c] - line[c]);
  response.shown[0] += lag * (decay - 1.0);
  response.d_log_omega = decay * (end_.d_log_omega + lag + kappa_ * since * (end_.shown[0] - line[0] + lag)) - lag;
  return response;
}

ShownPoint LaggedTrack::at(const model::VelocityTrack& track, double tau) const {
  const Column motion = motion_at(track, tau);
  Response y{motion, -1.0 / kappa_};
  if (tau <= 0.0) {
    y.shown[0] -= 1.0 / kappa_;
  } else if (tau >= track.tau_end()) {
    y = after_slip(track, tau);
  } else {
    const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), tau,
                                        [](double time, const Piece& piece) { return time < piece.begin; });
    const Piece& piece = *(after - 1);
    y = response(piece, (tau - piece.begin) / piece.length);
  }
  ShownPoint point;
  point.z = y.shown[0];
  point.d_tau = kappa_ * (motion[0] - y.shown[0]);
  point.d_z0 = y.shown[1];
  point.d_zeta = y.shown[2];
  point.d_slope = y.shown[3];
  point.d_rate = y.shown[4];
  point.d_log_omega = y.d_log_omega;
  return point;
}

}  // namespace slipfit::fit
