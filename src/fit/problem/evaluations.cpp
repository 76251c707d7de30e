#include "fit/problem/evaluations.hpp"

#include <algorithm>

#include "fit/cycle/side_by_side.hpp"

namespace slipfit::fit {

void Evaluations::PrepareForEvaluation(bool with_jacobian, bool is_new) {
  if (is_new) {
    values_.clear();
    for (const auto& [block, size] : blocks_) values_.insert(values_.end(), block, block + size);
    for (const Asked& cycle : cycles_) cycle.cost->forget();
  }
  if (pays_side_by_side(residuals_)) prepare_cycles(with_jacobian);
}

void Evaluations::add(CycleCost& cost, std::vector<double*> blocks) {
  residuals_ += cost.rows();
  cycles_.push_back({&cost, std::move(blocks)});
}

void Evaluations::watch(const ceres::Problem& problem) {
  std::vector<double*> blocks;
  problem.GetParameterBlocks(&blocks);
  for (double* block : blocks) blocks_.emplace_back(block, problem.ParameterBlockSize(block));
}

void Evaluations::restore_last_point() const {
  const auto was_outside = [](const Asked& cycle) { return cycle.cost->was_outside_model(); };
  if (std::any_of(cycles_.begin(), cycles_.end(), was_outside)) return;
  auto value = values_.begin();
  for (const auto& [block, size] : blocks_) {
    std::copy_n(value, size, block);
    value += size;
  }
}

void Evaluations::prepare_cycles(bool with_jacobian) {
  for_cycles(cycles_.size(), residuals_, [&](std::size_t begin, std::size_t end) {
    CycleRows room;
    for (std::size_t i = begin; i < end; ++i) cycles_[i].cost->prepare(cycles_[i].blocks.data(), with_jacobian, room);
  });
}

}  // namespace slipfit::fit
