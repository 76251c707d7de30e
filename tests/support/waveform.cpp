#include "support/waveform.hpp"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>

#include "model/slip.hpp"
#include "model/weakening.hpp"

namespace slipfit {
namespace {

using model::Phasor;

constexpr std::size_t kFresh = 256;  // steps after which a phasor is started afresh: rounding adds up over them

struct Periodic {
  model::Slip slip;
  double w_n = 0.0;
  double zeta = 0.0;
  double scale_N = 0.0;  ///< k V / w_n
  double kinetic_N = 0.0;
  double tau_period = 0.0;
};

std::optional<Periodic> periodic(const Slider& slider, const Friction& friction, double speed_m_per_s) {
  Periodic p;
  p.w_n = slider.natural_frequency_rad_per_s();
  p.zeta = slider.damping_ratio();
  p.scale_N = slider.stiffness_N_per_m() * speed_m_per_s / p.w_n;
  p.kinetic_N = friction.kinetic_N();
  const double lambda = friction.difference_N() / p.scale_N;
  if (!(lambda > 0.0)) return std::nullopt;
  p.slip = model::solve_slip(lambda - 2.0 * p.zeta, p.zeta);
  if (!p.slip.resticks) return std::nullopt;
  p.tau_period = p.slip.tau_end + p.slip.z0 - p.slip.end.z;
  return p;
}

/// Calls `slips(first, last, tau_first)` and `sticks(first, last, tau_first, cycle)` for every stretch of samples; tau
/// counts from the onset of the stretch's cycle.
template <class Slips, class Sticks>
void for_each_stretch(const Periodic& p, const SampleTimes& times, const Slips& slips, const Sticks& sticks) {
  const double step = p.w_n * times.step_s;
  const double begin = p.w_n * times.begin_s;
  std::size_t first = 0;
  auto cycle = static_cast<std::size_t>(begin / p.tau_period);
  while (first < times.count) {
    const double onset = static_cast<double>(cycle) * p.tau_period;
    const auto samples_before = [&](double tau) {
      const double samples = std::ceil((onset + tau - begin) / step);
      return std::clamp(samples, static_cast<double>(first), static_cast<double>(times.count));
    };
    const auto tau_at = [&](std::size_t i) { return begin + static_cast<double>(i) * step - onset; };
    const auto slip_last = static_cast<std::size_t>(samples_before(p.slip.tau_end));
    for (; first < slip_last; first = std::min(slip_last, first + kFresh)) {
      slips(first, std::min(slip_last, first + kFresh), tau_at(first), cycle);
    }
    const auto stick_last = static_cast<std::size_t>(samples_before(p.tau_period));
    if (first < stick_last) sticks(first, stick_last, tau_at(first), cycle);
    first = std::max(first, stick_last);
    ++cycle;
  }
}

}  // namespace

std::optional<std::vector<double>> damped_waveform(const Slider& slider, const Friction& friction, double speed_m_per_s,
                                                   ForceView view, const SampleTimes& times) {
  const std::optional<Periodic> p = periodic(slider, friction, speed_m_per_s);
  if (!p) return std::nullopt;
  std::vector<double> force_N(times.count);
  const double step = p->w_n * times.step_s;
  const double drag = view == ForceView::Spring ? 0.0 : 2.0 * p->zeta;  // z' = 1 in stick
  // z = z0 c + (1 + zeta z0) s / b and z' = c - (z0 + zeta) s / b: one cosine and one sine weight for the view's sum.
  const double z0 = p->slip.z0;
  const double sine_scale = p->scale_N / p->slip.b;
  double cosine_N = p->scale_N * (z0 + drag);
  double sine_N = sine_scale * (1.0 + p->zeta * z0 - drag * (z0 + p->zeta));
  if (view == ForceView::Contact) cosine_N = sine_N = 0.0;
  Phasor phasor(p->zeta, p->slip.b, step);
  const auto slips = [&](std::size_t first, std::size_t last, double tau, std::size_t) {
    phasor.start(tau);
    for (std::size_t i = first; i < last; ++i, phasor.step()) {
      force_N[i] = p->kinetic_N + cosine_N * phasor.c() + sine_N * phasor.s();
    }
  };
  const auto sticks = [&](std::size_t first, std::size_t last, double tau, std::size_t) {
    const double start_N = p->kinetic_N + p->scale_N * (p->slip.end.z + drag + tau - p->slip.tau_end);
    for (std::size_t i = first; i < last; ++i) {
      force_N[i] = start_N + p->scale_N * step * static_cast<double>(i - first);
    }
  };
  for_each_stretch(*p, times, slips, sticks);
  return force_N;
}

namespace {

using Jet = ceres::Jet<double, static_cast<int>(kSensitivityParameters)>;

/// Derivatives with respect to the model's parameters.
class ForceJets {
 public:
  ForceJets(const Periodic& p, const Slider& slider, const Friction& friction, double speed_m_per_s)
      : w_n_(p.w_n, static_cast<int>(kNaturalFrequency)),
        zeta_(p.zeta, static_cast<int>(kDampingRatio)),
        kinetic_N_(p.kinetic_N, static_cast<int>(kKineticFriction)),
        scale_N_(Jet(slider.stiffness_N_per_m(), static_cast<int>(kStiffness)) *
                 Jet(speed_m_per_s, static_cast<int>(kDrivingSpeed)) / w_n_),
        z0_((Jet(friction.static_N(), static_cast<int>(kStaticFriction)) - kinetic_N_) / scale_N_ - 2.0 * zeta_),
        period_by_(damped_sensitivity(slider, friction, speed_m_per_s)->period_s.gradient.data()) {}

