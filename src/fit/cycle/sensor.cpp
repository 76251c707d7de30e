#include "fit/cycle/sensor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/filter_delay.hpp"

namespace slipfit::fit {

namespace {

using Complex = std::complex<double>;

/// q times the integral over x from 0 to 1 of exp(-q (1 - x)) x^j, for j up to N - 1: the response to x^j.
template <std::size_t N>
std::array<Complex, N> moments(const Complex& q) {
  std::array<Complex, N> moment{};
  // Upward, a step multiplies the error by j / q; downward by q / j.
  if (std::abs(q) >= 0.5 * static_cast<double>(N)) {
    moment[0] = 1.0 - std::exp(-q);
    for (std::size_t j = 1; j < N; ++j) moment[j] = 1.0 - static_cast<double>(j) / q * moment[j - 1];
    return moment;
  }
  // The series for the last one, and downward from it.
  constexpr int kMostTerms = 80;       // 16^80 exp(-16) / 80! is below round-off
  constexpr double kRounding = 1e-17;  // of the moments of low order, which are of the size of q
  Complex power = q * std::exp(-q);
  const double size = std::abs(q);
  const double least = kRounding * std::abs(power);
  double bound = std::abs(power);  // of the next term
  for (int n = 0; n < kMostTerms && (bound > least || n < size); ++n) {
    moment[N - 1] += power * (1.0 / (n + static_cast<double>(N)));
    const double by_order = 1.0 / (n + 1.0);
    power *= q * by_order;
    bound *= size * by_order;
  }
  for (std::size_t j = N - 1; j > 0; --j) moment[j - 1] = (1.0 - moment[j]) * q / static_cast<double>(j);
  return moment;
}

}  // namespace

std::vector<FilterResponse::Pole> FilterResponse::butterworth_poles(std::size_t order, double delay_tau) {
  const auto n = static_cast<double>(order);
  const double corner = butterworth_delay(order) / delay_tau;
  std::vector<Complex> kappas;
  for (std::size_t k = 0; k < order; ++k) {
    const double angle = std::numbers::pi * ((2.0 * static_cast<double>(k) + 1.0) / (2.0 * n) - 0.5);
    kappas.push_back(std::polar(corner, angle));
  }
  std::vector<Pole> poles;
  for (std::size_t k = order / 2; k < order; ++k) {  // the lower half are the conjugates
    const bool is_real = order % 2 == 1 && k == order / 2;
    const Complex kappa = is_real ? Complex(corner) : kappas[k];
    Complex share = is_real ? 1.0 : 2.0;  // partial fractions of the product of kappa / (s + kappa)
    for (std::size_t i = 0; i < order; ++i) {
      if (i != k) share *= kappas[i] / (kappas[i] - kappa);
    }
    poles.push_back({kappa, is_real ? Complex(share.real()) : share});
  }
  return poles;
}

FilterResponse::FilterResponse(const MotionPoint& onset, const MotionPoint& delayed, std::vector<model::SlipPart> parts,
                               std::size_t order, double delay_tau)
    : tau_end_(parts.back().begin + parts.back().length), delay_tau_(delay_tau), parts_(std::move(parts)) {
  const Column at_onset = column_of(onset);
  const Column before = column_of(delayed);
  for (const Pole& pole : butterworth_poles(order, delay_tau)) {
    const Complex lag = 1.0 / pole.kappa;
    memory_delay_tau_ += (pole.share * lag * lag).real() / delay_tau;
    Response now;
    for (std::size_t c = 0; c < kColumns; ++c) now.shown[c] = at_onset[c] - lag / delay_tau * (at_onset[c] - before[c]);
    now.d_log_omega = -lag * delayed.d_tau;
    Channel channel{pole, {now}};
    for (const model::SlipPart& part : parts_) {
      now = response(pole.kappa, part, now, part.length);
      channel.begin.push_back(now);
    }
    channels_.push_back(std::move(channel));
  }
}

FilterResponse::Response FilterResponse::response(const Complex& kappa, const model::SlipPart& part,
                                                  const Response& begin, double time) {
  constexpr std::size_t kTerms = model::kSeriesOrder + 1;
  const Complex q = kappa * time;
  const std::array<Complex, kTerms + 1> moment = moments<kTerms + 1>(q);
  const Complex decay = std::exp(-q);
  Response response;
  for (std::size_t c = 0; c < kColumns; ++c) response.shown[c] = decay * begin.shown[c];
  response.d_log_omega = decay * (begin.d_log_omega + q * begin.shown[0]);
  double power = 1.0;
  for (std::size_t j = 0; j < kTerms; ++j) {
    const auto& terms = part.terms[j];
    const Complex weight = power * moment[j];
    for (std::size_t c = 0; c < kColumns; ++c) response.shown[c] += terms[c] * weight;
    // kappa, and with it q, is proportional to 1 / w_n: less q times the derivative of the moment.
    response.d_log_omega -= terms[0] * power * (moment[j] - q * moment[j] + q * moment[j + 1]);
    power *= time;
  }
  return response;
}

FilterResponse::Response FilterResponse::at(const Channel& channel, const MotionPoint& motion, double tau) const {
  const Complex& kappa = channel.pole.kappa;
  if (tau < tau_end_) {
    const auto after = std::upper_bound(parts_.begin(), parts_.end(), tau,
                                        [](double time, const model::SlipPart& part) { return time < part.begin; });
    const auto index = static_cast<std::size_t>(after - parts_.begin()) - 1;
    return response(kappa, parts_[index], channel.begin[index], tau - parts_[index].begin);
  }
  const Response& end = channel.begin.back();
  const double since = tau - tau_end_;
  const Complex decay = std::exp(-kappa * since);
  const Complex lag = 1.0 / kappa;
  Response response{column_of(motion), 0.0};
  // The line of the stick at the end of the slip.
  Column line = response.shown;
  line[0] -= since;
  for (std::size_t c = 0; c < kColumns; ++c) response.shown[c] += decay * (end.shown[c] - line[c]);
  response.shown[0] += lag * (decay - 1.0);
  response.d_log_omega = decay * (end.d_log_omega + lag + kappa * since * (end.shown[0] - line[0] + lag)) - lag;
  return response;
}

void FilterResponse::add(const Complex& weight, const Response& response, ShownPoint& sum) {
  const auto real = [&weight](const Complex& value) { return (weight * value).real(); };
  sum.z += real(response.shown[0]);
  sum.d_z0 += real(response.shown[1]);
  sum.d_zeta += real(response.shown[2]);
  sum.d_law[0] += real(response.shown[3]);
  sum.d_law[1] += real(response.shown[4]);
  sum.d_log_omega += real(response.d_log_omega);
}

ShownPoint FilterResponse::at(const MotionPoint& motion, double tau) const {
  ShownPoint sum;
  for (const Channel& channel : channels_) {
    const Response y = at(channel, motion, tau);
    add(channel.pole.share, y, sum);
    sum.d_tau += (channel.pole.share * channel.pole.kappa * (motion.z - y.shown[0])).real();
  }
  return sum;
}

ShownPoint FilterResponse::memory_at(const MotionPoint& motion, double tau) const {
  ShownPoint sum;
  for (const Channel& channel : channels_) {
    Response y = at(channel, motion, tau);
    // y' = kappa (z - y) makes the integral of y that of z less y / kappa; 1 / kappa is proportional to w_n.
    y.d_log_omega += y.shown[0];
    add(channel.pole.share / channel.pole.kappa, y, sum);
    sum.d_tau += (channel.pole.share * (motion.z - y.shown[0])).real();
  }
  return sum;
}

AveragedSlip::AveragedSlip(const model::Slip& slip, const model::StickLine& after, double average_tau, bool transmitted)
    : zeta_(slip.zeta),
      b_(slip.b),
      tau_end_(slip.tau_end),
      half_(0.5 * average_tau),
      by_average_(1.0 / average_tau),
      slide_(slide_of(slip)) {
  before_ = {{slip.z0}, 1.0, 0.0};
  const double tau = tau_end_;
  const Force end = force_at(tau);
  after_ = {{after.intercept, end.integral - tau * (after.intercept + 0.5 * tau), end.d_z0 - tau * after.d_z0,
             end.d_zeta - tau * after.d_zeta},
            after.d_z0,
            after.d_zeta};
  if (transmitted) transmit(slip, after);
}

/// Returns the slide of the spring's force. z'' + 2 zeta z' + z = 0 gives the integral of z: 1 + 2 zeta (z0 - z) - z'.
AveragedSlip::Slide AveragedSlip::slide_of(const model::Slip& slip) {
  const double z0 = slip.z0;
  const double zeta = slip.zeta;
  const double by_b = 1.0 / slip.b;
  const double bend = (z0 + zeta) * by_b * by_b;  // as in model::slip_wave
  const double start = 1.0 + 2.0 * zeta * z0;
  return {{0.0, start, 2.0 * zeta, 2.0 * z0},
          {z0, -start, -2.0 * zeta, -2.0 * z0},
          {by_b * (1.0 + zeta * z0), by_b * (z0 - zeta * start), by_b * (1.0 - 2.0 * zeta * zeta),
           -by_b * (start + zeta * bend)},
          1.0 + zeta * bend,
          -by_b * z0};
}

/// 2 zeta z' on top, the integral of which is 2 zeta z.
void AveragedSlip::transmit(const model::Slip& slip, const model::StickLine& after) {
  const double z0 = slip.z0;
  const double zeta = slip.zeta;
  const double drag = 2.0 * zeta;
  const double by_b = 1.0 / slip.b;
  const double bend = (z0 + zeta) * by_b * by_b;
  const auto add = [](Force& force, const Force& more) {
    force.z += more.z;
    force.integral += more.integral;
    force.d_z0 += more.d_z0;
    force.d_zeta += more.d_zeta;
  };
  add(slide_.by_c, {drag, drag * z0, drag, 2.0 * z0});
  add(slide_.by_s, {-drag * by_b * (z0 + zeta), drag * by_b * (1.0 + zeta * z0), drag * by_b * zeta,
                    by_b * (drag * bend + 2.0 * (1.0 + zeta * z0))});
  slide_.d_zeta_by_tau_c -= drag * bend;
  slide_.d_zeta_by_tau_s -= drag * by_b;
  add(before_.constant, {drag, drag * z0, drag, 2.0 * z0});
  add(after_.constant, {drag, drag * after.intercept, drag * after.d_z0, drag * after.d_zeta + 2.0 * after.intercept});
  before_.d_zeta_by_tau += 2.0;
  after_.d_zeta_by_tau += 2.0;
}

AveragedSlip::Force AveragedSlip::force_at(double tau) const {
  if (!slides_at(tau)) return sticking_at(tau);
  const double decay = std::exp(-zeta_ * tau);
  return sliding_at(tau, decay * std::cos(b_ * tau), decay * std::sin(b_ * tau));
}

model::WavePoint AveragedSlip::at(double tau) const {
  return between(force_at(tau - half_), force_at(tau + half_));
}

}  // namespace slipfit::fit
