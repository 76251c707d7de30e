#pragma once

#include "forward_methods.hpp"

// What people use instead of a closed form. Each starts at the onset of a slip and runs to the second fall of the
// force.

namespace atlas {

/// F_k(0+) over F_s - F_k, where the whole friction matters: smoothing acts on it, and it turns where the body slides
/// back.
inline constexpr double kKineticShare = 2.0;

/// Classical Runge-Kutta with a fixed step; a sliding speed below zero at the end of a step means stick.
Answer run_sign_switching(const ForwardScene& scene, const WaveTimes& times, double step);

/// Moreau's midpoint time stepping: friction as a set-valued impulse, no event, first order.
Answer run_time_stepping(const ForwardScene& scene, const WaveTimes& times, double step);

/// Dormand-Prince 5(4) with dense output; the end of slip by bisection of the step at whose end the speed has changed
/// sign (what scipy's solve_ivp and MATLAB's events do). Sticks in closed form.
Answer run_event_location(const ForwardScene& scene, const WaveTimes& times, double tolerance);

/// Leine's switch model: a band of sliding speeds of this half width (in V) counts as stick and draws the body to rest.
Answer run_switch_model(const ForwardScene& scene, const WaveTimes& times, double band);

/// Friction times tanh(v / width), static peak decaying over sqrt(width) in V; Rosenbrock 4(3), as it is stiff.
Answer run_smoothed(const ForwardScene& scene, const WaveTimes& times, double width);

/// slipfit's tiers, friction as each of them knows it.
Answer run_sawtooth(const ForwardScene& scene, const WaveTimes& times);
Answer run_undamped(const ForwardScene& scene, const WaveTimes& times);
Answer run_paper(const ForwardScene& scene, const WaveTimes& times);
Answer run_damped(const ForwardScene& scene, const WaveTimes& times);
Answer run_velocity(const ForwardScene& scene, const WaveTimes& times);

}  // namespace atlas
