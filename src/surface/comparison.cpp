#include "slipfit/surface/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"

namespace slipfit {
namespace {

/// A coarse pattern of every second, third, ... slip. A whole number is reported only if its neighbours fit worse.
std::string ratio_verdict(double ratio, double relative_reach) {
  if (std::abs(ratio - 1.0) < thresholds::kSameSpacing) {
    return fmt::format(
        "nearly the same: the spacings differ by {:.2g} %, more than their uncertainties allow; an inaccurate stated "
        "speed is a possible reason (--speed-uncertainty)",
        100.0 * std::abs(ratio - 1.0));
  }
  for (const bool is_coarser : {true, false}) {
    const double times = is_coarser ? ratio : 1.0 / ratio;
    const double whole = std::round(times);
    const double reach = times * relative_reach;
    const bool is_known = reach <= thresholds::kWholeReach && std::abs(times - whole) <= std::max(reach, 1e-9);
    if (!is_known || whole < 2.0) continue;
    return is_coarser ? fmt::format(
                            "the pattern is {:.0f} times as coarse as the slips: several slips make one ridge, or "
                            "every pass leaves its own",
                            whole)
                      : fmt::format("the pattern is {:.0f} times as fine as the slips: each slip leaves several ridges",
                                    whole);
  }
  return "no relation: the spacing of the pattern is neither that of the slips nor a multiple of it";
}

}  // namespace

SpacingComparison compare_spacings(const Estimate& by_force_m, const Estimate& on_surface_m) {
  SpacingComparison compared;
  const bool known = by_force_m.value && by_force_m.ci95 && on_surface_m.value && on_surface_m.ci95;
  if (!known) {
    compared.verdict = !on_surface_m.value ? "the surface shows no spacing" +
                                                 (on_surface_m.note.empty() ? "" : ": " + on_surface_m.note)
                                           : std::string("the force shows no spacing to compare with");
    compared.En.note = compared.ratio.note = compared.verdict;
    return compared;
  }
  const double force_m = *by_force_m.value;
  const double surface_m = *on_surface_m.value;
  const double force_reach_m = reach_towards(by_force_m, surface_m);
  const double surface_reach_m = reach_towards(on_surface_m, force_m);
  const double reach_m = std::hypot(force_reach_m, surface_reach_m);
  if (!(reach_m > 0.0)) {
    compared.verdict = "the spacings have no uncertainty to compare them with";
    compared.En.note = compared.ratio.note = compared.verdict;
    return compared;
  }
  const double relative_reach = std::hypot(force_reach_m / force_m, surface_reach_m / surface_m);
  const double ratio = surface_m / force_m;
  const double factor = std::exp(relative_reach);
  compared.En = {(surface_m - force_m) / reach_m, std::nullopt, std::nullopt, {}};
  compared.ratio = {ratio, ratio * relative_reach / kNormalQuantile, Interval{ratio / factor, ratio * factor}, {}};
  if (std::abs(*compared.En.value) > 1.0) {
    compared.verdict = ratio_verdict(ratio, relative_reach);
  } else {
    compared.verdict =
        fmt::format("agrees: pattern and slips have the same spacing within {:.2g} %", 100.0 * relative_reach);
  }
  return compared;
}

WornTrack worn_track_of(const Profile& profile, const Surface& surface) {
  return {profile.file, surface.spacing_m, profile.pitch_m, profile.height, surface.ridge_places_m, profile.inputs};
}

Result<Conditions> with_worn_track(Conditions conditions, const std::filesystem::path& file) {
  if (file.empty()) return conditions;
  const auto profile = read_profile(file);
  if (!profile) return profile.error();
  const auto surface = measure_surface(profile.value());
  if (!surface) return surface.error();
  conditions.worn_track = std::make_shared<const WornTrack>(worn_track_of(profile.value(), surface.value()));
  return conditions;
}

}  // namespace slipfit
