#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "core/word_list.hpp"
#include "io/cells.hpp"
#include "io/container/formats.hpp"
#include "io/container/zip_archive.hpp"
#include "io/message.hpp"
#include "surface/read_profile.hpp"

#ifdef SLIPFIT_HAS_XLSX
#include "io/container/xml.hpp"
#endif

// ISO 25178-72: a zip archive whose main.xml says what the numbers in bindata/data.bin, or in the XML itself, are.

namespace slipfit::surface {

#ifdef SLIPFIT_HAS_XLSX

namespace {

using reading::ZipArchive;
constexpr std::size_t kMostXml = std::size_t{256} << 20U;

/// CX, CY or CZ of Record1. An absolute axis has a number for each point, an incremental one a step.
struct Axis {
  bool is_absolute = false;
  char type = 'D';
  double increment = 1.0;  ///< metres of one unit, or of one step: NaN where an incremental axis has none
  double offset = 0.0;     ///< metres

  [[nodiscard]] std::size_t bytes() const { return type == 'I' ? 2 : type == 'D' ? 8 : 4; }
};

/// Reads a number with a decimal point, as the standard demands, or a decimal comma; NaN for anything else.
double xml_number(std::string_view text) {
  const double value = reading::plain_number(trim(text), false);
  return std::isfinite(value) ? value : reading::plain_number(trim(text), true);
}

/// The default holds where the axis has no such field. Error: damaged_surface.
double number_in(const SurfaceFile& file, const pugi::xml_node& axis, const char* field, double absent) {
  const pugi::xml_node node = axis.child(field);
  if (node.empty()) return absent;
  const double value = xml_number(node.text().as_string());
  if (std::isfinite(value)) return value;
  throw damaged_surface(file, fmt::format("{} of axis {} in its main.xml is '{}', expected a number of metres without "
                                          "a unit",
                                          field, axis.name(), reading::printable_utf8(node.text().as_string())));
}

/// `step`: the increment of an incremental axis that states none. Error: damaged_surface.
Axis axis_of(const SurfaceFile& file, const pugi::xml_node& axes, const char* name, double step) {
  const pugi::xml_node node = axes.child(name);
  Axis axis;
  axis.is_absolute = trim(node.child("AxisType").text().as_string("A")).starts_with('A');
  const std::string_view type = trim(node.child("DataType").text().as_string("D"));
  if (type.size() != 1 || std::string_view("ILFD").find(type) == std::string_view::npos) {
    throw damaged_surface(file, fmt::format("DataType of axis {} in its main.xml is '{}', expected I, L, F or D", name,
                                            reading::printable_utf8(type)));
  }
  axis.type = type.front();
  axis.increment = number_in(file, node, "Increment", axis.is_absolute ? 1.0 : step);
  axis.offset = number_in(file, node, "Offset", 0.0);
  return axis;
}

double number_of(std::string_view bytes, std::size_t place, const Axis& axis) {
  const auto as = [&](auto number) {
    std::memcpy(&number, bytes.data() + place, sizeof number);
    return static_cast<double>(number);
  };
  if (axis.type == 'I') return as(std::int16_t{});
  if (axis.type == 'L') return as(std::int32_t{});
  return axis.type == 'F' ? as(float{}) : as(double{});
}

/// The document, and what it says about the points.
struct X3p {
  const SurfaceFile& file;
  const ZipArchive& archive;
  pugi::xml_document document;
  pugi::xml_node record3;
  Axis x, y, z;
  std::size_t columns = 0;
  std::size_t rows = 1;
  std::vector<double> places_m;  ///< of an absolute x axis
};

/// "bindata/data.bin" and the like: of this archive, whatever precedes it.
std::string linked(const X3p& x3p, const char* link, std::size_t most) {
  const std::string name(trim(x3p.record3.child("DataLink").child(link).text().as_string()));
  if (name.empty() || x3p.archive.find(name) == nullptr) {
    throw damaged_surface(x3p.file, "it names a part '" + reading::printable_utf8(name) + "' that it does not contain");
  }
  return x3p.archive.content(name, most);
}

/// A bit of each point: whether it was measured.
void leave_out_invalid(X3p& x3p, std::vector<double>& heights) {
  if (trim(x3p.record3.child("DataLink").child("ValidPointsLink").text().as_string()).empty()) return;
  const std::string valid = linked(x3p, "ValidPointsLink", kMostPoints);
  if (valid.size() < (heights.size() + 7) / 8) throw damaged_surface(x3p.file, "its list of valid points is cut off");
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const auto eight = static_cast<unsigned>(static_cast<unsigned char>(valid[i / 8]));
    if ((eight >> (i % 8) & 1U) == 0U) heights[i] = kHole;
  }
}

std::vector<double> binary_heights_of(X3p& x3p) {
  const std::size_t count = x3p.columns * x3p.rows;
  const std::size_t before = (x3p.x.is_absolute ? x3p.x.bytes() : 0) + (x3p.y.is_absolute ? x3p.y.bytes() : 0);
  const std::size_t point = before + x3p.z.bytes();
  const std::string bytes = linked(x3p, "PointDataLink", count * point + 1024);
  if (bytes.size() / point < count) throw damaged_surface(x3p.file, "it ends before the last point that it announces");
  std::vector<double> heights(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (x3p.x.is_absolute) {
      x3p.places_m.push_back(x3p.x.offset + x3p.x.increment * number_of(bytes, i * point, x3p.x));
    }
    heights[i] = x3p.z.offset + x3p.z.increment * number_of(bytes, i * point + before, x3p.z);
  }
  leave_out_invalid(x3p, heights);
  return heights;
}

/// "x;y;z" a Datum, empty fields where an axis is incremental or nothing was measured.
std::vector<double> listed_heights(X3p& x3p) {
  const std::size_t count = x3p.columns * x3p.rows;
  std::vector<double> heights;
  for (const pugi::xml_node datum : x3p.record3.child("DataList").children("Datum")) {
    if (heights.size() == count) break;
    const std::string_view text = datum.text().as_string();
    const std::size_t last = text.rfind(';');
    const double z = xml_number(last == std::string_view::npos ? text : text.substr(last + 1));
    if (x3p.x.is_absolute) {
      const double x = xml_number(text.substr(0, text.find(';')));
      if (!std::isfinite(x)) continue;
      x3p.places_m.push_back(x3p.x.offset + x3p.x.increment * x);
    }
    heights.push_back(x3p.z.offset + x3p.z.increment * z);
  }
  if (heights.size() < count) throw damaged_surface(x3p.file, "it ends before the last point that it announces");
  return heights;
}

/// Numbers of points along x and y. Several layers (SizeZ) are none of a surface.
void read_sizes(X3p& x3p) {
  const pugi::xml_node matrix = x3p.record3.child("MatrixDimension");
  const auto size = [](const pugi::xml_node& node) {
    std::size_t number = 0;
    const std::string_view text = trim(node.text().as_string());
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() ? number : 0;
  };
  const bool is_grid = !matrix.empty();
  x3p.columns = is_grid ? size(matrix.child("SizeX")) : size(x3p.record3.child("ListDimension"));
  x3p.rows = is_grid ? size(matrix.child("SizeY")) : 1;
  if (x3p.columns == 0 || x3p.rows == 0) throw damaged_surface(x3p.file, "it does not state its number of points");
  if (is_grid && size(matrix.child("SizeZ")) > 1) {
    throw damaged_surface(x3p.file, "it contains several layers; expected one surface");
  }
  check_extent(x3p.columns, x3p.rows, x3p.file.name);
}

HeightMap map_of(X3p& x3p) {
  std::vector<double> heights = x3p.record3.child("DataLink").empty() ? listed_heights(x3p) : binary_heights_of(x3p);
  HeightMap map{x3p.columns, x3p.rows, x3p.x.increment, x3p.y.increment, std::move(heights), true};
  if (x3p.x.is_absolute && x3p.rows == 1) {
    Profile even = value_or_throw(profile_of(std::move(x3p.places_m), std::move(map.values), x3p.file.name));
    map.x_pitch_m = even.pitch_m;
    map.values = std::move(even.height);
    map.columns = map.values.size();
  } else if (x3p.x.is_absolute || (x3p.rows > 1 && x3p.y.is_absolute)) {
    throw ThrownError({"point_cloud", x3p.file.name +
                                          ": a cloud of points, not a grid; export it as a grid (SUR with incremental "
                                          "axes)"});
  }
  const auto is_length = [](double pitch) { return std::isfinite(pitch) && pitch > 0.0; };
  if (!is_length(map.x_pitch_m) || (map.rows > 1 && !is_length(map.y_pitch_m))) {
    throw damaged_surface(x3p.file, "it contains no distance between points");
  }
  return map;
}

ZipArchive open_archive(const SurfaceFile& file) {
  return ZipArchive::open(reading::read_all(*file.stream, file.name), file.name);
}

}  // namespace

