#include <memory>
#include <numbers>
#include <optional>
#include <tuple>
#include <variant>

#include "results.hpp"
#include "slipfit/compare.hpp"
#include "slipfit/core/units.hpp"
#include "slipfit/figures/figures.hpp"
#include "slipfit/io/manifest_draft.hpp"
#include "slipfit/model/simulation.hpp"
#include "slipfit/predict/speeds.hpp"
#include "slipfit/report/comparison.hpp"
#include "slipfit/report/estimate_row.hpp"
#include "slipfit/report/fit_document.hpp"
#include "slipfit/report/info.hpp"
#include "slipfit/report/plan.hpp"
#include "slipfit/report/prediction.hpp"
#include "slipfit/report/surface.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit::python {
namespace {

/// A document as JSON and for people, and a table or a page where there is one.
using Texts = std::vector<std::string>;

Texts texts_of(const Prediction& prediction, const PredictionSource& source) {
  return {to_json(prediction, source), to_text(prediction, source), prediction_to_csv(prediction)};
}

Result<Texts> prediction_of(const std::string& content, const std::string& name, const Speeds& speeds,
                            std::optional<double> normal_force_N) {
  auto document = read_fit_document(content, name);
  if (document && normal_force_N) document = at_load(std::move(document).value(), *normal_force_N, name);
  if (!document) return document.error();
  const FitDocument& fit = document.value();
  return texts_of(predict_at(fit.model, speeds.speeds_m_per_s), {name, fit.conditional_on, speeds.unit, fit.warnings});
}

Speeds speeds_from(const std::variant<std::string, std::vector<double>>& asked) {
  const auto* const text = std::get_if<std::string>(&asked);
  Speeds speeds = text != nullptr ? value_or_raise(parse_speeds(*text)) : Speeds{std::get<1>(asked), {}};
  for (const double speed : speeds.speeds_m_per_s) {
    if (!(speed > 0.0 && speed < 1e300)) raise({"out_of_range", "--speeds: a speed is not above zero or no number"});
  }
  return speeds;
}

Texts predict(const std::string& content, const std::string& name,
              const std::variant<std::string, std::vector<double>>& asked, std::optional<double> normal_force_N) {
  const Speeds speeds = speeds_from(asked);
  return value_or_raise(without_gil([&] { return prediction_of(content, name, speeds, normal_force_N); }));
}

Result<Texts> plan_of(const std::string& content, const std::string& name, const std::optional<PlanTarget>& target) {
  const auto document = read_fit_document(content, name);
  if (!document) return document.error();
  const auto basis = read_plan_basis(content, name);
  if (!basis) return basis.error();
  const auto planned = plan_next(basis.value(), target);
  if (!planned) return Error{planned.error().code, name + ": " + planned.error().message};
  const PredictionSource source{name, document.value().conditional_on};
  return Texts{to_json(planned.value(), source), to_text(planned.value(), source)};
}

Texts plan(const std::string& content, const std::string& name, const std::optional<std::string>& target,
           std::optional<double> speed_m_per_s) {
  const auto asked = target ? std::optional(PlanTarget{*target, speed_m_per_s}) : std::nullopt;
  return value_or_raise(without_gil([&] { return plan_of(content, name, asked); }));
}

Result<ComparisonSide> side_of(const std::string& name, const Texts& documents) {
  ComparisonSide side{name, {}};
  for (const std::string& document : documents) {
    auto fit = compared_fit(document, name);
    if (!fit) return fit.error();
    side.fits.push_back(std::move(fit).value());
  }
  return side;
}

std::vector<ComparedRecording> shown(const std::vector<AnalysedRecording>& recordings) {
  std::vector<ComparedRecording> all;
  all.reserve(recordings.size());
  for (const AnalysedRecording& one : recordings) all.push_back({*one.recording, *one.analysis});
  return all;
}

/// What a file holds, as JSON and for people.
Texts info(const std::string& file, const Cells& cells) {
  const auto look = [&]() -> Result<Texts> {
    const auto entry = entry_of(cells);
    if (!entry) return entry.error();
    const auto inspection = inspect(file, entry.value().options);
    if (!inspection) return inspection.error();
    return Texts{to_json(inspection.value(), file), to_text(inspection.value(), file)};
  };
  return value_or_raise(without_gil(look));
}

/// The draft as a manifest that stands in `folder`; code and message of each file that holds no recording.
py::tuple manifest(const std::vector<std::string>& paths, const std::string& folder) {
  const ManifestDraft draft = without_gil([&] { return writable(draft_manifest({paths.begin(), paths.end()})); });
  std::vector<std::pair<std::string, std::string>> skipped;
  for (const Error& error : draft.skipped) skipped.emplace_back(error.code, error.message);
  return py::make_tuple(to_csv(draft, folder), skipped);
}

class ComparedSides {
 public:
  ComparedSides(const std::string& name_a, const Texts& a, const std::string& name_b, const Texts& b)
      : comparison_(compare(value_or_raise(side_of(name_a, a)), value_or_raise(side_of(name_b, b)))) {}

