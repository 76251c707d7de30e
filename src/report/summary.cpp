#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "analysis/rules.hpp"
#include "report/model_terms.hpp"
#include "report/names.hpp"
#include "report/quantities.hpp"
#include "report/text_sections.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/report/sweep.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {
namespace {

constexpr std::size_t kMostLines = 25;    // of a summary: one screen
constexpr std::size_t kMostWarnings = 5;  // those with the largest effect
constexpr std::size_t kMostFootnotes = 3;
constexpr std::size_t kBelowSentences = 2;   // a blank line and the pointer to all results
constexpr std::size_t kRoomForWarnings = 6;  // a blank line, a warning of two lines, and what is below it
constexpr std::size_t kLongestName = 32;     // of a path in the headline; of a longer one the name of the file
constexpr std::size_t kMostListed = 8;       // recordings of a sweep

/// A sentence as a line of text ends: with a full stop.
std::string sentence(std::string text) {
  if (!text.empty() && text.back() != '.') text += '.';
  return text;
}

/// The text up to its first semicolon where it is longer than two lines: `--details` has the whole.
std::string shortened(const std::string& text) {
  return text.size() > 2 * (kLineWidth - 4) ? text.substr(0, text.find(';')) : text;
}

/// Collects rows and footnotes, then the lines below them until the screen is full.
class Screen {
 public:
  using Row = std::array<std::string, 4>;

  explicit Screen(std::string headline) : headline_(std::move(headline)) {}

  /// All rows are added before `number_notes`.
  void add_row(std::string_view label, const EstimateRow& row, std::string status, const std::string& note) {
    const bool is_noted = status != name_of(ParameterStatus::Identified);
    rows_.push_back({std::string(label), value_text(row), row.interval, std::move(status)});
    notes_of_rows_.push_back(is_noted ? note : std::string());
  }
  void add_parameter(const Parameter& parameter) {
    const ParameterInfo& known = info(parameter.id);
    EstimateRow row = estimate_row(parameter.estimate, std::string(known.unit));
    if (parameter.status == ParameterStatus::Bounded) row.value = "-";
    if (row.value == "-" && !row.interval.empty() && !row.unit.empty()) row.interval += " " + row.unit;
    add_row(known.words, row, std::string(name_of(parameter.status)), parameter.estimate.note);
  }
  /// Numbers the notes of the rows, of which one that continues another one has a footnote for the rest alone.
  void number_notes() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      for (const std::string& part : parts_of(notes_of_rows_[i])) {
        if (notes_.size() < kMostFootnotes && std::ranges::find(notes_, part) == notes_.end()) notes_.push_back(part);
      }
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (const std::string numbers = numbers_of(notes_of_rows_[i]); !numbers.empty()) rows_[i].back() += " " + numbers;
    }
  }
  /// "(1)" where footnotes have this note, else the note itself.
  [[nodiscard]] std::string reference(const std::string& note) const {
    const std::string numbers = numbers_of(note);
    return numbers.empty() ? note : numbers;
  }
  /// Adds a measured quantity; nothing if its value is not known.
  void add_measured(const Quantity& quantity, const Estimate& estimate, const Conditions& conditions) {
    if (estimate.value) add_row(full_words(quantity), estimate_row(quantity, estimate, conditions), "measured", {});
  }
  void add_recording(Row row) { recordings_.push_back(std::move(row)); }
  void add_text(const std::string& text) { below_.push_back(wrapped("  ", text)); }
  void add_warnings(const Warnings& warnings);

  [[nodiscard]] std::string text(const SummaryHints& hints) const;

 private:
  /// Returns the note, or the note of another row with which it begins and the rest.
  [[nodiscard]] std::vector<std::string> parts_of(const std::string& note) const {
    if (note.empty()) return {};
    for (const std::string& other : notes_of_rows_) {
      if (!other.empty() && note.starts_with(other + "; ")) return {other, note.substr(other.size() + 2)};
    }
    return {note};
  }
  /// "(1, 2)": the footnotes that have this note; empty where one is missing.
  [[nodiscard]] std::string numbers_of(const std::string& note) const {
    std::string numbers;
    for (const std::string& part : parts_of(note)) {
      const auto found = std::ranges::find(notes_, part);
      if (found == notes_.end()) return {};
      numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", found - notes_.begin() + 1);
    }
    return numbers.empty() ? numbers : "(" + numbers + ")";
  }
  [[nodiscard]] bool has_footnote(const std::string& message) const {
    return std::ranges::any_of(notes_,
                               [&](const std::string& note) { return note.find(message) != std::string::npos; });
  }

  std::string headline_;
  std::vector<Row> rows_;
  std::vector<std::string> notes_of_rows_;  ///< empty: none
  std::vector<Row> recordings_;
  std::vector<std::string> notes_;  ///< footnotes, in their order
  std::vector<std::vector<std::string>> below_;
  std::vector<std::vector<std::string>> warnings_;
  std::size_t warnings_left_out_ = 0;
};

