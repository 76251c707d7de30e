#include "slipfit/predict/plan.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "commands.hpp"
#include "document_file.hpp"
#include "failure.hpp"
#include "output.hpp"
#include "quantities.hpp"
#include "slipfit/report/fit_document.hpp"
#include "slipfit/report/plan.hpp"

namespace {

struct PlanArguments {
  std::string file;
  std::optional<std::string> target;
  std::optional<std::string> speed;
  DocumentOptions document;
};

constexpr const char* kSpacing = "periodic_displacement_m";

std::optional<slipfit::PlanTarget> target_from(const PlanArguments& arguments) {
  if (!arguments.target && !arguments.speed) return std::nullopt;
  slipfit::PlanTarget target{key_of_parameter(arguments.target.value_or(kSpacing)), std::nullopt};
  if (arguments.speed) {
    if (target.name != kSpacing) refuse("--at can only be combined with --for {}", kSpacing);
    target.speed_m_per_s = quantity("--at", *arguments.speed, slipfit::Dimension::Speed, Limits::AboveZero);
  } else if (target.name == kSpacing) {
    refuse("--for {} needs a speed: give it with --at", kSpacing);
  }
  return target;
}

void add_options(CLI::App& command, PlanArguments& arguments) {
  command.add_option("FIT.json", arguments.file, "Document written by slipfit fit --json")->required();
  command.add_option("--for", arguments.target,
                     "Parameter whose interval should shrink, by its symbol (zeta) or key, or periodic_displacement_m; "
                     "default: the least well known");
  command.add_option("--at", arguments.speed, "Speed at which the predicted spacing is needed");
  add_document_options(command, arguments.document, "text");
}

void run(const PlanArguments& arguments) {
  const std::optional<slipfit::PlanTarget> target = target_from(arguments);
  check_outputs(arguments.document.outputs, arguments.file, "fit document");
  const std::string content = document_text(arguments.file);
  const slipfit::FitDocument document = value_or_fail(slipfit::read_fit_document(content, arguments.file));
  const auto plan = slipfit::plan_next(value_or_fail(slipfit::read_plan_basis(content, arguments.file)), target);
  if (!plan) refuse("{}: {}", arguments.file, plan.error().message);
  const slipfit::PredictionSource source{
      arguments.file, document.conditional_on,
      arguments.speed ? std::string(slipfit::unit_in(*arguments.speed)) : document.speed_unit};
  write_results(arguments.document, [&](const std::string&) {
    return arguments.document.json ? slipfit::to_json(plan.value(), source) + "\n"
                                   : slipfit::to_text(plan.value(), source);
  });
}

}  // namespace

void add_plan_command(CLI::App& program, const std::string& /*typed_line*/) {
  add_command<PlanArguments>(
      program, "plan", "Recommends the speed, sampling rate and duration of the next measurement", add_options, run);
}
