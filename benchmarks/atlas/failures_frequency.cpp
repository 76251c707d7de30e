#include <algorithm>
#include <cmath>

#include "failure_plane.hpp"
#include "frequency_methods.hpp"
#include "scenes.hpp"

namespace atlas {
namespace {

constexpr double kGross = 0.05;      // relative error that counts as wrong, if it is outside the method's interval too
constexpr double kTolerated = 0.11;  // share of wrong trials below which a cell is called right

/// Close to 1/5 ... 1/2 or 2 ... 5 times the truth, or the mains' 50 Hz.
bool is_multiple(double ratio, double frequency_Hz) {
  const double whole = ratio > 1.0 ? ratio : 1.0 / ratio;
  const bool octave =
      std::round(whole) >= 2.0 && std::round(whole) <= 5.0 && std::abs(whole / std::round(whole) - 1.0) < 0.02;
  return octave || std::abs(frequency_Hz / 50.0 - 1.0) < 0.01;
}

Mark judge(const FrequencyMethod& method, const Factors& factors, std::size_t trials) {
  std::size_t none = 0, wrong = 0, multiple = 0;
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
    ++(is_multiple(*found.value / truth_Hz, *found.value) ? multiple : wrong);
  }
  if (static_cast<double>(wrong + multiple) > kTolerated * static_cast<double>(trials)) {
    return multiple > wrong ? Mark::Multiple : Mark::Wrong;
  }
  return 2 * none > trials ? Mark::Silent : Mark::Fine;
}

chart::Chart over(const std::string& title, const Plane& plane, double Factors::*x, double Factors::*y,
                  std::size_t trials) {
  chart::Chart chart{title, explain_marks({Mark::Silent, Mark::Wrong, Mark::Multiple}), {}};
  chart.remarks.emplace_back("wrong: in more than a tenth of the trials off by more than 5 % and outside its interval");
  for (const FrequencyMethod& method : frequency_methods()) {
    if (method.look.name == "FFT peak") continue;  // as the interpolated one
    chart.panels.push_back(draw_plane(plane, method.look.name, [&](double at_x, double at_y) {
      Factors factors;
      factors.*x = at_x;
      factors.*y = at_y;
      return judge(method, factors, trials);
    }));
  }
  return chart;
}

}  // namespace

std::vector<File> map_frequency_failures(Effort effort) {
  const bool full = effort == Effort::Full;
  const std::size_t trials = full ? 14 : 5;
  const PlaneAxis noise{"noise, rms over the friction drop  [-]", log_spaced(0.02, 4.0, full ? 13 : 6)};
  const PlaneAxis hum{"amplitude of the 50 Hz hum over the drop  [-]", log_spaced(0.02, 4.0, full ? 13 : 6)};
  const PlaneAxis jitter{"scatter of F_s over the drop  [-]", log_spaced(0.003, 0.3, full ? 7 : 4)};
  const PlaneAxis cycles{"cycles  [-]", log_spaced(4.0, 100.0, full ? 8 : 4)};
  return {
      {"failures_frequency_noise.svg",
       to_svg(over("Where frequency methods fail: noise and few cycles", {noise, cycles, 170.0, {}}, &Factors::noise,
                   &Factors::cycles, trials))},
      {"failures_frequency_hum.svg", to_svg(over("Where frequency methods fail: hum and scatter",
                                                 {hum, jitter, 170.0, {}}, &Factors::hum, &Factors::jitter, trials))}};
}

}  // namespace atlas