void Screen::add_warnings(const Warnings& warnings) {
  for (const Warning& warning : by_effect(warnings)) {
    if (is_fact(warning) || has_footnote(warning.message)) continue;
    if (warnings_.size() == kMostWarnings) {
      ++warnings_left_out_;
    } else {
      warnings_.push_back(wrapped("  ! ", sentence(shortened(printable(warning.message)))));
    }
  }
}

std::string Screen::text(const SummaryHints& hints) const {
  std::string text = headline_ + "\n";
  std::size_t lines = 1;
  const auto put = [&](const std::string& line) {
    text += line + "\n";
    ++lines;
  };
  const auto put_table = [&](const Row& head, const std::vector<Row>& rows) {
    if (rows.empty()) return;
    Table table({Align::Left, Align::Right, Align::Left, Align::Left});
    table.add({head.begin(), head.end()});
    for (const Row& row : rows) table.add({row.begin(), row.end()});
    text += "\n" + table.text();
    lines += rows.size() + 2;
  };
  put_table({"", "value", "95 % interval", "status"}, rows_);
  put_table({"recording", "speed", std::string(kMeasured.front().words), "predicted from the others"}, recordings_);
  if (!notes_.empty() || !below_.empty()) put("");
  for (std::size_t i = 0; i < notes_.size(); ++i) {
    for (const std::string& line : wrapped(fmt::format("  ({}) ", i + 1), sentence(printable(notes_[i])))) put(line);
  }
  for (const std::vector<std::string>& sentences : below_) {
    if (lines + sentences.size() + (warnings_.empty() ? kBelowSentences : kRoomForWarnings) > kMostLines) continue;
    for (const std::string& line : sentences) put(line);
  }
  std::size_t left_out = warnings_left_out_;
  if (!warnings_.empty()) put("");
  constexpr std::size_t kBelowWarnings = 3;  // a line for those left out, a blank one, and the pointer to all results
  for (const std::vector<std::string>& warning : warnings_) {
    const bool fits = lines + warning.size() + kBelowWarnings <= kMostLines || &warning == &warnings_.front();
    if (!fits) ++left_out;
    for (std::size_t i = 0; fits && i < warning.size(); ++i) put(warning[i]);
  }
  if (left_out > 0)
    put(fmt::format("  ! {} more {}: {}", left_out, left_out == 1 ? "warning" : "warnings", hints.details));
  put("");
  put("  " + hints.all);
  return text;
}

/// Parameters that describe the contact; the others are terms of the model or follow from these.
constexpr std::array kHeadlineParameters{ParameterId::Stiffness,
                                         ParameterId::FrictionDifference,
                                         ParameterId::FrictionCoefficientDifference,
                                         ParameterId::StaticFriction,
                                         ParameterId::KineticFriction,
                                         ParameterId::StaticFrictionCoefficient,
                                         ParameterId::KineticFrictionCoefficient,
                                         ParameterId::NaturalFrequency,
                                         ParameterId::Mass,
                                         ParameterId::DampingRatio,
                                         ParameterId::Alpha,
                                         ParameterId::Ageing,
                                         ParameterId::Relaxation,
                                         ParameterId::RelaxationTime};

