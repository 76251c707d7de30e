#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fit/inference/ageing_line.hpp"
#include "fit/inference/load_response.hpp"
#include "fit/inference/sliding_model.hpp"
#include "fit/report/notes.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/result.hpp"

namespace slipfit::fit {

/// Returns the assumptions that the numbers of one recording rest on.
std::vector<std::string> conditions_of(const Recording& recording, Tier tier);

/// Holds what is known of friction that depends on the speed; only a sweep has it.
struct LawFindings {
  bool depends_on_speed = false;
  std::string reason;                                ///< why it does, or not
  std::optional<AgeingCutoff> ageing{};              ///< where static friction grows with the stick time
  std::optional<double> reference_normal_force_N{};  ///< known for all recordings
  bool stiffness_grows = false;                      ///< with the speed
  bool at_one_speed = false;                         ///< then no more is known of it than by one recording
};

/// All that the parameters of a fit are made from, of one recording or a sweep.
struct Findings {
  Coordinates values;  ///< zeta >= 0
  Units units;
  Intervals intervals;
  Estimate damping;                            ///< zeta; without value where it is not determined, with the reason
  Held held{};                                 ///< by the user
  std::optional<double> free_damping_ratio{};  ///< best zeta where that is negative
  bool in_newtons = true;
  bool zero_known = false;  ///< of the sensor
  std::size_t cycles = 0;
  double samples_per_slip = 0.0;
  double sample_interval_s = 0.0;
  /// States why nothing that is read from the slip is identified; empty: no reason.
  std::string slip_doubt{};
  /// States why F_s - F_k(0+) is not identified, for a mean over recordings whose static friction differs, or where
  /// another law of kinetic friction gives another value; empty: no reason.
  std::string difference_doubt{};
  /// Says how far that other law moves F_k(0+) and F_s - F_k(0+), which lengthens their intervals.
  Coordinates other_law = Coordinates::Zero();
  /// States why k is not identified, whatever its interval; empty: no reason.
  std::string stiffness_doubt{};
  std::string stiffness_note{};
  std::string level_doubt{};  ///< why absolute forces depend on the part of the recording; empty: they do not
  LevelTrend level_trend{};
  std::string frequency_unknown{};  ///< why there is no natural frequency to read from the slips; empty: there is
  std::optional<double> sensor_average_s{};     ///< stated, in the model
  std::optional<Estimate> fitted_average{};     ///< s, found by the fit
  std::string average_unknown{};                ///< why it is unknown whether there is one
  std::string damping_doubt{};                  ///< why zeta is not identified
  std::string slip_unresolved{};                ///< why w_n and F_s - F_k cannot be read from the slip; empty: they can
  std::optional<Interval> difference_bounds{};  ///< all that is known of F_s - F_k
  std::optional<LawFindings> law{};
  bool weakens = false;                 ///< friction falls over a slip distance, in the model
  std::string slip_distance_unknown{};  ///< why D_c was asked for in vain; empty: it was not
  bool frequency_tested = false;        ///< the slips' w_n agrees with a ring-down or a stated mass
  std::optional<LoadResponse> load_response{};
  bool mass_gives_frequency = false;  ///< w_n is held at sqrt(k / m) of the stated mass, whose error the spread holds
  Warnings warnings{};

  /// Returns the intervals of F_k(0+) and F_s - F_k(0+), which depend on the law below the speeds that were measured.
  [[nodiscard]] Intervals intervals_at_rest() const {
    Spread spread = intervals.spread();
    spread.one_sided.push_back(other_law);
    return Intervals(std::move(spread));
  }
  [[nodiscard]] bool damping_known() const { return damping.value.has_value(); }
};

/// Fills parameters, correlation and model estimate.
void report_parameters(const Findings& findings, FitResult& result);

}  // namespace slipfit::fit
