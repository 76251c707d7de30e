#include "fit/level/stick_ripple.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "signal/robust.hpp"
#include "signal/transform.hpp"

namespace slipfit::fit {
namespace {

constexpr std::size_t kBlocksPerPeriod = 64;  // twice the fastest line that is looked for
constexpr std::size_t kFewestBlocks = 8;      // of a stick
constexpr double kSlowest = 2.5;              // a period: what is slower bends the whole stick
constexpr double kFastest = 30.0;
constexpr double kLeastShare = 1e-3;  // of the speed: changes k by no more than that

/// Holds what the fit leaves of a stick, in means over blocks of samples.
struct Stick {
  std::size_t first = 0;  ///< block of the recording
  Eigen::VectorXd time_s, force;
  [[nodiscard]] std::size_t end() const { return first + static_cast<std::size_t>(force.size()); }
};

/// Returns the columns without the straight line that fits each best.
template <class Columns>
Columns without_line(const Eigen::VectorXd& time_s, Columns columns) {
  const Eigen::VectorXd since_s = time_s.array() - time_s.mean();
  const auto slope = (since_s.transpose() * columns / since_s.squaredNorm()).eval();
  const auto mean = columns.colwise().mean().eval();
  columns.noalias() -= since_s * slope;
  columns.rowwise() -= mean;
  return columns;
}

/// Cosine and sine.
using Waves = Eigen::Matrix<double, Eigen::Dynamic, 2>;

Waves waves_at(const Eigen::VectorXd& time_s, double frequency_Hz) {
  const Eigen::ArrayXd angle = 2.0 * std::numbers::pi * frequency_Hz * time_s.array();
  Waves waves(time_s.size(), 2);
  waves << angle.cos(), angle.sin();
  return waves;
}

/// k V.
double stick_slope(const BlockFit& fit) {
  return std::exp(fit.parameters.values(kLogStiffness)) * fit.scales().speed_m_per_s;
}

class Sticks {
 public:
  Sticks(const Recording& recording, const BlockFit& fit, const Residuals& residuals)
      : recording_(recording), fit_(fit), residuals_(residuals) {
    std::vector<double> periods_s;
    for (std::size_t i = 0; i + 1 < fit.size(); ++i) {
      if (fit.data(i).continuous_with_next) periods_s.push_back(fit.reference_s(i + 1) - fit.reference_s(i));
    }
    period_s_ = signal::median(std::move(periods_s));
    const double samples = period_s_ / recording.sample_interval_s();
    block_ = std::max<std::size_t>(1, static_cast<std::size_t>(samples) / kBlocksPerPeriod);
    step_s_ = static_cast<double>(block_) * recording.sample_interval_s();
    if (period_s_ > 0.0) collect();
  }

  [[nodiscard]] std::optional<StickRipple> largest_line() const {
    if (sticks_.size() < 3) return std::nullopt;
    const std::optional<double> near_Hz = peak();
    if (!near_Hz) return std::nullopt;
    const double reach_Hz = 0.5 / (sticks_.back().time_s(0) - sticks_.front().time_s(0));
    const auto [frequency_Hz, cost] = boost::math::tools::brent_find_minima(
        [&](double f) { return -gain(f); }, *near_Hz - reach_Hz, *near_Hz + reach_Hz, 20);
    if (!lasts(frequency_Hz)) return std::nullopt;
    return line_at(frequency_Hz);
  }

 private:
  void collect() {
    const std::vector<CyclePart>& part = residuals_.part;
    for (std::size_t begin = 0, end = 0; begin < part.size(); begin = std::max(end, begin + 1)) {
      end = begin;
      while (end < part.size() && part[end] == CyclePart::Stick) ++end;
      add(begin, end);
    }
  }

  /// Blocks begin at multiples of their length, so that all sticks lie on one grid.
  void add(std::size_t begin, std::size_t end) {
    // Next to a slip, onset and end are known to about a sample, and an average still shows the slip.
    const auto margin = 2 + static_cast<std::size_t>(0.5 * fit_.sensor().average_s / recording_.sample_interval_s());
    const std::size_t first = (begin + margin + block_ - 1) / block_;
    const std::size_t last = end < margin ? 0 : (end - margin) / block_;
    if (last < first + kFewestBlocks) return;
    const auto count = static_cast<Eigen::Index>(last - first);
    Stick stick{0, Eigen::VectorXd(count), Eigen::VectorXd(count)};
    for (Eigen::Index i = 0; i < count; ++i) {
      const std::size_t at = (first + static_cast<std::size_t>(i)) * block_;
      double sum = 0.0;
      for (std::size_t k = at; k < at + block_; ++k) sum += residuals_.value[k];
      stick.time_s(i) = 0.5 * (recording_.time_s()[at] + recording_.time_s()[at + block_ - 1]);
      stick.force(i) = sum / static_cast<double>(block_);
    }
    // By time, not by samples: where some are missing, later sticks keep their place.
    const double place = (stick.time_s(0) - recording_.time_s().front()) / step_s_;
    stick.first = static_cast<std::size_t>(place + 0.25);  // the middle of a block lies up to half a block behind
    if (!sticks_.empty()) stick.first = std::max(stick.first, sticks_.back().end());
    sticks_.push_back(std::move(stick));
  }

