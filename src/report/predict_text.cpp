#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "report/rounding.hpp"
#include "report/table.hpp"
#include "report/text_sections.hpp"
#include "slipfit/report/prediction.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {
namespace {

/// "49.3 ms [47.1, 51.7]", in a unit that suits the number.
template <class Unit>
std::string cell(const Estimate& estimate, const Unit& unit) {
  if (!estimate.value || !std::isfinite(*estimate.value)) return "-";
  const EstimateRow row = estimate_row(estimate, unit);
  const std::string number_and_unit = row.unit.empty() ? row.value : row.value + " " + row.unit;
  return row.interval == "-" ? number_and_unit : number_and_unit + " " + row.interval;
}

std::string regime_words(const PredictedMotion& row, const std::string& mark) {
  return (row.regime == "stick_slip_bistable" ? "stick-slip, bistable" : plain_words(row.regime)) + mark;
}

std::string critical_text(const Prediction& prediction, const std::string& given_unit) {
  const Estimate& speed = prediction.critical_speed_m_per_s;
  std::string text = "  critical speed: ";
  if (!speed.value || !speed.note.empty()) {
    return text + (speed.note.empty() ? "not known" : one_line(speed.note)) + "\n";
  }
  return text + fmt::format("{}, lambda at it {}\n", cell(speed, speed_unit(given_unit, speed.value)),
                            cell(prediction.lambda_critical, ""));
}

/// Each note of the rows once; the rows that it is about bear its mark.
class Footnotes {
 public:
  std::string mark(const std::string& note) {
    if (note.empty()) return {};
    const auto known = std::find(notes_.begin(), notes_.end(), note);
    const auto index = static_cast<std::size_t>(known - notes_.begin());
    if (known == notes_.end()) notes_.push_back(note);
    return " " + std::string(index + 1, '*');
  }
  [[nodiscard]] std::string text() const {
    std::string text;
    for (std::size_t i = 0; i < notes_.size(); ++i) {
      text += fmt::format("  {} {}\n", std::string(i + 1, '*'), one_line(notes_[i]));
    }
    return text;
  }

 private:
  std::vector<std::string> notes_;
};

}  // namespace

std::string to_text(const Prediction& prediction, const PredictionSource& source) {
  Table table({Align::Right, Align::Left, Align::Left, Align::Left, Align::Left, Align::Left});
  table.add({"speed", "period", "frequency", "spacing V T", "sticking degree", "regime"});
  Footnotes notes;
  bool has_bands = false;
  for (const PredictedMotion& row : prediction.rows) {
    table.add({quantity_text(row.speed_m_per_s, speed_unit(source.speed_unit, row.speed_m_per_s)),
               cell(row.period_s, "s"), cell(row.frequency_Hz, "Hz"), cell(row.periodic_displacement_m, "m"),
               cell(row.sticking_degree, ""), regime_words(row, notes.mark(row.note))});
    has_bands = has_bands || row.lambda.ci95.has_value();
  }
  return fmt::format("Predicted from {}{}\n", one_line(source.name),
                     has_bands ? ", [95 % interval of the mean cycle]" : "") +
         critical_text(prediction, source.speed_unit) + conditions_text(source.conditional_on) + "\n" + table.text() +
         notes.text();
}

}  // namespace slipfit
