#include "report/html/figure.hpp"

#include "report/html/scaling.hpp"
#include "report/quantities.hpp"

namespace slipfit::html {

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
