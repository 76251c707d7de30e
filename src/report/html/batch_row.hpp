#pragma once

#include <string>

#include "report/batch_html.hpp"

namespace slipfit::html {

/// <thead> and <tr> of the table.
std::string batch_headings();
std::string batch_row(const BatchPageRow& row);

}  // namespace slipfit::html
