#include "fit/cycle/cycle_data.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/thresholds.hpp"
#include "fit/cycle/sensor.hpp"
#include "signal/smoothing.hpp"

namespace slipfit::fit {

namespace {

/// Holds the sum of a wave over the samples of a bin, and that of the wave times the distance from the mean time.
struct WaveSums {
  std::complex<double> sum, moment;
};

constexpr std::size_t kBinsPerRamp = 4;  // lets a bent ramp or a drift show; a straight one loses nothing
constexpr std::size_t kMinRampSamples = 2;

class Cutter {
 public:
  Cutter(std::span<const double> force, const Recording& recording, const Segmentation& segmentation,
         double half_width_s, const std::vector<std::size_t>& excluded, const HumLines& hum)
      : time_s_(recording.time_s()),
        force_(force),
        slips_(segmentation.slips),
        offered_(offered_slips(recording, segmentation)),
        half_width_s_(half_width_s),
        step_s_(recording.sample_interval_s()),
        clock_is_even_(recording.clock_is_even()),
        excluded_(excluded),
        hum_(hum) {
    if (const auto lag_s = recording.conditions().sensor_lag_s()) forgotten_s_ = kForgottenLags * *lag_s;
  }

  [[nodiscard]] std::vector<CycleData> cut() const {
    std::vector<std::size_t> selected;
    for (std::size_t i = 1; i < slips_.size(); ++i) {
      if (offered_.has(i)) selected.push_back(i);
    }
    std::vector<CycleData> all(selected.size());
    for_cycles(all.size(), time_s_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) all[k] = cut_one(selected[k]);
    });
    std::vector<CycleData> cycles;
    for (CycleData& cycle : all) {
      const std::size_t i = cycle.slip;
      const DetectedSlip& slip = slips_[i];
      const bool has_ramps = index_at(cycle.window_begin_s) + kMinRampSamples <= slip.peak &&
                             slip.trough + kMinRampSamples < index_at(cycle.window_end_s);
      if (!has_ramps || has_gap(cycle.samples)) continue;
      if (!cycles.empty()) cycles.back().continuous_with_next = cycles.back().slip + 1 == i && !gap_between(i - 1, i);
      cycles.push_back(std::move(cycle));
    }
    return cycles;
  }

 private:
  [[nodiscard]] CycleData cut_one(std::size_t i) const {
    CycleData cycle;
    cycle.slip = i;
    const double before_s = slips_[i - 1].middle_s + 0.5 * slips_[i - 1].fall_s;
    cycle.window_begin_s = std::max(0.5 * (before_s + slips_[i].middle_s), before_s + forgotten_s_);
    cycle.window_end_s = i + 1 < slips_.size()
                             ? 0.5 * (slips_[i].middle_s + slips_[i + 1].middle_s)
                             : std::min(time_s_.back(), slips_[i].middle_s + slips_[i].middle_s - cycle.window_begin_s);
    const double margin_s = std::max(half_width_s_, 1.5 * step_s_);
    const std::size_t begin = index_at(cycle.window_begin_s);
    const std::size_t slip_begin = std::clamp(index_at(slips_[i].middle_s - margin_s), begin, time_s_.size());
    const std::size_t end = index_at(cycle.window_end_s);
    const std::size_t slip_end =
        std::clamp(index_at(slips_[i].middle_s + margin_s), slip_begin, std::max(slip_begin, end));
    cycle.bins_before = bin(begin, slip_begin);
    cycle.bins_after = bin(slip_end, end);
    for_each_run(slip_begin, slip_end, [&](std::size_t from, std::size_t to) {
      for (std::size_t j = from; j < to; ++j) {
        cycle.samples.push_back(j);
        cycle.time_s.push_back(time_s_[j]);
        cycle.force.push_back(force_[j]);
      }
    });
    return cycle;
  }

  [[nodiscard]] std::size_t index_at(double time_s) const { return fit::index_at(time_s_, time_s); }

  [[nodiscard]] bool has_gap(const std::vector<std::size_t>& samples) const {
    for (std::size_t i = 1; i < samples.size(); ++i) {
      if (time_s_[samples[i]] - time_s_[samples[i] - 1] > thresholds::kGapSteps * step_s_) return true;
    }
    return samples.empty();
  }

  [[nodiscard]] bool gap_between(std::size_t first_slip, std::size_t second_slip) const {
    for (std::size_t i = slips_[first_slip].trough + 1; i <= slips_[second_slip].peak; ++i) {
      if (time_s_[i] - time_s_[i - 1] > thresholds::kGapSteps * step_s_) return true;
    }
    return false;
  }

  [[nodiscard]] std::vector<StickBin> bin(std::size_t begin, std::size_t end) const {
    std::vector<StickBin> bins;
    if (end <= begin) return bins;
    const std::size_t length = end - begin;
    const std::size_t parts = std::min<std::size_t>(kBinsPerRamp, std::max<std::size_t>(1, length / 8));
    for (std::size_t part = 0; part < parts; ++part) {
      const StickBin one = reduce(begin + part * length / parts, begin + (part + 1) * length / parts);
      if (one.count > 0.0) bins.push_back(one);
    }
    return bins;
  }

