#pragma once

#include <cstddef>
#include <vector>

#include "forward_methods.hpp"

namespace atlas {

/// What a step-by-step method leaves behind: states with cubics between them, and the falls through z = 0.
class Track {
 public:
  struct Node {
    double tau = 0.0, z = 0.0, dz = 0.0;
    bool stuck = false;
  };

  explicit Track(const WaveTimes& times) : times_(times) { nodes_.reserve(1024); }

  void add(const Node& node);
  /// Two falls and all sample times passed, or steps without end.
  [[nodiscard]] bool finished() const;
  /// From the first fall to the second.
  [[nodiscard]] Answer answer() const;

 private:
  static constexpr std::size_t kMostNodes = 3'000'000;

  [[nodiscard]] double wanted_end() const;
  [[nodiscard]] static double between(const Node& from, const Node& to, double tau);
  [[nodiscard]] static double fall_between(const Node& from, const Node& to);

  WaveTimes times_;
  std::vector<Node> nodes_;
  std::vector<double> falls_;
  std::size_t first_fall_node_ = 0;
  bool stuck_between_ = false;
};

}  // namespace atlas