  /// Frequency of the largest value of the periodogram, unless that is chance: of exponential values about the local
  /// level one exceeds r times it with exp(-r).
  [[nodiscard]] std::optional<double> peak() const {
    const std::size_t origin = sticks_.front().first;
    std::vector<double> values(sticks_.back().end() - origin);
    for (const Stick& stick : sticks_) {
      const Eigen::VectorXd straight = without_line(stick.time_s, stick.force);
      std::copy(straight.begin(), straight.end(), values.begin() + static_cast<std::ptrdiff_t>(stick.first - origin));
    }
    const std::size_t padded = signal::good_length(2 * values.size());
    const std::vector<double> power = signal::hann_power(values, padded);
    const double bin_Hz = 1.0 / (step_s_ * static_cast<double>(padded));
    const auto bin_of = [&](double f) { return std::min(power.size(), static_cast<std::size_t>(f / bin_Hz)); };
    const auto begin = power.begin() + static_cast<std::ptrdiff_t>(bin_of(kSlowest / period_s_));
    const auto end = power.begin() + static_cast<std::ptrdiff_t>(bin_of(kFastest / period_s_));
    if (begin >= end) return std::nullopt;
    const auto top = std::max_element(begin, end);
    const auto distance = top - power.begin();
    const std::vector<double> around(std::max(begin, power.begin() + distance / 2),
                                     std::min(end, power.begin() + std::min(2 * distance, end - power.begin())));
    const double level = signal::median(around) / std::numbers::ln2;
    const double chance = static_cast<double>(end - begin) * std::exp(-*top / level);
    if (!(level > 0.0) || chance > thresholds::kRippleChance) return std::nullopt;
    return static_cast<double>(distance) * bin_Hz;
  }

  struct Normal {
    Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
    Eigen::Vector2d cross = Eigen::Vector2d::Zero();
    [[nodiscard]] Eigen::Vector2d solution() const { return square.ldlt().solve(cross); }
  };

  /// Returns the normal equations of cosine and sine over blocks [from, to) of each stick, as shares of its length.
  [[nodiscard]] Normal normal(double frequency_Hz, double from, double to) const {
    Normal sum;
    for (const Stick& stick : sticks_) {
      const auto count = static_cast<double>(stick.force.size());
      const auto first = static_cast<Eigen::Index>(from * count);
      const Eigen::Index length = static_cast<Eigen::Index>(to * count) - first;
      const Eigen::VectorXd time_s = stick.time_s.segment(first, length);
      const Waves waves = without_line(time_s, waves_at(time_s, frequency_Hz));
      sum.square += waves.transpose() * waves;
      sum.cross += waves.transpose() * stick.force.segment(first, length);
    }
    return sum;
  }

  [[nodiscard]] double gain(double frequency_Hz) const {
    const Normal all = normal(frequency_Hz, 0.0, 1.0);
    return all.cross.dot(all.solution());
  }

  /// Ringing after a slip dies out: a drive swings as much in the second half of the sticks as in the first, in step.
  [[nodiscard]] bool lasts(double frequency_Hz) const {
    const Eigen::Vector2d early = normal(frequency_Hz, 0.0, 0.5).solution();
    const Eigen::Vector2d late = normal(frequency_Hz, 0.5, 1.0).solution();
    return (early - late).norm() < 0.5 * (early + late).norm();
  }

  /// Fits a line at this frequency: each stick has a mean of its own and all have one slope, without and with the line.
  [[nodiscard]] StickRipple line_at(double frequency_Hz) const {
    Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
    Eigen::Vector3d cross = Eigen::Vector3d::Zero();
    for (const Stick& stick : sticks_) {
      Eigen::MatrixXd columns(stick.force.size(), 3);
      columns << stick.time_s, waves_at(stick.time_s, frequency_Hz);
      columns.rowwise() -= columns.colwise().mean().eval();
      square += columns.transpose() * columns;
      cross += columns.transpose() * stick.force;
    }
    const Eigen::Vector3d with = square.ldlt().solve(cross);
    const double slope = stick_slope(fit_);
    const double force = with.tail<2>().norm();
    return {frequency_Hz, force, speed_share(fit_, frequency_Hz, force), (with(0) - cross(0) / square(0, 0)) / slope};
  }

  const Recording& recording_;
  const BlockFit& fit_;
  const Residuals& residuals_;
  double period_s_ = 0.0;
  double step_s_ = 0.0;
  std::size_t block_ = 1;
  std::vector<Stick> sticks_;
};

}  // namespace

double speed_share(const BlockFit& fit, double frequency_Hz, double force) {
  return 2.0 * std::numbers::pi * frequency_Hz * force / stick_slope(fit);
}

std::optional<StickRipple> find_stick_ripple(const Recording& recording, const BlockFit& fit,
                                             const Residuals& residuals, double least_force) {
  const std::optional<StickRipple> line = Sticks(recording, fit, residuals).largest_line();
  return line && line->force > least_force && line->speed_share > kLeastShare ? line : std::nullopt;
}

}  // namespace slipfit::fit
