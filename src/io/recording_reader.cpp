#include "slipfit/io/recording_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "io/column_search.hpp"
#include "io/columns.hpp"
#include "io/message.hpp"
#include "io/opened_file.hpp"
#include "io/part.hpp"
#include "io/rows.hpp"
#include "io/rows_report.hpp"
#include "io/sign.hpp"
#include "io/stated.hpp"

namespace slipfit {
namespace {

using namespace reading;

constexpr std::size_t kMostReserved = std::size_t{1} << 27;

struct Interpreted {
  std::vector<double> force;
  Conditions conditions;
  std::vector<std::string> assumed;
  Warnings warnings;
};

/// Normal force, zero and sign: from what the column says to the force that opposes the motion.
Interpreted interpret_force(std::vector<double> force, const Conditions& conditions, ForceQuantity column) {
  Interpreted result{std::move(force), conditions, {}, {}};
  result.conditions.quantity = column;
  const auto change = [&](double factor, double offset) {
    for (double& value : result.force) value = value * factor + offset;
  };
  if (column == ForceQuantity::FrictionCoefficient && conditions.normal_force_N) {
    change(*conditions.normal_force_N, 0.0);
    result.conditions.quantity = ForceQuantity::Force_N;
    result.assumed.push_back(
        fmt::format("Force is the friction coefficient times the normal force of {} N.", *conditions.normal_force_N));
  }
  if (conditions.zero_force_N && result.conditions.quantity == ForceQuantity::Force_N) {
    change(1.0, -*conditions.zero_force_N);
  } else if (conditions.zero_force_N) {
    result.warnings.push_back(
        {"zero_force_ignored",
         "a zero force in newtons cannot be subtracted from a friction coefficient without the normal force"});
  }
  if (is_negative_throughout(result.force)) {
    change(-1.0, 0.0);
    result.assumed.emplace_back("The force is negative throughout: its sign was turned.");
  }
  return result;
}

std::size_t expected_rows(const OpenedFile& file, const ReadOptions& options) {
  if (options.window || options.rows || options.where) return 0;
  return std::min(kMostReserved, static_cast<std::size_t>(1.02 * static_cast<double>(file.source->estimated_size()) /
                                                          std::max(1.0, file.layout.mean_line_length)));
}

/// A column of friction coefficients beside one of normal forces: their products are the force.
void make_forces(Rows& rows, Choice& choice, const Layout& layout) {
  if (choice.force.quantity != ForceQuantity::FrictionCoefficient || !choice.normal_force) return;
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < rows.force.size(); ++i) {
    rows.force[i] *= rows.normal_force_N[i];
    if (std::isfinite(rows.force[i])) known.push_back(i);
  }
  rows.without_number += rows.force.size() - known.size();
  if (known.size() < rows.force.size()) rows.keep(known);
  choice.force.quantity = ForceQuantity::Force_N;
  choice.assumed.push_back(
      fmt::format("Force is the friction coefficient times {}.", describe(layout, choice.normal_force->column)));
}

Error reciprocating(const Rows& rows, const std::string& file) {
  return {"reciprocating",
          fmt::format("{}: the sign of the force turns with every stroke (a reciprocating test), and one "
                      "stroke is one recording; choose one with --window T0:T1 (in s; from {} to {})",
                      file, rows.time_s.front(), rows.time_s.back())};
}

Result<Recording> build(Part part, const RowPlan& plan, const Conditions& conditions, const std::string& file) {
  if (const auto error = check_part(part, plan, file)) return *error;
  auto stated = state_conditions(part.rows, plan.choice, plan.layout, conditions, file);
  if (!stated) return stated.error();
  Provenance provenance = describe_part(part, plan, file);
  Interpreted force =
      interpret_force(std::move(part.rows.force), stated.value().conditions, plan.choice.force.quantity);
  if (is_reciprocating(force.force)) return reciprocating(part.rows, file);
  const auto append = [&provenance](const std::vector<std::string>& assumed, const Warnings& warnings) {
    provenance.assumed.insert(provenance.assumed.end(), assumed.begin(), assumed.end());
    provenance.warnings.insert(provenance.warnings.end(), warnings.begin(), warnings.end());
  };
  append(stated.value().assumed, stated.value().warnings);
  append(force.assumed, force.warnings);
  auto recording =
      Recording::create(std::move(part.rows.time_s), std::move(force.force), force.conditions, std::move(provenance));
  if (!recording) return Error{recording.error().code, file + ": " + recording.error().message};
  return recording;
}

Result<Recording> read_file(const std::filesystem::path& path, const std::string& name, const Conditions& conditions,
                            const ReadOptions& options) {
  if (const auto error = check_options(options, name)) return *error;
  auto opened = open_file(path, options);
  if (!opened) return opened.error();
  OpenedFile file = std::move(opened).value();
  auto chosen = choose_columns(file.layout, options, conditions.speed_m_per_s, name);
  if (!chosen) return chosen.error();
  Choice choice = std::move(chosen).value();
  const std::vector<std::string>& packed = file.source->assumed();
  choice.assumed.insert(choice.assumed.begin(), packed.begin(), packed.end());
  // The steps are counted over the whole file: with one of them the window is cut from it later.
  const std::optional<TimeWindow> window = options.step ? std::nullopt : options.window;
  RowPlan plan{file.layout, choice, options.sample_rate_Hz, options.rows, window, expected_rows(file, options)};
  Rows rows = read_rows(name, std::move(file.source), plan);
  make_forces(rows, choice, file.layout);
  auto part = take_part(std::move(rows), options, name);
  if (!part) return part.error();
  plan.window = options.window;
  return build(std::move(part).value(), plan, conditions, name);
}

}  // namespace

Result<Recording> read_recording(const std::filesystem::path& file, const Conditions& conditions,
                                 const ReadOptions& options) {
  const std::string name = printable(file.string());
  return with_errors_of_reading(name, [&] { return read_file(file, name, conditions, options); });
}

}  // namespace slipfit
