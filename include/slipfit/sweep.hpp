#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slipfit/analysis.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/sweep.hpp"
#include "slipfit/io/manifest.hpp"
#include "slipfit/io/recording_reader.hpp"

namespace slipfit {

/// One recording of a sweep, by its name in the manifest.
using SweepEntry = NamedRecording;

/// Reads the recordings of a manifest in its order; a row with strokes or segments gives each of them. A fit of a sweep
/// compares spring forces. Errors: those of read_recording, not_a_force, view_not_spring.
Result<std::vector<SweepEntry>> read_sweep(std::span<const ManifestEntry> manifest);

/// Returns the reason why a recording cannot be fitted together with others. Errors: not_a_force, view_not_spring.
std::optional<Error> check_joint(const Recording& recording);

/// A quantity over recordings at one speed: strokes, or repeated recordings.
struct Repeat {
  std::string name;  ///< of the JSON: "force_drop_N"
  std::string words;
  std::string unit;
  std::size_t count = 0;  ///< recordings that show it
  Estimate mean;
  double standard_deviation = 0.0;  ///< between the recordings
};

/// Recordings of one sliding pair at several speeds (or loads), analysed separately and then together.
struct SweepAnalysis {
  std::vector<Analysis> recordings;              ///< in the order of the entries; `fit` is each recording's own
  std::vector<SweepRole> roles;                  ///< what each was used for
  std::optional<SweepFit> fit;                   ///< empty: fewer than two recordings with stick-slip cycles
  std::vector<std::vector<AuditPair>> audits{};  ///< of `fit` with each recording; empty without `fit`
  std::string fit_reason;                        ///< what it is made of, or why there is none
  Derived derived;                               ///< critical speed; what belongs to one speed is empty
  std::vector<Repeat> repeats;                   ///< empty where the speeds differ
  Warnings warnings;                             ///< of the sweep as a whole, the fit of the sweep's included
  std::optional<AskedFit> asked{};               ///< empty: no fit was asked for
};

/// Analyses each recording and then fits one set of parameters to all. At least one entry is required.
SweepAnalysis analyze_sweep(std::span<const SweepEntry> entries, const FitOptions& options = {});

/// Analyses each recording without a fit.
SweepAnalysis analyze_each(std::span<const SweepEntry> entries);

}  // namespace slipfit
