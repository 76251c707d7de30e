#include "slipfit/predict/prediction.hpp"

#include <optional>
#include <string>

#include "commands.hpp"
#include "document_file.hpp"
#include "failure.hpp"
#include "model_options.hpp"
#include "output.hpp"
#include "quantities.hpp"
#include "slipfit/predict/speeds.hpp"
#include "slipfit/report/fit_document.hpp"
#include "slipfit/report/prediction.hpp"

namespace {

struct PredictArguments {
  std::optional<std::string> file;
  std::optional<std::string> speeds;
  std::optional<double> normal_force_N;
  ModelArguments model;
  DocumentOptions document;
};

void add_options(CLI::App& command, PredictArguments& arguments) {
  command.add_option("FIT.json", arguments.file, "Document written by slipfit fit --json; or give the model options");
  command.add_option("--speeds", arguments.speeds,
                     "A:B:N, N speeds from A to B, logarithmically spaced: 1mm/s:1m/s:50; or a list: 5,10 mm/s");
  add_quantity(
      command, "--normal-force", arguments.normal_force_N, slipfit::Dimension::Force, Limits::AboveZero,
      "Normal force of the prediction: 2.3, 2.3N; needs a fit whose recordings state theirs (default: their mean)");
  add_model_options(command, arguments.model);
  add_document_options(command, arguments.document, "table");
  add_output_option(command, arguments.document, "--csv",
                    "Write one row for each speed: value, low and high of every quantity (CSV)");
}

slipfit::FitDocument document_from(const PredictArguments& arguments) {
  const std::string& file = *arguments.file;
  slipfit::FitDocument document = value_or_fail(slipfit::read_fit_document(document_text(file), file));
  if (!arguments.normal_force_N) return document;
  return value_or_fail(slipfit::at_load(std::move(document), *arguments.normal_force_N, file));
}

/// A model, and where it comes from.
struct Basis {
  slipfit::PredictionModel model;
  slipfit::PredictionSource source;
};

Basis basis_from(const PredictArguments& arguments) {
  const bool stated = model_given(arguments.model);
  if (arguments.file && stated) {
    refuse("give either '{}' or the model options (--stiffness, ...), not both", *arguments.file);
  }
  if (arguments.file) {
    slipfit::FitDocument document = document_from(arguments);
    return {std::move(document.model),
            {*arguments.file, std::move(document.conditional_on), std::move(document.speed_unit),
             std::move(document.warnings)}};
  }
  if (!stated) {
    refuse(
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

void run(const PredictArguments& arguments) {
  const auto speeds = value_or_fail(slipfit::parse_speeds(
      required(arguments.speeds, "--speeds", "A:B:N or a list, for example --speeds 1mm/s:1m/s:50")));
  check_outputs(arguments.document.outputs, arguments.file.value_or(""), "fit document");
  Basis basis = basis_from(arguments);
  if (!speeds.unit.empty()) basis.source.speed_unit = speeds.unit;
  const slipfit::Prediction prediction = slipfit::predict_at(basis.model, speeds.speeds_m_per_s);
  write_results(arguments.document, [&](const std::string& option) {
    if (option == "--csv") return slipfit::prediction_to_csv(prediction);
    return arguments.document.json ? slipfit::to_json(prediction, basis.source) + "\n"
                                   : slipfit::to_text(prediction, basis.source);
  });
}

}  // namespace

void add_predict_command(CLI::App& program, const std::string& /*typed_line*/) {
  add_command<PredictArguments>(program, "predict",
                                "Predicts period, frequency and spacing at other speeds and the end of stick-slip",
                                add_options, run);
}
