#include "model_options.hpp"

#include <cmath>

#include "failure.hpp"
#include "quantities.hpp"

using slipfit::Dimension;

namespace {

double natural_frequency_rad_per_s(const ModelArguments& arguments, double stiffness_N_per_m) {
  if (arguments.mass_kg.has_value() == arguments.natural_frequency_rad_per_s.has_value()) {
    refuse("give either --mass (kg) or --natural-frequency (rad/s)");
  }
  return arguments.mass_kg ? std::sqrt(stiffness_N_per_m / *arguments.mass_kg) : *arguments.natural_frequency_rad_per_s;
}

/// F_k(v), where it is given in place of a constant.
std::optional<slipfit::VelocityFriction> velocity_friction(const ModelArguments& arguments, double static_N) {
  if (!arguments.f0_N && !arguments.f1_N && !arguments.alpha_s_per_m) return std::nullopt;
  if (arguments.kinetic_friction_N) refuse("give either --kinetic-friction or --f0, --f1 and --alpha, not both");
  return value_or_fail(slipfit::VelocityFriction::create(
      static_N, required(arguments.f0_N, "--f0", "the constant part of F_k (N)"),
      required(arguments.f1_N, "--f1", "the part of F_k that depends on the speed (N)"),
      required(arguments.alpha_s_per_m, "--alpha", "its rate of change with speed (s/m)")));
}

}  // namespace

void add_model_options(CLI::App& command, ModelArguments& arguments) {
  using enum Limits;
  add_quantity(command, "--stiffness", arguments.stiffness_N_per_m, Dimension::Stiffness, AboveZero,
               "Tangential stiffness (N/m)");
  add_quantity(command, "--mass", arguments.mass_kg, Dimension::Mass, AboveZero, "Oscillating mass (kg)");
  add_quantity(command, "--natural-frequency", arguments.natural_frequency_rad_per_s, Dimension::AngularSpeed,
               AboveZero, "sqrt(k/m) (rad/s), instead of --mass");
  add_quantity(command, "--damping-ratio", arguments.damping_ratio, Dimension::Dimensionless, None,
               "c / (2 sqrt(k m)), at least 0; at 1 and above there is no stick-slip")
      ->default_str("0");
  add_quantity(command, "--static-friction", arguments.static_friction_N, Dimension::Force, None, "F_s (N)");
  add_quantity(command, "--kinetic-friction", arguments.kinetic_friction_N, Dimension::Force, None,
               "F_k (N), at most F_s");
  add_quantity(command, "--f0", arguments.f0_N, Dimension::Force, None,
               "Friction that depends on the sliding speed v: f0 + f1 exp(alpha v), instead of --kinetic-friction (N)");
  add_quantity(command, "--f1", arguments.f1_N, Dimension::Force, None, "See --f0 (N); f0 + f1 at most F_s");
  add_quantity(command, "--alpha", arguments.alpha_s_per_m, Dimension::Slowness, None,
               "See --f0 (s/m); if negative, friction decreases with speed for f1 > 0");
}

bool model_given(const ModelArguments& arguments) {
  return arguments.stiffness_N_per_m || arguments.mass_kg || arguments.natural_frequency_rad_per_s ||
         arguments.damping_ratio || arguments.static_friction_N || arguments.kinetic_friction_N || arguments.f0_N ||
         arguments.f1_N || arguments.alpha_s_per_m;
}

Model model_from(const ModelArguments& arguments) {
  const double stiffness_N_per_m =
      required(arguments.stiffness_N_per_m, "--stiffness", "the tangential stiffness (N/m)");
  const double static_N = required(arguments.static_friction_N, "--static-friction", "F_s (N)");
  const auto by_speed = velocity_friction(arguments, static_N);
  const double kinetic_N =
      by_speed ? by_speed->onset_N()
               : required(arguments.kinetic_friction_N, "--kinetic-friction", "F_k (N), or --f0, --f1 and --alpha");
  const double omega_rad_per_s = natural_frequency_rad_per_s(arguments, stiffness_N_per_m);
  return {
      value_or_fail(slipfit::Slider::create(stiffness_N_per_m, omega_rad_per_s, arguments.damping_ratio.value_or(0.0))),
      value_or_fail(slipfit::Friction::create(static_N, kinetic_N)), by_speed};
}
