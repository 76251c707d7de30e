#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scenes.hpp"
#include "slipfit/core/estimate.hpp"
#include "study.hpp"

namespace atlas {

enum FitParameter : std::size_t { kStiffnessOf, kFrequencyOf, kDampingOf, kDropOf, kFitParameters };
inline constexpr std::array<const char*, kFitParameters> kFitParameterNames{"k", "w_n", "zeta", "F_s-F_k"};

struct FitAnswer {
  std::array<slipfit::Estimate, kFitParameters> estimates;  ///< no value: the method has none to give
  std::array<bool, kFitParameters> sure{};                  ///< claims to know it ("identified")
};

/// A way to get parameters from a recording of these factors. It makes what it needs from the seed and says how long
/// the fit itself took.
struct TimedFit {
  FitAnswer answer;
  double time_s = 0.0;
};
struct FitMethod {
  std::string name;
  std::function<TimedFit(const Factors&, std::uint64_t seed)> run;
};

std::vector<FitMethod> fit_methods();
/// slipfit's fit of Coulomb friction without an average of the sensor, where the two are not asked for.
FitMethod fit_without_terms();

/// Whether the method calls the parameter known and is off by more than 4 standard errors and 2 %.
bool is_confidently_wrong(const FitAnswer& answer, std::size_t parameter, double truth);

std::array<double, kFitParameters> truth_of(const Scene& scene);

/// Least squares of all samples at once, by Levenberg-Marquardt with exact derivatives: k, w_n, zeta, F_s - F_k, F_k
/// and the time of the first onset. Starts off by `start_error` (relative, signs by the seed), the time true.
FitAnswer fit_whole_trace(const Scene& scene, double start_error, std::uint64_t seed);

/// Medians over the detected slips: slopes of the ramps, drops, times of fall. No damping.
FitAnswer fit_features(const Scene& scene);

/// Standard errors that white noise alone leaves, at the truth, to the parameters of `fit_whole_trace`.
std::array<double, kFitParameters> whole_trace_bound(const Scene& scene);

}  // namespace atlas
