#include "failure_plane.hpp"

#include <fmt/format.h>

namespace atlas {
namespace {

const char* word_of(Mark mark) {
  switch (mark) {
    case Mark::Right:
      return "right";
    case Mark::Refused:
      return "refused";
    case Mark::Weak:
      return "weak";
    case Mark::Wrong:
      break;
  }
  return "wrong";
}

}  // namespace

std::string failure_columns() {
  return "map,method,x,y,answer\n";
}

std::string judge_plane(const Plane& plane, const std::string& method, const Judge& judge) {
  std::string rows;
  for (const double x : plane.x) {
    for (const double y : plane.y) {
      rows += fmt::format("{},\"{}\",{:.6g},{:.6g},{}\n", plane.name, method, x, y, word_of(judge(x, y)));
    }
  }
  return rows;
}

std::string judge_factors(const Plane& plane, const std::string& method, double Factors::*x, double Factors::*y,
                          const std::function<Mark(const Factors&)>& judge) {
  return judge_plane(plane, method, [&](double at_x, double at_y) {
    Factors factors;
    factors.*x = at_x;
    factors.*y = at_y;
    return judge(factors);
  });
}

std::vector<File> map_failures(Effort effort) {
  return {{"failures.csv", failure_columns() + map_forward_failures(effort) + map_frequency_failures(effort) +
                               map_fit_failures(effort)}};
}

}  // namespace atlas
