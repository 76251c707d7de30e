#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "slipfit/model/motion.hpp"
#include "slipfit/model/velocity_friction.hpp"

/// The model on the command line.
struct ModelArguments {
  std::optional<double> stiffness_N_per_m, mass_kg, natural_frequency_rad_per_s, damping_ratio;
  std::optional<double> static_friction_N, kinetic_friction_N, f0_N, f1_N, alpha_s_per_m;
};

struct Model {
  slipfit::Slider slider;
  slipfit::Friction friction;  ///< with velocity-dependent friction: its F_k(0+)
  std::optional<slipfit::VelocityFriction> velocity_friction;
};

void add_model_options(CLI::App& command, ModelArguments& arguments);

/// Returns true if any of the options was given.
bool model_given(const ModelArguments& arguments);

/// Throws Failure(WrongUsage).
Model model_from(const ModelArguments& arguments);
