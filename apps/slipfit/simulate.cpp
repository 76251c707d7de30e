#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "commands.hpp"
#include "failure.hpp"
#include "model_options.hpp"
#include "output.hpp"
#include "quantities.hpp"
#include "slipfit/model/simulation.hpp"
#include "slipfit/report/csv.hpp"

using slipfit::Dimension;

namespace {

constexpr double kMostSamples = 2e8;  // about 10 GB of text: more is taken for a typing error

struct SimulateArguments {
  ModelArguments model;
  std::optional<std::string> speed;
  std::optional<std::string> radius;
  std::optional<std::string> duration;
  std::optional<std::string> sample_rate;
  std::string noise = "0";
  std::string jitter = "0";
  std::string offset = "0";
  std::string drift = "0";
  std::string hum = "0";
  std::string hum_frequency = "50";
  std::string force_view = "spring";
  std::uint64_t seed = 1;
  std::optional<std::string> out;
  bool quiet = false;
};

void add_options(CLI::App& command, SimulateArguments& arguments) {
  add_model_options(command, arguments.model);
  command.add_option("--speed", arguments.speed, "Driving speed: 0.01 (m/s), 10mm/s; 60rpm with --radius");
  command.add_option("--radius", arguments.radius, "Distance of the contact from the axis: 12mm");
  command.add_option("--duration", arguments.duration, "Length of the recording (s)");
  command.add_option("--sample-rate", arguments.sample_rate, "Samples a second (Hz)");
  command.add_option("--noise", arguments.noise, "White noise (N rms)")->capture_default_str();
  command.add_option("--jitter", arguments.jitter, "Standard deviation of F_s from slip to slip (N)")
      ->capture_default_str();
  command.add_option("--offset", arguments.offset, "Added to the force (N)")->capture_default_str();
  command.add_option("--drift", arguments.drift, "Added to the force (N/s)")->capture_default_str();
  command.add_option("--hum", arguments.hum, "Amplitude of mains hum (N)")->capture_default_str();
  command.add_option("--hum-frequency", arguments.hum_frequency, "Mains frequency (Hz)")->capture_default_str();
  command.add_option("--force-view", arguments.force_view, "spring, transmitted or contact")->capture_default_str();
  command.add_option("--seed", arguments.seed, "Same seed, same numbers")->capture_default_str();
  command.add_option("--out", arguments.out, "Write to this file, not to standard output");
  command.add_flag("--quiet", arguments.quiet, "No messages on standard error but errors");
}

slipfit::SimulationOptions options_from(const SimulateArguments& arguments) {
  slipfit::SimulationOptions options;
  options.duration_s = positive_quantity(
      "--duration", required(arguments.duration, "--duration", "the length of the recording (s)"), Dimension::Time);
  options.sample_rate_Hz =
      positive_quantity("--sample-rate", required(arguments.sample_rate, "--sample-rate", "the samples a second (Hz)"),
                        Dimension::Frequency);
  options.force_view = force_view(arguments.force_view);
  options.static_friction_sd_N = quantity_not_negative("--jitter", arguments.jitter, Dimension::Force);
  options.noise_rms_N = quantity_not_negative("--noise", arguments.noise, Dimension::Force);
  options.offset_N = quantity("--offset", arguments.offset, Dimension::Force);
  options.drift_N_per_s = plain_number("--drift", arguments.drift, "N/s");
  options.hum_N = quantity_not_negative("--hum", arguments.hum, Dimension::Force);
  options.hum_frequency_Hz = positive_quantity("--hum-frequency", arguments.hum_frequency, Dimension::Frequency);
  options.seed = arguments.seed;
  if (options.duration_s * options.sample_rate_Hz > kMostSamples) {
    throw Failure(ExitCode::WrongUsage, fmt::format("--duration times --sample-rate is {:.3g} samples, at most {:.0e}",
                                                    options.duration_s * options.sample_rate_Hz, kMostSamples));
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

slipfit::SimulatedTrace simulated(const Model& model, double speed_m_per_s, const slipfit::SimulationOptions& options) {
  if (!model.velocity_friction) return slipfit::simulate(model.slider, model.friction, speed_m_per_s, options);
  auto trace = slipfit::simulate(model.slider, *model.velocity_friction, speed_m_per_s, options);
  if (!trace) throw Failure(ExitCode::WrongUsage, trace.error());
  return std::move(trace).value();
}

void run(const SimulateArguments& arguments) {
  const Model model = model_from(arguments.model);
  const double speed_m_per_s = driving_speed(
      required(arguments.speed, "--speed", "the driving speed, for example --speed 10mm/s"), arguments.radius);
  const slipfit::SimulationOptions options = options_from(arguments);
  if (arguments.out) check_outputs({{"--out", *arguments.out}}, "");
  const slipfit::SimulatedTrace trace = simulated(model, speed_m_per_s, options);
  const std::string csv = slipfit::trace_to_csv(trace, comment_for(model, speed_m_per_s, options));
  if (!arguments.out) {
    write_standard_output(csv);
    return;
  }
  write_file({"--out", *arguments.out}, csv);
  if (!arguments.quiet) say(fmt::format("wrote '{}'", *arguments.out));
}

}  // namespace

void add_simulate_command(CLI::App& program) {
  CLI::App* const command = program.add_subcommand("simulate", "A recording of the model, with noise (CSV)");
  const auto arguments = std::make_shared<SimulateArguments>();
  add_options(*command, *arguments);
  command->callback([arguments] { run(*arguments); });
}