  /// tau = w_n (t - cycle * T): moves with w_n and with the period.
  [[nodiscard]] Jet force_N(const model::WavePoint& wave, double tau, std::size_t cycle) const {
    Jet z(wave.z);
    z.v = wave.d_z0 * z0_.v + wave.d_zeta * zeta_.v +
          wave.d_tau * (tau / w_n_.a * w_n_.v - static_cast<double>(cycle) * w_n_.a * period_by_);
    return kinetic_N_ + scale_N_ * z;
  }

 private:
  Jet w_n_, zeta_, kinetic_N_, scale_N_, z0_;
  decltype(Jet::v) period_by_;
};

}  // namespace

std::optional<WaveformSensitivity> damped_waveform_sensitivity(const Slider& slider, const Friction& friction,
                                                               double speed_m_per_s, const SampleTimes& times) {
  const std::optional<Periodic> p = periodic(slider, friction, speed_m_per_s);
  if (!p) return std::nullopt;
  WaveformSensitivity result{std::vector<double>(times.count),
                             std::vector<double>(times.count * kSensitivityParameters)};
  const ForceJets jets(*p, slider, friction, speed_m_per_s);
  const double step = p->w_n * times.step_s;
  const auto put = [&](std::size_t i, const model::WavePoint& wave, double tau, std::size_t cycle) {
    const Jet force_N = jets.force_N(wave, tau, cycle);
    result.force_N[i] = force_N.a;
    std::copy_n(force_N.v.data(), kSensitivityParameters, result.gradient.data() + i * kSensitivityParameters);
  };
  Phasor phasor(p->zeta, p->slip.b, step);
  const auto slips = [&](std::size_t first, std::size_t last, double tau, std::size_t cycle) {
    phasor.start(tau);
    for (std::size_t i = first; i < last; ++i, phasor.step(), tau += step) {
      put(i, model::slip_wave(p->slip, tau, phasor.c(), phasor.s() / p->slip.b), tau, cycle);
    }
  };
  const model::StickLine line = model::stick_after(p->slip);
  const auto sticks = [&](std::size_t first, std::size_t last, double tau_first, std::size_t cycle) {
    for (std::size_t i = first; i < last; ++i) {
      const double tau = tau_first + step * static_cast<double>(i - first);
      put(i, {line.intercept + tau, line.d_z0, line.d_zeta, 1.0}, tau, cycle);
    }
  };
  for_each_stretch(*p, times, slips, sticks);
  return result;
}

}  // namespace slipfit
