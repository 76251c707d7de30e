#pragma once

#include <array>
#include <string>

#include "report/batch_html.hpp"

namespace slipfit::html {

/// A quantity of the table, in one unit so that rows compare by eye, and its distribution.
struct BatchColumn {
  const char* heading = nullptr;
  const char* unit = nullptr;
  double per_SI = 1.0;
  Estimate BatchPageRow::*quantity = nullptr;
  const char* id = nullptr;                               ///< of the distribution
  std::string BatchPageRow::*parameter_status = nullptr;  ///< null for what is no parameter
};

inline constexpr std::array<BatchColumn, 5> kBatchColumns{
    {{"frequency", "Hz", 1.0, &BatchPageRow::frequency_Hz, "frequencies"},
     {"pattern spacing V/f", "mm", 1e3, &BatchPageRow::spacing_m, "spacings"},
     {"stiffness", "N/m", 1.0, &BatchPageRow::stiffness_N_per_m, "stiffnesses", &BatchPageRow::stiffness_status},
     {"F_s - F_k", "N", 1.0, &BatchPageRow::friction_difference_N, "differences", &BatchPageRow::difference_status},
     {"damping ratio", "-", 1.0, &BatchPageRow::damping_ratio, "damping-ratios", &BatchPageRow::damping_status}}};

/// <thead> and <tr> of the table.
std::string batch_headings();
std::string batch_row(const BatchPageRow& row);

}  // namespace slipfit::html