  [[nodiscard]] std::string json() const { return to_json(comparison_); }
  [[nodiscard]] std::string text() const { return to_text(comparison_); }
  [[nodiscard]] std::string page(const std::vector<AnalysedRecording>& a, const std::vector<AnalysedRecording>& b,
                                 const std::string& command) const {
    return without_gil([&] { return to_html(comparison_, {command, shown(a), shown(b)}); });
  }

 private:
  Comparison comparison_;
};

struct MeasuredSurface {
  Profile profile;
  Surface surface;
};

Result<MeasuredSurface> measured(const std::string& file, const ProfileOptions& options) {
  auto profile = read_profile(file, options);
  if (!profile) return profile.error();
  auto surface = measure_surface(profile.value());
  if (!surface) return surface.error();
  return MeasuredSurface{std::move(profile).value(), std::move(surface).value()};
}

MeasuredSurface measure(const std::string& file, const std::optional<std::string>& unit, std::optional<double> pitch_m,
                        std::optional<double> pixel_m, std::optional<double> along_rad,
                        const std::optional<std::string>& x_column, const std::optional<std::string>& z_column) {
  ProfileOptions options{std::nullopt, pitch_m, pixel_m, along_rad, x_column, z_column};
  if (unit) options.unit_m = value_or_raise(parse_unit(*unit, Dimension::Length));
  return value_or_raise(without_gil([&] { return measured(file, options); }));
}

/// Static friction, then the constant kinetic friction or f0, f1 and alpha.
using FrictionNumbers = std::vector<double>;

/// A body and its friction; `by_speed` replaces `friction` where kinetic friction depends on the speed.
struct StatedModel {
  Slider slider;
  Friction friction;
  std::optional<VelocityFriction> by_speed;
};

StatedModel stated(const std::vector<double>& slider, const FrictionNumbers& numbers) {
  auto body = value_or_raise(Slider::create(slider.at(0), slider.at(1), slider.at(2)));
  if (numbers.size() == 2) {
    return {body, value_or_raise(Friction::create(numbers.at(0), numbers.at(1))), std::nullopt};
  }
  auto law = value_or_raise(VelocityFriction::create(numbers.at(0), numbers.at(1), numbers.at(2), numbers.at(3)));
  return {body, value_or_raise(Friction::create(numbers.at(0), law.onset_N())), law};
}

Texts predict_stated(const std::vector<double>& slider, const FrictionNumbers& friction,
                     const std::variant<std::string, std::vector<double>>& asked) {
  const StatedModel model = stated(slider, friction);
  const Speeds speeds = speeds_from(asked);
  PredictionModel prediction = stated_model(model.slider, model.friction);
  if (model.by_speed) {
    prediction.estimate.speed_dependence =
        SpeedDependence{model.by_speed->f1_N() * model.by_speed->alpha_s_per_m(), model.by_speed->alpha_s_per_m()};
  }
  return without_gil([&] {
    const Prediction predicted = predict_at(prediction, speeds.speeds_m_per_s);
    return texts_of(predicted, {"parameters", {}, speeds.unit});
  });
}

Result<SimulatedTrace> simulated(const StatedModel& model, double speed_m_per_s, const SimulationOptions& options) {
  return model.by_speed ? simulate(model.slider, *model.by_speed, speed_m_per_s, options)
                        : simulate(model.slider, model.friction, speed_m_per_s, options);
}

/// Raises bad_document where a reader of the document would be misled.
void check_document(const std::string& content, const std::string& name) {
  if (const auto error = without_gil([&] { return check_fit_document(content, name); })) raise(*error);
}

std::vector<std::pair<std::string, std::string>> figures() {
  std::vector<std::pair<std::string, std::string>> files;
  for (FigureFile& file : without_gil([] { return paper_figures(); })) {
    files.emplace_back(std::move(file.name), std::move(file.content));
  }
  return files;
}

/// The summary, which points to the rest of the results in words of Python.
std::string summary(const std::string& content, const std::string& name) {
  return value_or_raise(summary_of_document(
      content, name,
      {".details()", "all results: .details() or .to_dict()      page with charts: .report(\"FILE.html\")"}));
}

/// Value, unit and 95 % interval as texts, rounded as everywhere.
std::tuple<std::string, std::string, std::string> rounded_row(std::optional<double> value, std::optional<double> se,
                                                              const std::optional<std::pair<double, double>>& ci95,
                                                              const std::string& unit) {
  const auto interval = ci95 ? std::optional(Interval{ci95->first, ci95->second}) : std::nullopt;
  const EstimateRow row = estimate_row({value, se, interval, {}}, unit);
  return {row.value, row.unit, row.interval};
}

ForceView view_called(const std::string& name) {
  if (name == "spring") return ForceView::Spring;
  if (name == "transmitted") return ForceView::Transmitted;
  if (name == "contact") return ForceView::Contact;
  raise({"unknown_force_view", "--force-view: unknown view '" + name + "', expected spring, transmitted or contact"});
}

/// `added`: jitter, noise, offset, drift, hum, its frequency.
py::tuple simulate_arrays(const std::vector<double>& slider, const FrictionNumbers& friction, double speed_m_per_s,
                          double duration_s, double sample_rate_Hz, const std::vector<double>& added,
                          const std::string& force_view, std::uint64_t seed) {
  constexpr double kMostSamples = 2e8;  // more is taken for a typing error
  if (duration_s * sample_rate_Hz > kMostSamples) {
    raise({"out_of_range", "--duration times --sample-rate is more than 2e8 samples, expected fewer"});
  }
  const SimulationOptions options{duration_s,  sample_rate_Hz, view_called(force_view),
                                  added.at(0), added.at(1),    added.at(2),
                                  added.at(3), added.at(4),    added.at(5),
                                  seed};
  const StatedModel model = stated(slider, friction);
  const SimulatedTrace trace = value_or_raise(without_gil([&] { return simulated(model, speed_m_per_s, options); }));
  return py::make_tuple(array_of(trace.time_s), array_of(trace.force_N));
}

}  // namespace

