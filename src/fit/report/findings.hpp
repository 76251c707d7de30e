#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fit/inference/sliding_model.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/result.hpp"

namespace slipfit::fit {

/// The condition on a speed without a standard error, and which parameters depend on it.
inline constexpr const char* kStatedSpeed =
    "the stated driving speed (k, m and c are in inverse proportion to it; --speed-uncertainty widens their intervals)";

/// Why w_n is not identified where averaging over a step of the clock would change it by so much of itself.
std::string averaging_doubt(double change);

/// What the numbers of one recording take for granted.
std::vector<std::string> conditions_of(const Recording& recording);

/// What is known of friction that depends on the speed; of a sweep only.
struct LawFindings {
  bool depends_on_speed = false;
  std::string reason;                                ///< why it does, or not
  bool ages = false;                                 ///< static friction grows with the stick time
  std::optional<double> reference_normal_force_N{};  ///< known for all recordings
  bool at_one_speed = false;                         ///< then no more is told of it than by one recording
};

/// All that the parameters of a fit are made from, of one recording or a sweep.
struct Findings {
  Coordinates values;  ///< zeta >= 0
  Units units;
  Intervals intervals;
  Estimate damping;                            ///< zeta; without value where it cannot be told, with the reason
  Held held{};                                 ///< by the user
  std::optional<double> free_damping_ratio{};  ///< best zeta where that is negative
  bool in_newtons = true;
  bool zero_known = false;  ///< of the sensor
  std::size_t cycles = 0;
  double samples_per_slip = 0.0;
  double sample_interval_s = 0.0;
  /// Why nothing that is read from the slip is identified; empty: no reason.
  std::string slip_doubt{};
  /// Why k is not identified, whatever its interval; empty: no reason.
  std::string stiffness_doubt{};
  std::string stiffness_note{};
  /// Why w_n, and m with it, is not identified, whatever its interval; empty: no reason.
  std::string frequency_doubt{};
  std::string frequency_unknown{};  ///< why there is no natural frequency to read from the slips; empty: there is
  std::optional<double> sensor_average_s{};     ///< stated, in the model
  std::optional<Estimate> fitted_average{};     ///< s, found by the fit
  std::string damping_doubt{};                  ///< why zeta is not identified
  std::string slip_unresolved{};                ///< why w_n and F_s - F_k cannot be read from the slip; empty: they can
  std::optional<Interval> difference_bounds{};  ///< all that is known of F_s - F_k
  std::optional<LawFindings> law{};
  Warnings warnings{};

  [[nodiscard]] bool damping_known() const { return damping.value.has_value(); }
};

/// Fills parameters, correlation and model estimate.
void report_parameters(const Findings& findings, FitResult& result);

}  // namespace slipfit::fit