  [[nodiscard]] StickBin reduce(std::size_t begin, std::size_t end) const {
    const Sums sums = sum(force_, begin, end);
    StickBin bin;
    bin.count = sums.count;
    if (bin.count == 0.0) return bin;
    bin.time_s = time_s_[begin] + sums.t / bin.count;
    bin.force = force_[begin] + sums.f / bin.count;
    bin.time_spread = sums.spread();
    bin.slope = sums.slope();
    bin.scatter = (hum_.force_without_lines.empty() ? sums : sum(hum_.force_without_lines, begin, end)).scatter();
    for (const double line_Hz : hum_.frequencies_Hz) bin.lines.push_back(reduce_line(begin, end, bin, line_Hz));
    return bin;
  }

  struct Sums {
    double count = 0.0, t = 0.0, f = 0.0, tt = 0.0, tf = 0.0, ff = 0.0;

    [[nodiscard]] double spread() const { return std::max(0.0, tt - t * t / count); }
    [[nodiscard]] double cross() const { return tf - t * f / count; }
    [[nodiscard]] double slope() const { return spread() > 0.0 ? cross() / spread() : 0.0; }
    /// Returns the sum of squares about the line.
    [[nodiscard]] double scatter() const { return std::max(0.0, ff - f * f / count - slope() * cross()); }
  };

  /// Sums about the first sample, which is near enough to the mean that nothing cancels.
  [[nodiscard]] Sums sum(std::span<const double> force, std::size_t begin, std::size_t end) const {
    Sums sums;
    for_each_run(begin, end, [&](std::size_t from, std::size_t to) {
      const auto length = static_cast<Eigen::Index>(to - from);
      const auto t = Eigen::Map<const Eigen::ArrayXd>(&time_s_[from], length) - time_s_[begin];
      const auto f = Eigen::Map<const Eigen::ArrayXd>(&force[from], length) - force[begin];
      sums.count += static_cast<double>(length);
      sums.t += t.sum();
      sums.f += f.sum();
      sums.tt += t.square().sum();
      sums.tf += (t * f).sum();
      sums.ff += f.square().sum();
    });
    return sums;
  }

  /// Calls `action` for each run of samples that are not excluded.
  template <typename Action>
  void for_each_run(std::size_t begin, std::size_t end, const Action& action) const {
    for (const std::size_t gap : excluded_in(begin, end)) {
      if (gap > begin) action(begin, gap);
      begin = gap + 1;
    }
    if (end > begin) action(begin, end);
  }

  [[nodiscard]] std::span<const std::size_t> excluded_in(std::size_t begin, std::size_t end) const {
    const auto from = std::lower_bound(excluded_.begin(), excluded_.end(), begin);
    const auto to = std::lower_bound(from, excluded_.end(), end);
    return {excluded_.data() + (from - excluded_.begin()), static_cast<std::size_t>(to - from)};
  }

  [[nodiscard]] LineInBin reduce_line(std::size_t begin, std::size_t end, const StickBin& bin, double line_Hz) const {
    const double omega = 2.0 * std::numbers::pi * line_Hz;
    const auto [sum, moment] =
        clock_is_even_ ? even_wave_sums(begin, end, bin, omega) : wave_sums(begin, end, bin, omega);
    const double inertia = bin.time_spread > 0.0 ? 1.0 / bin.time_spread : 0.0;
    return {{sum.real() / bin.count, sum.imag() / bin.count}, {moment.real() * inertia, moment.imag() * inertia}};
  }

  [[nodiscard]] std::complex<double> wave_at(double time_s, double omega) const {
    return std::polar(1.0, omega * (time_s - hum_.begin_s));
  }

  [[nodiscard]] WaveSums wave_sums(std::size_t begin, std::size_t end, const StickBin& bin, double omega) const {
    WaveSums sums;
    for_each_run(begin, end, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) {
        const std::complex<double> wave = wave_at(time_s_[i], omega);
        sums.sum += wave;
        sums.moment += (time_s_[i] - bin.time_s) * wave;
      }
    });
    return sums;
  }

  /// On an even clock the phase turns by the same angle from sample to sample, and the sums over all samples have a
  /// closed form: with m = -(n - 1) / 2 ... (n - 1) / 2, sum e^(i m a) = sin(n a / 2) / sin(a / 2), and its derivative
  /// by a is i sum m e^(i m a).
  [[nodiscard]] WaveSums even_wave_sums(std::size_t begin, std::size_t end, const StickBin& bin, double omega) const {
    using namespace std::complex_literals;
    const double step_s = (time_s_.back() - time_s_.front()) / static_cast<double>(time_s_.size() - 1);
    const double half = 0.5 * omega * step_s;
    const auto n = static_cast<double>(end - begin);
    const double all = std::sin(n * half) / std::sin(half);
    const double derivative = 0.5 * (n * std::cos(n * half) - all * std::cos(half)) / std::sin(half);
    const double centre_s = 0.5 * (time_s_[begin] + time_s_[end - 1]);
    const std::complex<double> centre = wave_at(centre_s, omega);
    std::complex<double> sum = all * centre;
    std::complex<double> moment = (centre_s - bin.time_s) * sum - 1i * (step_s * derivative) * centre;
    for (const std::size_t i : excluded_in(begin, end)) {
      const std::complex<double> wave = wave_at(time_s_[i], omega);
      sum -= wave;
      moment -= (time_s_[i] - bin.time_s) * wave;
    }
    return {sum, moment};
  }

  std::span<const double> time_s_;
  std::span<const double> force_;
  const std::vector<DetectedSlip>& slips_;
  OfferedSlips offered_;
  double half_width_s_;
  double step_s_;
  bool clock_is_even_;
  const std::vector<std::size_t>& excluded_;
  const HumLines& hum_;
  double forgotten_s_ = 0.0;
};

}  // namespace

