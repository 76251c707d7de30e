// Bytes as a manifest: rows that keep their promises, errors of one line, and an end.
#include <cmath>
#include <utility>

#include "demand.hpp"
#include "memory_file.hpp"
#include "slipfit/io/manifest.hpp"

namespace {

void check(const slipfit::ManifestEntry& entry) {
  fuzz::demand(fuzz::is_one_line(entry.id) && entry.id.find('/') == std::string::npos, "an id is a name: " + entry.id);
  fuzz::demand(!entry.id.starts_with("group:"), "an id is not one of a group");
  fuzz::demand(std::isfinite(entry.conditions.speed_m_per_s) && entry.conditions.speed_m_per_s >= 0.0,
               "speed, or 0: a column tells it");
  const auto& normal_N = entry.conditions.normal_force_N;
  fuzz::demand(!normal_N || (std::isfinite(*normal_N) && *normal_N > 0.0), "normal force > 0");
  const auto& rate_Hz = entry.options.sample_rate_Hz;
  fuzz::demand(!rate_Hz || (std::isfinite(*rate_Hz) && *rate_Hz > 0.0), "sampling rate > 0");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  auto opened = slipfit::ManifestReader::open(file.name());
  if (!opened) {
    fuzz::demand_readable(opened.error());
    return 0;
  }
  slipfit::ManifestReader reader = std::move(opened).value();
  // A line gives one row or error at most.
  for (std::size_t rows = 0; rows <= size + 1; ++rows) {
    const auto entry = reader.next();
    if (!entry) {
      fuzz::demand_readable(entry.error());
      if (entry.error().code == "not_readable") return 0;
      continue;
    }
    if (!entry.value()) {
      if (const auto group = slipfit::read_manifest_group(file.name(), "a"); !group) {
        fuzz::demand_readable(group.error());
      }
      return 0;
    }
    check(*entry.value());
  }
  fuzz::demand(false, "reading a manifest ends");
  return 0;
}
