// Every document of every recording, the degenerate ones too: numbers in their ranges, values in their intervals,
// sentences without infinities, pages and pictures that end.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "document_rules.hpp"
#include "run_program.hpp"
#include "scenes.hpp"
#include "slipfit/io/recording_reader.hpp"
#include "slipfit/predict/prediction.hpp"
#include "slipfit/report/csv.hpp"
#include "slipfit/report/html.hpp"
#include "slipfit/report/json.hpp"
#include "slipfit/report/prediction.hpp"
#include "slipfit/report/sweep.hpp"
#include "slipfit/report/sweep_html.hpp"
#include "slipfit/report/text.hpp"

using namespace slipfit;
using test::Scene;

namespace {

/// Whole periods of 100 samples at 1 kHz; the same in each.
Scene periodic(const std::string& described, std::size_t samples, const std::function<double(double)>& force_of_phase) {
  Scene scene{described, {}, {}, {}};
  for (std::size_t i = 0; i < samples; ++i) {
    scene.time_s.push_back(0.001 * static_cast<double>(i));
    scene.force_N.push_back(force_of_phase(static_cast<double>(i % 100) / 100.0));
  }
  scene.conditions.speed_m_per_s = 0.01;
  scene.conditions.zero_force_N = 0.0;
  return scene;
}

double sawtooth(double phase) {
  return 1.0 + (phase < 0.9 ? phase : 9.0 * (1.0 - phase));
}

Scene changed(Scene scene, const std::string& described, double force_factor, double force_offset,
              double time_factor = 1.0, double time_offset_s = 0.0) {
  scene.described = described;
  for (double& force : scene.force_N) force = force_factor * force + force_offset;
  for (double& time : scene.time_s) time = time_factor * time + time_offset_s;
  return scene;
}

Scene at_speed(Scene scene, double speed_m_per_s) {
  scene.described += fmt::format(" at {} m/s", speed_m_per_s);
  scene.conditions.speed_m_per_s = speed_m_per_s;
  return scene;
}

/// Forces in steps of a sensor of few bits.
Scene rounded(Scene scene, double step_N) {
  scene.described += fmt::format(", rounded to {} N", step_N);
  for (double& force : scene.force_N) force = step_N * std::round(force / step_N);
  return scene;
}

/// Slips that are large and small by turns, of whole samples: no scatter is left to estimate.
Scene alternating() {
  Scene scene = periodic("large and small by turns", 4000, sawtooth);
  for (std::size_t i = 0; i < scene.force_N.size(); ++i) {
    if (i / 100 % 2 == 1) scene.force_N[i] = 1.0 + 0.7 * (scene.force_N[i] - 1.0);
  }
  return scene;
}

/// One recording, far from what sensors and machines do.
std::vector<Scene> extremes_of(const Scene& scene) {
  Scene coefficient = scene;
  coefficient.described += ", friction coefficient";
  coefficient.conditions.quantity = ForceQuantity::FrictionCoefficient;
  Scene contact = scene;
  contact.described += ", contact";
  contact.conditions.force_view = ForceView::Contact;
  Scene stated = scene;
  stated.described += ", mass, resonance, load, bandwidth and spacing stated";
  stated.conditions.mass_kg = 1e-3;
  stated.conditions.sensor_resonance_Hz = 100.0;
  stated.conditions.sensor_bandwidth_Hz = 50.0;
  stated.conditions.normal_force_N = 5.0;
  stated.conditions.measured_spacing_m = 1e-3;
  stated.conditions.speed_standard_error_m_per_s = 0.02 * stated.conditions.speed_m_per_s;
  const std::string name = scene.described;
  return {scene,
          coefficient,
          contact,
          stated,
          rounded(scene, 0.25),
          changed(scene, name + ", time offset of 1e15 s", 1.0, 0.0, 1000.0, 1e15),
          changed(scene, name + ", force offset of 1e16 N", 1.0, 1e16),
          changed(scene, name + ", subnormal forces", 1e-310, 0.0),
          changed(scene, name + ", tiny forces", 1e-200, 0.0),
          changed(scene, name + ", small forces", 1e-33, 0.0),
          changed(scene, name + ", huge forces", 1e30, 0.0),
          changed(scene, name + ", nanoseconds", 1.0, 0.0, 1e-9),
          changed(scene, name + ", steps of 1e-30 s", 1.0, 0.0, 1e-27),
          changed(scene, name + ", ages", 1.0, 0.0, 1e30),
          at_speed(scene, 1e-300),
          at_speed(scene, 1e300)};
}

std::vector<Scene> degenerate_scenes() {
  std::vector<Scene> scenes{
      periodic("two samples", 2, sawtooth),
      periodic("three samples", 3, sawtooth),
      periodic("constant", 2000, [](double) { return 0.3; }),
      periodic("zero", 2000, [](double) { return 0.0; }),
      periodic("the last digit", 2000, [](double p) { return p < 0.5 ? 0.3 : 0.1 + 0.2; }),
      periodic("two levels", 2000, [](double p) { return p < 0.9 ? 1.0 : 0.0; }),
      periodic("sine", 2000, [](double p) { return 1.0 + std::sin(2.0 * M_PI * p); }),
      periodic("triangle", 2000, [](double p) { return std::abs(p - 0.5); }),
      periodic("a damped swing in each", 4000,
               [](double p) { return 1.0 + p + std::exp(-20.0 * p) * std::cos(60.0 * p); }),
      periodic("few cycles", 350, sawtooth),
      alternating(),
      rounded(alternating(), 0.1),
  };
  for (const Scene& scene : {periodic("saw-tooth", 2000, sawtooth), alternating(), test::random_scene(941)}) {
    for (Scene& extreme : extremes_of(scene)) scenes.push_back(std::move(extreme));
  }
  return scenes;
}

/// Few cycles of large scatter: wide intervals.
Scene short_scene(std::uint64_t seed) {
  Scene scene = test::random_scene(seed);
  const std::size_t count = scene.time_s.size() / (4 + seed % 7);
  scene.time_s.resize(count);
  scene.force_N.resize(count);
  for (std::size_t i = 0; i < count; ++i) scene.force_N[i] += 0.05 * std::sin(0.37 * static_cast<double>(i * i % 1009));
  return scene;
}

/// Documents for the schemas, validated together.
class Schemas {
 public:
  void add_fit(const std::string& json) { add(fits_, json); }
  void add_prediction(const std::string& json) { add(predictions_, json); }

