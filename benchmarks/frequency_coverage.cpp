// How often the 95 % interval of the quoted frequency holds the truth, and how large its error is beside those of the
// two methods that it chooses from. docs/validation.md quotes what it prints.
//   frequency_coverage [RECORDINGS [SEED]]

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "analysis/conclusions.hpp"
#include "fit/inference/intervals.hpp"
#include "scenes.hpp"
#include "slipfit/pipeline.hpp"

namespace {

using atlas::Factors;
using slipfit::Estimate;

/// Errors and coverage of one method over the recordings of a scene.
struct Tally {
  std::vector<double> errors;  // relative
  std::size_t held = 0;

  void add(const Estimate& estimate, double truth_Hz) {
    if (!estimate.value || !estimate.ci95) return;
    errors.push_back(std::abs(*estimate.value / truth_Hz - 1.0));
    if (estimate.ci95->low <= truth_Hz && truth_Hz <= estimate.ci95->high) ++held;
  }
  [[nodiscard]] std::string text() const {
    if (errors.empty()) return ",";
    std::vector<double> sorted = errors;
    const auto place = static_cast<std::size_t>(0.68 * static_cast<double>(sorted.size()));
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(place), sorted.end());
    return fmt::format("{:.3g},{:.1f}", sorted[place],
                       100.0 * static_cast<double>(held) / static_cast<double>(errors.size()));
  }
};

Estimate of_spectrum(const slipfit::SpectralFrequency& spectral, double degrees_of_freedom) {
  if (!spectral.value_Hz || !spectral.standard_error_Hz) return {};
  return slipfit::symmetric(*spectral.value_Hz, *spectral.standard_error_Hz, std::max(1.0, degrees_of_freedom));
}

void study(const std::string& name, const Factors& factors, std::size_t recordings, std::uint64_t seed) {
  Tally quoted, fitted, spectral;
  std::size_t by_spectrum = 0;
  for (std::size_t i = 0; i < recordings; ++i) {
    const atlas::Scene scene = atlas::make_scene(factors, seed + i);
    const slipfit::Analysis analysis = slipfit::analyze_and_fit(scene.recording);
    const double truth_Hz = 1.0 / scene.cycle.period_s;
    quoted.add(analysis.frequency.quoted, truth_Hz);
    if (analysis.frequency.method == slipfit::FrequencyMethod::HarmonicLeastSquares) ++by_spectrum;
    spectral.add(of_spectrum(analysis.frequency.spectral, static_cast<double>(analysis.cycles.count) - 3.0), truth_Hz);
    const auto from_fit = analysis.fit ? slipfit::fitted_frequency(*analysis.fit, scene.recording) : std::nullopt;
    if (from_fit) fitted.add(*from_fit, truth_Hz);
  }
  fmt::print("{},{},{},{},{},{:.0f}\n", name, recordings, quoted.text(), fitted.text(), spectral.text(),
             100.0 * static_cast<double>(by_spectrum) / static_cast<double>(recordings));
}

}  // namespace

int main(int count, char** words) {
  const std::size_t recordings = count > 1 ? std::strtoul(words[1], nullptr, 10) : 400;
  const std::uint64_t seed = count > 2 ? std::strtoul(words[2], nullptr, 10) : 5000;
  fmt::print(
      "# error: 68 % of the recordings have a smaller one, relative; covered: %\n"
      "scene,recordings,quoted_error,quoted_covered,fitted_error,fitted_covered,spectrum_error,spectrum_covered,"
      "quoted_from_spectrum_percent\n");
  const std::vector<atlas::FactorSweep> sweeps{
      {"regular {:g} cycles", &Factors::cycles, {6.0, 10.0, 20.0, 40.0, 100.0, 300.0}},
      {"noise {:g}", &Factors::noise, {0.002, 0.1}},
      {"{:g} samples per slip", &Factors::samples_per_slip, {3.0, 8.0}},
      {"drift {:g}", &Factors::drift, {3.0, 30.0}},
      {"hum {:g}", &Factors::hum, {0.02, 0.1}},
      {"jitter {:g}", &Factors::jitter, {0.0001, 0.0002, 0.0005, 0.001, 0.002, 0.005, 0.02, 0.05, 0.15}}};
  for (const atlas::FactorSweep& sweep : sweeps) {
    for (const double value : sweep.values) {
      study(fmt::format(fmt::runtime(sweep.name), value), sweep.at(value), recordings, seed);
    }
  }
}
