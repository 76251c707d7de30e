#pragma once

#include <optional>
#include <string>
#include <vector>

#include "families.hpp"
#include "sweeps.hpp"

namespace coverage {

/// One parameter of one recording or sweep: truth against estimate.
struct Row {
  std::string family, note;
  std::uint64_t seed = 0;
  std::string parameter;
  double truth = 0.0;
  slipfit::Estimate estimate;
  std::string status;           ///< of the parameter; "measured" for the spacing, "predicted" in sweeps
  std::string motion;           ///< of the recording
  std::string warnings;         ///< codes of the recording's, with blanks between; only in the row of the spacing
  std::optional<double> bound;  ///< Cramer-Rao bound of the standard deviation
};

std::vector<Row> fit_scene(const Scene& scene);

/// Of the joint fit: parameters, and the spacings at each speed from the others (left_out) and at the two highest from
/// the three lowest (higher).
std::vector<Row> fit_joint(const Sweep& sweep);

std::string to_csv(const std::vector<Row>& rows);

}  // namespace coverage
