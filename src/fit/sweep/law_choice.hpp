#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fit/sweep/sweep_data.hpp"
#include "fit/sweep/sweep_outcome.hpp"
#include "fit/sweep/sweep_solution.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/fit/sweep_recording.hpp"

namespace slipfit::fit {

/// Holds the choice of a friction law, and the sentence that says why.
struct LawChoice {
  bool velocity = false;
  std::string reason;
};

/// Returns the ratio of the highest speed to the lowest among the recordings in the fit.
double speed_ratio(std::span<const SweepRecording> recordings);

struct ChosenLaw {
  SweepOutcome outcome;
  LawChoice choice;
  std::vector<Candidate> candidates;
};

/// The law by chance; where residuals are larger than the noise, more parameters fit the model's error as well, and it
/// is the one that predicts recordings left out better (left_out_error). So is k that varies with driving speed.
/// `tier`: asked for; `speeds`: speed_ratio().
ChosenLaw choose_law(const SweepData& data, const SweepFits& fits, std::optional<Tier> tier, double speeds);

/// Returns the recordings with a spring that relaxes (docs/model.md section 10) where that explains them better than
/// sticks that are straight or rise over a displacement, and than k that varies with driving speed; otherwise the
/// recordings are returned as they are. The time of relaxation is the same at all speeds.
SweepData with_relaxation(SweepData data, std::span<const SweepRecording> recordings, const HeldParameters& held);

}  // namespace slipfit::fit
