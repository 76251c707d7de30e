#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "chart/chart.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/figures/figures.hpp"
#include "slipfit/model/motion.hpp"
#include "slipfit/model/paper.hpp"

// One function for each figure of the paper; each returns its tables and its picture.

namespace slipfit::figures {

std::vector<FigureFile> slip_and_stick_times();            // figure 2
std::vector<FigureFile> sticking_degree_and_amplitude();   // figure 3
std::vector<FigureFile> amplitude_against_speed();         // figure 4
std::vector<FigureFile> velocity_ratio();                  // figure 5
std::vector<FigureFile> spring_force();                    // figure 6
std::vector<FigureFile> damped_sticking_degree();          // figure 7
std::vector<FigureFile> damped_amplitude_against_speed();  // figure 8
std::vector<FigureFile> regime_map();

/// A table of numbers, whose columns are the lines of a picture.
class Table {
 public:
  Table(std::vector<std::string> comments, std::vector<std::string> columns)
      : comments_(std::move(comments)), columns_(std::move(columns)) {}
  void add(std::vector<double> row);
  /// CSV under lines of comment; what is not finite becomes an empty cell.
  [[nodiscard]] std::string csv() const;
  /// Adds the points of two columns, the second in units of 1 / `scale`, to a line: of all rows, or of those whose
  /// first cell is `key`.
  [[nodiscard]] chart::Line line(chart::Line line, std::size_t x, std::size_t y, std::optional<double> key = {},
                                 double scale = 1.0) const;

 private:
  std::vector<std::string> comments_, columns_;
  std::vector<std::vector<double>> rows_;
};

/// The table NAME.csv and the picture NAME.svg.
std::vector<FigureFile> files_of(const std::string& name, const Table& table, const chart::Chart& chart);

// The model in scaled form: with w_n = 1, k = 1 and V = 1 times are w_n t and lengths are in V/w_n, so that lambda is
// F_s - F_k and the periodic displacement is xi, [Paper] eqs (9)-(11).

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();  ///< no value: an empty cell, a gap in a line

/// The limits of stick-slip that the paper reads off its figure 7.
struct PrintedLimit {
  double damping_ratio = 0.0;
  double lambda = 0.0;
};
constexpr std::array<PrintedLimit, 3> kPrintedLimits{{{0.015, 0.2}, {0.05, 0.5}, {0.1, 0.9}}};

Motion scaled_motion(double lambda, double damping_ratio);
Result<PaperCycle> scaled_paper_cycle(double lambda, double damping_ratio);

/// The smallest lambda at which [Paper] eq. (36) has a root. Damping ratio in (0, 1).
double first_solvable_lambda(double damping_ratio);

/// The sticking degree that a slip at lambda_c(zeta) just reaches: it jumps from there to zero.
double sticking_degree_at_limit(double damping_ratio);

std::vector<double> evenly_spaced(double low, double high, int intervals);

/// Returns values with equal ratios; low > 0.
std::vector<double> logarithmically_spaced(double low, double high, int intervals);

}  // namespace slipfit::figures
