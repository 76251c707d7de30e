// slipfit-image FILE: grey values of a PNG, TIFF or JPEG on standard output, for slipfit: "=WIDTHxHEIGHT", a line end,
// then two bytes a pixel, the lower first, row by row. "!CODE MESSAGE" where something is wrong. A program of its own:
// the libraries take several others with them, and a damaged file that ends them ends nothing else.
#include <leptonica/allheaders.h>

#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../helper_limits.hpp"

namespace {

struct Destroy {
  void operator()(Pix* image) const { pixDestroy(&image); }
};
using Image = std::unique_ptr<Pix, Destroy>;

constexpr std::int64_t kMostPixels = std::int64_t{64} << 20U;

constexpr rlim_t kMostMemory = rlim_t{2} << 30U;
constexpr rlim_t kMostSeconds = 60;

int refuse(const char* line) {
  std::printf("!%s\n", line);
  std::fflush(stdout);
  return 1;
}

/// Eight or sixteen bits a pixel, without colours.
Image grey(Image image) {
  if (pixGetDepth(image.get()) == 16) return image;
  return Image(pixConvertTo8(image.get(), 0));
}

bool write(const Image& image) {
  const int width = pixGetWidth(image.get());
  const int height = pixGetHeight(image.get());
  const bool is_deep = pixGetDepth(image.get()) == 16;
  std::printf("=%dx%d\n", width, height);
  std::vector<unsigned char> row(2 * static_cast<std::size_t>(width));
  for (int y = 0; y < height; ++y) {
    const l_uint32* const line = pixGetData(image.get()) + static_cast<std::ptrdiff_t>(y) * pixGetWpl(image.get());
    for (int x = 0; x < width; ++x) {
      const unsigned value = is_deep ? GET_DATA_TWO_BYTES(line, x) : GET_DATA_BYTE(line, x);
      row[2 * static_cast<std::size_t>(x)] = static_cast<unsigned char>(value & 255U);
      row[2 * static_cast<std::size_t>(x) + 1] = static_cast<unsigned char>(value >> 8U);
    }
    if (std::fwrite(row.data(), 1, row.size(), stdout) != row.size()) return false;
  }
  return std::fflush(stdout) == 0;
}

int run(const char* name) {
  const std::string_view file = map_only_file(name);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): Leptonica's
  const auto* const bytes = reinterpret_cast<const l_uint8*>(file.data());
  setMsgSeverity(L_SEVERITY_NONE);
  l_int32 format = 0;
  l_int32 width = 0;
  l_int32 height = 0;
  if (pixReadHeaderMem(bytes, file.size(), &format, &width, &height, nullptr, nullptr, nullptr) != 0) {
    return refuse("damaged_surface the image is damaged or of an unsupported kind; save it as PNG");
  }
  if (static_cast<std::int64_t>(width) * height > kMostPixels) {
    return refuse("map_too_large the image has more than 64 million pixels; crop it to the track");
  }
  Image image(pixReadMem(bytes, file.size()));
  if (image) image = grey(std::move(image));
  if (!image) return refuse("damaged_surface the image is damaged; save it as PNG");
  return write(image) ? 0 : 1;
}

int run_or_refuse(const char* name) {
  try {
    return run(name);
  } catch (const std::exception&) {
    return refuse("map_too_large the image needs more memory than is available; crop it to the track");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  end_with_slipfit();
  limit_resources(kMostMemory, kMostSeconds);
  end_program(run_or_refuse(argv[1]));
}