HeightMap read_x3p(const SurfaceFile& file) {
  const ZipArchive archive = open_archive(file);
  if (archive.find("main.xml") == nullptr) {
    throw ThrownError(
        {"not_a_surface",
         file.name + ": a zip archive without main.xml, not an X3P file; give X3P, SDF, text or an image"});
  }
  auto document =
      reading::parse_xml(archive.content("main.xml", kMostXml), pugi::parse_minimal | pugi::parse_escapes, file.name);
  if (!document) throw damaged_surface(file, "its main.xml is not XML");
  X3p x3p{file, archive, *std::move(document), {}, {}, {}, {}, 0, 1, {}};
  const pugi::xml_node root = x3p.document.document_element();
  const pugi::xml_node axes = root.child("Record1").child("Axes");
  x3p.record3 = root.child("Record3");
  x3p.x = axis_of(file, axes, "CX", kHole);
  x3p.y = axis_of(file, axes, "CY", kHole);
  x3p.z = axis_of(file, axes, "CZ", 1.0);
  read_sizes(x3p);
  return map_of(x3p);
}

#else

HeightMap read_x3p(const SurfaceFile& file) {
  throw reading::not_built_in(file.name, "an X3P file", "zlib1g-dev, libminizip-dev and libpugixml-dev");
}

#endif

}  // namespace slipfit::surface
