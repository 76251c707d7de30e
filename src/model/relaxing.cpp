#include "model/relaxing.hpp"

#include <algorithm>

namespace slipfit::model {

/// The motion of a slip about one instant, by powers of the time since.
template <class Jet>
class RelaxingSlipOf<Jet>::Series {
 public:
  Series(const Motion& at, const RelaxingSlipOf& slip) {
    z_[0] = at.z;
    speed_[0] = at.speed;
    relaxing_[0] = at.relaxing;
    const Jet rate = 1.0 / slip.time_;
    for (std::size_t n = 0; n < kSeriesOrder; ++n) {
      z_[n + 1] = (speed_[n] - rate * relaxing_[n]) * kReciprocals[n + 1];
      speed_[n + 1] = (-z_[n] - 2.0 * slip.zeta_ * speed_[n]) * kReciprocals[n + 1];
      relaxing_[n + 1] = (slip.share_ * speed_[n] - rate * relaxing_[n]) * kReciprocals[n + 1];
    }
  }

  [[nodiscard]] const Jet& z(std::size_t order) const { return z_[order]; }
  [[nodiscard]] const Jet& speed(std::size_t order) const { return speed_[order]; }
  [[nodiscard]] Motion at(const Jet& since) const {
    return {sum(z_, since), sum(speed_, since), sum(relaxing_, since)};
  }
  /// x' and x'' without derivatives by the parameters.
  [[nodiscard]] double speed_at(double since) const {
    double value = speed_[kSeriesOrder].a;
    for (std::size_t n = kSeriesOrder; n > 0; --n) value = value * since + speed_[n - 1].a;
    return value;
  }
  [[nodiscard]] double acceleration_at(double since) const {
    double value = 0.0;
    for (std::size_t n = kSeriesOrder; n > 0; --n) value = value * since + static_cast<double>(n) * speed_[n].a;
    return value;
  }

 private:
  static Jet sum(const JetSeries& series, const Jet& since) {
    Jet value = series[kSeriesOrder];
    for (std::size_t n = kSeriesOrder; n > 0; --n) value = value * since + series[n - 1];
    return value;
  }

