#include "slipfit/report/csv.hpp"

#include <fmt/format.h>

#include <iterator>
#include <vector>

#include "report/format.hpp"
#include "report/quantity_rows.hpp"
#include "slipfit/core/printable.hpp"

namespace slipfit {

namespace {

std::string unit_suffix(const Recording& recording) {
  return recording.conditions().quantity == ForceQuantity::Force_N ? "N" : "coefficient";
}

}  // namespace

std::string cycles_to_csv(const Recording& recording, const Analysis& analysis) {
  const std::string unit = unit_suffix(recording);
  std::string csv = fmt::format(
      "cycle,peak_s,trough_s,peak_force_{0},trough_force_{0},force_drop_{0},used,onset_s,end_s,onset_force_{0},"
      "level_force_{0},residual_rms_{0}\n",
      unit);
  std::size_t row = 0;
  for (const Cycle& cycle : analysis.cycle_table) {
    fmt::format_to(std::back_inserter(csv), "{},{},{},{},{},{},{},{},{},{},{},{}\n", ++row, cell(cycle.peak_s),
                   cell(cycle.trough_s), cell(cycle.peak_force), cell(cycle.trough_force),
                   cell(cycle.peak_force - cycle.trough_force), cycle.used ? 1 : 0, cell(cycle.onset_s),
                   cell(cycle.end_s), cell(cycle.onset_force), cell(cycle.level_force), cell(cycle.residual_rms));
  }
  return csv;
}

std::string curve_to_csv(const Recording& recording, const Analysis& analysis) {
  const std::vector<double> fitted = fitted_force(recording, analysis);
  std::string csv = fmt::format("time_s,force_{0},fitted_{0},residual_{0}\n", unit_suffix(recording));
  for (std::size_t i = 0; i < recording.size(); ++i) {
    const double force = recording.force()[i];
    fmt::format_to(std::back_inserter(csv), "{},{},{},{}\n", recording.time_s()[i], force, cell(fitted[i]),
                   cell(force - fitted[i]));
  }
  return csv;
}

std::string trace_to_csv(const SimulatedTrace& trace, const std::string& comment) {
  std::string csv = fmt::format("# {}\ntime_s,force_N\n", printable(comment));
  for (std::size_t i = 0; i < trace.time_s.size() && i < trace.force_N.size(); ++i) {
    fmt::format_to(std::back_inserter(csv), "{},{}\n", cell(trace.time_s[i]), cell(trace.force_N[i]));
  }
  return csv;
}

}  // namespace slipfit
