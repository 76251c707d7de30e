#pragma once

// Taylor series of a slip with velocity-dependent friction about one instant, with or without its derivatives with
// respect to the four scaled parameters (velocity_law.hpp).

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "model/velocity_law.hpp"

namespace slipfit::model {

/// In a step of at most one radian the terms of higher order are below 1e-12 of an undisturbed swing.
inline constexpr std::size_t kSeriesOrder = 14;

/// Coefficients of the powers of the time since the instant.
using Series = std::array<double, kSeriesOrder + 1>;

/// This table holds 1 / n: divisions would take longer than the rest of an integral.
inline constexpr auto kReciprocals = [] {
  std::array<double, kSeriesOrder + 2> reciprocals{};
  for (std::size_t n = 1; n < reciprocals.size(); ++n) reciprocals[n] = 1.0 / static_cast<double>(n);
  return reciprocals;
}();

inline double value_of(const Series& series, double time) {
  double value = series[kSeriesOrder];
  for (std::size_t n = kSeriesOrder; n > 0; --n) value = value * time + series[n - 1];
  return value;
}

inline double slope_of(const Series& series, double time) {
  double value = static_cast<double>(kSeriesOrder) * series[kSeriesOrder];
  for (std::size_t n = kSeriesOrder - 1; n > 0; --n) value = value * time + static_cast<double>(n) * series[n];
  return value;
}

/// The integral of the series over so much time from the instant on.
inline double integral_of(const Series& series, double time) {
  double value = 0.0;
  for (std::size_t n = kSeriesOrder + 1; n > 0; --n) value = (value + series[n - 1] * kReciprocals[n]) * time;
  return value;
}

/// Derivatives with respect to z0 = lambda - 2 zeta, zeta, slope and rate of the law at a fixed time.
inline constexpr std::size_t kScaledParameters = 4;
using ScaledGradient = std::array<double, kScaledParameters>;

/// A part of a slip in which the force is a polynomial: z and its derivatives with respect to z0, zeta and two numbers
/// of the law are sums of terms[n] (tau - begin)^n.
struct SlipPart {
  double begin = 0.0, length = 0.0;
  std::array<std::array<double, 1 + kScaledParameters>, kSeriesOrder + 1> terms{};
};
using GradientSeries = std::array<ScaledGradient, kSeriesOrder + 1>;

inline ScaledGradient value_of(const GradientSeries& series, double time) {
  ScaledGradient value = series[kSeriesOrder];
  for (std::size_t n = kSeriesOrder; n > 0; --n) {
    for (std::size_t p = 0; p < kScaledParameters; ++p) value[p] = value[p] * time + series[n - 1][p];
  }
  return value;
}

inline ScaledGradient slope_of(const GradientSeries& series, double time) {
  ScaledGradient value{};
  for (std::size_t n = kSeriesOrder; n > 0; --n) {
    for (std::size_t p = 0; p < kScaledParameters; ++p) {
      value[p] = value[p] * time + static_cast<double>(n) * series[n][p];
    }
  }
  return value;
}

inline ScaledGradient integral_of(const GradientSeries& series, double time) {
  ScaledGradient value{};
  for (std::size_t n = kSeriesOrder + 1; n > 0; --n) {
    for (std::size_t p = 0; p < kScaledParameters; ++p) {
      value[p] = (value[p] + series[n - 1][p] * kReciprocals[n]) * time;
    }
  }
  return value;
}

/// The state of a slip: s and v, and their derivatives at a fixed time.
struct SlipState {
  double s = 0.0, v = 0.0;
  ScaledGradient ds{}, dv{};
};

/// The motion near one instant, s' = 1 - v and v' = s - 2 zeta v - g(v), and (kWithGradient) the linear equations of
/// its derivatives. docs/model.md section 5
template <bool kWithGradient>
class SlipSeries {
 public:
  SlipSeries() = default;
  SlipSeries(const ScaledSlip& slip, const SlipState& at) {
    // Without strength the exponential does not count, but may be infinite.
    const ScaledLaw law = kWithGradient || slip.law.slope != 0.0 ? slip.law : ScaledLaw{};
    const ExcessFriction friction = law.at(at.v);
    s[0] = at.s;
    v[0] = at.v;
    Terms terms(law, at.v, friction);
    if constexpr (kWithGradient) {
      ds[0] = at.ds;
      dv[0] = at.dv;
    }
    // Each order with its own number of terms, known to the compiler: loops of few terms cost more than the terms.
    [&]<std::size_t... n>(std::index_sequence<n...>) {
      (extend<n>(slip, terms), ...);
    }
    (std::make_index_sequence<kSeriesOrder>());
  }

  Series s{}, v{};
  GradientSeries ds{}, dv{};  ///< zero without derivatives

