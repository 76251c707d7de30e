#include "io/read_options.hpp"

#include <cmath>

#include "core/unit_text.hpp"
#include "core/word_list.hpp"
#include "slipfit/core/units.hpp"

namespace slipfit::reading {

std::optional<ForceScale> parse_force_scale(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const std::string_view unit = trim(text.substr(slash + 1));
  const auto force = parse_quantity(text.substr(0, slash), Dimension::Force);
  const auto per = read_unit(unit);
  if (!force || unit.empty() || !(std::abs(force.value()) > 0.0)) return std::nullopt;
  return ForceScale{force.value() / (per ? per->factor : 1.0), std::string(unit)};
}

}  // namespace slipfit::reading
