#include "slipfit/report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/names.hpp"
#include "report/rounding.hpp"
#include "report/text_sections.hpp"

namespace slipfit {
namespace {

std::string plain_verdict(Verdict verdict) {
  switch (verdict) {
    case Verdict::StickSlip:
      return "stick-slip";
    case Verdict::SteadySliding:
      return "steady sliding, no stick-slip";
    case Verdict::OscillatorySlip:
      return "oscillatory slip (the body hardly sticks)";
    case Verdict::Undetermined:
      return "cannot tell whether this is stick-slip";
  }
  return "cannot tell whether this is stick-slip";
}

std::string assumed_text(const std::vector<std::string>& assumed) {
  if (assumed.empty()) return {};
  std::string text = "\nAssumed while reading\n";
  for (const std::string& sentence : assumed) text += fmt::format("  - {}\n", one_line(sentence));
  return text;
}

std::string tests_text(const std::vector<ShortTest>& tests) {
  if (tests.empty()) return {};
  std::string text = "\nTests\n";
  for (const ShortTest& test : tests) text += fmt::format("  - {}\n", one_line(test.finding));
  return text;
}

std::string judgement_text(const Recording& recording, const Analysis& analysis) {
  const std::string& file = recording.provenance().file;
  std::string text =
      fmt::format("{}: {}", file.empty() ? "recording" : one_line(file), plain_verdict(analysis.verdict));
  if (analysis.frequency.quoted.value) {
    text += fmt::format(", {} Hz", with_error(analysis.frequency.quoted));
    if (analysis.cycles.count > 0) text += fmt::format(", {} slips", analysis.cycles.count);
  }
  text += "\n";
  if (!analysis.verdict_reason.empty()) text += fmt::format("  {}\n", one_line(analysis.verdict_reason));
  return text;
}

}  // namespace

std::string warnings_text(const Warnings& warnings) {
  if (warnings.empty()) return {};
  std::string text = "\nWarnings\n";
  for (const Warning& warning : warnings) {
    text += fmt::format("  ! {} [{}]\n", one_line(warning.message), one_line(warning.code));
  }
  return text;
}

std::string one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20U || byte == 0x7FU) c = '?';
  }
  return line;
}

std::string force_unit(ForceQuantity quantity) {
  return quantity == ForceQuantity::Force_N ? "N" : "";
}

EstimateRow estimate_row(const Estimate& estimate, const std::string& SI_unit) {
  std::optional<double> typical = estimate.value;
  if (!typical && estimate.ci95) typical = estimate.ci95->high;
  if (typical && estimate.standard_error) typical = std::max(std::abs(*typical), *estimate.standard_error);
  return estimate_row(estimate, display_unit(SI_unit, typical));
}

EstimateRow estimate_row(const Estimate& estimate, const DisplayUnit& unit) {
  const RoundedEstimate text = rounded(scaled(estimate, unit.per_SI));
  return {text.value, text.interval, unit.unit};
}

std::string quantity_text(std::optional<double> value, const std::string& SI_unit) {
  return value ? quantity_text(*value, display_unit(SI_unit, value)) : "-";
}

std::string quantity_text(double value, const DisplayUnit& unit) {
  const std::string text = rounded(value * unit.per_SI, std::nullopt);
  return unit.unit.empty() || text == "-" ? text : text + " " + unit.unit;
}

std::string stated_text(double value, const std::string& SI_unit) {
  return stated_text(value, display_unit(SI_unit, value));
}

std::string stated_text(double value, const DisplayUnit& unit) {
  return std::isfinite(value) ? fmt::format("{:.6g} {}", value * unit.per_SI, unit.unit) : "-";
}

std::string speed_text(const Conditions& conditions) {
  return stated_text(conditions.speed_m_per_s, speed_unit(conditions.speed_unit, conditions.speed_m_per_s));
}

std::string plain_words(std::string_view name) {
  if (name == "stick_slip") return "stick-slip";
  std::string words = one_line(name);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string to_text(const Recording& recording, const Analysis& analysis) {
  std::string text = judgement_text(recording, analysis);
  text += parameters_text(recording, analysis);
  text += frequency_text(analysis.frequency);
  text += cycles_text(analysis.cycles, recording.conditions().quantity);
  text += spacing_text(recording, analysis.derived);
  const bool moves_like_model = analysis.verdict == Verdict::StickSlip || analysis.verdict == Verdict::OscillatorySlip;
  if (moves_like_model) text += predicted_text(recording, analysis.derived);
  text += tests_text(analysis.tests);
  text += recording_text(recording, analysis);
  text += warnings_text(analysis.warnings);
  text += assumed_text(recording.provenance().assumed);
  return text;
}

}  // namespace slipfit
