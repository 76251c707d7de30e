#pragma once

#include <span>
#include <string>
#include <vector>

#include "fit/selection/sweep_fit.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/fit/sweep_recording.hpp"

namespace slipfit::fit {

/// Which friction law, and the sentence that says why.
struct LawChoice {
  bool velocity = false;
  std::string reason;
};

/// The model leaves something out of the recordings.
bool is_misfit(const SweepSolution& solution);

/// Of the fastest recording in the fit over the slowest.
double speed_ratio(std::span<const SweepRecording> recordings);

LawChoice choose_by_chance(const SweepFits& fits, double speeds);

/// Where residuals are larger than the noise, more parameters fit the model's error as well: the law is then chosen by
/// how well it predicts a recording left out (left_out_error).
LawChoice choose_by_left_out(double velocity_error, double coulomb_error);

/// Speed-dependent friction has two parameters more, its mean slope and its rate.
std::vector<Candidate> candidates_of(const SweepFits& fits, const LawChoice& choice);

}  // namespace slipfit::fit
