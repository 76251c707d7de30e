#include <fmt/format.h>

#include <optional>
#include <string>

#include "commands.hpp"
#include "failure.hpp"
#include "model_options.hpp"
#include "output.hpp"
#include "quantities.hpp"
#include "recording_options.hpp"
#include "slipfit/model/simulation.hpp"
#include "slipfit/report/csv.hpp"

using slipfit::Dimension;

namespace {

constexpr double kMostSamples = 2e8;  // about 10 GB of text: more is taken for a typing error

struct SimulateArguments {
  ModelArguments model;
  RecordingArguments recording;  ///< speed and view
  std::optional<double> duration_s, sample_rate_Hz;
  slipfit::SimulationOptions options;  ///< without these
  DocumentOptions document;
};

void add_options(CLI::App& command, SimulateArguments& arguments) {
  using enum Limits;
  slipfit::SimulationOptions& options = arguments.options;
  add_model_options(command, arguments.model);
  add_options_where(command, arguments.recording, [](const slipfit::RecordingOption& option) {
    return option.column == "speed" || option.column == "radius" || option.column == "force_view";
  });
  add_quantity(command, "--duration", arguments.duration_s, Dimension::Time, AboveZero, "Length of the recording (s)");
  add_quantity(command, "--sample-rate", arguments.sample_rate_Hz, Dimension::Frequency, AboveZero,
               "Sampling rate (Hz)");
  add_quantity(command, "--noise", options.noise_rms_N, Dimension::Force, NotNegative, "White noise (N rms)")
      ->default_str("0");
  add_quantity(command, "--jitter", options.static_friction_sd_N, Dimension::Force, NotNegative,
               "Standard deviation of F_s from slip to slip (N)")
      ->default_str("0");
  add_quantity(command, "--offset", options.offset_N, Dimension::Force, None, "Offset added to the force (N)")
      ->default_str("0");
  add_quantity(command, "--drift", options.drift_N_per_s, Dimension::ForceRate, None, "Drift added to the force (N/s)")
      ->default_str("0");
  add_quantity(command, "--hum", options.hum_N, Dimension::Force, NotNegative, "Amplitude of mains hum (N)")
      ->default_str("0");
  add_quantity(command, "--hum-frequency", options.hum_frequency_Hz, Dimension::Frequency, AboveZero,
               "Mains frequency (Hz)")
      ->default_str("50");
  command.add_option("--seed", options.seed, "Seed of the random numbers")->capture_default_str();
  add_output_option(command, arguments.document, "--out", "Write to this file instead of standard output");
  add_quiet_option(command, arguments.document);
}

slipfit::SimulationOptions options_from(const SimulateArguments& arguments, slipfit::ForceView view) {
  slipfit::SimulationOptions options = arguments.options;
  options.force_view = view;
  options.duration_s = required(arguments.duration_s, "--duration", "the length of the recording (s)");
  options.sample_rate_Hz = required(arguments.sample_rate_Hz, "--sample-rate", "the samples a second (Hz)");
  if (options.duration_s * options.sample_rate_Hz > kMostSamples) {
    refuse("--duration times --sample-rate is {:.3g} samples, at most {:.0e}",
           options.duration_s * options.sample_rate_Hz, kMostSamples);
  }
  return options;
}

std::string comment_for(const Model& model, double speed_m_per_s, const slipfit::SimulationOptions& options) {
  const auto& by_speed = model.velocity_friction;
  const std::string kinetic = by_speed ? fmt::format("f0 {} N, f1 {} N, alpha {} s/m", by_speed->f0_N(),
                                                     by_speed->f1_N(), by_speed->alpha_s_per_m())
                                       : fmt::format("kinetic friction {} N", model.friction.kinetic_N());
  return fmt::format(
      "slipfit simulate: stiffness {} N/m, natural frequency {} rad/s, damping ratio {}, static friction {} N, {}, "
      "speed {} m/s, seed {}",
      model.slider.stiffness_N_per_m(), model.slider.natural_frequency_rad_per_s(), model.slider.damping_ratio(),
      model.friction.static_N(), kinetic, speed_m_per_s, options.seed);
}

void run(const SimulateArguments& arguments) {
  const Model model = model_from(arguments.model);
  if (arguments.recording.speeds.empty()) {
    refuse("--speed is missing: give the driving speed, for example --speed 10mm/s");
  }
  const slipfit::Conditions conditions = entry_from(arguments.recording).conditions;
  const double speed_m_per_s = conditions.speed_m_per_s;
  const slipfit::SimulationOptions options = options_from(arguments, conditions.force_view);
  check_outputs(arguments.document.outputs, "");
  const slipfit::SimulatedTrace trace =
      model.velocity_friction
          ? value_or_fail(slipfit::simulate(model.slider, *model.velocity_friction, speed_m_per_s, options))
          : slipfit::simulate(model.slider, model.friction, speed_m_per_s, options);
  const std::string csv = slipfit::trace_to_csv(trace, comment_for(model, speed_m_per_s, options));
  if (arguments.document.outputs.empty()) return write_standard_output(csv);
  write_file(arguments.document.outputs.back(), csv);
  arguments.document.notify(fmt::format("wrote '{}'", arguments.document.outputs.back().file));
}

}  // namespace

void add_simulate_command(CLI::App& program, const std::string& /*typed_line*/) {
  add_command<SimulateArguments>(program, "simulate", "Simulates a recording of the model, with noise (CSV)",
                                 add_options, run);
}
