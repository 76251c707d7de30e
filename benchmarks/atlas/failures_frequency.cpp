#include <algorithm>
#include <cmath>

#include "failure_plane.hpp"
#include "frequency_methods.hpp"
#include "scenes.hpp"

namespace atlas {
namespace {

constexpr double kGross = 0.05;      // relative error that counts as wrong, if it is outside the method's interval too
constexpr double kTolerated = 0.11;  // share of wrong trials below which a cell is called right

Mark judge(const FrequencyMethod& method, const Factors& factors, std::size_t trials) {
  std::size_t none = 0, wrong = 0;
  for (std::size_t i = 0; i < trials; ++i) {
    const Scene scene = make_scene(factors, 5000 + i);
    const slipfit::Estimate found = method.find(scene.recording);
    if (!found.value) {
      ++none;
      continue;
    }
    const double truth_Hz = 1.0 / scene.cycle.period_s;
    const bool inside = found.ci95 && found.ci95->low <= truth_Hz && truth_Hz <= found.ci95->high;
    if (inside || std::abs(*found.value / truth_Hz - 1.0) < kGross) continue;
    ++wrong;
  }
  if (static_cast<double>(wrong) > kTolerated * static_cast<double>(trials)) return Mark::Wrong;
  return 2 * none > trials ? Mark::Refused : Mark::Right;
}

std::string over(const Plane& plane, double Factors::*x, double Factors::*y, std::size_t trials) {
  std::string rows;
  for (const FrequencyMethod& method : frequency_methods()) {
    if (method.name == "FFT peak") continue;  // as the interpolated one
    rows +=
        judge_factors(plane, method.name, x, y, [&](const Factors& factors) { return judge(method, factors, trials); });
  }
  return rows;
}

}  // namespace

std::string map_frequency_failures(Effort effort) {
  const bool full = effort == Effort::Full;
  const std::size_t trials = full ? 14 : 5;
  const std::vector<double> strength = log_spaced(0.02, 4.0, full ? 13 : 6);  // over the friction drop
  const std::vector<double> jitter = log_spaced(0.003, 0.3, full ? 7 : 4);
  const std::vector<double> cycles = log_spaced(4.0, 100.0, full ? 8 : 4);
  return over({"frequency_noise", strength, cycles}, &Factors::noise, &Factors::cycles, trials) +
         over({"frequency_hum", strength, jitter}, &Factors::hum, &Factors::jitter, trials);
}

}  // namespace atlas
