#include "fit/problem/common_columns.hpp"

namespace slipfit::fit {

using Eigen::Index;

CommonColumns::CommonColumns(const Problem& problem) {
  const std::size_t count = problem.recordings.size();
  const auto globals = static_cast<Index>(problem.recordings.front().model(0).globals());
  size_ = globals;
  if (problem.recordings.front().model(0).has_exponent()) exponent_ = size_++;
  for (const BlockFit& recording : problem.recordings) {
    if (recording.model(0).has_sensor_time() && !sensor_time_) sensor_time_ = size_++;
  }
  const auto add = [&](std::vector<Index>& columns, auto&& width_of, bool shared) {
    for (std::size_t r = 0; r < count; ++r) {
      const Index width = width_of(problem.recordings[r]);
      const bool again = shared && r > 0;
      columns.push_back(again ? columns.front() : size_);
      if (!again) size_ += width;
    }
  };
  const auto constants = [](const BlockFit& r) { return r.model(0).has_constant() ? Index{1} : Index{0}; };
  const auto populations = [](const BlockFit& r) { return r.scales().population ? Index{1} : Index{0}; };
  const auto drifts = [](const BlockFit& r) { return static_cast<Index>(r.model(0).drift_parameters()); };
  add(levels_, constants, problem.sweep.sharing.level);
  add(differences_, populations, problem.sweep.sharing.difference);
  add(drifts_, drifts, false);
  for (std::size_t r = 0; r < count; ++r) {
    const BlockFit& recording = problem.recordings[r];
    of_.emplace_back();
    for (Index i = 0; i < globals; ++i) of_.back().push_back(i);
    if (exponent_) of_.back().push_back(*exponent_);
    if (recording.model(0).has_sensor_time()) of_.back().push_back(*sensor_time_);
    if (populations(recording) > 0) of_.back().push_back(differences_[r]);
    if (constants(recording) > 0) of_.back().push_back(levels_[r]);
    for (Index i = 0; i < drifts(recording); ++i) of_.back().push_back(drifts_[r] + i);
  }
}

std::vector<Index> CommonColumns::of_steady(std::size_t globals) const {
  std::vector<Index> columns(of_.front().begin(), of_.front().begin() + static_cast<std::ptrdiff_t>(globals));
  columns.push_back(levels_.front());
  return columns;
}

Held held_in(const Problem& problem, Held held) {
  for (std::size_t i = problem.recordings.front().model(0).globals(); i < held.size(); ++i) held[i] = false;
  return held;
}

}  // namespace slipfit::fit
