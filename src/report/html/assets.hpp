#pragma once

#include <string_view>

namespace slipfit::assets {

// Files of src/report/html, embedded by cmake/SlipfitAssets.cmake.
std::string_view page();
std::string_view trace_part();
std::string_view table_part();
std::string_view style();
std::string_view trace_script();
std::string_view table_script();
std::string_view save_script();  ///< of every page

}  // namespace slipfit::assets
