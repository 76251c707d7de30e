#pragma once

// Stick-slip of one body on a spring, by fixed-step Runge-Kutta with located events: shares no code with slipfit.
// Forces in N, times in s. simulator.py compiles it for Python; benchmarks/atlas links it.

namespace independent {

struct Model {
  double stiffness, omega, damping_ratio;  // k, sqrt(k / m), parallel to the spring
  double stribeck_force, stribeck_speed;   // falls off from the kinetic friction's excess at rest
  double quadratic;                        // N s^2/m^2
  double weakening_length;                 // D_c: friction falls from static to kinetic over this sliding distance
  double ageing, ageing_time;              // B ln(1 + t/t_c) added to the static friction
  double creep_force, creep_share;         // creep in stick: share * V * exp(-(F_s - F) / force)
  double reload_force, reload_length;      // stiffer after a slip: A (1 - exp(-s / l))
  double stiffening;                       // N/m^3
  double sensor_omega, sensor_damping;     // second-order sensor; 0: none
  double precursor_at, precursor_share;    // small fall at this share of the way to F_s
  double aftershock_s, aftershock_share;   // small fall so long after a slip
  double velocity_law;                     // of stribeck_force: 0 exponential, 1 logarithmic, 2 hyperbolic
  double ageing_law;                       // 0 ln(1 + t/t_c), 1 power of t/t_c, 2 saturating
  double relax_share, relax_time;          // a standard linear solid: this share of the stiffness relaxes
  double servo_compliance, servo_time;     // m/N, s: the drive gives way under the force and catches up
  double slow_share, slow_time;            // a second relaxing spring beside the first
  double heat_slope, heat_time;  // N/m by which the distance slid lowers the kinetic friction; it cools so fast
  double line_length;  // m: k is that of a line which the drive shortens (below 0: lengthens) from this length
  double load_slope;   // the load rises by this share of itself when the force doubles its kinetic level
};

// What changes with time, one value a sample; static friction further takes a factor for each slip.
struct Course {
  const double *speed, *static_friction, *kinetic_friction, *slip_factor;
  long samples, factors;
  double step;
  int substeps;
};

struct Slip {
  double onset_s, end_s, onset_force, end_force;
};

// `force`: what the sensor shows at every sample; `behind`: how far the drive is behind its command, in m. Returns the
// number of slips (at most `most`); the last may be open.
extern "C" long simulate(const Model* m, const Course* course, double start_force, double* force, double* behind,
                         Slip* slips, long most);

}  // namespace independent
