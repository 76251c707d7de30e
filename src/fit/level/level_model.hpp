#pragma once

#include <ceres/jet.h>
#include <cstddef>
#include <memory>
#include <vector>

#include "fit/cycle/cycle_data.hpp"

namespace slipfit::fit {

/// Reloading hysteresis: after a slip the force rises by A (1 - exp(-x / l)) more than by k x over the path x = V t of
/// the stick (docs/model.md section 10). The ends of the slips are fixed while fitting.
struct RiseAfterSlip {
  double length_m = 0.0;  ///< l with which a fit begins
  /// The fit ends with this l at most: over a longer path the rise cannot be distinguished from a softer spring.
  double longest_m = 0.0;
  bool is_free = false;  ///< the fit solves for l
  double speed_m_per_s = 0.0;
  std::vector<double> slip_begin_s;  ///< of every slip of the recording
  std::vector<double> slip_end_s;

  /// A share of A and its derivatives with respect to ln l and to the logarithm of the average.
  struct Share {
    double value = 0.0;
    double by_log_length = 0.0;
    double by_log_average = 0.0;
  };
  /// Holds mean and least-squares slope over a bin's samples, evenly spread.
  struct Line {
    Share mean, slope;
  };
};

/// The rise around one slip: what the rise after the slip before it still lacks at the onset (below 0), 0 in the slip,
/// the rise after it.
class RiseAroundSlip {
 public:
  /// `average_s`: over which the sensor averages; 0: it does not.
  RiseAroundSlip(const RiseAfterSlip& rise, std::size_t slip, double length_m, double average_s);

  [[nodiscard]] RiseAfterSlip::Share at(double time_s) const;
  [[nodiscard]] RiseAfterSlip::Line over(const StickBin& bin) const;

 private:
  using LengthJet = ceres::Jet<double, 1>;

  /// The rise over part of a stick, as a share of A: 1 - exp(-t / scale) with t from the end of the slip before it,
  /// less `risen`.
  struct Stick {
    double begin_s = 0.0;
    LengthJet scale_s, risen;

    [[nodiscard]] LengthJet at(double time_s) const;
  };
  [[nodiscard]] LengthJet without_average(double time_s) const;

  bool has_before_;
  double average_s_;
  double onset_s_;
  Stick before_, after_;
};

/// Describes the kinetic level F_k by one polynomial in time (additive drift of the sensor, order 0: constant) or by
/// one value a cycle (friction that wanders). It also describes hum of the mains by a cosine and a sine for each line,
/// and a rise of the force after slips.
struct LevelModel {
  bool per_cycle = false;
  std::size_t terms = 1;  ///< of the Legendre polynomial; 0 where per_cycle
  std::vector<double> lines_Hz;
  std::shared_ptr<const RiseAfterSlip> reloading{};  ///< null: sticks are straight

  friend bool operator==(const LevelModel&, const LevelModel&) = default;

  /// Functions of time with a coefficient each: those of the polynomial, then cosine and sine of each line.
  [[nodiscard]] std::size_t columns() const { return terms + 2 * lines_Hz.size(); }
  [[nodiscard]] std::size_t columns_behind_constant() const { return columns() - (terms > 0 ? 1 : 0); }
};

}  // namespace slipfit::fit