OfferedSlips::OfferedSlips(std::size_t slips, double samples_in_fall)
    : all_((slips + kCyclesOfRun - 1) / kCyclesOfRun) {
  constexpr double kMostRuns = 64.0;
  constexpr double kFewestRuns = 16.0;
  constexpr double kSamples = 16.0;
  most_ = static_cast<std::size_t>(std::clamp(kMostRuns * kSamples / samples_in_fall, kFewestRuns, kMostRuns));
}

bool OfferedSlips::has(std::size_t slip) const {
  constexpr double kGolden = 0.6180339887498949;  // multiples of it are spread evenly and never repeat
  if (all_ <= most_) return true;
  const std::size_t run = slip / kCyclesOfRun;
  const std::size_t part = run * most_ / all_;
  const std::size_t begin = (part * all_ + most_ - 1) / most_;
  const std::size_t end = ((part + 1) * all_ + most_ - 1) / most_;
  if (part + 1 == most_) return run + 1 == end;
  const double place = kGolden * static_cast<double>(part);
  return run == begin + static_cast<std::size_t>((place - std::floor(place)) * static_cast<double>(end - begin));
}

OfferedSlips offered_slips(const Recording& recording, const Segmentation& segmentation) {
  std::vector<double> falls_s;
  for (const DetectedSlip& slip : segmentation.slips) falls_s.push_back(slip.fall_s);
  return {falls_s.size(), signal::median(falls_s) / recording.sample_interval_s()};
}

std::vector<CycleData> cut_cycles(const Recording& recording, const Segmentation& segmentation, double half_width_s,
                                  const std::vector<std::size_t>& excluded, const HumLines& hum) {
  return cut_cycles_of(recording.force(), recording, segmentation, half_width_s, excluded, hum);
}

std::vector<CycleData> cut_cycles_of(std::span<const double> force, const Recording& recording,
                                     const Segmentation& segmentation, double half_width_s,
                                     const std::vector<std::size_t>& excluded, const HumLines& hum) {
  return Cutter(force, recording, segmentation, half_width_s, excluded, hum).cut();
}

CycleData thinned(CycleData cycle, double middle_s, double half_period_s, double step_s) {
  constexpr double kSamples = 20.0;
  constexpr double kReach = 2.0;
  constexpr std::size_t kSmooth = 4;
  const auto stride = static_cast<std::size_t>(std::max(1.0, half_period_s / step_s / kSamples));
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < cycle.time_s.size(); ++i) {  // by their numbers: steps stay even where some are left out
    const bool is_near = std::abs(cycle.time_s[i] - middle_s) <= kReach * half_period_s;
    const std::size_t every = is_near ? stride : kSmooth * stride;
    if ((cycle.samples[i] - cycle.samples.front()) % every == 0) kept.push_back(i);
  }
  const auto thin = [&](auto& values) {
    if (values.empty()) return;
    for (std::size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
    values.resize(kept.size());
  };
  thin(cycle.samples);
  thin(cycle.time_s);
  thin(cycle.force);
  thin(cycle.weight);
  return cycle;
}

std::vector<std::size_t> spread_indices(std::size_t count, std::size_t most) {
  const std::size_t size = std::min(count, most);
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < size; ++i) indices.push_back(size < 2 ? 0 : i * (count - 1) / (size - 1));
  return indices;
}

std::vector<CycleData> spread_subset(const std::vector<CycleData>& cycles, std::size_t size) {
  std::vector<CycleData> subset;
  for (const std::size_t i : spread_indices(cycles.size(), size)) subset.push_back(cycles[i]);
  return subset;
}

std::vector<Cycle> detected_cycles(const Recording& recording, const Segmentation& segmentation) {
  std::vector<Cycle> table;
  for (const DetectedSlip& slip : segmentation.slips) {
    Cycle row;
    row.peak_s = recording.time_s()[slip.peak];
    row.trough_s = recording.time_s()[slip.trough];
    row.peak_force = slip.peak_force;
    row.trough_force = slip.trough_force;
    table.push_back(row);
  }
  return table;
}

}  // namespace slipfit::fit
