#pragma once

#include <ceres/evaluation_callback.h>
#include <ceres/problem.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace slipfit::fit {

/// The point at which Ceres evaluated a problem last. At the end of a solve this is the step whose gain was small
/// enough to end it, the best point known, but Ceres returns the point before it.
class LastPoint : public ceres::EvaluationCallback {
 public:
  void PrepareForEvaluation(bool, bool is_new) override {
    if (!is_new) return;
    values_.clear();
    for (const auto& [block, size] : blocks_) values_.insert(values_.end(), block, block + size);
  }

  /// To be called when the problem has all its blocks.
  void watch(const ceres::Problem& problem) {
    std::vector<double*> blocks;
    problem.GetParameterBlocks(&blocks);
    for (double* block : blocks) blocks_.emplace_back(block, problem.ParameterBlockSize(block));
  }
  /// Sets the problem's blocks to it.
  void restore() const {
    auto value = values_.begin();
    for (const auto& [block, size] : blocks_) {
      std::copy_n(value, size, block);
      value += size;
    }
  }

 private:
  std::vector<std::pair<double*, int>> blocks_;
  std::vector<double> values_;
};

}  // namespace slipfit::fit
