#include "fit/problem/common_columns.hpp"

#include <algorithm>

namespace slipfit::fit {

using Eigen::Index;

namespace {

bool is_shared(Coordinate coordinate, const Sharing& sharing) {
  return !is_of_recording(coordinate) || (coordinate == kDifference && sharing.difference);
}

}  // namespace

CommonColumns::CommonColumns(const Problem& problem)
    : coordinates_(problem.recordings.size()), of_(problem.recordings.size()) {
  const std::size_t count = problem.recordings.size();
  for (Index i = 0; i < kCoordinates; ++i) {
    const auto coordinate = static_cast<Coordinate>(i);
    std::optional<Index> of_all;
    for (std::size_t r = 0; r < count; ++r) {
      if (!problem.recordings[r].solves_for(coordinate)) continue;
      if (!of_all || !is_shared(coordinate, problem.sweep.sharing)) of_all = size_++;
      coordinates_[r][static_cast<std::size_t>(i)] = of_all;
    }
  }
  for (const BlockFit& recording : problem.recordings) {
    const bool is_again = problem.sweep.sharing.level && !levels_.empty();
    levels_.push_back(is_again ? levels_.front() : size_);
    if (!is_again && recording.columns().has_constant()) ++size_;
  }
  for (const BlockFit& recording : problem.recordings) {
    drifts_.push_back(size_);
    size_ += static_cast<Index>(recording.columns().drift());
  }
  for (std::size_t r = 0; r < count; ++r) {
    const Columns& columns = problem.recordings[r].columns();
    for (const Coordinate coordinate : columns.coordinates()) of_[r].push_back(*find(r, coordinate));
    if (r == 0) {
      of_steady_ = of_[0];
      of_steady_.push_back(levels_[0]);
    }
    if (columns.has_constant()) of_[r].push_back(levels_[r]);
    for (Index i = 0; i < static_cast<Index>(columns.drift()); ++i) of_[r].push_back(drifts_[r] + i);
  }
}

std::vector<Index> CommonColumns::held(const Held& held) const {
  std::vector<Index> columns;
  for (const OfCoordinates& of_recording : coordinates_) {
    for (std::size_t i = 0; i < held.size(); ++i) {
      if (held[i] && of_recording[i]) columns.push_back(*of_recording[i]);
    }
  }
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  return columns;
}

}  // namespace slipfit::fit
