#include "fit/cycle/cycle_table.hpp"

namespace slipfit::fit {

std::vector<Cycle> detected_cycles(const Recording& recording, const Segmentation& segmentation) {
  std::vector<Cycle> table;
  for (const DetectedSlip& slip : segmentation.slips) {
    Cycle row;
    row.peak_s = recording.time_s()[slip.peak];
    row.trough_s = recording.time_s()[slip.trough];
    row.peak_force = slip.peak_force;
    row.trough_force = slip.trough_force;
    table.push_back(row);
  }
  return table;
}

}  // namespace slipfit::fit
