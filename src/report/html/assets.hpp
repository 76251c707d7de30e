#pragma once

#include <string_view>

namespace slipfit::assets {

// Files of src/report/html and of the chart library, embedded by cmake/SlipfitAssets.cmake.
std::string_view page();
std::string_view trace_part();
std::string_view table_part();
std::string_view style();
std::string_view trace_script();
std::string_view table_script();
std::string_view save_script();      ///< of every page
std::string_view dygraphs_script();  ///< empty where the build had no dygraphs
std::string_view dygraphs_style();

}  // namespace slipfit::assets
