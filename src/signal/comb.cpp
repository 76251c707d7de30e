#include "signal/comb.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/statistics.hpp"
#include "signal/smoothing.hpp"

namespace slipfit::signal {

namespace {

// Half widths of the lines over their frequency: a period that scatters by s makes the fundamental 2 pi s^2 wide.
constexpr std::array kWidths{0.0, 0.01, 0.03, 0.08, 0.16};

/// -ln P(line / gaps > ratio) for two independent gamma variates of mean one.
double surprise(double ratio, double line_shape, double gap_shape) {
  const double p = fisher_above(ratio, 2.0 * line_shape, 2.0 * gap_shape);
  return p > 1e-300 ? -std::log(std::min(1.0, p)) : 690.0;
}

/// Fisher's sum of the surprises of the first harmonics; neighbours share a gap, which `spread` allows for (Brown).
double comb_probability(const Comb& comb, std::size_t harmonics, const std::vector<double>& surprises) {
  double sum = 0.0;
  double spread = 0.0;
  for (std::size_t h = 0; h < harmonics; ++h) {
    sum += surprises[h];
    spread += 1.0 + 0.5 / comb.gap_shape[h];
  }
  spread /= static_cast<double>(harmonics);
  return chi_squared_above(2.0 * sum / spread, 2.0 * static_cast<double>(harmonics) / spread);
}

/// Independent places to look at: two to a resolution for sharp lines (harmonics move faster than the fundamental), two
/// to a width for broad ones. Every width is a class of its own, so that broad combs do not pay for all sharp ones.
double trials(const BandPower& bands, CombRange range, double relative_width) {
  const double places = relative_width > 0.0 ? 2.0 * std::log(range.high_Hz / range.low_Hz) / relative_width
                                             : 2.0 * (range.high_Hz - range.low_Hz) / bands.resolution_Hz();
  return std::max(1.0, places) * static_cast<double>(kWidths.size());
}

void judge(const BandPower& bands, CombRange range, Comb& comb) {
  std::vector<double> surprises;
  for (std::size_t h = 0; h < std::min(comb.measured, std::max<std::size_t>(4, comb.harmonics)); ++h) {
    surprises.push_back(surprise(comb.ratio[h], comb.line_shape[h], comb.gap_shape[h]));
  }
  double smallest = 1.0;
  for (const std::size_t harmonics : {std::size_t{1}, std::size_t{2}, std::size_t{4}, comb.harmonics}) {
    if (harmonics > comb.measured) continue;
    smallest = std::min(smallest, comb_probability(comb, harmonics, surprises));
  }
  // Sums over the first so many harmonics agree largely: together they count as two.
  const double per_place = std::min(1.0, 2.0 * smallest);
  comb.false_alarm_probability = -std::expm1(trials(bands, range, comb.relative_width) * std::log1p(-per_place));
  if (per_place >= 1.0) comb.false_alarm_probability = 1.0;
}

/// Local maxima of the power against a running mean on either side, the strongest ones: frequencies.
std::vector<double> outstanding_peaks(const BandPower& bands, CombRange range, std::size_t most) {
  struct Peak {
    double ratio;
    double frequency_Hz;
  };
  std::vector<Peak> peaks;
  const double bin = bands.resolution_Hz();
  double before = 0.0;
  double here = 0.0;
  const double step = bin;
  for (double f = range.low_Hz; f < range.high_Hz; f += step) {
    const double next = bands.mean(f - 0.75 * bin, f + 0.75 * bin);
    if (here >= before && here > next) {
      const double at = f - step;
      const double reach = std::max(10.0 * bin, 0.25 * at);
      const double around = 0.5 * (bands.mean(at - reach, at - 2.0 * bin) + bands.mean(at + 2.0 * bin, at + reach));
      if (here > 3.0 * around) peaks.push_back({here / (around + 1e-300), at});
    }
    before = here;
    here = next;
  }
  const std::size_t kept = std::min(most, peaks.size());
  const auto middle = peaks.begin() + static_cast<std::ptrdiff_t>(kept);
  std::partial_sort(peaks.begin(), middle, peaks.end(), [](const Peak& a, const Peak& b) { return a.ratio > b.ratio; });
  std::vector<double> frequencies;
  for (auto peak = peaks.begin(); peak != middle; ++peak) frequencies.push_back(peak->frequency_Hz);
  return frequencies;
}

void search_peaks(const BandPower& bands, CombRange range, std::vector<Comb>& found) {
  const CombRange lines{range.low_Hz, std::min(4.0 * range.high_Hz, 0.98 * bands.highest_Hz())};
  for (const double peak : outstanding_peaks(bands, lines, 30)) {
    for (const double multiple : {1.0, 2.0, 3.0, 4.0}) {  // it may be a harmonic of a fundamental that is hidden
      const double f = peak / multiple;
      if (f < range.low_Hz || f > range.high_Hz) continue;
      found.push_back(best_comb(bands, 10, 0.0, [&](int step) {  // the peak is known to within one resolution
        return (peak + 0.1 * step * bands.resolution_Hz()) / multiple;
      }));
    }
  }
}

void search_grid(const BandPower& bands, CombRange range, std::vector<Comb>& found) {
  for (double f = range.low_Hz; f < range.high_Hz; f += 0.05 * bands.resolution_Hz()) {
    found.push_back(measure_comb(bands, f, 0.0));
  }
}

void search_broad(const BandPower& bands, CombRange range, double width, std::vector<Comb>& found) {
  // Below the start the lines are no broader than sharp ones.
  const double start = std::max(range.low_Hz, 1.5 * bands.resolution_Hz() / width);
  for (double f = start; f < range.high_Hz; f *= 1.0 + 0.4 * width) {
    found.push_back(measure_comb(bands, f, width));
  }
}

/// The probabilities cost a microsecond each: only the combs with the largest scores of every width get theirs, and
/// those with the strongest single line, which a sum of logarithms ranks too low.
void keep_best(std::vector<Comb>& found, std::size_t most) {
  const auto by_score = [](const Comb& a, const Comb& b) { return a.score > b.score; };
  const auto by_line = [](const Comb& a, const Comb& b) { return a.ratio[0] > b.ratio[0]; };
  const std::size_t first = std::min(most, found.size());
  const std::size_t second = std::min(2 * most, found.size());
  const auto at = [&](std::size_t i) { return found.begin() + static_cast<std::ptrdiff_t>(i); };
  std::partial_sort(found.begin(), at(first), found.end(), by_score);
  std::partial_sort(at(first), at(second), found.end(), by_line);
  found.resize(second);
}

/// One more line of the comb and the gaps on either side of it, half a spacing away (nearer below the highest
/// frequency, so that there are always two). False: no room for it.
bool measure_line(const BandPower& bands, std::size_t h, Comb& comb) {
  const double spacing = comb.frequency_Hz;
  const double resolution = bands.resolution_Hz();
  const double line = static_cast<double>(h + 1) * spacing;
  const double away = std::min(0.5 * spacing, 0.8 * (bands.highest_Hz() - line));
  const double sharp = std::min(resolution, 0.17 * spacing);
  const double half = std::max(sharp, std::min(comb.relative_width * line, 0.25 * spacing));
  if (away < 2.0 * half) return false;
  const double gap = std::clamp(away - 1.9 * resolution, 0.1 * resolution, 0.4 * away);
  const double below = bands.mean(line - away - gap, line - away + gap);
  const double above = bands.mean(line + away - gap, line + away + gap);
  comb.line_shape[h] = bands.shape(2.0 * half);
  comb.gap_shape[h] = 2.0 * bands.shape(2.0 * gap);
  // A smooth background may exceed the mean of its sides by a third or so (the knee of a low-pass): where
  // averaging over a broad line would make that significant, it is allowed for.
  const double expected = (1.5 - 0.5 / comb.line_shape[h]) * 0.5 * (below + above);
  const double height = bands.mean(line - half, line + half);
  comb.ratio[h] = height / (expected + 1e-300);
  comb.power[h] = std::max(0.0, height - expected) * 2.0 * half / line;
  comb.measured = h + 1;
  return true;
}

}  // namespace

BandPower::BandPower(std::span<const double> power, double bin_Hz, double resolution_Hz)
    : bin_Hz_(bin_Hz),
      per_bin_(1.0 / bin_Hz),
      last_(static_cast<double>(power.size())),
      resolution_Hz_(resolution_Hz),
      tail_(power.size() + 1) {
  for (std::size_t i = power.size(); i-- > 0;) tail_[i] = tail_[i + 1] + power[i] * static_cast<double>(i);
}

double BandPower::shape(double width_Hz) const {
  return 1.0 + 0.45 * std::max(0.0, width_Hz / resolution_Hz_ - 1.0);
}

Comb measure_comb(const BandPower& bands, double frequency_Hz, double relative_width) {
  Comb comb;
  comb.frequency_Hz = frequency_Hz;
  comb.relative_width = relative_width;
  double sum = 0.0;
  double variance = 0.0;
  for (std::size_t h = 0; h < Comb::kMostHarmonics; ++h) {
    if (!measure_line(bands, h, comb)) break;
    sum += std::log(std::clamp(comb.ratio[h], 0.5, 1e12));
    variance += 1.0 / comb.line_shape[h] + 1.0 / comb.gap_shape[h] + 0.09;
    const double score = sum / std::sqrt(variance);
    if (h == 0 || score > comb.score) {
      comb.score = score;
      comb.harmonics = h + 1;
    }
    if (h == 2 && comb.score < 1.0) break;  // nothing here: the rest is not worth the time
  }
  return comb;
}

std::vector<Comb> search_combs(const BandPower& bands, CombRange range, CombGrid grid) {
  std::vector<Comb> combs;
  if (!(range.high_Hz > range.low_Hz)) return combs;
  for (const double width : kWidths) {
    std::vector<Comb> found;
    if (width > 0.0) {
      search_broad(bands, range, width, found);
    } else if (grid == CombGrid::Fine) {
      search_grid(bands, range, found);
    } else {
      search_peaks(bands, range, found);
    }
    keep_best(found, 5);
    for (Comb& comb : found) {
      judge(bands, range, comb);
      combs.push_back(comb);
    }
  }
  return combs;
}

/// The higher harmonics by multiplication: a cosine costs more than all else that a sample takes here.
Eigen::MatrixXd line_and_harmonics(const Eigen::VectorXd& time_s, const Oscillation& oscillation) {
  const auto waves = static_cast<Eigen::Index>(oscillation.harmonics);
  Eigen::MatrixXd columns(time_s.size(), 2 + 2 * waves);
  columns.col(0).setOnes();
  columns.col(1) = time_s;
  const Eigen::ArrayXd angle = 2.0 * std::numbers::pi * oscillation.frequency_Hz * time_s.array();
  columns.col(2) = angle.cos();
  columns.col(3) = angle.sin();
  const auto turn_c = columns.col(2).array();
  const auto turn_s = columns.col(3).array();
  for (Eigen::Index h = 1; h < waves; ++h) {
    const auto c = columns.col(2 * h).array();
    const auto s = columns.col(2 * h + 1).array();
    columns.col(2 * h + 2) = c * turn_c - s * turn_s;
    columns.col(2 * h + 3) = c * turn_s + s * turn_c;
  }
  if (oscillation.decay_per_s != 0.0) {
    columns.rightCols(2 * waves).array().colwise() *= (-oscillation.decay_per_s * time_s.array()).exp();
  }
  return columns;
}

HarmonicFit::HarmonicFit(const Samples& samples, const Oscillation& oscillation)
    : samples_(samples),
      columns_(line_and_harmonics(samples.time_s, oscillation)),
      weighted_(samples.weight.asDiagonal() * columns_),
      normal_(weighted_.transpose() * columns_),
      coefficients_(solve(samples.force)) {}

Eigen::VectorXd HarmonicFit::solve(const Eigen::VectorXd& values) const {
  return normal_.solve(weighted_.transpose() * values);
}

Eigen::VectorXd HarmonicFit::by_frequency() const {
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(samples_.time_s.size());
  for (Eigen::Index c = 2; c + 1 < columns_.cols(); c += 2) {
    const double turn = std::numbers::pi * static_cast<double>(c);
    slope.array() += turn * samples_.time_s.array() *
                     (coefficients_[c + 1] * columns_.col(c) - coefficients_[c] * columns_.col(c + 1)).array();
  }
  return slope;
}

Eigen::VectorXd HarmonicFit::by_decay() const {
  const Eigen::Index waves = columns_.cols() - 2;
  return -samples_.time_s.cwiseProduct(columns_.rightCols(waves) * coefficients_.tail(waves));
}

Eigen::VectorXd HarmonicFit::without_columns(const Eigen::VectorXd& values) const {
  return values - columns_ * solve(values);
}

HarmonicStep harmonic_step(const Samples& samples, double frequency_Hz, std::size_t harmonics) {
  const HarmonicFit fit(samples, {frequency_Hz, harmonics});
  // What the linear columns can explain holds no information about the frequency.
  const Eigen::VectorXd slope = fit.without_columns(fit.by_frequency());
  const Eigen::VectorXd pull = samples.weight.cwiseProduct(slope);
  HarmonicStep step;
  step.residual = fit.residual();
  step.information = pull.dot(slope);
  step.influence =
      step.information > 0.0 ? Eigen::VectorXd(pull / step.information) : Eigen::VectorXd::Zero(slope.size());
  step.change_Hz = step.influence.dot(step.residual);
  return step;
}

namespace {

/// The trace in means of a few samples, time and force from their middles. Weights of Hann: without them the harmonics
/// that are left out pull at both ends (0.8 % at 4 cycles).
Samples thinned(const Recording& recording, double highest_Hz) {
  const std::span<const double> time = recording.time_s();
  const double step = recording.duration_s() / static_cast<double>(recording.size() - 1);
  const auto factor = static_cast<std::size_t>(std::max(1.0, 1.0 / (8.0 * highest_Hz * step)));
  const auto count = static_cast<Eigen::Index>(recording.size() / factor);
  Samples points{Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count)};
  const double middle = 0.5 * (time.front() + time.back());
  for (Eigen::Index row = 0; row < count; ++row) {
    for (std::size_t k = 0; k < factor; ++k) {
      const std::size_t i = static_cast<std::size_t>(row) * factor + k;
      points.time_s[row] += (time[i] - middle) / static_cast<double>(factor);
      points.force[row] += recording.force()[i] / static_cast<double>(factor);
    }
  }
  points.force.array() -= points.force.mean();
  points.weight = 1.0 + (2.0 * std::numbers::pi / recording.duration_s() * points.time_s.array()).cos();
  return points;
}

/// Noise of the residuals from their second differences, which see little of what varies slowly.
double noise_variance(const Eigen::VectorXd& residual) {
  std::vector<double> bends;
  for (Eigen::Index i = 1; i + 1 < residual.size(); ++i) {
    bends.push_back(std::abs(residual[i - 1] - 2.0 * residual[i] + residual[i + 1]));
  }
  const double rms = kMedianToSigma * median(std::move(bends)) / std::sqrt(6.0);
  return rms * rms;
}

/// Variance of the estimate: noise, and what the residuals show beyond it, summed over correlations up to a period
/// (Newey and West). The latter comes from periods that scatter, that is a phase that walks at random; of a walk the
/// straight line fitted to N cycles leaves N/15 of the variance of one step in the residuals, but is itself off by
/// 6/5 of it over N: 3/2 N times what independent errors of the size of the residuals would make.
double variance(const HarmonicStep& step, double cycles, double points_per_period) {
  const Eigen::VectorXd score = step.influence.cwiseProduct(step.residual);
  const Eigen::Index n = score.size();
  const Eigen::Index reach = std::min<Eigen::Index>(n - 1, static_cast<Eigen::Index>(points_per_period) + 1);
  double sum = score.squaredNorm();
  for (Eigen::Index lag = 1; lag < reach; ++lag) {
    const double weight = 1.0 - static_cast<double>(lag) / static_cast<double>(reach);
    sum += 2.0 * weight * score.head(n - lag).dot(score.tail(n - lag));
  }
  const double noise = step.influence.squaredNorm() * noise_variance(step.residual);
  const double widened = students_factor(cycles - 1.0);
  return 1.2 * noise + widened * widened * 1.5 * cycles * std::max(0.0, sum - noise);
}

}  // namespace

std::optional<TrackedFrequency> fit_harmonics(const Recording& recording, double near_Hz, std::size_t harmonics) {
  const Samples points = thinned(recording, near_Hz * static_cast<double>(harmonics));
  if (points.time_s.size() < static_cast<Eigen::Index>(2 * harmonics + 6)) return std::nullopt;
  const double resolution_Hz = 1.0 / recording.duration_s();
  double frequency = near_Hz;
  for (int pass = 0; pass < 12; ++pass) {
    const HarmonicStep step = harmonic_step(points, frequency, harmonics);
    const double change = std::clamp(step.change_Hz, -0.1 * resolution_Hz, 0.1 * resolution_Hz);
    frequency += change;
    if (!std::isfinite(frequency) || std::abs(frequency - near_Hz) > 0.7 * resolution_Hz) return std::nullopt;
    if (std::abs(change) < 1e-5 * resolution_Hz) {
      const double per_period = static_cast<double>(points.time_s.size()) * resolution_Hz / frequency;
      const double error = std::sqrt(variance(step, frequency / resolution_Hz, per_period));
      return TrackedFrequency{frequency, error, std::nullopt};
    }
  }
  return std::nullopt;
}

}  // namespace slipfit::signal
