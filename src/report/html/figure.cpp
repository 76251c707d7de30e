#include "report/html/figure.hpp"

#include <limits>

#include "report/html/scaling.hpp"

namespace slipfit::html {
namespace {

std::vector<double> fitted_force(const Recording& recording, const Analysis& analysis) {
  std::vector<double> fitted(recording.size(), std::numeric_limits<double>::quiet_NaN());
  if (!analysis.fit) return fitted;
  for (const CurvePoint& point : analysis.fit->curve) {
    if (point.sample < fitted.size()) fitted[point.sample] = point.force;
  }
  return fitted;
}

}  // namespace

Source source_of(const Recording& recording, const Analysis& analysis, const Background& background) {
  return {recording, analysis, background, force_unit_of(recording), fitted_force(recording, analysis)};
}

bool shows_cycles(const Analysis& analysis) {
  return analysis.motion != MotionClass::SteadySliding;
}

bool has_fitted_curve(const Analysis& analysis) {
  return shows_cycles(analysis) && analysis.fit && !analysis.fit->curve.empty();
}

std::vector<Figure> figures_of(const Source& source) {
  return {trace_figure(source), spectrum_figure(source), cycles_figure(source), pairs_figure(source),
          map_figure(source),   speed_figure(source),    pattern_figure(source)};
}

}  // namespace slipfit::html
