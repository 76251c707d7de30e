#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "analysis/rules.hpp"
#include "report/document/check_document.hpp"
#include "report/document/json_node.hpp"
#include "report/names.hpp"
#include "report/quantity_rows.hpp"
#include "report/text_sections.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/report/sweep.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {
namespace {

using documents::JsonNode;

constexpr std::size_t kMostLines = 25;    // of a summary: one screen
constexpr std::size_t kMostWarnings = 5;  // those with the largest effect
constexpr std::size_t kMostFootnoteLines = 9;
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

std::vector<std::string> footnote(std::size_t index, const std::string& note) {
  return wrapped(fmt::format("  ({}) ", index + 1), sentence(printable(note)));
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
    all_notes_.push_back(notes_of_rows_.back());
  }
  void add_parameter(const Parameter& parameter) {
    const ParameterInfo& known = info(parameter.id);
    EstimateRow row = parameter_row(parameter);
    if (row.value == "-" && !row.interval.empty() && !row.unit.empty()) row.interval += " " + row.unit;
    add_row(known.words, row, std::string(name_of(parameter.status)), parameter.estimate.note);
  }
  /// Adds a parameter that the data do not determine.
  void add_open(std::string_view label, const std::string& reason) {
    open_.emplace_back(label, reason);
    all_notes_.push_back(reason);
  }
  /// Numbers the notes of the rows; a part that several notes have in common has one footnote.
  void number_notes() {
    std::size_t lines = 0;
    for (const std::string& note : notes_of_rows_) {
      for (const std::string& part : parts_of(note)) {
        if (std::ranges::find(notes_, part) != notes_.end()) continue;
        const std::size_t more = footnote(0, part).size();
        if (lines + more > kMostFootnoteLines) continue;
        lines += more;
        notes_.push_back(part);
      }
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      rows_[i].back() += reference_to(notes_of_rows_[i]).numbers;
    }
  }
  /// Adds a measured quantity; nothing if its value is not known.
  void add_measured(const Quantity& quantity, const Estimate& estimate, const Conditions& conditions) {
    if (estimate.value) add_row(full_words(quantity), estimate_row(quantity, estimate, conditions), "measured", {});
  }
  void add_recording(Row row) { recordings_.push_back(std::move(row)); }
  void add_text(const std::string& text) {
    if (!text.empty()) below_.push_back(wrapped("  ", text));
  }
  void add_open_parameters();
  void add_warnings(const Warnings& warnings);

  [[nodiscard]] std::string text(const SummaryHints& hints) const;

 private:
  /// Returns whether the clauses follow each other in every note that has one of them.
  [[nodiscard]] bool always_together(const std::string& first, const std::string& second) const {
    const auto has = [](const std::string& note, const std::string& clauses) {
      return ("; " + note + "; ").find("; " + clauses + "; ") != std::string::npos;
    };
    return std::ranges::all_of(all_notes_, [&](const std::string& note) {
      const bool has_both = has(note, first + "; " + second);
      return has(note, first) == has_both && has(note, second) == has_both;
    });
  }
  /// Returns the note in parts: runs of its clauses that no note separates.
  [[nodiscard]] std::vector<std::string> parts_of(const std::string& note) const {
    std::vector<std::string> parts;
    std::string last;
    for (std::size_t begin = 0; begin < note.size();) {
      const std::size_t end = std::min(note.find("; ", begin), note.size());
      const std::string clause = note.substr(begin, end - begin);
      if (parts.empty() || !always_together(last, clause)) {
        parts.push_back(clause);
      } else {
        parts.back() += "; " + clause;
      }
      last = clause;
      begin = end + 2;
    }
    return parts;
  }
  /// A note as a reference to the footnotes that say it, and what none of them says.
  struct Reference {
    std::string numbers;  ///< " (1, 2)", or empty
    std::string rest;
  };
  [[nodiscard]] Reference reference_to(const std::string& note) const {
    Reference reference;
    for (const std::string& part : parts_of(note)) {
      const auto says_it = [&](const std::string& footnote) { return footnote.find(part) != std::string::npos; };
      const auto found = std::ranges::find_if(notes_, says_it);
      if (found == notes_.end()) {
        reference.rest += (reference.rest.empty() ? "" : "; ") + part;
      } else {
        reference.numbers += fmt::format("{}{}", reference.numbers.empty() ? " (" : ", ", found - notes_.begin() + 1);
      }
    }
    if (!reference.numbers.empty()) reference.numbers += ")";
    return reference;
  }

