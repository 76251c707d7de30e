#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenes.hpp"

namespace test {

/// A change of a recording that leaves its physics as it is: `change` changes samples and conditions alike, `factors`
/// says what each number of the answer is then multiplied by.
struct Transform {
  std::string name;
  std::function<Scene(Scene)> change;
  Factors factors;
  double allowed_errors = 0.3;  ///< standard errors by which a number may differ
  bool is_certain = true;       ///< else the answer may differ for a good reason
};

/// Sensor zero, sign, unit of force, speed and start of the clock, lost samples. `seed` chooses the lost samples. Where
/// the zero is moved so far that the force turns negative, only its shape shows that its sign has not been turned: not
/// certain.
std::vector<Transform> invariances(std::uint64_t seed);

/// How two answers to what is the same recording differ; empty where they agree.
struct Differences {
  bool in_motion = false;                 ///< the kind of motion
  std::vector<std::string> in_numbers;    ///< numbers that are too far apart
  std::vector<std::string> in_knowledge;  ///< numbers that only one of the two answers has

  [[nodiscard]] bool any() const { return in_motion || !in_numbers.empty() || !in_knowledge.empty(); }
  [[nodiscard]] std::string text() const;
};

Differences differences(const slipfit::Analysis& before, const slipfit::Analysis& after, const Transform& transform);

/// The answer to a scene that is read as a file with these two columns would be.
slipfit::Analysis analyse_as_read(const Scene& scene);

}  // namespace test
