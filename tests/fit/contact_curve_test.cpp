#include <cmath>
#include <optional>
#include <vector>

#include "scene.hpp"

using namespace slipfit;

namespace {

Scene contact_scene() {
  return {.noise = 0.01, .view = ForceView::Contact};
}

double noise_N(const Scene& s) {
  return s.noise * (s.static_N - s.kinetic_N);
}

std::vector<CurvePoint> curve_of(const Recording& recording) {
  FitOptions options;
  options.curve = true;
  const Analysis analysis = analyze_and_fit(recording, options);
  REQUIRE(analysis.fit);
  REQUIRE_FALSE(analysis.fit->curve.empty());
  return analysis.fit->curve;
}

double residual_rms_N(const Recording& recording, const std::vector<CurvePoint>& curve) {
  double square = 0.0;
  for (const CurvePoint& point : curve) square += std::pow(recording.force()[point.sample] - point.force, 2);
  return std::sqrt(square / static_cast<double>(curve.size()));
}

}  // namespace

TEST_CASE("the curve of a sensor at the contact: plateaus at F_k, ramps that rise with k V, residuals of the noise") {
  const Scene s = contact_scene();
  const Recording recording = record(s);
  const std::vector<CurvePoint> curve = curve_of(recording);
  REQUIRE(static_cast<double>(curve.size()) > 0.85 * static_cast<double>(recording.size()));
  const double ramp_N = s.stiffness * s.speed * recording.sample_interval_s();
  std::size_t on_plateau = 0;
  std::size_t on_ramp = 0;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const double rise_N = curve[i].force - curve[i - 1].force;
    if (rise_N == 0.0) {
      ++on_plateau;
      CHECK(curve[i].force == Approx(s.kinetic_N).margin(5.0 * noise_N(s) / std::sqrt(s.samples_per_slip)));
    } else if (std::abs(rise_N) < 2.0 * ramp_N) {  // else one of the two jumps
      ++on_ramp;
      CHECK(rise_N == Approx(ramp_N).epsilon(0.01));
    }
  }
  CHECK(static_cast<double>(on_plateau) > 0.8 * s.cycles * s.samples_per_slip);
  CHECK(on_ramp > on_plateau);
  CHECK(residual_rms_N(recording, curve) < 1.1 * noise_N(s));
}

TEST_CASE("the curve of a sensor at the contact drifts with the level and stops where a slip was not understood") {
  Scene s = contact_scene();
  s.drift_over_drop = GENERATE(0.0, 2.0);
  const Recording whole = record(s);
  const std::optional<double> hidden_s = analyze_and_fit(whole).fit->cycles.at(10).onset_s;
  REQUIRE(hidden_s);
  std::vector<double> time_s;
  std::vector<double> force_N;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (std::abs(whole.time_s()[i] - *hidden_s) < 3.0 * whole.sample_interval_s()) continue;
    time_s.push_back(whole.time_s()[i]);
    force_N.push_back(whole.force()[i]);
  }
  const Recording recording = Recording::create(time_s, force_N, whole.conditions()).value();
  const std::vector<CurvePoint> curve = curve_of(recording);
  CHECK(curve.size() < curve_of(whole).size());
  CHECK(static_cast<double>(curve.size()) > 0.7 * static_cast<double>(recording.size()));
  CHECK(residual_rms_N(recording, curve) < 1.1 * noise_N(s));
}
