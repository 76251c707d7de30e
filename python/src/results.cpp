#include <cmath>
#include <limits>
#include <optional>

#include "recordings.hpp"
#include "results.hpp"
#include "slipfit/background.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/report/csv.hpp"
#include "slipfit/report/html.hpp"
#include "slipfit/report/json.hpp"
#include "slipfit/report/prediction.hpp"
#include "slipfit/report/sweep.hpp"
#include "slipfit/report/sweep_html.hpp"
#include "slipfit/report/text.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit::python {
namespace {

Result<FitOptions> options_from(const std::string& tier, const std::vector<std::string>& fixed, FitKind kind) {
  auto options = parse_fit_options(tier, fixed, kind);
  if (!options) return options;
  FitOptions known = std::move(options).value();
  known.curve = true;
  return known;
}

void check_data(const Recording& recording) {
  if (const std::optional<Error> error = missing_data(recording)) raise(*error);
}

AnalysedRecording analyse(const SharedRecording& recording) {
  check_data(*recording);
  return interruptible([&] {
    return AnalysedRecording{recording, std::make_shared<const Analysis>(analyze(*recording))};
  });
}

AnalysedRecording fit(const SharedRecording& recording, const std::string& tier,
                      const std::vector<std::string>& fixed) {
  const FitOptions options = value_or_raise(options_from(tier, fixed, FitKind::Single));
  check_data(*recording);
  return interruptible([&] {
    return AnalysedRecording{recording, std::make_shared<const Analysis>(analyze_and_fit(*recording, options))};
  });
}

using Named = std::vector<std::pair<std::string, SharedRecording>>;

Result<AnalysedSweep> sweep_of(const Named& recordings, const std::optional<FitOptions>& options) {
  auto all = std::make_shared<AnalysedSweep::Parts>();
  for (const auto& [id, recording] : recordings) {
    if (options) {
      if (auto error = check_joint(*recording)) return Error{error->code, id + ": " + error->message};
    }
    all->entries.push_back({id, *recording});
  }
  all->sweep = options ? analyze_sweep(all->entries, *options) : analyze_each(all->entries);
  return AnalysedSweep{all, recordings};
}

AnalysedSweep fit_sweep(const Named& recordings, const std::string& tier, const std::vector<std::string>& fixed) {
  const FitOptions options = value_or_raise(options_from(tier, fixed, FitKind::Sweep));
  return value_or_raise(interruptible([&] { return sweep_of(recordings, options); }));
}

AnalysedSweep analyse_sweep(const Named& recordings) {
  return value_or_raise(interruptible([&] { return sweep_of(recordings, std::nullopt); }));
}

JsonOptions layout_of(const std::string& id) {
  JsonOptions options;
  options.id = id;
  return options;
}

/// The fitted force at each sample; not a number where the fit does not reach.
py::array_t<double> fitted_of(const AnalysedRecording& result) {
  std::vector<double> fitted(result.recording->size(), std::numeric_limits<double>::quiet_NaN());
  if (result.analysis->fit) {
    for (const CurvePoint& point : result.analysis->fit->curve) {
      if (point.sample < fitted.size()) fitted[point.sample] = point.force;
    }
  }
  return array_of(fitted);
}

std::string charts_of(const AnalysedRecording& result, const std::string& which) {
  return without_gil([&] {
    return report_charts(*result.recording, *result.analysis, gather_background(*result.recording, *result.analysis),
                         which);
  });
}

std::string charts_of(const AnalysedSweep& result, const std::string& which) {
  return without_gil([&] {
    const auto& [entries, sweep] = *result.parts;
    return report_charts(entries, sweep, predict_around(entries, sweep), which);
  });
}

std::string page_of(const AnalysedRecording& result, const std::string& command) {
  return without_gil([&] {
    return to_html(*result.recording, *result.analysis, gather_background(*result.recording, *result.analysis),
                   {command});
  });
}

std::string page_of(const AnalysedSweep& result, const std::string& name, const std::string& command) {
  return without_gil([&] {
    const auto& [entries, sweep] = *result.parts;
    return to_html(entries, sweep, predict_around(entries, sweep), SweepOrigin{name, command});
  });
}

std::vector<AnalysedRecording> members_of(const AnalysedSweep& result) {
  std::vector<AnalysedRecording> members;
  for (std::size_t i = 0; i < result.recordings.size(); ++i) {
    members.push_back({result.recordings[i].second,
                       std::shared_ptr<const Analysis>(result.parts, &result.parts->sweep.recordings[i])});
  }
  return members;
}

}  // namespace

void add_results(py::module_& module) {
  py::class_<AnalysedRecording>(module, "Analysis", "One recording, analysed, with or without a fit.")
      .def_property_readonly("recording", [](const AnalysedRecording& r) { return r.recording; })
      .def(
          "json",
          [](const AnalysedRecording& r, const std::string& id) {
            return to_json(*r.recording, *r.analysis, layout_of(id));
          },
          py::arg("id") = "")
      .def("text", [](const AnalysedRecording& r) { return to_text(*r.recording, *r.analysis); })
      .def("cycles_csv", [](const AnalysedRecording& r) { return cycles_to_csv(*r.recording, *r.analysis); })
      .def("fitted", fitted_of)
      .def("charts", py::overload_cast<const AnalysedRecording&, const std::string&>(charts_of), py::arg("which"))
      .def("page", py::overload_cast<const AnalysedRecording&, const std::string&>(page_of), py::arg("command"));
  py::class_<AnalysedSweep>(module, "Sweep", "Several recordings, each analysed, and what holds for all.")
      .def(
          "json",
          [](const AnalysedSweep& r, const std::string& id) {
            return to_json(r.parts->entries, r.parts->sweep, layout_of(id));
          },
          py::arg("id"))
      .def(
          "text",
          [](const AnalysedSweep& r, const std::string& id) { return to_text(r.parts->entries, r.parts->sweep, id); },
          py::arg("id"))
      .def_property_readonly("members", members_of)
      .def("charts", py::overload_cast<const AnalysedSweep&, const std::string&>(charts_of), py::arg("which"))
      .def("page", py::overload_cast<const AnalysedSweep&, const std::string&, const std::string&>(page_of),
           py::arg("id"), py::arg("command"));
  module.def("analyze", analyse, py::arg("recording"));
  module.def("fit", fit, py::arg("recording"), py::arg("tier"), py::arg("fixed"));
  module.def("analyze_sweep", analyse_sweep, py::arg("recordings"));
  module.def("fit_sweep", fit_sweep, py::arg("recordings"), py::arg("tier"), py::arg("fixed"));
}

}  // namespace slipfit::python
