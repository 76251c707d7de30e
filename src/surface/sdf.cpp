#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <string_view>
#include <type_traits>

#include "core/word_list.hpp"
#include "io/cells.hpp"
#include "surface/read_profile.hpp"

// ISO 25178-71: a header of fixed fields, then NumProfiles rows of NumPoints heights in steps of Zscale.

namespace slipfit::surface {
namespace {

constexpr std::size_t kBinaryHeader = 81;

struct SdfHeader {
  double points = 0.0;
  double profiles = 0.0;
  double x_scale_m = 0.0;
  double y_scale_m = 0.0;
  double z_scale_m = 0.0;
  double compression = 0.0;
  double type = -1.0;
};

/// Reads a little-endian number; the caller has checked that `place` is inside.
template <class Number>
Number number_at(std::string_view bytes, std::size_t place) {
  Number number{};
  std::memcpy(&number, bytes.data() + place, sizeof number);
  return number;
}

SdfHeader binary_header(std::string_view bytes) {
  constexpr std::size_t kNumPoints = 8 + 10 + 12 + 12;
  constexpr std::size_t kScales = kNumPoints + 4;
  return {static_cast<double>(number_at<std::uint16_t>(bytes, kNumPoints)),
          static_cast<double>(number_at<std::uint16_t>(bytes, kNumPoints + 2)),
          number_at<double>(bytes, kScales),
          number_at<double>(bytes, kScales + 8),
          number_at<double>(bytes, kScales + 16),
          static_cast<double>(number_at<std::uint8_t>(bytes, kScales + 32)),
          static_cast<double>(number_at<std::uint8_t>(bytes, kScales + 33))};
}

/// "Name = value" a line, up to a line that begins with an asterisk; `rest` is what follows it.
SdfHeader text_header(std::string_view bytes, std::string_view& rest) {
  std::map<std::string, double> fields;
  rest = {};
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t end = std::min(bytes.find_first_of("\r\n", begin), bytes.size());
    const std::string_view line = trim(bytes.substr(begin, end - begin));
    begin = end + 1;
    if (line.starts_with('*')) {
      rest = bytes.substr(std::min(begin, bytes.size()));
      break;
    }
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) continue;
    fields[lower(trim(line.substr(0, equals)))] = reading::plain_number(trim(line.substr(equals + 1)), false);
  }
  const auto value = [&](const char* name) { return fields.contains(name) ? fields.at(name) : kHole; };
  return {value("numpoints"), value("numprofiles"), value("xscale"),  value("yscale"),
          value("zscale"),    value("compression"), value("datatype")};
}

bool is_count(double number) {
  return number >= 1.0 && number <= static_cast<double>(kMostPoints) && number == std::floor(number);
}

/// Returns the defect of the header, or an empty text.
std::string fault_of(const SdfHeader& header) {
  if (!is_count(header.points) || !is_count(header.profiles))
    return "its header contains no numbers of points and profiles";
  const auto is_length = [](double scale) { return std::isfinite(scale) && scale > 0.0; };
  if (!is_length(header.x_scale_m)) return "its header contains no distance between points (Xscale)";
  if (header.profiles > 1.0 && !is_length(header.y_scale_m))
    return "its header contains no distance between profiles (Yscale)";
  if (!is_length(header.z_scale_m)) return "its header contains no scale of the heights (Zscale)";
  if (header.compression > 0.0) return "its heights are compressed in a format that the standard does not define";
  return {};
}

/// The lowest integer marks points that were not measured (ISO 25178-71).
template <class Number>
std::vector<double> heights_of(std::string_view bytes, std::size_t count, double scale) {
  std::vector<double> heights(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = number_at<Number>(bytes, i * sizeof(Number));
    const bool is_hole =
        std::is_integral_v<Number> && std::is_signed_v<Number> && number == std::numeric_limits<Number>::lowest();
    heights[i] = is_hole ? kHole : static_cast<double>(number) * scale;
  }
  return heights;
}

struct HeightType {
  std::size_t bytes = 0;
  std::vector<double> (*read)(std::string_view bytes, std::size_t count, double scale) = nullptr;
};

template <class Number>
constexpr HeightType kHeightType{sizeof(Number), heights_of<Number>};

/// Types of the heights by the number of the data type.
constexpr std::array kHeightTypes{kHeightType<std::uint8_t>, kHeightType<std::uint16_t>, kHeightType<std::uint32_t>,
                                  kHeightType<float>,        kHeightType<std::int8_t>,   kHeightType<std::int16_t>,
                                  kHeightType<std::int32_t>, kHeightType<double>};

std::vector<double> binary_heights(const SurfaceFile& file, std::string_view bytes, std::size_t count,
                                   const SdfHeader& header) {
  if (!(header.type >= 0.0 && header.type <= 7.0))
    throw damaged_surface(file, "its data type is not defined by the standard");
  const HeightType& type = kHeightTypes.at(static_cast<std::size_t>(header.type));
  if (bytes.size() / type.bytes < count)
    throw damaged_surface(file, "it ends before the last height that its header announces");
  return type.read(bytes, count, header.z_scale_m);
}

/// Numbers parted by blanks or line ends; a word ("BAD") where nothing was measured.
std::vector<double> text_heights(const SurfaceFile& file, std::string_view text, std::size_t count, double scale) {
  constexpr std::string_view kBlanks = " \t\r\n,;";
  std::vector<double> heights;
  std::size_t begin = text.find_first_not_of(kBlanks);
  while (begin < text.size() && text[begin] != '*' && heights.size() < count) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
    heights.push_back(scale * reading::plain_number(text.substr(begin, end - begin), false));
    begin = text.find_first_not_of(kBlanks, end);
  }
  if (heights.size() < count) throw damaged_surface(file, "it ends before the last height that its header announces");
  return heights;
}

}  // namespace

HeightMap read_sdf(const SurfaceFile& file) {
  const std::string content = whole_file(file, std::size_t{1} << 30U);
  const std::string_view bytes = content;
  const bool is_binary = bytes.starts_with('b');
  if (is_binary && bytes.size() < kBinaryHeader) throw damaged_surface(file, "its header is cut off");
  std::string_view data = bytes.substr(std::min(kBinaryHeader, bytes.size()));
  const SdfHeader header = is_binary ? binary_header(bytes) : text_header(bytes, data);
  if (const std::string fault = fault_of(header); !fault.empty()) throw damaged_surface(file, fault);
  check_extent(static_cast<std::size_t>(header.points), static_cast<std::size_t>(header.profiles), file.name);
  HeightMap map{static_cast<std::size_t>(header.points),
                static_cast<std::size_t>(header.profiles),
                header.x_scale_m,
                header.y_scale_m,
                {},
                true};
  const std::size_t count = map.columns * map.rows;
  map.values =
      is_binary ? binary_heights(file, data, count, header) : text_heights(file, data, count, header.z_scale_m);
  return map;
}

}  // namespace slipfit::surface