  std::string headline_;
  std::vector<Row> rows_;
  std::vector<std::string> notes_of_rows_;                 ///< empty: none
  std::vector<std::pair<std::string, std::string>> open_;  ///< parameters that are not determined, and why
  std::vector<std::string> all_notes_;
  std::vector<Row> recordings_;
  std::vector<std::string> notes_;  ///< footnotes, in their order
  std::vector<std::vector<std::string>> below_;
  std::vector<std::vector<std::string>> warnings_;
  std::size_t warnings_left_out_ = 0;
};

/// "Not determined: natural frequency w_n, damping ratio zeta: the slip has 4.1 samples.", each reason once.
void Screen::add_open_parameters() {
  struct Group {
    std::string first;
    std::string names;
    std::vector<std::string> parts;
  };
  std::vector<Group> groups;
  for (const auto& [name, reason] : open_) {
    const std::vector<std::string> parts = parts_of(reason);
    const std::string first = parts.empty() ? std::string() : parts.front();
    auto group = std::ranges::find(groups, first, &Group::first);
    if (group == groups.end()) group = groups.insert(group, Group{first, {}, {}});
    group->names += (group->names.empty() ? "" : ", ") + name;
    for (const std::string& part : parts) {
      if (std::ranges::find(group->parts, part) == group->parts.end()) group->parts.push_back(part);
    }
  }
  for (const Group& group : groups) {
    const Reference reason = reference_to(fmt::format("{}", fmt::join(group.parts, "; ")));
    const std::string rest = reason.rest.empty() ? "" : ": " + printable(reason.rest);
    add_text(sentence("Not determined: " + group.names + reason.numbers + rest));
  }
}