  void check() {
    check("docs/fit.schema.json", fits_);
    check("docs/predict.schema.json", predictions_);
  }

 private:
  void add(std::vector<std::string>& files, const std::string& json) {
    files.push_back(folder_.file(fmt::format("{}.json", fits_.size() + predictions_.size()), json));
  }
  static void check(const std::string& schema, const std::vector<std::string>& files) {
    if (files.empty()) return;
    const auto project = std::filesystem::path(SLIPFIT_TESTDATA_DIR).parent_path();
    std::vector<std::string> arguments{(project / "tests/cli/validate_schema.py").string(),
                                       (project / schema).string()};
    arguments.insert(arguments.end(), files.begin(), files.end());
    const test::ProgramResult result = test::run_program("/usr/bin/python3", arguments);
    CAPTURE(result.out, result.err);
    if (result.exit_code == 77) {
      WARN("skipped: python3-jsonschema is not installed");
      return;
    }
    CHECK(result.exit_code == 0);
  }

  test::TemporaryFolder folder_;
  std::vector<std::string> fits_;
  std::vector<std::string> predictions_;
};

void check_document(const std::string& text) {
  const auto document = nlohmann::json::parse(text, nullptr, false);
  REQUIRE(document.is_object());
  for (const std::string& breach : test::breaches_of(document)) {
    CAPTURE(breach);
    CHECK(breach.empty());
  }
}

void check_words(const std::string& what, const std::string& text) {
  CAPTURE(what);
  CHECK_FALSE(test::says_not_a_number(text));
}

void check_predictions(const Analysis& analysis, Schemas& schemas) {
  if (!analysis.fit || !analysis.fit->estimate) return;
  const PredictionModel model{*analysis.fit->estimate, true, std::nullopt};
  const std::vector<double> speeds{1e-300, 1e-9, 1e-3, 1e-2, 1.0, 1e9, 1e300};
  const Prediction prediction = predict_at(model, speeds);
  const std::string json = to_json(prediction, PredictionSource{"scene", {}});
  schemas.add_prediction(json);
  check_document(json);
  check_words("prediction", to_text(prediction, PredictionSource{"scene", {}}));
  check_words("prediction table", prediction_to_csv(prediction));
}

void check_all(const Recording& recording, const Analysis& analysis, Schemas& schemas) {
  const std::string json = to_json(recording, analysis);
  schemas.add_fit(json);
  check_document(json);
  check_words("text", to_text(recording, analysis));
  check_words("cycles", cycles_to_csv(recording, analysis));
  check_words("curve", curve_to_csv(recording, analysis));
  const Background background = gather_background(recording, analysis);
  const std::string page = to_html(recording, analysis, background, {});
  check_words("page", test::without_scripts(page));
  CHECK(page.size() < 2'000'000 + 12 * recording.size());
  for (const PictureFile& picture : report_pictures(recording, analysis, background)) {
    check_words(picture.name, picture.content);
  }
  check_predictions(analysis, schemas);
}

void check_recording(const Recording& recording, Schemas& schemas) {
  FitOptions options;
  options.curve = true;
  check_all(recording, analyze_and_fit(recording, options), schemas);
  check_all(recording, analyze(recording), schemas);
}

void check_scene(const Scene& scene, Schemas& schemas) {
  CAPTURE(scene.described);
  const auto recording = Recording::create(scene.time_s, scene.force_N, scene.conditions);
  if (recording) {
    check_recording(recording.value(), schemas);
  } else {
    CHECK_FALSE(recording.error().message.empty());
  }
}

}  // namespace