bool is_headline(ParameterId id) {
  return std::ranges::find(kHeadlineParameters, id) != kHeadlineParameters.end();
}

/// "Not determined: natural frequency w_n, damping ratio zeta: the slip has 4.1 samples."
std::string not_determined(const FitResult& fit, const Screen& screen) {
  std::string names;
  std::string reason;
  for (const Parameter& parameter : fit.parameters) {
    if (parameter.status != ParameterStatus::Unidentified || !is_headline(parameter.id)) continue;
    names += (names.empty() ? "" : ", ") + std::string(info(parameter.id).words);
    if (reason.empty()) reason = parameter.estimate.note;
  }
  if (names.empty()) return {};
  if (reason.empty()) return sentence("Not determined: " + names);
  const std::string shown = screen.reference(reason);
  return shown == reason ? sentence("Not determined: " + names + ": " + printable(reason))
                         : sentence("Not determined: " + names + " " + shown);
}

std::string terms_text(const FitResult& fit) {
  std::string terms;
  for (const ModelTerm& term : model_terms(fit)) {
    const bool is_shown =
        term.parameters.empty() || is_headline(term.parameters.front());  // as a fact, or in the table
    if (!is_shown) terms += (terms.empty() ? "" : "; ") + term.text;
  }
  return terms.empty() ? terms : sentence("The model includes " + terms);
}

std::string residual_sentence(const FitResult& fit, ForceQuantity quantity) {
  constexpr double kLevel = 1e-3;
  std::string text = fmt::format("Residual {} rms", quantity_text(fit.residual.rms, force_unit(quantity)));
  const auto& chi2 = fit.residual.reduced_chi2;
  const auto& p = fit.residual.whiteness_p;
  if (p && *p >= kLevel) return text + ", consistent with white noise.";
  constexpr double kAlike = 1.05;  // residual over noise that is not worth mentioning
  if (chi2 && std::sqrt(*chi2) < kAlike && !p) return text + ", as large as the noise.";
  if (chi2) text += fmt::format(", {:.2g} times the noise", std::sqrt(*chi2));
  if (p) text += "; neighbouring residuals are correlated";
  return text + ".";
}

/// Returns the treatment of defects of the recording and of effects of the instrument, in one or two lines.
std::string facts_text(const Warnings& warnings) {
  std::string facts;
  for (const Warning& warning : warnings) {
    if (!is_fact(warning) || warning.code == "suspicious_line") continue;
    facts += (facts.empty() ? "" : "; ") + printable(warning.message);
  }
  if (facts.empty()) return facts;
  facts.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(facts.front())));
  return sentence(facts);
}

void add_parameters(Screen& screen, const FitResult& fit, bool zero_is_known) {
  for (const Parameter& parameter : fit.parameters) {
    const bool is_known = parameter.status != ParameterStatus::Unidentified;
    const bool has_zero = zero_is_known || !info(parameter.id).depends_on_sensor_zero;
    if (is_known && has_zero && is_headline(parameter.id)) screen.add_parameter(parameter);
  }
}

/// Adds the properties of the cycles that need no fit.
void add_cycles(Screen& screen, const CycleStatistics& cycles, const Conditions& conditions) {
  constexpr auto kShown = std::to_array<std::string_view>({"period_s", "peak_force_N", "force_drop_N"});
  for (const auto& quantity : kCycleQuantities) {
    const bool is_stiffness = quantity.unit == "N/m" && conditions.quantity == ForceQuantity::Force_N;
    if (is_stiffness || std::ranges::find(kShown, quantity.key) != kShown.end())
      screen.add_measured(quantity, quantity.of(cycles), conditions);
  }
}

void add_below_table(Screen& screen, const FitResult& fit, ForceQuantity quantity) {
  for (const std::string& text : {not_determined(fit, screen), residual_sentence(fit, quantity), terms_text(fit)}) {
    if (!text.empty()) screen.add_text(text);
  }
}

}  // namespace

