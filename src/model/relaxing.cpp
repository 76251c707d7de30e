#include "model/relaxing.hpp"

#include <algorithm>

namespace slipfit::model {

/// The motion of a slip about one instant, by powers of the time since.
class RelaxingSlip::Series {
 public:
  Series(const Motion& at, const RelaxingSlip& slip) {
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

RelaxingSlip::Column RelaxingSlip::column_of(const Jet& jet) {
  return {jet.a, jet.v[0], jet.v[1], jet.v[2], jet.v[3]};
}

RelaxingSlip::RelaxingSlip(double z0, double zeta, double share, const Times& times, ForceView view)
    : z0_(z0, 0),
      zeta_(zeta, 1),
      share_(share, 2),
      time_(times.relaxation, 3),
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

void RelaxingSlip::slide() {
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

void RelaxingSlip::add_part(const Series& series, double begin, double length) {
  SlipPart part{begin, length, {}};
  Column next = integrals_.back();
  double power = length;
  for (std::size_t n = 0; n <= kSeriesOrder; ++n, power *= length) {
    part.terms[n] = column_of(series.z(n) + drag() * series.speed(n));
    for (std::size_t c = 0; c < next.size(); ++c) next[c] += part.terms[n][c] * power * kReciprocals[n + 1];
  }
  parts_.push_back(part);
  integrals_.push_back(next);
}

/// The end moves with the parameters: x' = 1 there, or x'' = 0 where the body does not come to rest.
void RelaxingSlip::end_at(const Series& series, double since) {
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
  for (std::size_t p = 0; p < kScaledParameters; ++p) end_.integral.v[static_cast<int>(p)] = integral[p + 1];
  end_.integral += (end_.z.a + drag().a * end.speed.a) * moves;
}

/// z' = 1 - q / t with q = s t - A exp(-(time since the slip before) / t); a line before that slip would have ended.
RelaxingSlip::State RelaxingSlip::before(double tau) const {
  const double since = std::max(0.0, stick_tau_ + tau);
  const Jet now = exp(-since / time_);
  const Jet rise = regained_ * (exp(-stick_tau_ / time_) - now);
  const double slope = since > 0.0 ? regained_.a / time_.a * now.a : 0.0;
  return {z0_ + (1.0 - share_) * tau + rise + drag(), 1.0 - share_.a + slope};
}

RelaxingSlip::State RelaxingSlip::after(double tau) const {
  const Jet since = tau - end_.tau;
  const Jet left = exp(-since / time_);
  const Jet rise = end_.regained * (1.0 - left);
  return {end_.z + (1.0 - share_) * since + rise + drag(), 1.0 - share_.a + end_.regained.a / time_.a * left.a};
}

std::size_t RelaxingSlip::part_at(double tau) const {
  const auto after = std::upper_bound(parts_.begin() + 1, parts_.end(), tau,
                                      [](double time, const SlipPart& part) { return time < part.begin; });
  return static_cast<std::size_t>(after - parts_.begin()) - 1;
}

RelaxingSlip::Point RelaxingSlip::at(double tau) const {
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

RelaxingSlip::Point RelaxingSlip::integral_to(double tau) const {
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
std::vector<SlipPart> RelaxingSlip::parts() const {
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

namespace {

/// Slip time, period and trough of slips that repeat: the typical cycle becomes its own.
std::optional<std::array<double, 3>> repeated(const std::array<double, 4>& numbers) {
  constexpr int kMostRounds = 200;
  constexpr double kSharp = 1e-12;
  const auto [z0, zeta, share, time] = numbers;
  RelaxingSlip::Times times{time, std::numbers::pi, std::numbers::pi + 2.0 * z0};
  for (int round = 0; round < kMostRounds; ++round) {
    const RelaxingSlip slip(z0, zeta, share, times);
    if (!slip.resticks()) return std::nullopt;
    const double trough = slip.end_force();
    const double longest = 2.0 * (z0 - trough) / (1.0 - share);  // twice the stick by the slope at rest
    const double begin = slip.tau_end();
    const double onset = z0;
    const double period =
        root_between([&slip, onset](double tau) { return slip.at(tau).z[0] - onset; }, begin, begin + longest);
    const double change = std::abs(period - times.period);
    times.slip = begin;
    times.period = period;
    if (change < kSharp * period) return std::array{begin, period, trough};
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

double relaxing_critical_lambda(double zeta, double share, double time, double near) {
  constexpr double kFarthest = 8.0;
  constexpr double kSharp = 1e-6;
  const auto repeats = [&](double lambda) {
    return lambda > 2.0 * zeta && repeated({lambda - 2.0 * zeta, zeta, share, time}).has_value();
  };
  double low = near;
  double high = near;
  while (low > near / kFarthest && repeats(low)) low /= 1.2;
  while (high < near * kFarthest && !repeats(high)) high *= 1.2;
  while (high > (1.0 + kSharp) * low) {
    const double middle = std::sqrt(low * high);
    (repeats(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace slipfit::model
