#include <fmt/format.h>

#include "analysis/rules.hpp"
#include "report/blocks.hpp"
#include "report/text_sections.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {
std::string warnings_text(const Warnings& warnings) {
  std::string doubts;
  std::string facts;
  for (const Warning& warning : warnings) {
    (is_fact(warning) ? facts : doubts) +=
        wrapped_text(is_fact(warning) ? "  - " : "  ! ", printable(warning.message + " [" + warning.code + "]"));
  }
  return (doubts.empty() ? "" : "\nWarnings\n" + doubts) +
         (facts.empty() ? "" : "\nAccounted for in the analysis\n" + facts);
}

std::string assumed_text(const std::vector<std::string>& assumed) {
  if (assumed.empty()) return {};
  std::string text = "\nAssumed while reading\n";
  for (const std::string& sentence : assumed) text += fmt::format("  - {}\n", printable(sentence));
  return text;
}

std::string to_text(const Recording& recording, const Analysis& analysis) {
  std::string text = headline_of(recording, analysis) + "\n";
  if (!analysis.motion_reason.empty()) text += fmt::format("  {}\n", printable(analysis.motion_reason));
  text += parameters_text(recording, analysis) + text_of(coefficients_block(analysis.coefficients));
  for (const Block& block : number_blocks(recording, analysis)) text += text_of(block);
  return text + text_of(quality_block(recording, analysis)) + warnings_text(analysis.warnings) +
         assumed_text(recording.provenance().assumed);
}

}  // namespace slipfit