TEST_CASE("documents of degenerate recordings keep their promises") {
  Schemas schemas;
  for (const Scene& scene : degenerate_scenes()) check_scene(scene, schemas);
  schemas.check();
}

TEST_CASE("documents of random recordings, whole and short, keep their promises") {
  Schemas schemas;
  for (std::uint64_t seed = 901; seed <= 920; ++seed) {
    check_scene(test::random_scene(seed), schemas);
    check_scene(short_scene(seed), schemas);
  }
  schemas.check();
}

TEST_CASE("documents of every recording at hand keep their promises") {
  Schemas schemas;
  Conditions conditions;
  conditions.speed_m_per_s = 0.01;
  conditions.zero_force_N = 0.0;
  std::size_t read = 0;
  for (const char* const folder : {SLIPFIT_TESTDATA_DIR, SLIPFIT_SHARED_DIR "/data"}) {
    if (!std::filesystem::exists(folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (!entry.is_regular_file() || entry.file_size() > 2'000'000) continue;
      const auto recording = read_recording(entry.path(), conditions);
      if (!recording) continue;
      CAPTURE(entry.path().string());
      check_recording(recording.value(), schemas);
      ++read;
    }
  }
  CHECK(read >= 8);
  schemas.check();
}

TEST_CASE("documents of sweeps keep their promises, with members that show nothing") {
  Schemas schemas;
  for (const std::uint64_t seed : {std::uint64_t{931}, std::uint64_t{932}}) {
    std::vector<SweepEntry> entries;
    const Scene scene = test::random_scene(seed);
    std::vector<Scene> members{scene, at_speed(scene, 0.5 * scene.conditions.speed_m_per_s), short_scene(seed)};
    members.push_back(periodic("constant", 500, [](double) { return 0.3; }));
    members.push_back(at_speed(periodic("saw-tooth", 2000, sawtooth), 1e-3));
    for (const Scene& member : members) {
      entries.push_back(
          {member.described, Recording::create(member.time_s, member.force_N, member.conditions).value()});
    }
    CAPTURE(scene.described);
    const SweepAnalysis sweep = analyze_sweep(entries);
    CHECK(sweep.fit.has_value());
    const std::string json = to_json(entries, sweep, {});
    schemas.add_fit(json);
    check_document(json);
    check_words("text", to_text(entries, sweep, "scene"));
    const auto prediction = predict_around(entries, sweep);
    check_words("page", test::without_scripts(to_html(entries, sweep, prediction, {})));
  }
  schemas.check();
}

TEST_CASE("documents of predictions at every speed that is a number keep their promises") {
  Schemas schemas;
  const std::vector<double> speeds{5e-324, 1e-300, 1e-100, 1e-3, 1.0, 1e100, 1e300, std::numeric_limits<double>::max()};
  for (const double zeta : {0.0, 1e-12, 0.05, 0.999999, 1.0, 3.0}) {
    const Slider slider = Slider::create(1000.0, 100.0, zeta).value();
    for (const double kinetic_N : {0.0, 1.0, 1.9999999}) {
      CAPTURE(zeta, kinetic_N);
      const Prediction prediction = predict_at(stated_model(slider, Friction::create(2.0, kinetic_N).value()), speeds);
      const std::string json = to_json(prediction, PredictionSource{"stated", {}});
      schemas.add_prediction(json);
      check_document(json);
      check_words("prediction", to_text(prediction, PredictionSource{"stated", {}}));
    }
  }
  schemas.check();
}
