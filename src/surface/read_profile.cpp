#include <array>
#include <cmath>
#include <string_view>

#include "io/container/byte_stream.hpp"
#include "io/message.hpp"
#include "io/opened_file.hpp"
#include "slipfit/surface/surface.hpp"
#include "surface/readers.hpp"

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
