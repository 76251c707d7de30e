#pragma once

#include <string>

#include "report/html/exhibit.hpp"
#include "slipfit/report/html.hpp"

namespace slipfit::html {

// Parts of the page of one recording, as HTML.
std::string verdict_sentence(const Source& source);
std::string key_numbers(const Source& source);
std::string warnings_part(const Warnings& warnings);
std::string parameters_part(const Source& source);
/// The table alone.
std::string parameter_table(const FitResult& fit);
std::string quality_part(const Source& source);
std::string repeat_part(const Source& source, const ReportOrigin& origin);
/// <section> with the chart, or with the reason why there is none.
std::string exhibit_part(const Exhibit& exhibit);

}  // namespace slipfit::html
