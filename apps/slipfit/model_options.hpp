#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "slipfit/model/motion.hpp"
#include "slipfit/model/velocity.hpp"

/// The model on the command line.
struct ModelArguments {
  std::optional<double> stiffness_N_per_m, mass_kg, natural_frequency_rad_per_s;
  double damping_ratio = 0.0;
  std::optional<double> static_friction_N, kinetic_friction_N;
  std::optional<double> f0_N, f1_N, alpha_s_per_m;
};

struct Model {
  slipfit::Slider slider;
  slipfit::Friction friction;  ///< with velocity-dependent friction: its F_k(0+)
  std::optional<slipfit::VelocityFriction> velocity_friction;
};

void add_model_options(CLI::App& command, ModelArguments& arguments);

/// Whether any of the options was given.
bool model_given(const CLI::App& command);

/// Throws Failure(WrongUsage).
Model model_from(const ModelArguments& arguments);
