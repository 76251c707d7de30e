#include "slipfit/core/recording.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/clock_step.hpp"
#include "core/filter_delay.hpp"

namespace slipfit {
namespace {

// No sensor reads beyond these, and the fourth powers of what lies between are still numbers. (Instruments that follow
// SCPI write 9.9e37 for infinity and 9.91e37 for what is not a number.)
constexpr double kLargest = 9e36;
constexpr double kSmallest = 1e-36;

// Counted, not searched: without a way out of the loop the compiler works on several values at once.
bool all_readable(const std::vector<double>& values) {
  return std::ranges::count_if(values, [](double v) { return !(std::abs(v) <= kLargest); }) == 0;
}

void flush_to_zero(std::vector<double>& values) {
  for (double& value : values) value = std::abs(value) < kSmallest ? 0.0 : value;
}

bool is_even(std::span<const double> time_s) {
  const double begin = time_s.front();
  const double step = (time_s.back() - begin) / static_cast<double>(time_s.size() - 1);
  const double bound = 0.25 * step;
  std::size_t off = 0;
  double place = 0.0;
  for (const double time : time_s) {
    off += std::abs(time - begin - step * place) < bound ? 0U : 1U;
    place += 1.0;
  }
  return off == 0;
}

}  // namespace

struct Recording::Samples {
  std::vector<double> time_s;
  std::vector<double> force;
  std::vector<double> normal_force_N;  ///< empty: not measured
  std::vector<double> drive_m;         ///< empty: not measured
};

double Recording::whole_begin_s() const {
  return samples_->time_s.front();
}

std::optional<double> Conditions::sensor_lag_s() const {
  if (!sensor_bandwidth_Hz) return std::nullopt;
  return butterworth_delay(sensor_filter_order) / (2.0 * std::numbers::pi * *sensor_bandwidth_Hz);
}

Result<Recording> Recording::create(std::vector<double> time_s, std::vector<double> force, Conditions conditions,
                                    Provenance provenance, std::vector<double> normal_force_N,
                                    std::vector<double> drive_m) {
  if (time_s.size() != force.size()) return Error{"length_mismatch", "time and force differ in length"};
  if (time_s.size() < 2) return Error{"too_few_samples", "fewer than 2 samples with a time and a force"};
  if (!all_readable(time_s) || !all_readable(force)) {
    return Error{"not_finite", "time or force is not finite or exceeds 9e36, which instruments write for an overload"};
  }
  if (order_of(time_s).backward > 0) return Error{"time_decreases", "time runs backwards"};
  if (time_s.front() == time_s.back()) return Error{"time_constant", "all samples have the same time"};
  if (!std::isfinite(conditions.speed_m_per_s) || conditions.speed_m_per_s <= 0.0) {
    return Error{"speed_not_positive", "the driving speed must be a positive number of metres per second"};
  }
  if (conditions.normal_force_N && !(*conditions.normal_force_N > 0.0 && std::isfinite(*conditions.normal_force_N))) {
    return Error{"normal_force_not_positive", "the normal force must be a positive number of newtons"};
  }
  flush_to_zero(force);
  if (normal_force_N.size() != time_s.size() || !all_readable(normal_force_N)) normal_force_N.clear();
  if (drive_m.size() != time_s.size() || !all_readable(drive_m)) drive_m.clear();
  Recording empty;
  empty.conditions_ = std::move(conditions);
  empty.provenance_ = std::move(provenance);
  const std::size_t size = time_s.size();
  auto samples = std::make_shared<const Samples>(
      Samples{std::move(time_s), std::move(force), std::move(normal_force_N), std::move(drive_m)});
  Recording recording = empty.with_samples(std::move(samples), 0, size);
  if (!(recording.sample_interval_s_ >= kSmallest))
    return Error{"time_constant", "the clock steps by less than 1e-36 s"};
  return recording;
}

Recording Recording::with_samples(std::shared_ptr<const Samples> samples, std::size_t begin, std::size_t end) const {
  Recording recording;
  recording.samples_ = std::move(samples);
  recording.time_s_ = std::span(recording.samples_->time_s).subspan(begin, end - begin);
  recording.force_ = std::span(recording.samples_->force).subspan(begin, end - begin);
  if (!recording.samples_->normal_force_N.empty()) {
    recording.normal_force_N_ = std::span(recording.samples_->normal_force_N).subspan(begin, end - begin);
  }
  if (!recording.samples_->drive_m.empty()) {
    recording.drive_m_ = std::span(recording.samples_->drive_m).subspan(begin, end - begin);
  }
  recording.sample_interval_s_ = median_positive_step(recording.time_s_);
  recording.clock_is_even_ = is_even(recording.time_s_);
  recording.conditions_ = conditions_;
  recording.provenance_ = provenance_;
  return recording;
}

Recording Recording::part(std::size_t begin, std::size_t end) const {
  const auto before = static_cast<std::size_t>(time_s_.data() - samples_->time_s.data());
  return with_samples(samples_, before + begin, before + end);
}

Recording Recording::selected(std::span<const std::size_t> samples) const {
  const auto pick = [&](std::span<const double> values) {
    std::vector<double> picked;
    picked.reserve(samples.size());
    for (const std::size_t i : samples) picked.push_back(values[i]);
    return picked;
  };
  Samples picked{pick(time_s_), pick(force_), {}, {}};
  if (!normal_force_N_.empty()) picked.normal_force_N = pick(normal_force_N_);
  if (!drive_m_.empty()) picked.drive_m = pick(drive_m_);
  return with_samples(std::make_shared<const Samples>(std::move(picked)), 0, samples.size());
}

}  // namespace slipfit
