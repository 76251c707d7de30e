#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "slipfit/core/digest.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit {

/// The force that the sensor measures (docs/model.md section 7).
enum class ForceView { Spring, Transmitted, Contact };

/// The contents of the force column: newtons, or a friction coefficient whose normal force is unknown.
enum class ForceQuantity { Force_N, FrictionCoefficient };

/// The cause of a trend of the force level over a recording: drift of the sensor adds it to every stick, a change of
/// the friction does not.
enum class LevelReading {
  Open,      ///< not stated, and the data do not determine it: one of the next two
  Sensor,    ///< drift of the sensor
  Friction,  ///< change of the friction: run-in, a load that changes
  None       ///< the user states that there is no trend: what the level changes by is chance
};

/// A file that was read, identified by the bytes that were parsed.
struct InputFile {
  std::string file;
  Digest digest;
  std::uint64_t bytes = 0;
};

/// The worn track of the test, as its profile shows it.
struct WornTrack {
  std::string file;
  Estimate spacing_m;  ///< empty, with a reason, if the surface does not determine it
  double pitch_m = 0.0;
  std::vector<double> height;          ///< not a number where nothing was measured
  std::vector<double> ridge_places_m;  ///< from the first sample
  std::vector<InputFile> inputs = {};  ///< that were read for it; empty: it is not from a file
};

/// Names that the user gives to a recording; each may be empty. Results contain them, but nothing is computed from
/// them.
struct Labels {
  std::string group, sample, material, operator_name;
};

/// The conditions of a recording: information that the trace itself does not contain.
struct Conditions {
  double speed_m_per_s = 0.0;  ///< driving speed, > 0
  /// False: nothing that depends on the speed is wanted, and a recording is read without one. The speed is then 1 m/s.
  bool speed_is_known = true;
  std::optional<double> speed_standard_error_m_per_s;  ///< of the stated speed, when the user gives one
  std::optional<double> normal_force_N;                ///< > 0
  ForceView force_view = ForceView::Spring;
  ForceQuantity quantity = ForceQuantity::Force_N;
  std::optional<double> zero_force_N;  ///< sensor reading at no force, already subtracted; absolute forces need it
  /// Bandwidth of the sensor or corner of its low-pass filter (-3 dB), in Hz, > 0: fits include it.
  std::optional<double> sensor_bandwidth_Hz;
  /// Order of that Butterworth filter, from 1 (a sensor of first order) to kHighestFilterOrder.
  std::size_t sensor_filter_order = 1;
  /// Averaging time of each sample in s, >= 0 (0: none). If empty, it is not stated and may be up to one step of the
  /// clock.
  std::optional<double> sensor_average_s;
  std::optional<double>
      sensor_resonance_Hz;                  ///< > 0, of the load cell as it is mounted: a frequency near it is doubted
  LevelReading drift = LevelReading::Open;  ///< how the user reads a trend of the force level
  std::optional<double> drive_period_s;     ///< > 0, of what may set the rhythm: a motor's step, an excitation
  std::optional<double> drive_path_m;  ///< > 0, over which the drive's force repeats: a pole pitch, a tooth, a turn
  /// Moving mass in kg, > 0: it determines w_n if averaging conceals it, and is otherwise compared with k / w_n^2.
  std::optional<double> mass_kg;
  std::optional<double> mass_standard_error_kg;  ///< >= 0, of the stated mass; empty: 2 % of it
  std::optional<double> measured_spacing_m;      ///< > 0, of the worn surface: a prediction is held against it
  std::optional<double> measured_spacing_se_m;   ///< >= 0; empty: the measured spacing counts as exact
  std::shared_ptr<const WornTrack> worn_track;   ///< none: no surface was given
  std::string speed_unit = {};  ///< that the speed was given in ("mm/min"): reports show it; empty: m/s
  Labels labels = {};

  /// Returns the time by which the sensor delays a slow ramp, in s, where its bandwidth is stated: 1 / (2 pi f) times
  /// the coefficient of s in the Butterworth polynomial, 1 / sin(pi / (2 n)). docs/model.md section 7
  [[nodiscard]] std::optional<double> sensor_lag_s() const;

  /// Standard error of the driving speed over the speed; 0 where none is stated.
  [[nodiscard]] double relative_speed_error() const {
    return speed_standard_error_m_per_s.value_or(0.0) / speed_m_per_s;
  }
};

