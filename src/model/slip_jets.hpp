#pragma once

#include <optional>

#include "model/root_between.hpp"
#include "model/slip.hpp"
#include "model/velocity_slip.hpp"

namespace slipfit::model {

/// The slip that starts from stick at one speed, in units of docs/model.md section 5, as numbers that know their
/// derivatives (ceres::Jet).
template <class Jet>
struct SlipJets {
  Jet force_unit_N, z0, zeta, slope, rate;

  /// Takes F_s - F_k(0+) and the slope of F_k(v) at rest, both at this speed's load.
  SlipJets(const Jet& stiffness_N_per_m, const Jet& omega_rad_per_s, const Jet& damping_ratio, const Jet& difference_N,
           const Jet& slope_N_s_per_m, const Jet& alpha_s_per_m, double speed_m_per_s)
      : force_unit_N(stiffness_N_per_m * speed_m_per_s / omega_rad_per_s),
        z0(difference_N / force_unit_N - 2.0 * damping_ratio),  // the slip starts from F_s - cV
        zeta(damping_ratio),
        slope(slope_N_s_per_m * omega_rad_per_s / stiffness_N_per_m),
        rate(alpha_s_per_m * speed_m_per_s) {}

  [[nodiscard]] std::optional<VelocityTrack> solve() const {
    return VelocityTrack::solve(z0.a, zeta.a, slope.a, rate.a);
  }

  /// A value of the track at fixed tau, with its derivatives `by` z0, zeta, slope and rate.
  template <class Derivatives>
  [[nodiscard]] Jet jet(double value, const Derivatives& by) const {
    Jet result(value);
    result.v = by.d_z0 * z0.v + by.d_zeta * zeta.v + by.d_slope * slope.v + by.d_rate * rate.v;
    return result;
  }
  [[nodiscard]] Jet jet(const TrackValue& y) const { return jet(y.value, y); }

  /// w_n times the time of the slip: z'(tau) = 1 holds at its end.
  [[nodiscard]] Jet tau_slip(const TrackEnd& end) const {
    Jet tau(end.tau);
    tau.v = -jet(end.first).v / end.second.value;
    return tau;
  }
  /// Returns w_n times the period of slip and straight stick.
  [[nodiscard]] Jet tau_period(const VelocityTrack& track) const { return z0 - jet(track.after()); }

  /// Returns the cycle; it is empty where the slip does not stick, or ends with the force above that of the next slip's
  /// start.
  [[nodiscard]] std::optional<ScaledCycle<Jet>> cycle(const VelocityTrack& track) const {
    if (!track.resticks()) return std::nullopt;
    const Jet slip = tau_slip(track.end());
    const Jet stick = tau_period(track) - slip;
    if (!(stick.a > 0.0)) return std::nullopt;
    // The force is largest soon after the slip has started and smallest soon before it ends: between those two it
    // falls.
    const double falling = track.fastest_tau();
    return ScaledCycle<Jet>{slip, stick, extreme(track, 0.0, falling), extreme(track, falling, track.tau_end())};
  }

  /// Positive where the slip sticks: z''^2 at its end is linear in the parameters up to where it vanishes; without
  /// stick what z' lacks to 1.
  [[nodiscard]] Jet restick_margin(const VelocityTrack& track) const {
    const TrackEnd& end = track.end();
    const Jet first = jet(end.first);
    if (!track.resticks()) return first - 1.0;
    Jet margin(end.second.value * end.second.value);
    margin.v = 2.0 * (end.second.value * jet(end.second).v - end.third * first.v);
    return margin;
  }

 private:
  /// z where z' passes 0 between two times; to first order it does not move with that time.
  [[nodiscard]] Jet extreme(const VelocityTrack& track, double before, double after) const {
    const TrackPoint point = track.at(root_between([&](double tau) { return track.at(tau).d_tau; }, before, after));
    return jet(point.z, point);
  }
};

}  // namespace slipfit::model
