#include <memory>

#include "analysis_run.hpp"
#include "commands.hpp"
#include "fit_options.hpp"

namespace {

struct FitArguments {
  AnalysisArguments analysis;
  std::string tier = "auto";
  std::vector<std::string> fixed;
};

}  // namespace

void add_fit_command(CLI::App& program) {
  CLI::App* const command =
      program.add_subcommand("fit", "The analysis, then the model fitted to it and what it predicts at this speed");
  const auto arguments = std::make_shared<FitArguments>();
  add_analysis_options(*command, arguments->analysis);
  command->add_option("--tier", arguments->tier, "Model: auto, sawtooth, undamped, damped")->capture_default_str();
  command->add_option("--fix", arguments->fixed, "NAME=VALUE: hold a parameter at a value (SI); may be repeated")
      ->allow_extra_args(false);
  command->add_option("--curve", arguments->analysis.curve, "Write time, force, fitted force and residual (CSV)");
  command->callback([arguments] {
    slipfit::FitOptions options = fit_options_from(arguments->tier, arguments->fixed);
    options.curve = arguments->analysis.curve.has_value();
    run_analysis(arguments->analysis, [&options](const slipfit::Recording& recording) {
      return slipfit::analyze_and_fit(recording, options);
    });
  });
}
