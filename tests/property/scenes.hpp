#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "slipfit/pipeline.hpp"

namespace test {

/// A stick-slip recording of random parameters, as bare numbers that a test can change.
struct Scene {
  std::string described;  ///< the seed and what it drew, for CAPTURE
  std::vector<double> time_s;
  std::vector<double> force_N;
  slipfit::Conditions conditions;
};

/// Well-sampled stick-slip of 30 to 60 cycles with noise and scatter; the same seed gives the same scene everywhere.
Scene random_scene(std::uint64_t seed);

slipfit::Analysis analyse(const Scene& scene);

/// What a transformation of the recording multiplies each parameter by; those not named stay as they are.
using Factors = std::map<std::string, double>;

/// Same kind of motion, same tier, same statuses, and every value and bound as foretold to 1 % of a standard error.
void check_same(const slipfit::Analysis& before, const slipfit::Analysis& after, const Factors& factors = {});

/// The 95 % intervals of every identified parameter overlap.
void check_agree(const slipfit::Analysis& first, const slipfit::Analysis& second);

}  // namespace test
