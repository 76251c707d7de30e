#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "slipfit/model/motion.hpp"
#include "slipfit/model/velocity.hpp"

/// The model on the command line, as typed.
struct ModelArguments {
  std::optional<std::string> stiffness;
  std::optional<std::string> mass;
  std::optional<std::string> natural_frequency;
  std::string damping_ratio = "0";
  std::optional<std::string> static_friction;
  std::optional<std::string> kinetic_friction;
  std::optional<std::string> f0;
  std::optional<std::string> f1;
  std::optional<std::string> alpha;
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
