#include "recordings.hpp"

#include <optional>
#include <tuple>

#include "slipfit/io/recording_reader.hpp"
#include "slipfit/surface/comparison.hpp"

namespace slipfit::python {

Result<ManifestEntry> entry_of(const Cells& cells) {
  std::vector<NamedCell> named;
  named.reserve(cells.size());
  for (const auto& [column, text] : cells) named.push_back({column, text});
  auto entry = entry_from_cells(named);
  if (!entry) return entry;
  ManifestEntry known = std::move(entry).value();
  auto conditions = with_worn_track(known.conditions, known.surface);
  if (!conditions) return conditions.error();
  known.conditions = std::move(conditions).value();
  return known;
}

namespace {

using NamedRecordings = std::vector<std::pair<std::string, SharedRecording>>;

NamedRecordings shared(std::vector<NamedRecording> recordings) {
  NamedRecordings result;
  for (NamedRecording& one : recordings) {
    result.emplace_back(one.id, std::make_shared<Recording>(std::move(one.recording)));
  }
  return result;
}

/// The same recording with another name of its file.
Result<Recording> renamed(const Recording& recording, const std::string& name) {
  Provenance provenance = recording.provenance();
  provenance.file = name;
  const auto copy = [](std::span<const double> values) { return std::vector<double>(values.begin(), values.end()); };
  return Recording::create(copy(recording.time_s()), copy(recording.force()), recording.conditions(),
                           std::move(provenance), copy(recording.normal_force_N()));
}

/// `name`: of the file in results and messages; it is a copy where they differ.
NamedRecordings read_file(const std::string& file, const Cells& cells, const std::string& name) {
  auto read = without_gil([&]() -> Result<std::vector<NamedRecording>> {
    const auto entry = entry_of(cells);
    if (!entry) return entry.error();
    auto pieces = read_pieces(file, entry.value().conditions, entry.value().options);
    if (!pieces || name == file) return pieces;
    std::vector<NamedRecording> named;
    for (const NamedRecording& one : pieces.value()) {
      auto recording = renamed(one.recording, name);
      if (!recording) return recording.error();
      named.push_back({one.id, std::move(recording).value()});
    }
    return named;
  });
  return shared(value_or_raise(std::move(read)));
}

std::vector<double> vector_of(const Numbers& numbers) {
  return {numbers.data(), numbers.data() + numbers.size()};
}

NamedRecordings take_arrays(const std::string& name, const std::optional<Numbers>& time, const Numbers& force,
                            const Cells& cells) {
  Samples samples{name, time ? vector_of(*time) : std::vector<double>(), vector_of(force)};
  auto read = without_gil([&]() -> Result<std::vector<NamedRecording>> {
    const auto entry = entry_of(cells);
    if (!entry) return entry.error();
    return read_samples(std::move(samples), entry.value().conditions, entry.value().options);
  });
  return shared(value_or_raise(std::move(read)));
}

/// The samples as the recording holds them, which nobody may change.
py::array_t<double> view_of(std::span<const double> values, const py::object& owner) {
  py::array_t<double> view(static_cast<py::ssize_t>(values.size()), values.data(), owner);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

using Pairs = std::vector<std::pair<std::string, std::string>>;

Pairs pairs_of(const Warnings& warnings) {
  Pairs pairs;
  for (const Warning& warning : warnings) pairs.emplace_back(warning.code, warning.message);
  return pairs;
}

using EstimateState =
    std::tuple<std::optional<double>, std::optional<double>, std::optional<std::pair<double, double>>, std::string>;
using InputState = std::tuple<std::string, std::uint64_t, std::uint64_t, std::uint64_t>;
using TrackState =
    std::tuple<std::string, EstimateState, double, std::vector<double>, std::vector<double>, std::vector<InputState>>;

std::optional<TrackState> state_of(const std::shared_ptr<const WornTrack>& track) {
  if (!track) return std::nullopt;
  const Estimate& spacing = track->spacing_m;
  const auto interval = spacing.ci95 ? std::optional(std::pair(spacing.ci95->low, spacing.ci95->high)) : std::nullopt;
  std::vector<InputState> inputs;
  for (const InputFile& one : track->inputs) inputs.emplace_back(one.file, one.digest.high, one.digest.low, one.bytes);
  return TrackState{track->file,           {spacing.value, spacing.standard_error, interval, spacing.note},
                    track->pitch_m,        track->height,
                    track->ridge_places_m, inputs};
}

std::shared_ptr<const WornTrack> track_from(const std::optional<TrackState>& state) {
  if (!state) return nullptr;
  const auto& [file, spacing, pitch_m, height, places_m, files] = *state;
  const auto& [value, error, ends, note] = spacing;
  const auto interval = ends ? std::optional(Interval{ends->first, ends->second}) : std::nullopt;
  WornTrack track{file, {value, error, interval, note}, pitch_m, height, places_m};
  for (const auto& [name, high, low, bytes] : files) track.inputs.push_back({name, Digest{high, low}, bytes});
  return std::make_shared<const WornTrack>(std::move(track));
}

// Plain values, so that a pickle needs nothing but Python's own types and numpy.
using ConditionNumbers = std::vector<std::optional<double>>;

ConditionNumbers numbers_of(const Conditions& c) {
  return {c.speed_m_per_s,
          c.speed_standard_error_m_per_s,
          c.normal_force_N,
          c.zero_force_N,
          c.sensor_bandwidth_Hz,
          c.sensor_average_s,
          c.sensor_resonance_Hz,
          c.drive_period_s,
          c.mass_kg,
          c.measured_spacing_m,
          c.measured_spacing_se_m,
          c.mass_standard_error_kg,
          c.drive_path_m,
          static_cast<double>(c.sensor_filter_order)};
}

Conditions conditions_from(const ConditionNumbers& n) {
  Conditions c;
  c.speed_m_per_s = n.at(0).value_or(0.0);
  c.speed_standard_error_m_per_s = n.at(1);
  c.normal_force_N = n.at(2);
  c.zero_force_N = n.at(3);
  c.sensor_bandwidth_Hz = n.at(4);
  c.sensor_average_s = n.at(5);
  c.sensor_resonance_Hz = n.at(6);
  c.drive_period_s = n.at(7);
  c.mass_kg = n.at(8);
  c.measured_spacing_m = n.at(9);
  c.measured_spacing_se_m = n.at(10);
  c.mass_standard_error_kg = n.at(11);
  c.drive_path_m = n.at(12);
  c.sensor_filter_order = static_cast<std::size_t>(n.at(13).value());
  return c;
}

py::tuple state_of(const Recording& recording) {
  const Conditions& c = recording.conditions();
  const Provenance& p = recording.provenance();
  const std::vector<double> time(recording.time_s().begin(), recording.time_s().end());
  const std::vector<double> force(recording.force().begin(), recording.force().end());
  const std::vector<double> load(recording.normal_force_N().begin(), recording.normal_force_N().end());
  const auto digest =
      p.input_digest ? std::optional(std::pair(p.input_digest->high, p.input_digest->low)) : std::nullopt;
  return py::make_tuple(
      array_of(time), array_of(force), numbers_of(c), static_cast<int>(c.force_view), static_cast<int>(c.quantity),
      state_of(c.worn_track), c.speed_unit,
      std::vector<std::string>{c.labels.group, c.labels.sample, c.labels.material, c.labels.operator_name}, p.file,
      digest, p.input_bytes, p.assumed, pairs_of(p.warnings),
      std::vector<std::size_t>{p.rows_without_number, p.rows_backward_in_time, p.rows_repeating_time}, p.window_given,
      static_cast<int>(c.drift), array_of(load),
      p.moved_m_per_s ? std::optional(std::pair(p.moved_m_per_s->value, p.moved_m_per_s->standard_error))
                      : std::nullopt,
      p.is_time_unit_assumed, p.options);
}

Provenance provenance_from(const py::tuple& state) {
  Provenance p;
  p.file = state[8].cast<std::string>();
  const auto digest = state[9].cast<std::optional<std::pair<std::uint64_t, std::uint64_t>>>();
  if (digest) p.input_digest = Digest{digest->first, digest->second};
  p.input_bytes = state[10].cast<std::optional<std::uint64_t>>();
  p.assumed = state[11].cast<std::vector<std::string>>();
  for (const auto& [code, message] : state[12].cast<Pairs>()) p.warnings.push_back({code, message});
  const auto counts = state[13].cast<std::vector<std::size_t>>();
  p.rows_without_number = counts.at(0);
  p.rows_backward_in_time = counts.at(1);
  p.rows_repeating_time = counts.at(2);
  p.window_given = state[14].cast<bool>();
  p.is_time_unit_assumed = state[18].cast<bool>();
  p.options = state[19].cast<Pairs>();
  using Moved = std::pair<std::optional<double>, std::optional<double>>;
  const auto moved = state[17].cast<std::optional<Moved>>();
  if (moved) p.moved_m_per_s = Estimate{moved->first, moved->second, std::nullopt, {}};
  return p;
}

SharedRecording recording_from(const py::tuple& state) {
  Conditions c = conditions_from(state[2].cast<ConditionNumbers>());
  c.force_view = static_cast<ForceView>(state[3].cast<int>());
  c.quantity = static_cast<ForceQuantity>(state[4].cast<int>());
  c.drift = static_cast<LevelReading>(state[15].cast<int>());
  c.worn_track = track_from(state[5].cast<std::optional<TrackState>>());
  c.speed_unit = state[6].cast<std::string>();
  const auto labels = state[7].cast<std::vector<std::string>>();
  c.labels = {labels.at(0), labels.at(1), labels.at(2), labels.at(3)};
  return std::make_shared<Recording>(
      value_or_raise(Recording::create(vector_of(state[0].cast<Numbers>()), vector_of(state[1].cast<Numbers>()),
                                       std::move(c), provenance_from(state), vector_of(state[16].cast<Numbers>()))));
}

}  // namespace

void add_recordings(py::module_& module) {
  const auto owner_view = [](const py::object& self, auto member) {
    return view_of((self.cast<const Recording&>().*member)(), self);
  };
  py::class_<Recording, SharedRecording>(module, "Recording", "Samples, and how they were made.")
      .def_property_readonly("time_s", [owner_view](const py::object& r) { return owner_view(r, &Recording::time_s); })
      .def_property_readonly("force", [owner_view](const py::object& r) { return owner_view(r, &Recording::force); })
      .def_property_readonly("file", [](const Recording& r) { return r.provenance().file; })
      .def_property_readonly("assumed", [](const Recording& r) { return r.provenance().assumed; })
      .def_property_readonly("warnings", [](const Recording& r) { return pairs_of(r.provenance().warnings); })
      .def_property_readonly("speed_m_per_s", [](const Recording& r) { return r.conditions().speed_m_per_s; })
      .def_property_readonly("normal_force_N", [](const Recording& r) { return r.conditions().normal_force_N; })
      .def_property_readonly(
          "is_coefficient",
          [](const Recording& r) { return r.conditions().quantity == ForceQuantity::FrictionCoefficient; })
      .def_property_readonly("group", [](const Recording& r) { return r.conditions().labels.group; })
      .def_property_readonly("sample_interval_s", &Recording::sample_interval_s)
      .def("__len__", &Recording::size)
      .def(py::pickle([](const Recording& r) { return state_of(r); },
                      [](const py::tuple& state) { return recording_from(state); }));
  module.def("read_file", read_file, py::arg("file"), py::arg("cells"), py::arg("name"));
  module.def("take_arrays", take_arrays, py::arg("name"), py::arg("time"), py::arg("force"), py::arg("cells"));
}

}  // namespace slipfit::python
