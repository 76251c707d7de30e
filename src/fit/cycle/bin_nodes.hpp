#pragma once

#include <array>
#include <cmath>
#include <span>

#include "fit/cycle/cycle_data.hpp"

namespace slipfit::fit {

/// Holds the times within a stick bin at which a smooth curve gives its mean and its least-squares slope over the
/// samples of the bin, taken as evenly spread: Gauss's nodes over a width whose centred square is that of the samples.
class BinNodes {
 public:
  struct Node {
    double time_s = 0.0;
    double mean = 0.0;         ///< share of the value in the mean
    double slope_per_s = 0.0;  ///< of the value in the slope
  };

  explicit BinNodes(const StickBin& bin) {
    nodes_[0] = {bin.time_s, 1.0, 0.0};
    if (bin.count < 2.0 || !(bin.time_spread > 0.0)) return;
    constexpr std::array kPlaces{0.5384693101056831, 0.9061798459386640};
    constexpr std::array kWeights{0.4786286704993665, 0.2369268850561891};
    constexpr double kMiddle = 0.5688888888888889;
    nodes_[0].mean = 0.5 * kMiddle;
    const double half_s = std::sqrt(3.0 * bin.time_spread / bin.count);
    for (std::size_t i = 0; i < kPlaces.size(); ++i) {
      for (const double side : {-1.0, 1.0}) {
        nodes_[count_++] = {bin.time_s + side * half_s * kPlaces[i], 0.5 * kWeights[i],
                            side * 1.5 * kWeights[i] * kPlaces[i] / half_s};
      }
    }
  }

  [[nodiscard]] std::span<const Node> nodes() const& { return {nodes_.data(), count_}; }
  [[nodiscard]] std::span<const Node> nodes() const&& = delete;

 private:
  std::array<Node, 5> nodes_{};
  std::size_t count_ = 1;
};

}  // namespace slipfit::fit