  [[nodiscard]] SlipState at(double time) const {
    SlipState state{value_of(s, time), value_of(v, time), {}, {}};
    if constexpr (kWithGradient) {
      state.ds = value_of(ds, time);
      state.dv = value_of(dv, time);
    }
    return state;
  }
  [[nodiscard]] double acceleration_at(double time) const { return slope_of(v, time); }

 private:
  /// The series of the friction, g = slope * unit(v, rate) with unit' = growth:
  /// growth = (1 - rate v / q)^-q with q infinite, 2 or 1, and d unit / d rate has the slope v growth / (1 - rate v /
  /// q).
  struct Terms {
    Terms(const ScaledLaw& own, double speed, const ExcessFriction& friction) : law(own) {
      unit[0] = friction.d_slope;
      by_rate[0] = law.slope == 0.0 ? 0.0 : friction.d_rate / law.slope;
      if (law.shape != LawShape::Exponential) {
        share = law.shape == LawShape::Hyperbolic ? 0.5 * law.rate : law.rate;
        inverse[0] = 1.0 / (1.0 - share * speed);
      } else {
        growth[0] = std::exp(law.rate * speed);
      }
    }

    /// growth to order n.
    template <std::size_t n>
    void extend(const Series& speed) {
      if (law.shape == LawShape::Exponential) {
        if constexpr (n > 0) growth[n] = law.rate * unit[n];
        return;
      }
      if constexpr (n > 0) inverse[n] = share * inverse[0] * product(inverse, speed, n - 1, 1);
      growth[n] = law.shape == LawShape::Hyperbolic ? product(inverse, inverse, n, 0) : inverse[n];
    }

    /// unit and d unit / d rate to order n + 1. Terms are summed in turns, as one sum waits for itself.
    template <std::size_t n>
    void integrate(const Series& speed) {
      slope[n] = static_cast<double>(n + 1) * speed[n + 1];
      std::array<double, 2> units{};
      std::array<double, 2> rates{};
      for (std::size_t k = n + 1; k-- > 0;) {  // what is known last comes last
        units[k % 2] += growth[k] * slope[n - k];
        if constexpr (kWithGradient) rates[k % 2] += moved[k] * slope[n - k];
      }
      constexpr double kNext = 1.0 / static_cast<double>(n + 1);
      unit[n + 1] = (units[0] + units[1]) * kNext;
      by_rate[n + 1] = (rates[0] + rates[1]) * kNext;
    }

    /// The slope of d unit / d rate to order n, from that of v growth.
    template <std::size_t n>
    void move(double v_growth) {
      plain[n] = v_growth;
      moved[n] = law.shape == LawShape::Exponential ? v_growth : product(plain, inverse, n, 0);
    }

    /// Sum over k from 0 to n of a[k] b[n - k + shift].
    static double product(const Series& a, const Series& b, std::size_t n, std::size_t shift) {
      double sum = 0.0;
      for (std::size_t k = 0; k <= n; ++k) sum += a[k] * b[n - k + shift];
      return sum;
    }

    ScaledLaw law;
    double share = 0.0;  ///< rate / q
    Series unit{}, growth{}, inverse{}, by_rate{}, moved{}, plain{};
    Series slope{};  ///< of v'
  };

  /// Extends everything from order n to order n + 1.
  template <std::size_t n>
  void extend(const ScaledSlip& slip, Terms& terms) {
    constexpr double kNext = 1.0 / static_cast<double>(n + 1);
    terms.template extend<n>(v);
    s[n + 1] = ((n == 0 ? 1.0 : 0.0) - v[n]) * kNext;
    v[n + 1] = (s[n] - 2.0 * slip.zeta * v[n] - slip.law.slope * terms.unit[n]) * kNext;
    if constexpr (kWithGradient) add_gradient<n>(slip, terms);
    terms.template integrate<n>(v);
  }

  template <std::size_t n>
  void add_gradient(const ScaledSlip& slip, Terms& terms) {
    constexpr double kNext = 1.0 / static_cast<double>(n + 1);
    ScaledGradient drag{};
    double moved = 0.0;
    for (std::size_t k = n + 1; k-- > 0;) {
      moved += terms.growth[k] * v[n - k];
      for (std::size_t p = 0; p < kScaledParameters; ++p) drag[p] += terms.growth[k] * dv[n - k][p];
    }
    terms.template move<n>(moved);
    const ScaledGradient direct{0.0, 2.0 * v[n], terms.unit[n], slip.law.slope * terms.by_rate[n]};
    for (std::size_t p = 0; p < kScaledParameters; ++p) {
      ds[n + 1][p] = -dv[n][p] * kNext;
      dv[n + 1][p] = (ds[n][p] - 2.0 * slip.zeta * dv[n][p] - slip.law.slope * drag[p] - direct[p]) * kNext;
    }
  }
};

}  // namespace slipfit::model
