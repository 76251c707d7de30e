#include "surface/read_profile.hpp"

#include <fmt/format.h>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "io/columns.hpp"
#include "io/container/formats.hpp"
#include "io/message.hpp"
#include "io/opened_file.hpp"
#include "io/text_lines.hpp"
#include "slipfit/core/units.hpp"
#include "slipfit/surface/surface.hpp"

namespace slipfit {

namespace surface {

ThrownError damaged_surface(const SurfaceFile& file, const std::string& what) {
  return ThrownError({"damaged_surface", file.name + ": " + what + "; copy or export the file again"});
}

std::string whole_file(const SurfaceFile& file, std::size_t most) {
  auto bytes = reading::read_all(*file.stream->bytes, most);
  if (!bytes) throw map_too_large(file.name);
  return *std::move(bytes);
}

namespace {

using namespace std::string_view_literals;
enum class Kind { Text, Sdf, X3p, Image };

struct Magic {
  std::string_view start;
  Kind kind = Kind::Text;
  bool is_jpeg = false;
};

constexpr std::array kMagics = std::to_array<Magic>({{"aISO-1.0"sv, Kind::Sdf},
                                                     {"aBCR-1.0"sv, Kind::Sdf},
                                                     {"bISO-1.0"sv, Kind::Sdf},
                                                     {"bBCR-1.0"sv, Kind::Sdf},
                                                     {"PK\x03\x04"sv, Kind::X3p},
                                                     {"\x89PNG\r\n\x1a\n"sv, Kind::Image},
                                                     {"\xFF\xD8\xFF"sv, Kind::Image, true},
                                                     {"II*\0"sv, Kind::Image},
                                                     {"MM\0*"sv, Kind::Image}});

/// The blocks of eight pixels that JPEG codes an image in show along its axes.
void note_blocks(Profile& profile) {
  const double c = std::abs(std::cos(profile.along_rad.value_or(0.0)));
  if (c > 0.99 || c < 0.14) profile.block_samples = 8.0;
}

Profile read(const SurfaceFile& file, const Magic& magic, const ProfileOptions& options) {
  if (magic.kind == Kind::Text) return read_text_profile(file, options);
  const HeightMap map = magic.kind == Kind::Sdf   ? read_sdf(file)
                        : magic.kind == Kind::X3p ? read_x3p(file)
                                                  : read_image(file, options);
  if (map.values.size() < 2) throw damaged_surface(file, "it contains no points");
  Profile profile = profile_of(map, options.along_rad);
  if (magic.is_jpeg) note_blocks(profile);
  return profile;
}

}  // namespace
}  // namespace surface

Result<Profile> read_profile(const std::filesystem::path& file, const ProfileOptions& options) {
  const std::string name = reading::name_of_file(file);
  return reading::with_errors_of_reading(name, [&] {
    const surface::SurfaceFile opened{name, std::make_shared<reading::TextStream>(reading::open_plain(file))};
    const std::shared_ptr<const Digester> digester = opened.stream->digester;
    surface::Magic found;
    for (const surface::Magic& magic : surface::kMagics) {
      if (opened.stream->start.starts_with(magic.start)) found = magic;
    }
    Profile profile = surface::read(opened, found, options);
    profile.file = name;
    profile.inputs = {{name, digester->digest(), digester->bytes()}};
    return profile;
  });
}

}  // namespace slipfit

