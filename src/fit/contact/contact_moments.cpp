#include "fit/contact/contact_moments.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/line_sums.hpp"
#include "model/slip.hpp"

namespace slipfit::fit {
namespace {

enum Moment : Eigen::Index { kLogSlope, kOnsetJump, kEndJump, kSlipTime };

constexpr double kLowestDamping = -0.1;
constexpr double kHighestDamping = 0.6;

/// Left over from the two equations for given moments; both 0 at the solution.
Eigen::Vector2d equations(const Eigen::Vector4d& moments, double log_omega, double zeta) {
  const double omega = std::exp(log_omega);
  const double u = std::exp(moments(kLogSlope)) / omega;
  const model::Slip slip = model::solve_slip(moments(kOnsetJump) / u - 2.0 * zeta, zeta);
  return {slip.tau_end - omega * moments(kSlipTime),
          u * (slip.end.z + 2.0 * zeta) / moments(kEndJump) + 1.0};  // in stick the sensor sees k u + c V
}

template <class F>
std::optional<double> root(const F& f, double low, double high) {
  const double at_low = f(low);
  const double at_high = f(high);
  if (!(at_low * at_high <= 0.0)) return std::nullopt;
  std::uintmax_t steps = 100;
  const auto bracket = boost::math::tools::toms748_solve(f, low, high, at_low, at_high,
                                                         boost::math::tools::eps_tolerance<double>(48), steps);
  return 0.5 * (bracket.first + bracket.second);
}

/// ln w_n from the slip time alone: tau_end lies between pi and a damped turn, and falls as w_n grows.
std::optional<double> log_omega_for(const Eigen::Vector4d& moments, double zeta) {
  const double turn = 6.4 / std::sqrt(1.0 - zeta * zeta);
  return root([&](double log_omega) { return equations(moments, log_omega, zeta)(0); },
              std::log(2.5 / moments(kSlipTime)), std::log(turn / moments(kSlipTime)));
}

/// Returns by how much the mean error of an edge can repeat where its phase against the clock does. It is the largest
/// gap in the phases of a regular recording, in steps. It is 0 where the edges scatter by more than a step: then the
/// spread over the cycles shows the error.
double phase_gap(const ContactCycles& found, double ContactCycle::*edge) {
  const std::size_t count = found.cycles.size();
  const LineSums line = line_sums(
      count, [&](std::size_t i) { return static_cast<double>(found.cycles[i].slip); },
      [&](std::size_t i) { return found.cycles[i].*edge; });
  double scatter = 0.0;
  std::vector<double> phases;
  for (const ContactCycle& c : found.cycles) {
    const double line_s = line.at(static_cast<double>(c.slip));
    scatter += (c.*edge - line_s) * (c.*edge - line_s);
    phases.push_back(line_s / found.step_s - std::floor(line_s / found.step_s));
  }
  if (std::sqrt(scatter / static_cast<double>(count)) > found.step_s) return 0.0;
  std::sort(phases.begin(), phases.end());
  double gap = 1.0 - phases.back() + phases.front();
  for (std::size_t i = 1; i < count; ++i) gap = std::max(gap, phases[i] - phases[i - 1]);
  return gap;
}

}  // namespace

ContactMoments moments_of(const ContactCycles& found) {
  ContactMoments moments;
  const auto count = static_cast<double>(found.cycles.size());
  std::vector<Eigen::Vector4d> values;
  double half_ramp_s = 0.0;
  for (const ContactCycle& c : found.cycles) {
    values.emplace_back(std::log(found.slope), c.onset_jump, c.end_jump, c.end_s - c.onset_s);
    moments.mean += values.back() / count;
    half_ramp_s += 0.5 * (c.onset_jump + c.end_jump) / found.slope / count;
  }
  for (const Eigen::Vector4d& value : values) {
    const Eigen::Vector4d d = value - moments.mean;
    moments.covariance += d * d.transpose() / (count - 1.0) / count;
  }
  moments.jump_sd = std::sqrt(moments.covariance(kOnsetJump, kOnsetJump) * count);
  // An onset timed too late by dt: the ramp is read too high, the slip too short. An end: the ramp too high, the jump
  // to it too small, the slip too long.
  const Eigen::Vector4d onset(0.0, found.slope, 0.0, -1.0);
  const Eigen::Vector4d end(0.0, 0.0, -found.slope, 1.0);
  const double onset_s = phase_gap(found, &ContactCycle::onset_s) * found.step_s;
  const double end_s = phase_gap(found, &ContactCycle::end_s) * found.step_s;
  moments.covariance += onset_s * onset_s / 12.0 * onset * onset.transpose();
  moments.covariance += end_s * end_s / 12.0 * end * end.transpose();
  const Eigen::Vector4d slope(1.0 / found.slope, half_ramp_s, half_ramp_s, 0.0);
  moments.covariance += found.slope_error * found.slope_error * slope * slope.transpose();
  return moments;
}

std::optional<ContactSolution> solve_moments(const ContactMoments& moments) {
  const Eigen::Vector4d& m = moments.mean;
  if (!(m(kOnsetJump) > 0.0) || !(m(kEndJump) > 0.0) || !(m(kSlipTime) > 0.0) || !m.allFinite()) return std::nullopt;
  const auto left_of_jump = [&](double zeta) {
    const std::optional<double> log_omega = log_omega_for(m, zeta);
    return log_omega ? equations(m, *log_omega, zeta)(1) : std::nan("");
  };
  const std::optional<double> zeta = root(left_of_jump, kLowestDamping, kHighestDamping);
  if (!zeta) return std::nullopt;
  const double log_omega = *log_omega_for(m, *zeta);

  // Implicit function theorem with central differences: the equations are smooth in all six arguments.
  Eigen::Matrix2d by_unknown;
  Eigen::Matrix<double, 2, 4> by_moment;
  constexpr double kStep = 1e-5;
  by_unknown.col(0) = (equations(m, log_omega + kStep, *zeta) - equations(m, log_omega - kStep, *zeta)) / (2.0 * kStep);
  by_unknown.col(1) = (equations(m, log_omega, *zeta + kStep) - equations(m, log_omega, *zeta - kStep)) / (2.0 * kStep);
  for (Eigen::Index i = 0; i < 4; ++i) {
    Eigen::Vector4d step = Eigen::Vector4d::Zero();
    step(i) = kStep * (i == kLogSlope ? 1.0 : m(i));
    by_moment.col(i) =
        (equations(m + step, log_omega, *zeta) - equations(m - step, log_omega, *zeta)) / (2.0 * step(i));
  }
  Eigen::Matrix4d response = Eigen::Matrix4d::Zero();
  response(0, kLogSlope) = 1.0;
  response.middleRows<2>(1) = -by_unknown.inverse() * by_moment;
  response(3, kOnsetJump) = 1.0 / m(kOnsetJump);
  ContactSolution solution;
  solution.value << m(kLogSlope), log_omega, *zeta, std::log(m(kOnsetJump));
  solution.covariance = response * moments.covariance * response.transpose();
  if (!solution.covariance.allFinite()) return std::nullopt;
  return solution;
}

}  // namespace slipfit::fit
