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
#include "report/blocks.hpp"
#include "report/document/json_node.hpp"
#include "report/names.hpp"
#include "report/quantity_rows.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/report/sweep.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {
namespace {

using documents::JsonNode;

/// A sentence as a line of text ends: with a full stop, unless it is a question.
std::string sentence(std::string text) {
  if (!text.empty() && text.back() != '.' && text.back() != '?') text += '.';
  return text;
}

/// The content of a summary, before it is fitted to the screen.
struct Screen {
  struct Row {
    std::string label;
    EstimateRow numbers;
    std::string status;
    std::string note;
  };
  std::string headline;
  std::vector<Row> rows{};
  std::vector<std::pair<std::string, std::string>> open{};     ///< parameters that are not determined, and why
  std::vector<std::vector<std::string>> recordings{};          ///< of a sweep: rows of their table
  std::string_view last_column = "predicted from the others";  ///< of that table
  std::string reason{};                                        ///< of the kind of motion
  std::vector<std::string> sentences{};
  Warnings warnings{};

  /// Adds a row; that of an identified parameter has no note.
  void add_row(std::string_view label, EstimateRow numbers, std::string_view status, const std::string& note) {
    const bool is_noted = status != name_of(ParameterStatus::Identified);
    rows.push_back({std::string(label), std::move(numbers), std::string(status), is_noted ? note : std::string()});
  }
  /// Adds a measured quantity; nothing if its value is not known.
  void add_measured(const Quantity& quantity, const Estimate& estimate, const Conditions& conditions) {
    if (estimate.value) add_row(full_words(quantity), estimate_row(quantity, estimate, conditions), "measured", {});
  }
};

/// The footnotes of a screen. A part that several notes have in common has one footnote.
class SharedNotes {
 public:
  explicit SharedNotes(const Screen& screen) {
    for (const Screen::Row& row : screen.rows) notes_.push_back(row.note);
    for (const auto& [name, reason] : screen.open) notes_.push_back(reason);
    constexpr std::size_t kMostLinesOfNotes = 9;
    for (const Screen::Row& row : screen.rows) {
      for (const std::string& part : parts_of(row.note)) {
        if (std::ranges::find(footnotes_, part) != footnotes_.end()) continue;
        const std::vector<std::string> lines =
            wrapped(fmt::format("  ({}) ", footnotes_.size() + 1), sentence(printable(part)));
        if (lines_.size() + lines.size() > kMostLinesOfNotes) continue;
        lines_.insert(lines_.end(), lines.begin(), lines.end());
        footnotes_.push_back(part);
      }
    }
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
  [[nodiscard]] Reference reference_to(const std::vector<std::string>& parts) const {
    std::vector<std::ptrdiff_t> numbers;
    std::vector<std::string> rest;
    for (const std::string& part : parts) {
      const auto says_it = [&](const std::string& footnote) { return footnote.find(part) != std::string::npos; };
      const auto found = std::ranges::find_if(footnotes_, says_it);
      found == footnotes_.end() ? rest.push_back(part) : numbers.push_back(found - footnotes_.begin() + 1);
    }
    return {numbers.empty() ? "" : fmt::format(" ({})", fmt::join(numbers, ", ")),
            fmt::format("{}", fmt::join(rest, "; "))};
  }
  [[nodiscard]] Reference reference_to(const std::string& note) const { return reference_to(parts_of(note)); }

  [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }

 private:
  /// Returns whether the clauses follow each other in every note that has one of them.
  [[nodiscard]] bool always_together(const std::string& first, const std::string& second) const {
    const auto has = [](const std::string& note, const std::string& clauses) {
      return ("; " + note + "; ").find("; " + clauses + "; ") != std::string::npos;
    };
    return std::ranges::all_of(notes_, [&](const std::string& note) {
      const bool has_both = has(note, first + "; " + second);
      return has(note, first) == has_both && has(note, second) == has_both;
    });
  }

  std::vector<std::string> notes_;
  std::vector<std::string> footnotes_;  ///< parts, in their order
  std::vector<std::string> lines_;
};

/// "Not determined: natural frequency w_n, damping ratio zeta: the slip has 4.1 samples.", each reason once.
std::vector<std::string> open_parameters(const Screen& screen, const SharedNotes& notes) {
  struct Group {
    std::string names;
    std::vector<std::string> parts;  ///< of the reasons
  };
  std::vector<std::pair<std::string, Group>> groups;  // by the first part
  for (const auto& [name, reason] : screen.open) {
    const std::vector<std::string> parts = notes.parts_of(reason);
    const std::string first = parts.empty() ? std::string() : parts.front();
    auto group = std::ranges::find(groups, first, [](const auto& one) { return one.first; });
    if (group == groups.end()) group = groups.insert(group, {first, {}});
    auto& [names, all] = group->second;
    names += (names.empty() ? "" : ", ") + name;
    for (const std::string& part : parts) {
      if (std::ranges::find(all, part) == all.end()) all.push_back(part);
    }
  }
  std::vector<std::string> texts;
  for (const auto& [first, group] : groups) {
    const auto [numbers, rest] = notes.reference_to(fmt::format("{}", fmt::join(group.parts, "; ")));
    texts.push_back(
        sentence("Not determined: " + group.names + numbers + (rest.empty() ? "" : ": " + printable(rest))));
  }
  return texts;
}

/// Returns the warnings with the largest effect, without what footnotes say, each in its lines.
std::vector<std::vector<std::string>> warning_lines(const Warnings& warnings, const SharedNotes& notes) {
  std::vector<std::vector<std::string>> all;
  for (const Warning& warning : by_effect(warnings)) {
    if (is_fact(warning)) continue;
    std::string message = printable(notes.reference_to(warning.message).rest);
    if (message.empty()) continue;
    // What is longer than two lines ends at its first semicolon: `--details` has the whole.
    if (message.size() > 2 * (kLineWidth - 4)) message = message.substr(0, message.find(';'));
    all.push_back(wrapped("  ! ", sentence(message)));
  }
  return all;
}

std::string text_of(const Screen& screen, const SummaryHints& hints) {
  constexpr std::size_t kMostLines = 25;       // of a summary: one screen
  constexpr std::size_t kMostWarnings = 5;     // those with the largest effect
  constexpr std::size_t kBelowSentences = 2;   // a blank line and the pointer to all results
  constexpr std::size_t kRoomForWarnings = 6;  // a blank line, a warning of two lines, and what is below it
  constexpr std::size_t kBelowWarnings = 3;    // a line for those left out, a blank one, and the pointer to all results
  std::string text = screen.headline + "\n";
  std::size_t lines = 1;
  const auto put = [&](const std::string& line) {
    text += line + "\n";
    ++lines;
  };
  const auto put_table = [&](std::vector<std::string> head, const std::vector<std::vector<std::string>>& rows) {
    if (rows.empty()) return;
    Table table({Align::Left, Align::Right, Align::Left, Align::Left});
    table.add(std::move(head));
    for (const std::vector<std::string>& row : rows) table.add(row);
    text += "\n" + table.text();
    lines += rows.size() + 2;
  };
  const SharedNotes notes(screen);
  std::vector<std::vector<std::string>> rows;
  for (const auto& [label, numbers, status, note] : screen.rows) {
    rows.push_back({label, value_text(numbers), numbers.interval, status + notes.reference_to(note).numbers});
  }
  put_table({"", "value", "95 % interval", "status"}, rows);
  put_table({"recording", "speed", std::string(kMeasured.front().words), std::string(screen.last_column)},
            screen.recordings);
  std::vector<std::string> below = open_parameters(screen, notes);
  below.insert(below.begin(), screen.reason);
  below.insert(below.end(), screen.sentences.begin(), screen.sentences.end());
  std::erase(below, "");
  const std::vector<std::vector<std::string>> warnings = warning_lines(screen.warnings, notes);
  if (!notes.lines().empty() || !below.empty()) put("");
  for (const std::string& line : notes.lines()) put(line);
  for (const std::string& sentences : below) {
    const std::vector<std::string> part = wrapped("  ", sentences);
    if (lines + part.size() + (warnings.empty() ? kBelowSentences : kRoomForWarnings) > kMostLines) continue;
    for (const std::string& line : part) put(line);
  }
  if (!warnings.empty()) put("");
  std::size_t left_out = 0;
  for (std::size_t i = 0; i < warnings.size(); ++i) {
    const bool fits = i < kMostWarnings && (i == 0 || lines + warnings[i].size() + kBelowWarnings <= kMostLines);
    if (!fits) ++left_out;
    for (const std::string& line : fits ? warnings[i] : std::vector<std::string>{}) put(line);
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
  const char* const reference = reference_of_residuals(document.has("recordings") ? FitKind::Sweep : FitKind::Single);
  if (chi2 && std::sqrt(*chi2) < kAlike && !p) return text + fmt::format(", as large as {}.", reference);
  if (chi2) text += fmt::format(", {:.3g} times {}", std::sqrt(*chi2), reference);
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
    const ParameterInfo& known = info(parameter.id);
    const std::string& note = parameter.estimate.note;
    if (!is_headline(parameter.id)) continue;
    if (parameter.status == ParameterStatus::Unidentified) {
      screen.open.emplace_back(known.words, note);
    } else if (input.zero_is_known || !known.depends_on_sensor_zero) {
      EstimateRow row = parameter_row(parameter);
      if (row.value == "-" && !row.interval.empty() && !row.unit.empty()) row.interval += " " + row.unit;
      screen.add_row(known.words, row, name_of(parameter.status), note);
    }
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
                 is_fitted ? name_of(zeta->status) : "derived",
                 is_fitted ? zeta->estimate.note : in_speed_unit(critical.note, input.conditions.speed_unit));
}

/// Adds the properties of the cycles that need no fit.
void add_cycles(Screen& screen, const SummaryInput& input) {
  constexpr auto kShown = std::to_array<std::string_view>({"period_s", "peak_force_N", "force_drop_N"});
  for (const Quantity& quantity : kCycleQuantities) {
    if (quantity.unit == "N/m" || std::ranges::find(kShown, quantity.key) != kShown.end())
      screen.add_measured(quantity, estimate_of(input.document, quantity), input.conditions);
  }
}

/// Adds the pattern on the worn surface and how it agrees with V / f.
void add_surface(Screen& screen, const SummaryInput& input) {
  screen.add_measured(kOnSurface.front(), estimate_of(input.document, kOnSurface.front()), input.conditions);
  const std::optional<JsonNode> verdict = input.document.known("derived", "surface_verdict");
  if (verdict) screen.sentences.push_back(sentence("Worn surface: " + printable(verdict->text())));
}

/// Adds the coefficients of friction, which depend on the zero of the sensor.
void add_coefficients(Screen& screen, const SummaryInput& input) {
  for (const Quantity& quantity : kCoefficients) {
    const Estimate estimate = estimate_of(input.document, quantity);
    if (!estimate.value) continue;
    screen.add_row(fmt::format("coefficient, {}", quantity.words), estimate_row(quantity, estimate, input.conditions),
                   input.zero_is_known ? "measured" : name_of(ParameterStatus::Conditional),
                   input.zero_is_known ? "" : estimate.note);
  }
}

void add_sentences(Screen& screen, const SummaryInput& input) {
  if (input.document.has("model")) {
    screen.sentences.push_back(residual_sentence(input.document, input.conditions.quantity));
    screen.sentences.push_back(terms_text(input.document));
  }
  screen.sentences.push_back(facts_text(input.warnings));
}

/// Adds what the reader took for granted of units, clock and tables: a wrong guess makes every result wrong.
void add_guesses(Screen& screen, const JsonNode& document) {
  std::string guesses;
  for (const JsonNode& assumed : document.elements_of("recording", "assumed")) {
    const std::string text = printable(assumed.text());
    const bool is_guess = text.find("assumed to be in") != std::string::npos ||
                          text.find("are not used") != std::string::npos ||
                          text.find("chooses another") != std::string::npos;
    if (is_guess) guesses += (guesses.empty() ? "" : " ") + text;
  }
  screen.sentences.push_back(guesses);
}

MotionClass motion_of(const JsonNode& document) {
  return with_name<MotionClass>(document.text_at("status")).value_or(MotionClass::Undetermined);
}

std::string headline_of(const JsonNode& document, const Conditions& conditions) {
  constexpr std::size_t kLongestName = 32;  // of a path; of a longer one the name of the file
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

Screen screen_of_recording(const SummaryInput& input) {
  const JsonNode& document = input.document;
  const MotionClass motion = motion_of(document);
  Screen screen{headline_of(document, input.conditions)};
  const bool has_slips = motion != MotionClass::SteadySliding;
  const bool is_fitted = document.has("model");
  if (is_fitted && has_slips) add_parameters(screen, input);
  screen.add_measured(kMeasured.front(), estimate_of(document, kMeasured.front()), input.conditions);
  add_critical_speed(screen, input);
  add_surface(screen, input);
  add_coefficients(screen, input);
  const std::string reason = document.text_at("status_reason");
  if (motion != MotionClass::StickSlip && !reason.empty()) screen.reason = sentence("Reason: " + printable(reason));
  if (!is_fitted && has_slips) add_cycles(screen, input);
  if (has_slips) {
    add_sentences(screen, input);
  } else {
    screen.sentences = {facts_text(input.warnings)};
  }
  add_guesses(screen, document);
  return screen;
}

Screen screen_of_sweep(const SummaryInput& input, const std::vector<JsonNode>& recordings) {
  const std::string name = printable(input.document.text_at("id"));
  const bool is_fitted = input.document.has("model");
  Screen screen{
      fmt::format("{}: {} recordings{}", name, recordings.size(), is_fitted ? " fitted together" : ", no joint fit")};
  if (is_fitted) {
    add_parameters(screen, input);
    add_critical_speed(screen, input);
    add_sentences(screen, input);
  } else {
    screen.reason = sentence("Reason: " + input.document.text_at("status_reason"));
    screen.last_column = "frequency";
  }
  const std::size_t most_listed = is_fitted ? 8 : 16;
  if (recordings.size() > most_listed) return screen;
  for (const JsonNode& recording : recordings) {
    const std::string motion = recording.text_at("status");
    const auto predicted = recording.known("joint", "spacing_left_out_m");
    const Estimate last =
        is_fitted ? (predicted ? predicted->estimate() : Estimate{}) : estimate_of(recording, kFrequency);
    screen.recordings.push_back(
        {printable(recording.text_at("id")), speed_text(conditions_of(recording.member("recording"))),
         motion == name_of(MotionClass::StickSlip) ? estimate_text(estimate_of(recording, kMeasured.front()), "m")
                                                   : plain_words(motion),
         estimate_text(last, is_fitted ? "m" : "Hz")});
  }
  return screen;
}

std::string summary_of(const JsonNode& document, const SummaryHints& hints) {
  SummaryInput input{document, {}, parameters_of(document), documents::warnings_in(document)};
  const bool is_sweep = document.has("recordings");
  const std::vector<JsonNode> recordings =
      is_sweep ? document.elements_of("recordings") : std::vector<JsonNode>{document};
  const auto states_zero = [](const JsonNode& one) {
    return one.member("recording").number_at("zero_force_N").has_value();
  };
  input.zero_is_known = std::ranges::all_of(recordings, states_zero);
  if (!recordings.empty()) input.conditions = conditions_of(recordings.front().member("recording"));
  if (is_sweep) input.conditions.quantity = ForceQuantity::Force_N;
  for (Parameter& parameter : input.parameters) {
    parameter.estimate.note = in_speed_unit(parameter.estimate.note, input.conditions.speed_unit);
  }
  Screen screen = is_sweep ? screen_of_sweep(input, recordings) : screen_of_recording(input);
  screen.warnings = input.warnings;
  return text_of(screen, hints);
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
