// Bytes as a worn surface: text, X3P, SDF. A profile that keeps its promises, or an error of one line; measured in
// bounded time.
#include <cmath>
#include <utility>

#include "demand.hpp"
#include "memory_file.hpp"
#include "slipfit/surface/surface.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  slipfit::ProfileOptions options;
  options.unit_m = 1e-6;
  auto read = slipfit::read_profile(file.name(), options);
  if (!read) {
    fuzz::demand_readable(read.error());
    return 0;
  }
  const slipfit::Profile profile = std::move(read).value();
  fuzz::demand(profile.height.size() >= 1, "a profile has points");
  if (profile.height.size() > 3000) return 0;
  const auto measured = slipfit::measure_surface(profile);
  if (!measured) {
    fuzz::demand_readable(measured.error());
    return 0;
  }
  const slipfit::Estimate& spacing_m = measured.value().spacing_m;
  fuzz::demand(!spacing_m.value || (std::isfinite(*spacing_m.value) && *spacing_m.value > 0.0), "spacing > 0");
  fuzz::demand(!spacing_m.ci95 || (spacing_m.ci95->low <= *spacing_m.value && *spacing_m.value <= spacing_m.ci95->high),
               "a spacing stands in its interval");
  return 0;
}
