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
  if (!result) throw Failure(ExitCode::WrongUsage, result.error().message);
  return std::move(result).value();
}

}  // namespace

const std::string& required(const std::optional<std::string>& text, const std::string& option,
                            const std::string& meaning) {
  if (!text) throw Failure(ExitCode::WrongUsage, fmt::format("{} is missing: give {}", option, meaning));
  return *text;
}

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
}

bool model_given(const CLI::App& command) {
  constexpr std::array<const char*, 6> kOptions{
      "--stiffness", "--mass", "--natural-frequency", "--damping-ratio", "--static-friction", "--kinetic-friction"};
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
  const double kinetic_N = quantity(
      "--kinetic-friction", required(arguments.kinetic_friction, "--kinetic-friction", "F_k (N)"), Dimension::Force);
  const double omega_rad_per_s = natural_frequency_rad_per_s(arguments, stiffness_N_per_m);
  return {value_or_refuse(slipfit::Slider::create(stiffness_N_per_m, omega_rad_per_s, damping_ratio)),
          value_or_refuse(slipfit::Friction::create(static_N, kinetic_N))};
}