std::string headline_of(const Recording& recording, const Analysis& analysis) {
  std::string file = recording.provenance().file;
  if (file.size() > kLongestName) file = std::filesystem::path(file).filename().string();
  std::string text =
      fmt::format("{}: {}", file.empty() ? "recording" : printable(file), words_for_motion(analysis.motion));
  const Estimate& frequency = analysis.frequency.quoted;
  if (frequency.value) {
    const EstimateRow row = estimate_row(frequency, std::string("Hz"));
    text += fmt::format(" at {} Hz{}", row.value, row.interval.empty() ? "" : " " + row.interval);
    if (analysis.cycles.count > 0) text += fmt::format(", {} slips", analysis.cycles.count);
  }
  return text + ", driven at " + speed_text(recording.conditions());
}

std::string to_summary(const Recording& recording, const Analysis& analysis, const SummaryHints& hints) {
  const Conditions& conditions = recording.conditions();
  Screen screen(headline_of(recording, analysis));
  const bool has_slips = analysis.motion != MotionClass::SteadySliding;
  const bool has_fit = analysis.fit && has_slips;
  if (has_fit) add_parameters(screen, *analysis.fit, conditions.zero_force_N.has_value());
  const Derived& derived = analysis.derived;
  screen.add_measured(kMeasured.front(), derived.pattern_spacing_m, conditions);
  if (const Estimate& critical = derived.critical_speed_m_per_s; critical.value) {
    const Quantity& quantity = quantity_with_key("critical_speed_m_per_s");
    const StatusAndNote known = critical_speed_status(analysis);
    screen.add_row(quantity.words, estimate_row(quantity, critical, conditions), known.status, known.note);
  }
  if (analysis.coefficients) {
    for (const auto& row : kCoefficients) screen.add_measured(row, row.of(*analysis.coefficients), conditions);
  }
  if (analysis.motion != MotionClass::StickSlip && !analysis.motion_reason.empty())
    screen.add_text(sentence("Reason: " + printable(analysis.motion_reason)));
  if (!analysis.fit && has_slips) add_cycles(screen, analysis.cycles, conditions);
  screen.number_notes();
  if (has_fit) add_below_table(screen, *analysis.fit, conditions.quantity);
  if (const std::string facts = facts_text(analysis.warnings); !facts.empty()) screen.add_text(facts);
  screen.add_warnings(analysis.warnings);
  return screen.text(hints);
}

std::string to_summary(std::span<const SweepEntry> entries, const SweepAnalysis& sweep, const std::string& name,
                       const SummaryHints& hints) {
  if (!sweep.fit) {
    Screen screen(fmt::format("{}: {} recordings, no joint fit", printable(name), entries.size()));
    screen.add_text(sentence("Reason: " + sweep.fit_reason));
    screen.add_warnings(sweep.warnings);
    return screen.text(hints);
  }
  Screen screen(fmt::format("{}: {} recordings fitted together", printable(name), entries.size()));
  const bool zero_is_known = std::ranges::all_of(
      entries, [](const SweepEntry& entry) { return entry.recording.conditions().zero_force_N.has_value(); });
  add_parameters(screen, sweep.fit->result, zero_is_known);
  if (const Estimate& critical = sweep.derived.critical_speed_m_per_s; critical.value) {
    const Quantity& quantity = quantity_with_key("critical_speed_m_per_s");
    screen.add_row(quantity.words, estimate_row(quantity, critical, entries.front().recording.conditions()), "derived",
                   {});
  }
  screen.number_notes();
  add_below_table(screen, sweep.fit->result, ForceQuantity::Force_N);
  if (const std::string facts = facts_text(sweep.warnings); !facts.empty()) screen.add_text(facts);
  for (std::size_t i = 0; i < entries.size() && entries.size() <= kMostListed; ++i) {
    const Analysis& analysis = sweep.recordings[i];
    const bool sticks = analysis.motion == MotionClass::StickSlip;
    screen.add_recording(
        {printable(entries[i].id), speed_text(entries[i].recording.conditions()),
         sticks ? estimate_text(analysis.derived.pattern_spacing_m, "m") : plain_words(name_of(analysis.motion)),
         estimate_text(sweep.fit->points[i].spacing_left_out_m, "m")});
  }
  screen.add_warnings(sweep.warnings);
  return screen.text(hints);
}

}  // namespace slipfit
