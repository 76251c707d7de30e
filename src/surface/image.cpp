#include <array>
#include <utility>

#include "io/container/formats.hpp"
#include "surface/readers.hpp"

namespace slipfit::surface {

HeightMap read_image(const SurfaceFile& file, const ProfileOptions& options) {
  if (!options.pixel_m) {
    throw ThrownError(
        {"no_pixel", file.name + ": an image; state the size of its pixels on the surface: --pixel 2.1um"});
  }
  const reading::HelperOutput output = reading::run_helper(
      {"slipfit-image", {reading::kFileOfHelper}, "an image", "libleptonica-dev"}, std::move(*file.stream), file.name);
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

}  // namespace slipfit::surface
