#include "figures/parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cassert>
#include <cmath>
#include <iterator>

#include "model/slip.hpp"

namespace slipfit::figures {
namespace {

Slider scaled_slider(double damping_ratio) {
  return Slider::create(1.0, 1.0, damping_ratio).value();
}

Friction scaled_friction(double lambda) {
  return Friction::create(lambda, 0.0).value();
}

}  // namespace

void Table::add(std::vector<double> row) {
  assert(row.size() == columns_.size());
  rows_.push_back(std::move(row));
}

std::string Table::csv() const {
  std::string csv;
  for (const std::string& comment : comments_) csv += "# " + comment + "\n";
  csv += fmt::format("{}\n", fmt::join(columns_, ","));
  for (const std::vector<double>& row : rows_) {
    std::vector<std::string> cells;
    cells.reserve(row.size());
    for (const double number : row) cells.push_back(std::isfinite(number) ? fmt::format("{}", number) : "");
    csv += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return csv;
}

chart::Line Table::line(chart::Line line, std::size_t x, std::size_t y, std::optional<double> key, double scale) const {
  for (const std::vector<double>& row : rows_) {
    if (!key || row.front() == *key) line.points.push_back({row.at(x), scale * row.at(y)});
  }
  return line;
}

std::vector<FigureFile> files_of(const std::string& name, const Table& table, const chart::Chart& chart) {
  return {{name + ".csv", table.csv()}, {name + ".svg", to_svg(chart)}};
}

Motion scaled_motion(double lambda, double damping_ratio) {
  return damped_motion(scaled_slider(damping_ratio), scaled_friction(lambda), 1.0);
}

Result<PaperCycle> scaled_paper_cycle(double lambda, double damping_ratio) {
  return paper_cycle(scaled_slider(damping_ratio), scaled_friction(lambda), 1.0);
}

double first_solvable_lambda(double damping_ratio) {
  double low = 0.0;
  double high = 1.0;
  while (!scaled_paper_cycle(high, damping_ratio)) {
    low = high;
    high *= 2.0;
  }
  constexpr int kMaxHalvings = 60;  // to the last bit of a double
  for (int halving = 0; halving < kMaxHalvings; ++halving) {
    const double middle = 0.5 * (low + high);
    (scaled_paper_cycle(middle, damping_ratio) ? high : low) = middle;
  }
  return high;
}

double sticking_degree_at_limit(double damping_ratio) {
  const double z0 = critical_lambda(damping_ratio) - 2.0 * damping_ratio;
  const model::Slip slip = model::solve_slip(z0, damping_ratio);
  const double stick = z0 - slip.end.z;
  return stick / (stick + slip.tau_end);
}

std::vector<double> evenly_spaced(double low, double high, int intervals) {
  std::vector<double> values;
  for (int i = 0; i <= intervals; ++i) values.push_back(low + (high - low) * i / intervals);
  return values;
}

std::vector<double> logarithmically_spaced(double low, double high, int intervals) {
  std::vector<double> values;
  for (int i = 0; i <= intervals; ++i) values.push_back(low * std::pow(high / low, static_cast<double>(i) / intervals));
  return values;
}

}  // namespace slipfit::figures

namespace slipfit {

std::vector<FigureFile> paper_figures() {
  std::vector<FigureFile> files;
  for (const auto figure :
       {figures::slip_and_stick_times, figures::sticking_degree_and_amplitude, figures::amplitude_against_speed,
        figures::velocity_ratio, figures::spring_force, figures::damped_sticking_degree,
        figures::damped_amplitude_against_speed, figures::regime_map}) {
    std::vector<FigureFile> part = figure();
    files.insert(files.end(), std::make_move_iterator(part.begin()), std::make_move_iterator(part.end()));
  }
  return files;
}

}  // namespace slipfit
