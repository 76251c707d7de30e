#include "fit/level/level_terms.hpp"

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/thresholds.hpp"
#include "fit/cycle/cycle_model.hpp"
#include "signal/least_squares.hpp"

namespace slipfit::fit {

namespace {

double sum_of_squares_about(const Eigen::MatrixXd& basis, const Eigen::VectorXd& level, Eigen::Index terms) {
  const Eigen::MatrixXd used = basis.leftCols(terms);
  return (level - used * signal::least_squares(used, level)).squaredNorm();
}

constexpr std::size_t kMostTerms = 12;

}  // namespace

Eigen::MatrixXd legendre_basis(const std::vector<double>& time_s, double begin_s, double end_s, std::size_t terms) {
  Eigen::MatrixXd basis(static_cast<Eigen::Index>(time_s.size()), static_cast<Eigen::Index>(terms));
  std::vector<double> values(terms);
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    legendre(2.0 * (time_s[i] - begin_s) / (end_s - begin_s) - 1.0, terms, values.data());
    for (std::size_t j = 0; j < terms; ++j)
      basis(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = values[j];
  }
  return basis;
}

std::size_t choose_level_terms(const std::vector<double>& time_s, const std::vector<double>& level) {
  const auto count = static_cast<Eigen::Index>(time_s.size());
  const double span_s = time_s.back() - time_s.front();
  if (count < 6 || !(span_s > 0.0)) return 1;
  const Eigen::MatrixXd basis = legendre_basis(time_s, time_s.front(), time_s.back(), kMostTerms);
  const Eigen::Map<const Eigen::VectorXd> values(level.data(), count);
  const double total = sum_of_squares_about(basis, values, 1);
  if (!(total > 0.0)) return 1;
  std::size_t best_terms = 1;
  double best = static_cast<double>(count) * std::log(total);
  for (const std::size_t terms : {2U, 3U, 4U, 5U, 6U, 8U, 10U, 12U}) {
    if (static_cast<Eigen::Index>(3 * terms) > count) break;
    const double rest = std::max(sum_of_squares_about(basis, values, static_cast<Eigen::Index>(terms)), 1e-30 * total);
    const double score = static_cast<double>(count) * std::log(rest) +
                         (static_cast<double>(terms) - 1.0) * std::log(static_cast<double>(count)) +
                         thresholds::kTierPrice;
    if (score >= best) continue;
    best = score;
    best_terms = terms;
  }
  return best_terms;
}

std::vector<double> smooth_level(const std::vector<double>& time_s, const std::vector<double>& level,
                                 std::size_t terms) {
  const Eigen::MatrixXd basis = legendre_basis(time_s, time_s.front(), time_s.back(), terms);
  const Eigen::Map<const Eigen::VectorXd> values(level.data(), static_cast<Eigen::Index>(level.size()));
  const Eigen::VectorXd smooth = basis * signal::least_squares(basis, values);
  return {smooth.data(), smooth.data() + smooth.size()};
}

double unexplained_level(const std::vector<double>& time_s, const std::vector<double>& level,
                         const std::vector<double>& drop, std::size_t terms) {
  const auto count = static_cast<Eigen::Index>(time_s.size());
  const auto columns = static_cast<Eigen::Index>(terms) + 1;
  if (count <= columns + 1 || !(time_s.back() > time_s.front())) return 0.0;
  Eigen::MatrixXd basis(count, columns);
  basis << legendre_basis(time_s, time_s.front(), time_s.back(), terms),
      Eigen::Map<const Eigen::VectorXd>(drop.data(), count);
  const Eigen::Map<const Eigen::VectorXd> values(level.data(), count);
  return std::sqrt(sum_of_squares_about(basis, values, columns) / static_cast<double>(count - columns));
}

namespace {

/// Calls `use` with each sample and `factor` times the value of a line there, for one line after the other.
template <class Use>
void for_each_wave(const Recording& recording, const BlockFit& fit, std::size_t begin, std::size_t end, double factor,
                   const Use& use) {
  if (begin >= end) return;
  const auto time_s = recording.time_s();
  const bool is_even = recording.clock_is_even();
  const double step_s = recording.duration_s() / static_cast<double>(recording.size() - 1);
  const double* pair = fit.wave_data();
  for (const double frequency_Hz : fit.level().lines_Hz) {
    const double omega = 2.0 * std::numbers::pi * frequency_Hz;
    const std::complex<double> amplitude = factor * fit.scales().force * std::complex(pair[0], -pair[1]);
    const std::complex<double> turn = std::polar(1.0, omega * step_s);
    std::complex<double> wave;
    for (std::size_t i = begin; i < end; ++i) {
      const bool is_anew = i == begin || !is_even;
      if (is_anew) wave = amplitude * std::polar(1.0, omega * (time_s[i] - fit.scales().time_begin_s));
      use(i, wave.real());
      wave *= turn;
    }
    pair += 2;
  }
}

}  // namespace

void add_hum(const Recording& recording, const BlockFit& fit, std::size_t begin, std::size_t end, double factor,
             std::vector<double>& values) {
  for_each_wave(recording, fit, begin, end, factor, [&](std::size_t i, double wave) {
    if (values[i] != 0.0) values[i] += wave;
  });
}

HumLines hum_of(const Recording& recording, const BlockFit& fit) {
  HumLines hum{fit.level().lines_Hz, fit.scales().time_begin_s};
  if (hum.frequencies_Hz.empty()) return hum;
  const auto force = recording.force();
  hum.force_without_lines.assign(force.begin(), force.end());
  for_each_wave(recording, fit, 0, force.size(), -1.0,
                [&](std::size_t i, double wave) { hum.force_without_lines[i] += wave; });
  return hum;
}

}  // namespace slipfit::fit
