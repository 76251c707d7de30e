#include "slipfit/predict/observed_end.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/unknown.hpp"

namespace slipfit {
namespace {

/// Estimates the end by the runs alone. `why` says why the fit does not determine it.
Estimate by_runs(const ObservedEnd& observed, const std::string& why) {
  const double sticks = *observed.sticks_m_per_s;
  if (!observed.slides_m_per_s) {
    return unknown(
        fmt::format("above {:.4g} m/s, the fastest run, which sticks; the fit gives no upper bound: {}", sticks, why));
  }
  const double slides = *observed.slides_m_per_s;
  return {
      std::sqrt(sticks * slides), std::nullopt, Interval{sticks, slides},
      fmt::format("by the runs: the fastest that sticks and the slowest that does not; the fit does not determine it: "
                  "{}",
                  why)};
}

/// Puts an interval without an upper end into words.
Estimate with_bound_in_words(const Estimate& by_fit) {
  if (by_fit.value || !by_fit.ci95) return by_fit;
  return unknown(fmt::format("above {:.4g} m/s; no upper bound: {}", by_fit.ci95->low, by_fit.note));
}

}  // namespace

Estimate with_observed_end(const Estimate& by_fit, const ObservedEnd& observed) {
  if (!observed.sticks_m_per_s) return with_bound_in_words(by_fit);
  if (!by_fit.value && !by_fit.ci95) return by_runs(observed, by_fit.note);
  if (!by_fit.ci95) return by_fit;
  const double sticks = *observed.sticks_m_per_s;
  const double slides = observed.slides_m_per_s.value_or(HUGE_VAL);
  if (by_fit.ci95->high < sticks) return by_runs(observed, "the fit puts it below a speed at which a run sticks");
  if (by_fit.ci95->low > slides) return by_runs(observed, "the fit puts it above a speed at which a run slides");
  Estimate both = by_fit;
  both.ci95 = Interval{std::max(by_fit.ci95->low, sticks), std::min(by_fit.ci95->high, slides)};
  if (!both.value && std::isfinite(both.ci95->high)) both.value = std::sqrt(both.ci95->low * both.ci95->high);
  if (both.value) both.value = std::clamp(*both.value, both.ci95->low, both.ci95->high);
  return with_bound_in_words(both);
}

}  // namespace slipfit