namespace slipfit::surface {

HeightMap read_image(const SurfaceFile& file, const ProfileOptions& options) {
  if (!options.pixel_m) {
    throw ThrownError(
        {"no_pixel", file.name + ": an image; state the size of its pixels on the surface: --pixel 2.1um"});
  }
  const reading::HelperOutput output =
      reading::run_helper({"slipfit-image", {reading::kFileOfHelper}, "an image", "libleptonica-dev"},
                          reading::file_in_memory(*file.stream->bytes, file.name), file.name);
  HeightMap map{0, 0, *options.pixel_m, *options.pixel_m, {}, false};
  if (std::sscanf(output.first.c_str(), "%zux%zu", &map.columns, &map.rows) != 2 || map.columns == 0 || map.rows == 0) {
    throw damaged_surface(file, "the image is damaged");
  }
  check_extent(map.columns, map.rows, file.name);
  const std::size_t count = map.columns * map.rows;
  map.values.reserve(count);
  std::array<char, 65536> part{};
  while (map.values.size() < count) {
    const std::size_t got = output.bytes->read(part.data(), part.size());
    if (got == 0) throw damaged_surface(file, "the image is damaged");
    for (std::size_t i = 0; i + 1 < got && map.values.size() < count; i += 2) {
      map.values.push_back(static_cast<unsigned char>(part[i]) + 256.0 * static_cast<unsigned char>(part[i + 1]));
    }
  }
  return map;
}

namespace {

using reading::CellKind;
using reading::Column;
using reading::Layout;

/// The columns to read; without positions the pitch defines them.
struct Choice {
  std::optional<std::size_t> x;
  std::size_t z = 0;
};

/// The column that an option names.
std::optional<std::size_t> named(const Layout& layout, const std::optional<std::string>& wanted, const char* option,
                                 const std::string& file) {
  if (!wanted) return std::nullopt;
  return reading::find_column(layout, *wanted, option, file);
}

bool is_counter(const Column& column) {
  return column.is_whole && column.is_regular && column.median_step == 1.0 && column.name.unit.empty();
}

/// Places rise along the track in (nearly) even steps; heights are what is left.
Choice choose(const Layout& layout, const ProfileOptions& options, const std::string& file) {
  Choice choice{named(layout, options.x_column, "--x-column", file), 0};
  const std::optional<std::size_t> z = named(layout, options.z_column, "--z-column", file);
  std::vector<std::size_t> heights;
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    const Column& column = layout.columns[c];
    if (!column.is_numeric() || c == z || c == choice.x) continue;
    if (column.never_decreases && is_counter(column) && layout.columns.size() > 2) continue;
    if (!choice.x && column.never_decreases && !options.pitch_m) {
      choice.x = c;
    } else {
      heights.push_back(c);
    }
  }
  if (z) heights = {*z};
  if (heights.empty()) {
    throw ThrownError({"no_numeric_column", file + ": no column of heights found; choose it with --z-column"});
  }
  choice.z = heights.front();
  if (heights.size() == 1) return choice;
  throw ThrownError({"ambiguous_columns",
                     fmt::format("{}: several columns may be the heights: {}; choose with --z-column (and --x-column)",
                                 file, reading::list_columns(layout))});
}

/// Returns the metres of one unit of a column; empty if the unit is unknown.
std::optional<double> scale_of(const Column& column, const ProfileOptions& options) {
  if (options.unit_m) return options.unit_m;
  const auto unit = parse_unit(column.name.unit, Dimension::Length);
  return unit && !column.name.unit.empty() ? std::optional<double>(unit.value()) : std::nullopt;
}

struct Columns {
  std::vector<double> x, z;
};

Columns read_columns(reading::OpenedFile file, const Choice& choice) {
  Columns columns;
  const reading::Dialect dialect = file.layout.dialect;
  const auto first = static_cast<unsigned>(file.layout.first_data_line);
  const std::string name = file.name;
  reading::ParsedLines lines(std::move(file.source));
  std::vector<std::string_view> cells;
  while (const char* const line = lines.next()) {
    if (lines.number() < first) continue;
    reading::split(line, dialect, cells);
    const auto number = [&](std::size_t column) {
      if (column >= cells.size()) return std::pair(CellKind::Text, kHole);
      const reading::Cell cell = reading::read_cell(cells[column], dialect.decimal_comma);
      return std::pair(cell.kind, cell.kind == CellKind::Number ? cell.value : kHole);
    };
    const auto [kind, height] = number(choice.z);
    const double place = choice.x ? number(*choice.x).second : 0.0;
    // A line of text is none of the profile; a place without a height is a hole.
    if (!std::isfinite(place) || kind == CellKind::Text || (!choice.x && kind == CellKind::Blank)) continue;
    if (choice.x) columns.x.push_back(place);
    columns.z.push_back(height);
    check_extent(columns.z.size(), 1, name);
  }
  return columns;
}

/// The columns as a profile, in metres where their units are known.
Profile made(Columns columns, const Choice& choice, const Layout& layout, const ProfileOptions& options,
             const std::string& file) {
  const std::optional<double> z_scale = scale_of(layout.columns[choice.z], options);
  for (double& z : columns.z) z *= z_scale.value_or(1.0);
  Profile profile;
  if (choice.x) {
    const double x_scale = *scale_of(layout.columns[*choice.x], options);
    for (double& x : columns.x) x *= x_scale;
    profile = value_or_throw(profile_of(std::move(columns.x), std::move(columns.z), file));
    profile.assumed.push_back("Positions along the track are " + reading::describe(layout, *choice.x) + ".");
  } else {
    profile.pitch_m = *options.pitch_m;
    profile.height = std::move(columns.z);
  }
  profile.assumed.push_back("Heights are " + reading::describe(layout, choice.z) + ".");
  profile.height_in_metres = z_scale.has_value();
  if (!z_scale) profile.assumed.emplace_back("The heights have no unit: their height is in that of the file.");
  return profile;
}

}  // namespace

Profile read_text_profile(const SurfaceFile& file, const ProfileOptions& options) {
  reading::OpenedFile opened =
      reading::open_file(reading::open_container(std::move(*file.stream), file.name, {}), file.name, {});
  const Layout layout = opened.layout;
  const Choice choice = choose(layout, options, file.name);
  if (!choice.x && !options.pitch_m) {
    throw ThrownError(
        {"no_pitch", file.name + ": a column of heights alone; state the distance between them: --pitch 1um"});
  }
  if (choice.x && !scale_of(layout.columns[*choice.x], options)) {
    throw ThrownError({"no_unit", fmt::format("{}: {} has no unit of length; state it with --unit um", file.name,
                                              reading::describe(layout, *choice.x))});
  }
  return made(read_columns(std::move(opened), choice), choice, layout, options, file.name);
}

}  // namespace slipfit::surface
