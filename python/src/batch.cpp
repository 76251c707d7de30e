#include "slipfit/batch/batch.hpp"

#include <optional>

#include "convert.hpp"

namespace slipfit::python {
namespace {

/// What Python hears of a batch. An exception of a callback or of a signal stops the batch and is raised at its end.
class Listener {
 public:
  Listener(py::object progress, py::object notify) : progress_(std::move(progress)), notify_(std::move(notify)) {}

  [[nodiscard]] BatchHooks hooks() {
    BatchHooks hooks;
    hooks.should_stop = [this] {
      const py::gil_scoped_acquire acquire;
      if (!raised_ && PyErr_CheckSignals() != 0) raised_.emplace();
      return raised_.has_value();
    };
    if (!progress_.is_none()) hooks.show_progress = [this](const BatchProgress& progress) { show(progress); };
    if (!notify_.is_none()) {
      hooks.notify = [this](const std::string& message) { guarded([&] { notify_(message); }); };
    }
    return hooks;
  }

  /// Raises what was kept.
  void raise_kept() {
    if (raised_) throw py::error_already_set(std::move(*raised_));
  }

 private:
  template <class Call>
  void guarded(const Call& call) {
    const py::gil_scoped_acquire acquire;
    if (raised_) return;
    try {
      call();
    } catch (py::error_already_set& error) {
      raised_.emplace(std::move(error));
    }
  }

  void show(const BatchProgress& progress) {
    guarded([&] { progress_(progress.total, progress.before, progress.fitted, progress.failed, progress.seconds); });
  }

  py::object progress_;
  py::object notify_;
  std::optional<py::error_already_set> raised_;
};

BatchOptions options_from(const py::dict& asked) {
  BatchOptions options;
  options.manifest = asked["manifest"].cast<std::string>();
  options.folder = asked["out"].cast<std::string>();
  options.fit = value_or_raise(parse_fit_options(asked["tier"].cast<std::string>(),
                                                 asked["fixed"].cast<std::vector<std::string>>(), FitKind::Single));
  options.jobs = asked["jobs"].cast<std::size_t>();
  options.timeout_s = asked["timeout_s"].cast<double>();
  options.resume = asked["resume"].cast<bool>();
  options.shard = {asked["shard"].cast<std::size_t>(), asked["shards"].cast<std::size_t>()};
  const auto report = asked["report"].cast<std::optional<std::string>>();
  if (report) options.report = BatchReport{*report, asked["command"].cast<std::string>()};
  if (asked["joint_groups"].cast<bool>()) options.fit_group = group_fit(options.fit, options.report);
  return options;
}

py::dict counts_of(const BatchProgress& progress) {
  py::dict counts;
  counts["total"] = progress.total;
  counts["before"] = progress.before;
  counts["fitted"] = progress.fitted;
  counts["failed"] = progress.failed;
  counts["seconds"] = progress.seconds;
  return counts;
}

py::dict run(const py::dict& asked, const py::object& progress, const py::object& notify) {
  const BatchOptions options = options_from(asked);
  Listener listener(progress, notify);
  auto outcome = without_gil([&] { return run_batch(options, listener.hooks()); });
  listener.raise_kept();
  const BatchOutcome done = value_or_raise(std::move(outcome));
  return counts_of(done.progress);
}

/// Finished shards into one folder.
py::dict merge(const std::vector<std::string>& shards, const std::string& folder) {
  const BatchProgress progress = value_or_raise(without_gil([&] {
    return merge_batches({shards.begin(), shards.end()}, folder);
  }));
  return counts_of(progress);
}

/// Names and cells of a row of summary.csv, as two lines.
py::tuple row_of(const std::string& document, const std::string& name) {
  return py::make_tuple(summary_columns(), value_or_raise(summary_row(document, name)));
}

}  // namespace

void add_batch(py::module_& module) {
  module.def("merge", merge, py::arg("shards"), py::arg("folder"));
  module.def("summary_row", row_of, py::arg("document"), py::arg("name"));
  module.def("default_jobs", default_jobs);
  module.def("batch", run, py::arg("options"), py::arg("progress"), py::arg("tell"));
}

}  // namespace slipfit::python
