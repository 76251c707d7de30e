#include "model_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "failure.hpp"
#include "quantities.hpp"

using slipfit::Dimension;

namespace {

double natural_frequency_rad_per_s(const ModelArguments& arguments, double stiffness_N_per_m) {
  if (arguments.mass.has_value() == arguments.natural_frequency.has_value()) {
    throw Failure(ExitCode::WrongUsage, "give either --mass (kg) or --natural-frequency (rad/s)");
  }
  if (arguments.natural_frequency) {
    return positive_quantity("--natural-frequency", *arguments.natural_frequency, Dimension::AngularSpeed);
  }
  const double mass_kg = plain_number("--mass", *arguments.mass, "kg");
  if (!(mass_kg > 0.0)) throw Failure(ExitCode::WrongUsage, fmt::format("--mass: '{}' is not above zero", mass_kg));
  return std::sqrt(stiffness_N_per_m / mass_kg);
}

template <class T>
T value_or_refuse(slipfit::Result<T> result) {
  if (!result) throw Failure(ExitCode::WrongUsage, result.error());
  return std::move(result).value();
}

/// F_k(v), where it is given in place of a constant.
std::optional<slipfit::VelocityFriction> velocity_friction(const ModelArguments& arguments, double static_N) {
  if (!arguments.f0 && !arguments.f1 && !arguments.alpha) return std::nullopt;
  if (arguments.kinetic_friction) {
    throw Failure(ExitCode::WrongUsage, "give either --kinetic-friction or --f0, --f1 and --alpha, not both");
  }
  const double f0_N =
      quantity("--f0", required(arguments.f0, "--f0", "the constant part of F_k (N)"), Dimension::Force);
  const double f1_N = quantity("--f1", required(arguments.f1, "--f1", "the part of F_k that depends on the speed (N)"),
                               Dimension::Force);
  const double alpha_s_per_m =
      plain_number("--alpha", required(arguments.alpha, "--alpha", "its rate with the speed (s/m)"), "s/m");
  return value_or_refuse(slipfit::VelocityFriction::create(static_N, f0_N, f1_N, alpha_s_per_m));
}

double kinetic_friction_N(const ModelArguments& arguments) {
  return quantity("--kinetic-friction",
                  required(arguments.kinetic_friction, "--kinetic-friction", "F_k (N), or --f0, --f1 and --alpha"),
                  Dimension::Force);
}

}  // namespace

void add_model_options(CLI::App& command, ModelArguments& arguments) {
  command.add_option("--stiffness", arguments.stiffness, "Tangential stiffness (N/m)");
  command.add_option("--mass", arguments.mass, "Oscillating mass (kg)");
  command.add_option("--natural-frequency", arguments.natural_frequency, "sqrt(k/m) (rad/s), in place of --mass");
  command
      .add_option("--damping-ratio", arguments.damping_ratio,
                  "c / (2 sqrt(k m)), at least 0; from 1 on there is no stick-slip")
      ->capture_default_str();
  command.add_option("--static-friction", arguments.static_friction, "F_s (N)");
  command.add_option("--kinetic-friction", arguments.kinetic_friction, "F_k (N), at most F_s");
  command.add_option("--f0", arguments.f0,
                     "Friction that depends on the sliding speed v: f0 + f1 exp(alpha v), in place of "
                     "--kinetic-friction (N)");
  command.add_option("--f1", arguments.f1, "See --f0 (N); f0 + f1 at most F_s");
  command.add_option("--alpha", arguments.alpha, "See --f0 (s/m); below 0 friction falls with the speed if f1 > 0");
}

bool model_given(const CLI::App& command) {
  constexpr std::array<const char*, 9> kOptions{"--stiffness",
                                                "--mass",
                                                "--natural-frequency",
                                                "--damping-ratio",
                                                "--static-friction",
                                                "--kinetic-friction",
                                                "--f0",
                                                "--f1",
                                                "--alpha"};
  return std::any_of(kOptions.begin(), kOptions.end(),
                     [&command](const char* name) { return command.count(name) > 0; });
}

Model model_from(const ModelArguments& arguments) {
  const double stiffness_N_per_m = plain_number(
      "--stiffness", required(arguments.stiffness, "--stiffness", "the tangential stiffness (N/m)"), "N/m");
  if (!(stiffness_N_per_m > 0.0)) {
    throw Failure(ExitCode::WrongUsage, fmt::format("--stiffness: '{}' is not above zero", stiffness_N_per_m));
  }
  const double damping_ratio = quantity("--damping-ratio", arguments.damping_ratio, Dimension::Dimensionless);
  const double static_N = quantity(
      "--static-friction", required(arguments.static_friction, "--static-friction", "F_s (N)"), Dimension::Force);
  const auto by_speed = velocity_friction(arguments, static_N);
  const double kinetic_N = by_speed ? by_speed->onset_N() : kinetic_friction_N(arguments);
  const double omega_rad_per_s = natural_frequency_rad_per_s(arguments, stiffness_N_per_m);
  return {value_or_refuse(slipfit::Slider::create(stiffness_N_per_m, omega_rad_per_s, damping_ratio)),
          value_or_refuse(slipfit::Friction::create(static_N, kinetic_N)), by_speed};
}