/// Highest order of the sensor's filter.
inline constexpr std::size_t kHighestFilterOrder = 8;

/// The origin of the numbers, and what the reader assumed, counted or left out.
struct Provenance {
  std::string file;
  std::optional<Digest> input_digest;        ///< of the bytes that were parsed; empty: not from a file
  std::optional<std::uint64_t> input_bytes;  ///< their number
  std::vector<std::string> assumed;          ///< sentences, in the order of the decisions
  Warnings warnings;                         ///< found while reading (speed against displacement, backward time, ...)
  std::size_t rows_without_number = 0;       ///< nan, inf, empty or text cells in the chosen columns: left out
  std::size_t rows_backward_in_time = 0;     ///< left out
  std::size_t rows_repeating_time = 0;       ///< kept: same time stamp as the row before
  bool is_time_unit_assumed = false;         ///< no unit of the clock is given: seconds are assumed
  /// The speed of a displacement column with its standard error; empty without such a column, or if the speed is not
  /// constant.
  std::optional<Estimate> moved_m_per_s{};
  std::size_t strokes = 0;    ///< of a reciprocating test that were read as one recording; 0: no such test
  bool window_given = false;  ///< the user chose what part to read: nothing else is left out
  /// The options that the user stated for reading it: columns of a manifest and their cells.
  std::vector<std::pair<std::string, std::string>> options{};
};

/// Time and tangential force of one recording: at least 2 samples, all finite, time never decreasing and not constant.
class Recording {
 public:
  /// Creates a recording. `force` is in newtons, or a friction coefficient as `conditions.quantity` states.
  /// `normal_force_N` has a value for every sample if a column contains it; it is not used if a value is missing or not
  /// finite; the same holds for `drive_m`. Errors: too_few_samples, length_mismatch, not_finite, time_decreases,
  /// time_constant, speed_not_positive, normal_force_not_positive.
  static Result<Recording> create(std::vector<double> time_s, std::vector<double> force, Conditions conditions,
                                  Provenance provenance = {}, std::vector<double> normal_force_N = {},
                                  std::vector<double> drive_m = {});

  [[nodiscard]] std::span<const double> time_s() const { return time_s_; }
  [[nodiscard]] std::span<const double> force() const { return force_; }
  /// Returns the measured normal force of each sample; empty if it was not measured.
  [[nodiscard]] std::span<const double> normal_force_N() const { return normal_force_N_; }
  /// Returns the measured position of each sample, of the drive or of another part; empty if it was not measured.
  [[nodiscard]] std::span<const double> drive_m() const { return drive_m_; }
  [[nodiscard]] std::size_t size() const { return time_s_.size(); }
  [[nodiscard]] const Conditions& conditions() const { return conditions_; }
  [[nodiscard]] const Provenance& provenance() const { return provenance_; }
  /// Returns the first time of the recording of which this is a part.
  [[nodiscard]] double whole_begin_s() const;
  [[nodiscard]] double duration_s() const { return time_s_.back() - time_s_.front(); }
  /// Returns the median step of the clock, over the steps that are not zero.
  [[nodiscard]] double sample_interval_s() const { return sample_interval_s_; }
  /// Returns true if every time stamp is within a quarter of a step of an even clock (rounded decimals are, gaps are
  /// not).
  [[nodiscard]] bool clock_is_even() const { return clock_is_even_; }

  /// Returns the samples [begin, end), at least 2 of them at different times, with the same conditions and provenance.
  /// The samples are not copied.
  [[nodiscard]] Recording part(std::size_t begin, std::size_t end) const;

  /// Returns these samples in ascending order, at least 2 of them at different times, with the same conditions and
  /// provenance.
  [[nodiscard]] Recording selected(std::span<const std::size_t> samples) const;

 private:
  Recording() = default;
  struct Samples;  // shared by a recording and its parts, which are never changed
  [[nodiscard]] Recording with_samples(std::shared_ptr<const Samples> samples, std::size_t begin,
                                       std::size_t end) const;

  std::shared_ptr<const Samples> samples_;
  std::span<const double> time_s_;
  std::span<const double> force_;
  std::span<const double> normal_force_N_;
  std::span<const double> drive_m_;
  Conditions conditions_;
  Provenance provenance_;
  double sample_interval_s_ = 0.0;
  bool clock_is_even_ = false;
};

}  // namespace slipfit
