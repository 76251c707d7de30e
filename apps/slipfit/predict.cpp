#include "slipfit/predict/prediction.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "commands.hpp"
#include "failure.hpp"
#include "fit_document.hpp"
#include "model_options.hpp"
#include "output.hpp"
#include "quantities.hpp"
#include "slipfit/report/prediction.hpp"

using slipfit::Dimension;

namespace {

constexpr std::size_t kMostSpeeds = 100'000;  // about 100 MB of JSON: more is taken for a typing error

struct PredictArguments {
  std::optional<std::string> file;
  std::optional<std::string> speeds;
  std::optional<std::string> normal_force;
  ModelArguments model;
  DocumentOptions document;
  std::optional<std::string> csv;
};

void add_options(CLI::App& command, PredictArguments& arguments) {
  command.add_option("FIT.json", arguments.file, "Document of slipfit fit --json; or the model options in its place");
  command.add_option("--speeds", arguments.speeds,
                     "A:B:N, N speeds from A to B in equal ratios: 1mm/s:1m/s:50; or a list: 5mm/s,10mm/s");
  command.add_option(
      "--normal-force", arguments.normal_force,
      "Predict under this load: 2.3, 2.3N; of a fit whose recordings state theirs (default: their mean)");
  add_model_options(command, arguments.model);
  add_document_options(command, arguments.document, "table");
  command.add_option("--csv", arguments.csv, "Write one row a speed: value, low and high of every quantity (CSV)");
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t start = 0;
  for (std::size_t end = 0; end != std::string::npos; start = end + 1) {
    end = text.find(separator, start);
    parts.push_back(text.substr(start, end == std::string::npos ? end : end - start));
  }
  return parts;
}

[[noreturn]] void refuse_speeds(const std::string& message) {
  throw Failure(ExitCode::WrongUsage, "--speeds: " + message);
}

std::size_t number_of_speeds(const std::string& text) {
  std::size_t count = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(text.data(), end, count);
  if (status != std::errc() || stop != end || count < 2 || count > kMostSpeeds) {
    refuse_speeds(fmt::format("bad number of speeds '{}', expected A:B:N with N from 2 to {}", text, kMostSpeeds));
  }
  return count;
}

/// N speeds from A to B in equal ratios, both ends exact.
std::vector<double> speed_range(const std::vector<std::string>& parts) {
  const double first = positive_quantity("--speeds", parts[0], Dimension::Speed);
  const double last = positive_quantity("--speeds", parts[1], Dimension::Speed);
  const std::size_t count = number_of_speeds(parts[2]);
  if (!(first < last)) {
    refuse_speeds(fmt::format("'{}' is not below '{}', expected A:B:N with A < B", parts[0], parts[1]));
  }
  std::vector<double> speeds(count, last);
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    const double root = std::exp(0.5 * share * (std::log(last) - std::log(first)));  // its square may be no number
    speeds[i] = first * root * root;
  }
  return speeds;
}

std::vector<double> speeds_from(const std::string& text) {
  if (text.find(':') != std::string::npos) {
    const std::vector<std::string> parts = split(text, ':');
    if (parts.size() != 3) refuse_speeds(fmt::format("bad range '{}', expected A:B:N", text));
    return speed_range(parts);
  }
  std::vector<double> speeds;
  for (const std::string& part : split(text, ',')) {
    speeds.push_back(positive_quantity("--speeds", part, Dimension::Speed));
  }
  if (speeds.size() > kMostSpeeds) refuse_speeds(fmt::format("more than {} speeds", kMostSpeeds));
  return speeds;
}

void check_places(const PredictArguments& arguments, const std::vector<OutputFile>& outputs) {
  for (const OutputFile& output : outputs) {
    std::error_code ignored;
    if (!arguments.file || !std::filesystem::equivalent(output.file, *arguments.file, ignored)) continue;
    throw Failure(ExitCode::WrongUsage,
                  fmt::format("{}: '{}' is the fit document itself, choose another file", output.option, output.file));
  }
  check_outputs(outputs, "");
}

void set_load(FitDocument& document, const PredictArguments& arguments) {
  const double load_N = positive_quantity("--normal-force", *arguments.normal_force, Dimension::Force);
  if (!document.model.estimate.normal_force_N) {
    throw Failure(ExitCode::WrongUsage,
                  fmt::format("--normal-force: the recordings of '{}' state no normal force; fit them again with "
                              "--normal-force or the manifest's normal_force_N",
                              *arguments.file));
  }
  document.model = slipfit::at_load(std::move(document.model), load_N);
  document.conditional_on.push_back(fmt::format("friction in proportion to the normal force, here {:.6g} N", load_N));
}

/// A model, and where it comes from.
struct Basis {
  slipfit::PredictionModel model;
  slipfit::PredictionSource source;
};

Basis basis_from(const PredictArguments& arguments, const CLI::App& command) {
  const bool stated = model_given(command);
  if (arguments.file && stated) {
    throw Failure(ExitCode::WrongUsage,
                  fmt::format("give either '{}' or the model options (--stiffness, ...), not both", *arguments.file));
  }
  if (arguments.file) {
    FitDocument document = read_fit_document(*arguments.file);
    if (arguments.normal_force) set_load(document, arguments);
    return {std::move(document.model),
            {*arguments.file, std::move(document.conditional_on), {}, std::move(document.warnings)}};
  }
  if (!stated) {
    throw Failure(ExitCode::WrongUsage,
                  "the model is missing: give FIT.json (from slipfit fit --json --out FIT.json), or --stiffness, "
                  "--natural-frequency, --damping-ratio, --static-friction and --kinetic-friction");
  }
  const Model model = model_from(arguments.model);
  slipfit::PredictionModel prediction = slipfit::stated_model(model.slider, model.friction);
  if (model.velocity_friction) {
    const slipfit::VelocityFriction& law = *model.velocity_friction;
    prediction.estimate.speed_dependence =
        slipfit::SpeedDependence{law.f1_N() * law.alpha_s_per_m(), law.alpha_s_per_m()};
  }
  return {std::move(prediction), {"command line", {}}};
}

void run(const PredictArguments& arguments, const CLI::App& command) {
  const std::vector<double> speeds_m_per_s =
      speeds_from(required(arguments.speeds, "--speeds", "A:B:N or a list, for example --speeds 1mm/s:1m/s:50"));
  const std::vector<OutputFile> outputs = outputs_of({{"--out", arguments.document.out}, {"--csv", arguments.csv}});
  check_places(arguments, outputs);
  Basis basis = basis_from(arguments, command);
  basis.source.speed_unit =
      slipfit::unit_in(split(*arguments.speeds, arguments.speeds->find(':') != std::string::npos ? ':' : ',').front());
  const slipfit::Prediction prediction = slipfit::predict_at(basis.model, speeds_m_per_s);
  write_results(arguments.document, outputs, [&](const std::string& option) {
    if (option == "--csv") return slipfit::prediction_to_csv(prediction);
    return arguments.document.json ? slipfit::to_json(prediction, basis.source) + "\n"
                                   : slipfit::to_text(prediction, basis.source);
  });
}

}  // namespace

void add_predict_command(CLI::App& program) {
  CLI::App* const command =
      program.add_subcommand("predict", "Period, frequency and spacing at other speeds; where stick-slip ends");
  const auto arguments = std::make_shared<PredictArguments>();
  add_options(*command, *arguments);
  command->callback([arguments, command] { run(*arguments, *command); });
}
