#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/fit.hpp"
#include "slipfit/predict/derived.hpp"
#include "slipfit/signal/quality.hpp"
#include "slipfit/signal/spectrum.hpp"

namespace slipfit {

/// The kind of motion that a recording shows.
enum class MotionClass { StickSlip, SteadySliding, OscillatorySlip, Undetermined };

/// The origin of the reported frequency: the fitted cycles, the spectrum, or the count of slips.
enum class FrequencyMethod { None, FittedCycles, HarmonicLeastSquares, SlipCounting };

/// The spectral and the counted frequency, and the one to report.
struct FrequencyReport {
  Estimate quoted;  ///< Hz; empty where neither method finds one
  FrequencyMethod method = FrequencyMethod::None;
  SpectralFrequency spectral;
  Estimate counted;                   ///< Hz, from the mean interval between slips
  std::vector<SuspiciousLine> lines;  ///< repetitions that are not the slips: never quoted
};

/// The rhythm of the slips: with a period of their own, irregular, or synchronous with the stated drive.
enum class Regularity { Regular, Irregular, Clocked };

/// Sticks whose slope clearly differs from that of most: the drive changed its speed there, or the zero of the sensor
/// drifted.
struct OtherSticks {
  std::size_t count = 0;  ///< 0: none
  Estimate stiffness;     ///< N/m: their slope over the speed
};

/// Statistics over the cycles of one recording; forces in the unit of the force column.
struct CycleStatistics {
  std::size_t count = 0;  ///< slips whose drop is at least a quarter of the median drop
  std::size_t minor = 0;  ///< smaller slips
  std::size_t used = 0;   ///< cycles in the fit (0 without one)
  std::optional<double> period_s, period_sd_s, slip_time_s, stick_time_s, sticking_degree;
  std::optional<double> peak_force, peak_force_sd, trough_force, force_drop, force_drop_sd;
  std::optional<double> drop_cv, period_cv;  ///< standard deviation over mean
  std::optional<Regularity> regularity;      ///< empty below 3 slips
  std::optional<double> fall_time_s;         ///< median duration of the detected falls
  Estimate stick_stiffness;  ///< N/m: slope of the rises over the speed, whatever model fits; of newtons
  OtherSticks other_sticks;
};

/// Short tests of assumptions of the fit. Their `value` is: relative change of the period over the recording;
/// displacement in m after which the level repeats; correlation of a slip with the previous one; force for each factor
/// e of stick time; k / w_n^2 over the stated mass; w_n over the resonance of the sensor.
enum class TestKind { PeriodDrift, LevelRepeats, ReturnMap, Ageing, StatedMass, SensorResonance };

struct ShortTest {
  TestKind kind = TestKind::PeriodDrift;
  std::optional<double> value, standard_error;
  std::optional<double> p_value;  ///< that chance alone shows as much
  std::string finding;            ///< one sentence
};

/// Wall-clock time of the stages, in s.
struct Timing {
  double read_s = 0.0;  ///< filled by the caller that reads the file
  double frequency_s = 0.0;
  double fit_s = 0.0;
  double total_s = 0.0;  ///< filled by the caller: from opening the file to the result
};

/// A part of a recording, in s of its own clock.
struct TimeSpan {
  double begin_s = 0.0;
  double end_s = 0.0;
};

/// Events of a recording before and after the sliding; each is empty with a reason if it is not observed.
struct Transients {
  Estimate loading_stiffness_N_per_m;  ///< slope of the first loading ramp over the speed
  Estimate breakaway_force;            ///< first peak, as the force column counts it
  Estimate ring_down_frequency_Hz;     ///< of a free oscillation after the release, or of a motion that died out
  Estimate ring_down_damping_ratio;
};

/// The conditions that a standard prescribes, and the deviations of this test from them.
struct StandardCoefficients {
  std::string standard;    ///< "ASTM D1894"
  std::string prescribes;  ///< one sentence
  Estimate static_coefficient, kinetic_coefficient;
  std::vector<std::string> differs;  ///< sentences; what slipfit cannot see is not among them
};

/// Coefficients of friction in the sliding part: force over normal force; each is empty, with a reason, if it is
/// unknown.
struct Coefficients {
  Estimate static_first_peak;                        ///< the breakaway peak
  Estimate static_mean_peak;                         ///< mean of the peaks before the slips
  Estimate kinetic_mean;                             ///< mean of the force while it slides
  Estimate kinetic_first_third, kinetic_last_third;  ///< of its time
  std::optional<double> static_peak_sd, kinetic_sd;  ///< scatter of the peaks; of the force
  std::vector<StandardCoefficients> standards;
};

/// A quantity that a document gives in two ways, each under its own key.
struct AuditPair {
  std::string pair;
  std::string first_of, second_of;
  Estimate first, second;
  bool contradicts = false;  ///< they differ by more than 4 standard errors and 1 %
  std::string recording{};   ///< of a joint fit: its name there; empty: the only one
};

/// The options of a fit as the user stated them.
struct AskedFit {
  std::optional<Tier> tier{};  ///< empty: chosen by the data
  HeldParameters held{};
};

/// The motion of a drive whose position is measured.
struct MeasuredDrive {
  double stick_speed_m_per_s = 0.0;  ///< its mean speed while the body sticks
  double share_in_slips = 0.0;       ///< its motion less a steady one in a slip, as a force over the drop
};

/// Everything that is known about one recording.
struct Analysis {
  Quality quality;   ///< of the whole recording
  TimeSpan sliding;  ///< the stretch that everything else is of: without run-up, stop, release and pauses
  MotionClass motion = MotionClass::Undetermined;
  std::string motion_reason;  ///< one plain sentence
  Warnings warnings;          ///< of the reader, the analysis and the fit
  FrequencyReport frequency;
  CycleStatistics cycles;
  std::vector<Cycle> cycle_table;
  std::optional<FitResult> fit;  ///< empty: not asked for, or no cycles to fit
  Derived derived;
  Transients transients;
  std::optional<Coefficients> coefficients;  ///< empty without a normal force
  std::vector<AuditPair> audit;              ///< pairs of which both values are known; of stick-slip with a fit
  std::vector<ShortTest> tests;              ///< only where the kind of motion is stick-slip with a fit
  Timing timing;
  std::optional<MeasuredDrive> drive{};  ///< empty: the fit assumes that the drive moves at the stated speed
  std::optional<AskedFit> asked{};       ///< empty: no fit was asked for
};

}  // namespace slipfit
