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

/// Which force the sensor sees (docs/model.md section 7).
enum class ForceView { Spring, Transmitted, Contact };

/// What the force column holds: newtons, or a friction coefficient whose normal force is not known.
enum class ForceQuantity { Force_N, FrictionCoefficient };

/// How a rise or fall of the force level over a recording is read: a sensor that drifts adds it to every stick,
/// friction that changes does not.
enum class LevelReading {
  Open,     ///< not stated, and the data do not determine it: one of the next two
  Sensor,   ///< drift of the sensor
  Friction  ///< change of the friction: run-in, a load that changes
};

/// A file that was read, by the bytes that were parsed.
struct InputFile {
  std::string file;
  Digest digest;
  std::uint64_t bytes = 0;
};

/// The track that was worn in the test, as a profile of it shows it.
struct WornTrack {
  std::string file;
  Estimate spacing_m;  ///< empty, with a reason, where the surface does not tell it
  double pitch_m = 0.0;
  std::vector<double> height;          ///< not a number where nothing was measured
  std::vector<double> ridge_places_m;  ///< from the first sample
  std::vector<InputFile> inputs = {};  ///< that were read for it; empty: it is not from a file
};

/// What the user calls a recording and what it is of; each may be empty. Results carry them, nothing is computed of
/// them.
struct Labels {
  std::string group, sample, material, operator_name;
};

/// How the recording was made: what the trace itself does not tell.
struct Conditions {
  double speed_m_per_s = 0.0;                          ///< driving speed, > 0
  std::optional<double> speed_standard_error_m_per_s;  ///< of the stated speed, when the user gives one
  std::optional<double> normal_force_N;                ///< > 0
  ForceView force_view = ForceView::Spring;
  ForceQuantity quantity = ForceQuantity::Force_N;
  std::optional<double> zero_force_N;  ///< sensor reading at no force, already subtracted; absolute forces need it
  /// > 0, of a first-order sensor, -3 dB: the fit of one recording lets its model lag by it. Fits of sweeps do not.
  std::optional<double> sensor_bandwidth_Hz;
  /// >= 0, each sample is the mean force over this time (0: an instant). Empty: not stated, taken for anything up to
  /// one step of the clock.
  std::optional<double> sensor_average_s;
  std::optional<double>
      sensor_resonance_Hz;                  ///< > 0, of the load cell as it is mounted: a frequency near it is doubted
  LevelReading drift = LevelReading::Open;  ///< how the user reads a trend of the force level
  std::optional<double> drive_period_s;     ///< > 0, of what may set the rhythm: a motor's step, an excitation
  std::optional<double> drive_path_m;  ///< > 0, over which the drive's force repeats: a pole pitch, a tooth, a turn
  /// > 0, of the moving body: gives w_n where averaging hides it, else held against k / w_n^2.
  std::optional<double> mass_kg;
  std::optional<double> mass_standard_error_kg;  ///< >= 0, of the stated mass; empty: 2 % of it
  std::optional<double> measured_spacing_m;      ///< > 0, of the worn surface: a prediction is held against it
  std::optional<double> measured_spacing_se_m;   ///< >= 0; empty: the measured spacing counts as exact
  std::shared_ptr<const WornTrack> worn_track;   ///< none: no surface was given
  std::string speed_unit = {};  ///< that the speed was given in ("mm/min"): reports show it; empty: m/s
  Labels labels = {};
};

/// Where the numbers came from and what the reader had to assume, count or leave out.
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
  /// Speed of a displacement column with its standard error; empty: no such column, or one that moves unsteadily.
  std::optional<Estimate> moved_m_per_s{};
  bool window_given = false;  ///< the user chose what part to read: nothing else is left out
  /// The options that the user stated for reading it: columns of a manifest and their cells.
  std::vector<std::pair<std::string, std::string>> options{};
};

/// Time and tangential force of one run: at least 2 samples, all finite, time never decreasing and not constant.
class Recording {
 public:
  /// Errors: too_few_samples, length_mismatch, not_finite, time_decreases, time_constant, speed_not_positive,
  /// normal_force_not_positive. `force` is in newtons, or a friction coefficient as `conditions.quantity` says.
  /// `normal_force_N`: of every sample, where a column has it; not used where a value is missing or not finite.
  static Result<Recording> create(std::vector<double> time_s, std::vector<double> force, Conditions conditions,
                                  Provenance provenance = {}, std::vector<double> normal_force_N = {});

  [[nodiscard]] std::span<const double> time_s() const { return time_s_; }
  [[nodiscard]] std::span<const double> force() const { return force_; }
  /// Measured with each sample; empty: not measured.
  [[nodiscard]] std::span<const double> normal_force_N() const { return normal_force_N_; }
  [[nodiscard]] std::size_t size() const { return time_s_.size(); }
  [[nodiscard]] const Conditions& conditions() const { return conditions_; }
  [[nodiscard]] const Provenance& provenance() const { return provenance_; }
  /// First time of the samples that this is a part of.
  [[nodiscard]] double whole_begin_s() const;
  [[nodiscard]] double duration_s() const { return time_s_.back() - time_s_.front(); }
  /// Median step of the clock (of the steps that are not zero).
  [[nodiscard]] double sample_interval_s() const { return sample_interval_s_; }
  /// Whether every time stamp lies within a quarter of a step of an even clock (printed decimals do, gaps do not).
  [[nodiscard]] bool clock_is_even() const { return clock_is_even_; }

  /// Samples [begin, end), at least 2 of them at different times: the same conditions, the same provenance. They are
  /// not copied.
  [[nodiscard]] Recording part(std::size_t begin, std::size_t end) const;

  /// These samples, ascending, at least 2 of them at different times: the same conditions, the same provenance.
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
  Conditions conditions_;
  Provenance provenance_;
  double sample_interval_s_ = 0.0;
  bool clock_is_even_ = false;
};

}  // namespace slipfit