  JetSeries z_, speed_, relaxing_;
};

template <class Jet>
typename RelaxingSlipOf<Jet>::Column RelaxingSlipOf<Jet>::column_of(const Jet& jet) {
  Column column{jet.a};
  if constexpr (kHasDerivatives) std::copy_n(jet.v.data(), kScaledParameters, column.begin() + 1);
  return column;
}

template <class Jet>
RelaxingSlipOf<Jet>::RelaxingSlipOf(double z0, double zeta, double share, const Times& times, ForceView view)
    : z0_(parameter(z0, 0)),
      zeta_(parameter(zeta, 1)),
      share_(parameter(share, 2)),
      time_(parameter(times.relaxation, 3)),
      view_(view),
      stick_tau_(times.period - times.slip),
      regained_(share_ * time_ * regained_in_stick(times.period / time_, times.slip / time_)) {
  constexpr int kMostSlides = 12;
  constexpr double kSame = 1e-11;  // of the force at the onset
  const Jet left = exp(-times.period / time_);
  for (int i = 0; i < kMostSlides; ++i) {
    slide();
    // Slips repeat: the stick before is like the one after it. Of what it is not, this share is left a period later.
    const Jet other = end_.regained - regained_;
    const double most = std::max(std::abs(other.a), other.v.cwiseAbs().maxCoeff());
    // What is left of it in the middle of the stick is the most that a cycle shows.
    if (!(most * std::exp(-0.5 * stick_tau_ / times.relaxation) > kSame * std::abs(z0))) break;
    regained_ += other / (1.0 - left);
  }
}

template <class Jet>
void RelaxingSlipOf<Jet>::slide() {
  constexpr double kLongest = 60.0;  // no slip takes ten periods of the oscillation
  parts_.clear();
  integrals_.assign(1, {});
  Motion motion{z0_, Jet(1.0), share_ * time_ - regained_ * exp(-stick_tau_ / time_)};
  const double step = 1.0 / std::max(1.0, 1.0 / time_.a + 2.0 * std::abs(zeta_.a));  // SlipPart: one radian
  bool was_slowing = false;
  for (double begin = 0.0; begin < kLongest; begin += step) {
    const Series series(motion, *this);
    // The body slides at 1 - x': it speeds up, slows down, and comes to rest or speeds up again.
    const auto slowing = [&](double since) { return series.acceleration_at(since); };
    const auto remaining = [&](double since) { return series.speed_at(since) - 1.0; };
    const bool slows = slowing(step) > 0.0;
    const double first = was_slowing ? 0.0 : slows ? root_between(slowing, 0.0, step) : step;
    const double last = was_slowing && !slows ? root_between(slowing, 0.0, step) : step;
    resticks_ = (was_slowing || slows) && remaining(last) >= 0.0;
    if (resticks_ || (was_slowing && !slows)) {
      const double since = resticks_ ? root_between(remaining, first, last) : last;
      add_part(series, begin, since);
      end_at(series, since);
      return;
    }
    was_slowing = slows;
    add_part(series, begin, step);
    motion = series.at(Jet(step));
  }
  end_at(Series(motion, *this), 0.0);
}

template <class Jet>
void RelaxingSlipOf<Jet>::add_part(const Series& series, double begin, double length) {
  SlipPart part{begin, length, {}};
  Column next = integrals_.back();
  double power = length;
  for (std::size_t n = 0; n <= kSeriesOrder; ++n, power *= length) {
    part.terms[n] = column_of(series.z(n) + drag() * series.speed(n));
    const std::size_t columns = kHasDerivatives ? next.size() : 1;
    for (std::size_t c = 0; c < columns; ++c) next[c] += part.terms[n][c] * power * kReciprocals[n + 1];
  }
  parts_.push_back(part);
  integrals_.push_back(next);
}

/// The end moves with the parameters: x' = 1 there, or x'' = 0 where the body does not come to rest.
template <class Jet>
void RelaxingSlipOf<Jet>::end_at(const Series& series, double since) {
  tau_end_ = parts_.back().begin + parts_.back().length;
  const Motion fixed = series.at(Jet(since));
  const Jet acceleration = -fixed.z - 2.0 * zeta_ * fixed.speed;
  const double slope = fixed.speed.a - fixed.relaxing.a / time_.a;
  Jet moves = resticks_ ? -(fixed.speed - 1.0) / series.acceleration_at(since) : acceleration / slope;
  moves.a = 0.0;
  const Motion end = series.at(since + moves);
  end_.tau = tau_end_ + moves;
  end_.z = end.z;
  end_.regained = share_ * time_ - end.relaxing;
  const Column& integral = integrals_.back();
  end_.integral = Jet(integral[0]);
  if constexpr (kHasDerivatives) std::copy_n(integral.begin() + 1, kScaledParameters, end_.integral.v.data());
  end_.integral += (end_.z.a + drag().a * end.speed.a) * moves;
}

/// z' = 1 - q / t with q = s t - A exp(-(time since the slip before) / t); a line before that slip would have ended.
template <class Jet>
typename RelaxingSlipOf<Jet>::State RelaxingSlipOf<Jet>::before(double tau) const {
  const double since = std::max(0.0, stick_tau_ + tau);
  const Jet now = exp(-since / time_);
  const Jet rise = regained_ * (exp(-stick_tau_ / time_) - now);
  const double slope = since > 0.0 ? regained_.a / time_.a * now.a : 0.0;
  return {z0_ + (1.0 - share_) * tau + rise + drag(), 1.0 - share_.a + slope};
}

template <class Jet>
typename RelaxingSlipOf<Jet>::State RelaxingSlipOf<Jet>::after(double tau) const {
  const Jet since = tau - end_.tau;
  const Jet left = exp(-since / time_);
  const Jet rise = end_.regained * (1.0 - left);
  return {end_.z + (1.0 - share_) * since + rise + drag(), 1.0 - share_.a + end_.regained.a / time_.a * left.a};
}

template <class Jet>
std::size_t RelaxingSlipOf<Jet>::part_at(double tau) const {
  const auto after = std::upper_bound(parts_.begin() + 1, parts_.end(), tau,
                                      [](double time, const SlipPart& part) { return time < part.begin; });
  return static_cast<std::size_t>(after - parts_.begin()) - 1;
}

template <class Jet>
typename RelaxingSlipOf<Jet>::Point RelaxingSlipOf<Jet>::at(double tau) const {
  if (tau <= 0.0) return point_of(before(tau));
  if (tau > tau_end_) return point_of(after(tau));
  const SlipPart& part = parts_[part_at(tau)];
  const double since = tau - part.begin;
  Point point{part.terms[kSeriesOrder], 0.0};
  for (std::size_t n = kSeriesOrder; n > 0; --n) {
    point.d_tau = point.d_tau * since + static_cast<double>(n) * part.terms[n][0];
    for (std::size_t c = 0; c < point.z.size(); ++c) point.z[c] = point.z[c] * since + part.terms[n - 1][c];
  }
  return point;
}

template <class Jet>
typename RelaxingSlipOf<Jet>::Point RelaxingSlipOf<Jet>::integral_to(double tau) const {
  if (tau <= 0.0) {
    const Jet onset = exp(-stick_tau_ / time_);
    const double since = std::max(0.0, stick_tau_ + tau);
    const Jet now = exp(-since / time_);
    const double in_line = std::min(0.0, stick_tau_ + tau);
    const Jet rise = regained_ * (onset * tau + time_ * (now - onset) - in_line);
    return {column_of(tau * (z0_ + drag() + 0.5 * (1.0 - share_) * tau) + rise), before(tau).z.a};
  }
  if (tau > tau_end_) {
    const Jet since = tau - end_.tau;
    const Jet rise = end_.regained * (since - time_ * (1.0 - exp(-since / time_)));
    const Jet line = since * (end_.z + drag() + 0.5 * (1.0 - share_) * since);
    return {column_of(end_.integral + line + rise), after(tau).z.a};
  }
  const std::size_t index = part_at(tau);
  const SlipPart& part = parts_[index];
  const double since = tau - part.begin;
  Point point{integrals_[index], at(tau).z[0]};
  double power = since;
  for (std::size_t n = 0; n <= kSeriesOrder; ++n, power *= since) {
    for (std::size_t c = 0; c < point.z.size(); ++c) point.z[c] += part.terms[n][c] * power * kReciprocals[n + 1];
  }
  return point;
}

/// Parts of the stick last as long as the exponential takes a radian, and longer once it has died out.
template <class Jet>
std::vector<SlipPart> RelaxingSlipOf<Jet>::parts() const {
  constexpr double kPeriods = 3.0;
  constexpr double kDiedOut = 36.0;  // exp(-36) is rounding
  std::vector<SlipPart> parts = parts_;
  const double last = kPeriods * (stick_tau_ + tau_end_);
  for (double begin = tau_end_; begin < last; begin += parts.back().length) {
    const bool is_straight = begin - tau_end_ > kDiedOut * time_.a;
    SlipPart part{begin, is_straight ? last - begin : std::min(time_.a, last - begin), {}};
    Jet term = is_straight ? Jet(0.0) : end_.regained * exp(-(begin - end_.tau) / time_);
    part.terms[0] = column_of(after(begin).z);
    for (std::size_t n = 1; n <= kSeriesOrder; ++n) {
      term *= -kReciprocals[n] / time_;
      part.terms[n] = column_of((n == 1 ? 1.0 - share_ : Jet(0.0)) - term);
    }
    parts.push_back(part);
  }
  return parts;
}

template class RelaxingSlipOf<ceres::Jet<double, static_cast<int>(kScaledParameters)>>;

namespace {

using PlainSlip = RelaxingSlipOf<ceres::Jet<double, 1>>;

/// Slip time, period and trough of slips that repeat: the typical cycle becomes its own.
std::optional<std::array<double, 3>> repeated(const std::array<double, 4>& numbers) {
  constexpr int kMostRounds = 200;
  constexpr double kSharp = 1e-10;  // the inner loop leaves 1e-11
  const auto [z0, zeta, share, time] = numbers;
  PlainSlip::Times times{time, std::numbers::pi, std::numbers::pi + 2.0 * z0};
  double change_before = 0.0;
  for (int round = 0; round < kMostRounds; ++round) {
    const PlainSlip slip(z0, zeta, share, times);
    if (!slip.resticks()) return std::nullopt;
    const double trough = slip.end_force();
    const double longest = 2.0 * (z0 - trough) / (1.0 - share);  // twice the stick by the slope at rest
    const double begin = slip.tau_end();
    const double onset = z0;
    const double period =
        root_between([&slip, onset](double tau) { return slip.at(tau).z[0] - onset; }, begin, begin + longest);
    const double change = period - times.period;
    times.slip = begin;
    times.period = period;
    if (std::abs(change) < kSharp * period) return std::array{begin, period, trough};
    // Every other round to where changes that shrink by the same ratio lead (Aitken).
    const double ratio = change_before != 0.0 ? change / change_before : 0.0;
    const double limit = period + change * ratio / (1.0 - ratio);
    const bool jumps = std::abs(ratio) < 1.0 && limit > begin;
    if (jumps) times.period = limit;
    change_before = jumps ? 0.0 : change;
  }
  return std::nullopt;
}

}  // namespace

std::optional<RelaxingPeriod> relaxing_period(double z0, double zeta, double share, double time) {
  const std::array<double, 4> numbers{z0, zeta, share, time};
  const auto found = repeated(numbers);
  if (!found) return std::nullopt;
  RelaxingPeriod result{{(*found)[0]}, {(*found)[1]}, {(*found)[2]}};
  const std::array<RelaxingSlip::Column*, 3> columns{&result.slip, &result.period, &result.trough};
  for (std::size_t p = 0; p < numbers.size(); ++p) {
    // Small enough for a share that must not fall below 0, and far above the sharpness of the solution.
    const double step = 1e-4 * std::max(std::abs(numbers[p]), 0.01);
    std::array<double, 4> above = numbers;
    std::array<double, 4> below = numbers;
    above[p] += step;
    below[p] -= step;
    const auto high = repeated(above);
    const auto low = repeated(below);
    if (!high || !low) return std::nullopt;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      (*columns[i])[p + 1] = ((*high)[i] - (*low)[i]) / (2.0 * step);
    }
  }
  return result;
}

bool relaxing_repeats(double z0, double zeta, double share, double time) {
  return repeated({z0, zeta, share, time}).has_value();
}

}  // namespace slipfit::model
