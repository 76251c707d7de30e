#pragma once

#include <ceres/evaluation_callback.h>
#include <ceres/problem.h>

#include <cstddef>
#include <utility>
#include <vector>

#include "fit/problem/cycle_cost.hpp"

namespace slipfit::fit {

/// What Ceres is about to evaluate. Cycles of large problems are worked out here, on all processors; Ceres itself adds
/// up on one thread, and so in the same order on any number of them.
class Evaluations : public ceres::EvaluationCallback {
 public:
  void PrepareForEvaluation(bool with_jacobian, bool is_new) override;

  /// `blocks`: of the cost. Both must outlive the solve.
  void add(CycleCost& cost, std::vector<double*> blocks);
  /// To be called when the problem has all its blocks.
  void watch(const ceres::Problem& problem);

  /// Sets the problem's blocks to the point at which Ceres evaluated it last. At the end of a solve this is the step
  /// whose gain was small enough to end it, the best point known, but Ceres returns the point before it. Does nothing
  /// where that step led out of the model: steps that are refused shorten until they end the solve, too.
  void restore_last_point() const;

 private:
  struct Asked {
    CycleCost* cost;
    std::vector<double*> blocks;
  };

  void prepare_cycles(bool with_jacobian);

  std::vector<Asked> cycles_;
  std::size_t residuals_ = 0;  ///< of all cycles, before their rows are reduced
  std::vector<std::pair<double*, int>> blocks_;
  std::vector<double> values_;
};

}  // namespace slipfit::fit
