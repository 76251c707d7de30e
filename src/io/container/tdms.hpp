#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slipfit::reading {

constexpr std::uint32_t kTdmsTimeStamp = 0x44;

/// A channel with its values, and the position of the reader in it.
struct TdmsChannel {
  std::string path;
  std::string unit;
  std::optional<double> increment_s;
  double offset_s = 0.0;
  bool is_scaled = false;  ///< its integers mean something else
  bool is_daqmx = false;
  bool has_data = false;  ///< in this segment
  std::uint32_t type = 0;
  std::uint64_t count = 0;  ///< values in a block
  std::uint64_t bytes = 0;  ///< of a block
  std::vector<double> values;
};

struct TdmsContent {
  std::vector<TdmsChannel> channels;  ///< in the order in which they appear
  std::uint64_t bytes_left_over = 0;  ///< of a block that is not whole, which a writer that was stopped leaves
};

/// Returns the contents of a TDMS file, or nothing if it is damaged or truncated other than between values.
std::optional<TdmsContent> read_tdms(std::string_view file);

}  // namespace slipfit::reading