void Screen::add_warnings(const Warnings& warnings) {
  for (const Warning& warning : by_effect(warnings)) {
    const std::string message = is_fact(warning) ? std::string() : reference_to(warning.message).rest;
    if (message.empty()) continue;
    if (warnings_.size() == kMostWarnings) {
      ++warnings_left_out_;
    } else {
      warnings_.push_back(wrapped("  ! ", sentence(shortened(printable(message)))));
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
    for (const std::string& line : footnote(i, notes_[i])) put(line);
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

/// A document of one recording or a sweep, with the parts that the summary uses.
struct SummaryInput {
  const JsonNode& document;
  Conditions conditions;  ///< that decide about units; of a sweep: of its first recording
  std::vector<Parameter> parameters;
  Warnings warnings;
  bool zero_is_known = false;
};

Conditions conditions_of(const JsonNode& recording) {
  Conditions conditions;
  const std::optional<double> speed_m_per_s = recording.number_at("speed_m_per_s");
  conditions.speed_m_per_s = speed_m_per_s.value_or(conditions.speed_m_per_s);
  conditions.speed_is_known = speed_m_per_s.has_value();
  conditions.speed_unit = recording.text_at("speed_unit");
  conditions.zero_force_N = recording.number_at("zero_force_N");
  if (recording.text_at("force_quantity") == name_of(ForceQuantity::FrictionCoefficient))
    conditions.quantity = ForceQuantity::FrictionCoefficient;
  return conditions;
}

std::vector<Parameter> parameters_of(const JsonNode& document) {
  std::vector<Parameter> parameters;
  for (const ParameterInfo& known : parameter_table()) {
    const std::optional<JsonNode> found = document.known("parameters", std::string(known.key));
    const auto status = found ? with_name<ParameterStatus>(found->text_at("status")) : std::nullopt;
    if (status) parameters.push_back({known.id, found->estimate(), *status});
  }
  return parameters;
}

Estimate estimate_of(const JsonNode& document, const Quantity& quantity) {
  return documents::quantity_in(document, quantity).value_or(documents::DocumentQuantity{}).estimate;
}

std::string terms_text(const JsonNode& document) {
  std::string terms;
  for (const JsonNode& term : document.elements_of("model", "terms")) {
    const std::vector<JsonNode> keys = term.elements_of("parameters");  // none: a fact
    const std::optional<ParameterId> first = keys.empty() ? std::nullopt : parameter_with_key(keys.front().text());
    if (first && !is_headline(*first)) terms += (terms.empty() ? "" : "; ") + term.text_at("text");
  }
  return terms.empty() ? terms : sentence("The model includes " + terms);
}

std::string residual_sentence(const JsonNode& document, ForceQuantity quantity) {
  constexpr double kLevel = 1e-3;
  const std::optional<JsonNode> residual = document.known("model", "residual");
  if (!residual) return {};
  const Estimate rms = estimate_of(document.member("model"), {"residual", "rms_N", "", "N"});
  std::string text = fmt::format("Residual {} rms", quantity_text(rms.value, force_unit(quantity)));
  const std::optional<double> chi2 = residual->number_at("reduced_chi2");
  const std::optional<double> p = residual->number_at("whiteness_p");
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

void add_parameters(Screen& screen, const SummaryInput& input) {
  for (const Parameter& parameter : input.parameters) {
    const bool is_known = parameter.status != ParameterStatus::Unidentified;
    const bool has_zero = input.zero_is_known || !info(parameter.id).depends_on_sensor_zero;
    if (!is_headline(parameter.id)) continue;
    if (!is_known) screen.add_open(info(parameter.id).words, parameter.estimate.note);
    if (is_known && has_zero) screen.add_parameter(parameter);
  }
}

/// Adds the critical speed with the status of the damping ratio, on which it depends.
void add_critical_speed(Screen& screen, const SummaryInput& input) {
  const Quantity& quantity = quantity_with_key("critical_speed_m_per_s");
  const Estimate critical = estimate_of(input.document, quantity);
  if (!critical.value) return;
  const auto zeta = std::ranges::find(input.parameters, ParameterId::DampingRatio, &Parameter::id);
  const bool is_fitted = zeta != input.parameters.end();
  screen.add_row(quantity.words, estimate_row(quantity, critical, input.conditions),
                 is_fitted ? std::string(name_of(zeta->status)) : "derived",
                 is_fitted ? zeta->estimate.note : critical.note);
}

/// Adds the properties of the cycles that need no fit.
void add_cycles(Screen& screen, const SummaryInput& input) {
  constexpr auto kShown = std::to_array<std::string_view>({"period_s", "peak_force_N", "force_drop_N"});
  for (const Quantity& quantity : kCycleQuantities) {
    if (quantity.unit == "N/m" || std::ranges::find(kShown, quantity.key) != kShown.end())
      screen.add_measured(quantity, estimate_of(input.document, quantity), input.conditions);
  }
}

void add_below_table(Screen& screen, const SummaryInput& input) {
  screen.add_open_parameters();
  screen.add_text(residual_sentence(input.document, input.conditions.quantity));
  screen.add_text(terms_text(input.document));
}

MotionClass motion_of(const JsonNode& document) {
  return with_name<MotionClass>(document.text_at("status")).value_or(MotionClass::Undetermined);
}

std::string headline_of(const JsonNode& document, const Conditions& conditions) {
  constexpr std::array<std::string_view, kNames<MotionClass>.size()> kWords{
      "stick-slip", "steady sliding, no stick-slip", "oscillatory slip (almost no sticks)", "motion undetermined"};
  std::string file = document.member("recording").text_at("file");
  if (file.size() > kLongestName) file = std::filesystem::path(file).filename().string();
  std::string text = fmt::format("{}: {}", file.empty() ? "recording" : printable(file),
                                 kWords.at(static_cast<std::size_t>(motion_of(document))));
  const Estimate frequency = estimate_of(document, kFrequency);
  if (frequency.value) {
    const EstimateRow row = estimate_row(frequency, std::string("Hz"));
    text += fmt::format(" at {} Hz{}", row.value, row.interval.empty() ? "" : " " + row.interval);
    const std::optional<JsonNode> count = document.known("cycles", "count");
    if (count && *count->number() > 0.0) text += fmt::format(", {:.0f} slips", *count->number());
  }
  return text + ", driven at " + speed_text(conditions);
}

std::string summary_of_recording(const SummaryInput& input, const SummaryHints& hints) {
  const JsonNode& document = input.document;
  const MotionClass motion = motion_of(document);
  Screen screen(headline_of(document, input.conditions));
  const bool has_slips = motion != MotionClass::SteadySliding;
  const bool is_fitted = document.has("model");
  if (is_fitted && has_slips) add_parameters(screen, input);
  screen.add_measured(kMeasured.front(), estimate_of(document, kMeasured.front()), input.conditions);
  add_critical_speed(screen, input);
  for (const Quantity& row : kCoefficients) screen.add_measured(row, estimate_of(document, row), input.conditions);
  const std::string reason = document.text_at("status_reason");
  if (motion != MotionClass::StickSlip && !reason.empty()) screen.add_text(sentence("Reason: " + printable(reason)));
  if (!is_fitted && has_slips) add_cycles(screen, input);
  screen.number_notes();
  if (is_fitted && has_slips) add_below_table(screen, input);
  screen.add_text(facts_text(input.warnings));
  screen.add_warnings(input.warnings);
  return screen.text(hints);
}

void add_recordings(Screen& screen, const std::vector<JsonNode>& recordings) {
  for (const JsonNode& recording : recordings) {
    const std::string motion = recording.text_at("status");
    const auto predicted = recording.known("joint", "spacing_left_out_m");
    screen.add_recording({printable(recording.text_at("id")), speed_text(conditions_of(recording.member("recording"))),
                          motion == name_of(MotionClass::StickSlip)
                              ? estimate_text(estimate_of(recording, kMeasured.front()), "m")
                              : plain_words(motion),
                          estimate_text(predicted ? predicted->estimate() : Estimate{}, "m")});
  }
}

std::string summary_of_sweep(SummaryInput input, const std::vector<JsonNode>& recordings, const SummaryHints& hints) {
  const std::string name = printable(input.document.text_at("id"));
  if (!input.document.has("model")) {
    Screen screen(fmt::format("{}: {} recordings, no joint fit", name, recordings.size()));
    screen.add_text(sentence("Reason: " + input.document.text_at("status_reason")));
    screen.add_warnings(input.warnings);
    return screen.text(hints);
  }
  Screen screen(fmt::format("{}: {} recordings fitted together", name, recordings.size()));
  add_parameters(screen, input);
  add_critical_speed(screen, input);
  screen.number_notes();
  add_below_table(screen, input);
  screen.add_text(facts_text(input.warnings));
  if (recordings.size() <= kMostListed) add_recordings(screen, recordings);
  screen.add_warnings(input.warnings);
  return screen.text(hints);
}

std::string summary_of(const JsonNode& document, const SummaryHints& hints) {
  SummaryInput input{document, {}, parameters_of(document), documents::warnings_in(document)};
  if (!document.has("recordings")) {
    input.conditions = conditions_of(document.member("recording"));
    input.zero_is_known = input.conditions.zero_force_N.has_value();
    return summary_of_recording(input, hints);
  }
  const std::vector<JsonNode> recordings = document.elements_of("recordings");
  input.zero_is_known = std::ranges::all_of(
      recordings, [](const JsonNode& one) { return one.member("recording").number_at("zero_force_N").has_value(); });
  if (!recordings.empty()) input.conditions = conditions_of(recordings.front().member("recording"));
  input.conditions.quantity = ForceQuantity::Force_N;
  return summary_of_sweep(std::move(input), recordings, hints);
}

/// Returns `view(document)` of a document that this library wrote.
template <class View>
std::string view_of(const std::string& content, const View& view) {
  const std::string name;
  const nlohmann::json json = nlohmann::json::parse(content);
  return view(JsonNode(name, json));
}

}  // namespace

std::string headline_of(const Recording& recording, const Analysis& analysis) {
  return view_of(to_json(recording, analysis), [](const JsonNode& document) {
    return headline_of(document, conditions_of(document.member("recording")));
  });
}

std::string to_summary(const Recording& recording, const Analysis& analysis, const SummaryHints& hints) {
  return view_of(to_json(recording, analysis), [&](const JsonNode& document) { return summary_of(document, hints); });
}

std::string to_summary(std::span<const SweepEntry> entries, const SweepAnalysis& sweep, const std::string& name,
                       const SummaryHints& hints) {
  return view_of(to_json(entries, sweep, {.id = name}),
                 [&](const JsonNode& document) { return summary_of(document, hints); });
}

Result<std::string> summary_of_document(const std::string& content, const std::string& name,
                                        const SummaryHints& hints) {
  return documents::with_document<std::string>(content, name,
                                               [&](const JsonNode& document) { return summary_of(document, hints); });
}

}  // namespace slipfit
