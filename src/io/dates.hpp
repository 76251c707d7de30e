#pragma once

#include <optional>
#include <string_view>

namespace slipfit::reading {

struct DateStart {
  double midnight_s = 0.0;  ///< since 1970
  std::string_view clock;   ///< what stands behind the date, without a time zone
};

/// Of "2024-05-12T12:22:17.5Z", "2024/05/12 12:22:17", "12.05.2024 12:22:17,5". Empty where no date begins the text, or
/// nothing follows it.
std::optional<DateStart> read_date(std::string_view text);

}  // namespace slipfit::reading
