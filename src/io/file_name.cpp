#include "io/file_name.hpp"

#include <algorithm>
#include <regex>

#include "slipfit/core/units.hpp"

namespace slipfit::reading {
namespace {

constexpr std::size_t kLongestName = 255;

/// Returns a matched number and unit as a quantity, or nothing.
std::optional<double> quantity_in(const std::smatch& match, const std::string& unit, Dimension dimension) {
  std::string number = match[1];
  std::ranges::replace(number, ',', '.');
  const auto value = parse_quantity(number + unit, dimension);
  return value && value.value() > 0.0 ? std::optional(value.value()) : std::nullopt;
}

/// Signs that part words do so once, and neither begin nor end the name.
std::string tidy(const std::string& name) {
  static const std::regex parted("[-_ .]*([-_ .])");
  const std::string single = std::regex_replace(name, parted, "$1");
  const std::size_t begin = single.find_first_not_of("-_ .");
  return begin == std::string::npos ? std::string() : single.substr(begin, single.find_last_not_of("-_ .") + 1 - begin);
}

}  // namespace

FileNameParts read_file_name(const std::string& stem) {
  static const std::regex speed(
      "(?:[vV]-?)?(\\d+(?:[.,]\\d+)?) ?(nm|um|mm|cm|m)(?:_?per_?|p|[-_/ ])?(s|sec|min)(?![A-Za-z0-9])");
  static const std::regex load("(?:^|[-_ ])(?:[fF]n?-?)?(\\d+(?:[.,]\\d+)?) ?(mN|N|kN|g|kg|gf)(?![A-Za-z0-9])");
  static const std::regex repeat("[-_ ](?:run|rep|test|nr|no)?[-_ ]?\\d{1,3}$");
  FileNameParts parts;
  if (stem.size() > kLongestName) return parts;
  std::string rest = stem;
  std::smatch match;
  if (std::regex_search(rest, match, speed)) {
    parts.speed_m_per_s = quantity_in(match, match[2].str() + "/" + match[3].str(), Dimension::Speed);
    rest = match.prefix().str() + match.suffix().str();
  }
  if (std::regex_search(stem, match, load)) parts.normal_force_N = quantity_in(match, match[2], Dimension::Force);
  parts.group = tidy(std::regex_replace(tidy(rest), repeat, ""));
  return parts;
}

}  // namespace slipfit::reading
