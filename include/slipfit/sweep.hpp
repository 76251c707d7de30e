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

/// The recordings that a manifest names, in its order; of a row with strokes or segments each of them. A fit of a sweep
/// compares forces behind the spring. Errors: those of read_recording, not_a_force, view_not_spring.
Result<std::vector<SweepEntry>> read_sweep(std::span<const ManifestEntry> manifest);

/// Why a recording cannot be fitted together with others. Errors: not_a_force, view_not_spring.
std::optional<Error> check_joint(const Recording& recording);

/// A quantity over recordings that are all at one speed: strokes, repeated runs.
struct Repeat {
  std::string name;  ///< of the JSON: "force_drop_N"
  std::string words;
  std::string unit;
  std::size_t count = 0;  ///< recordings that show it
  Estimate mean;
  double standard_deviation = 0.0;  ///< between the recordings
};

/// Recordings of one sliding pair at several speeds (or loads), analysed one by one and then together.
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

/// Each recording on its own, then one set of parameters for all. Needs at least one entry.
SweepAnalysis analyze_sweep(std::span<const SweepEntry> entries, const FitOptions& options = {});

/// Each recording on its own, no fit.
SweepAnalysis analyze_each(std::span<const SweepEntry> entries);

}  // namespace slipfit