void add_documents(py::module_& module) {
  module.def("predict", predict, py::arg("document"), py::arg("name"), py::arg("speeds"), py::arg("normal_force_N"));
  module.def("predict_stated", predict_stated, py::arg("slider"), py::arg("friction"), py::arg("speeds"));
  module.def("check_document", check_document, py::arg("document"), py::arg("name"));
  module.def("estimate_row", rounded_row, py::arg("value"), py::arg("se"), py::arg("ci95"), py::arg("unit"));
  module.def("summary", summary, py::arg("document"), py::arg("name"));
  module.def("figures", figures);
  module.def("info", info, py::arg("file"), py::arg("cells"));
  module.def("manifest", manifest, py::arg("paths"), py::arg("folder"));
  module.def("plan", plan, py::arg("document"), py::arg("name"), py::arg("target"), py::arg("speed_m_per_s"));
  py::class_<ComparedSides>(module, "Comparison", "Two sides, quantity by quantity.")
      .def(py::init<const std::string&, const Texts&, const std::string&, const Texts&>(), py::arg("name_a"),
           py::arg("documents_a"), py::arg("name_b"), py::arg("documents_b"))
      .def("json", &ComparedSides::json)
      .def("text", &ComparedSides::text)
      .def("page", &ComparedSides::page, py::arg("recordings_a"), py::arg("recordings_b"), py::arg("command"));
  py::class_<MeasuredSurface>(module, "Surface", "A worn surface and its pattern.")
      .def("json", [](const MeasuredSurface& s) { return to_json(s.profile, s.surface); })
      .def("text", [](const MeasuredSurface& s) { return to_text(s.profile, s.surface); })
      .def(
          "page",
          [](const MeasuredSurface& s, const std::string& command) { return to_html(s.profile, s.surface, command); },
          py::arg("command"))
      .def_property_readonly("height", [](const MeasuredSurface& s) { return array_of(s.profile.height); })
      .def_property_readonly("pitch_m", [](const MeasuredSurface& s) { return s.profile.pitch_m; })
      .def_property_readonly("ridge_places_m",
                             [](const MeasuredSurface& s) { return array_of(s.surface.ridge_places_m); });
  module.def("measure_surface", measure, py::arg("file"), py::arg("unit"), py::arg("pitch_m"), py::arg("pixel_m"),
             py::arg("along_rad"), py::arg("x_column"), py::arg("z_column"));
  module.def("simulate", simulate_arrays, py::arg("slider"), py::arg("friction"), py::arg("speed_m_per_s"),
             py::arg("duration_s"), py::arg("sample_rate_Hz"), py::arg("added"), py::arg("force_view"),
             py::arg("seed"));
}

}  // namespace slipfit::python
