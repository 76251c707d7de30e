#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fit/level/hum.hpp"
#include "fit/sweep/ageing_line.hpp"
#include "fit/sweep/sweep_data.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/fit/result.hpp"

namespace slipfit::fit {

/// The condition on a speed without a standard error, and which parameters depend on it.
inline constexpr const char* kStatedSpeed =
    "the stated driving speed (k, m and c are inversely proportional to it; --speed-uncertainty widens their "
    "intervals)";

/// States why nothing that is read from the slip is identified where W is fitted.
inline constexpr const char* kFittedAverage = "assumes that the sensor averages uniformly over the fitted time";
/// States the source of w_n and zeta that are not read from the slips alone.
inline constexpr const char* kRingDown = "the free ring-down, which was used as data for w_n and zeta";

/// Warns that an average of the samples is fitted.
Warning averaged_warning(double average_s);

/// Returns the assumptions that the numbers of one recording rest on.
std::vector<std::string> conditions_of(const Recording& recording, Tier tier);

/// States what a caveat is about, by precedence: the first one that concerns a parameter is its note. `concerned_by` in
/// parameters.cpp says which parameters each of them concerns.
enum class About {
  Slip,              ///< all that is read from the slip
  Sampling,          ///< of the slip
  Stiffness,         ///< k, and what rests on it
  StiffnessAlone,    ///< k
  Difference,        ///< F_s - F_k
  Damping,           ///< zeta
  Frequency,         ///< w_n that is read from the slips
  Average,           ///< of the sensor
  SlipDistance,      ///< of friction that weakens
  Rise,              ///< what rests on the rise of the force after a slip: of time or of distance
  RiseAlone,         ///< this rise
  FrictionAtSpeeds,  ///< kinetic friction at other speeds
  SameWithinSlip,    ///< friction and load within a slip
  Level,             ///< absolute forces
  Cycles             ///< their number
};

/// Says why parameters are less certain than their intervals.
struct Caveat {
  About about = About::Slip;
  ParameterStatus best = ParameterStatus::Weak;  ///< that it leaves; Identified: it is a remark
  std::string reason;
};

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
  bool levels_differ = false;     ///< each slip has its own F_k
  bool onsets_scatter = false;    ///< F_s of slips that a spring shows does: their troughs measure zeta
  std::vector<Caveat> caveats{};  ///< those about the same that were added later precede
  /// Says how far another law of kinetic friction moves F_k(0+) and F_s - F_k(0+), which lengthens their intervals.
  Coordinates other_law = Coordinates::Zero();
  LevelTrend level_trend{};
  std::optional<double> sensor_average_s{};     ///< stated, in the model
  std::optional<Estimate> fitted_average{};     ///< s, found by the fit
  std::string slip_unresolved{};                ///< why w_n and F_s - F_k cannot be read from the slip; empty: they can
  std::optional<Interval> difference_bounds{};  ///< all that is known of F_s - F_k
  std::optional<LawFindings> law{};
  bool weakens = false;           ///< friction falls over a slip distance, in the model
  bool frequency_tested = false;  ///< the slips' w_n agrees with a ring-down or a stated mass
  std::optional<LoadResponse> load_response{};
  bool mass_gives_frequency = false;  ///< w_n is held at sqrt(k / m) of the stated mass, whose error the spread holds
  Warnings warnings{};

  /// Adds a caveat if it has a reason.
  void add(About about, ParameterStatus best, std::string reason) {
    if (!reason.empty()) caveats.insert(caveats.begin(), {about, best, std::move(reason)});
  }
  [[nodiscard]] bool has_caveat(About about) const;

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
