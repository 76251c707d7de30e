#include "fit/problem/cycle_cost.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace slipfit;
using namespace slipfit::fit;

namespace {

/// A slip of k = 1 N/m and w_n = 1 rad/s at 1 m/s that falls from 2 N above the level, in 40 samples.
CycleSet one_cycle(const Scales& scales) {
  CycleData data;
  for (int i = 0; i < 40; ++i) {
    data.samples.push_back(data.samples.size());
    data.time_s.push_back(-1.0 + 0.15 * i);
    data.force.push_back(2.0 - 0.1 * i);
  }
  data.window_begin_s = data.time_s.front();
  data.window_end_s = data.time_s.back();
  return {{data}, {0.0}, LevelModel{}, scales};
}

struct Values {
  bool is_inside = false;
  std::vector<double> residuals, globals, level, own;

  friend bool operator==(const Values&, const Values&) = default;
};

Values evaluate(const CycleCost& cost, const std::vector<const double*>& point, bool with_jacobian) {
  const auto rows = static_cast<std::size_t>(cost.num_residuals());
  Values values{false, std::vector<double>(rows), std::vector<double>(3 * rows), std::vector<double>(rows),
                std::vector<double>(2 * rows)};
  std::vector<double*> jacobians{values.globals.data(), values.level.data(), values.own.data()};
  values.is_inside = cost.Evaluate(point.data(), values.residuals.data(), with_jacobian ? jacobians.data() : nullptr);
  return values;
}

}  // namespace

TEST_CASE("fit: what is prepared of a cycle is what is evaluated without") {
  Scales scales;
  scales.speed_m_per_s = 1.0;
  scales.time_begin_s = -1.0;
  scales.time_end_s = 5.0;
  const CycleSet set = one_cycle(scales);
  const CycleModel model(set, 0, scales);
  CycleRows room, other_room;
  const CycleCost plain(model, room);
  CycleCost prepared(model, room);
  const bool with_jacobian = GENERATE(false, true);
  const double damping = GENERATE(0.05, 2.0);  // 2: no solution
  const std::vector<double> globals{0.0, 0.0, damping}, level{0.1}, own{0.0, 2.0}, other_own{0.1, 1.5};
  const std::vector<const double*> point{globals.data(), level.data(), own.data()};
  const std::vector<const double*> other_point{globals.data(), level.data(), other_own.data()};
  const Values expected = evaluate(plain, point, with_jacobian);
  CHECK(expected.is_inside == (damping < 1.0));

  prepared.prepare(point.data(), with_jacobian, other_room);
  CHECK(evaluate(prepared, point, with_jacobian) == expected);
  CHECK(evaluate(prepared, point, true) == evaluate(plain, point, true));  // more than was prepared
  prepared.forget();
  prepared.prepare(other_point.data(), with_jacobian, other_room);
  CHECK(evaluate(prepared, other_point, with_jacobian) == evaluate(plain, other_point, with_jacobian));
  if (expected.is_inside) CHECK_FALSE(evaluate(prepared, other_point, with_jacobian) == expected);
}
