#include <algorithm>

#include "rivals.hpp"
#include "track.hpp"

namespace atlas {
namespace {

struct State {
  double z = 0.0, dz = 0.0;
};

State rate_of(const ForwardScene& scene, const State& s) {
  return {s.dz, -s.z - 2.0 * scene.zeta * s.dz + friction_above(scene, 1.0 - s.dz)};
}

State runge_kutta(const ForwardScene& scene, const State& s, double h) {
  const auto ahead = [&s](const State& rate, double by) { return State{s.z + by * rate.z, s.dz + by * rate.dz}; };
  const State a = rate_of(scene, s);
  const State b = rate_of(scene, ahead(a, 0.5 * h));
  const State c = rate_of(scene, ahead(b, 0.5 * h));
  const State d = rate_of(scene, ahead(c, h));
  return {s.z + h / 6.0 * (a.z + 2.0 * b.z + 2.0 * c.z + d.z),
          s.dz + h / 6.0 * (a.dz + 2.0 * b.dz + 2.0 * c.dz + d.dz)};
}

}  // namespace

Answer run_sign_switching(const ForwardScene& scene, const WaveTimes& times, double step) {
  const double onset = scene.lambda - 2.0 * scene.zeta;
  State state{onset, 1.0};
  bool stuck = false;
  Track track(times);
  track.add({0.0, onset, 1.0, stuck});
  for (double tau = step; !track.finished(); tau += step) {
    if (stuck) {
      state.z += step;
      stuck = state.z < onset;
    } else {
      state = runge_kutta(scene, state, step);
      stuck = state.dz >= 1.0;
      if (stuck) state.dz = 1.0;
    }
    track.add({tau, state.z, state.dz, stuck});
  }
  return track.answer();
}

Answer run_time_stepping(const ForwardScene& scene, const WaveTimes& times, double step) {
  double z = scene.lambda - 2.0 * scene.zeta;
  double speed = 0.0;
  bool slides = true;  // at the very onset
  Track track(times);
  track.add({0.0, z, 1.0, false});
  for (double tau = step; !track.finished(); tau += step) {
    const double middle = z + 0.5 * step * (1.0 - speed);
    const double push = middle + 2.0 * scene.zeta * (1.0 - speed);
    const double resistance = slides ? friction_above(scene, speed) : scene.lambda;
    const double next = std::max(0.0, speed + step * (push - resistance));
    slides = next > 0.0;
    z = middle + 0.5 * step * (1.0 - next);
    speed = next;
    track.add({tau, z, 1.0 - speed, !slides});
  }
  return track.answer();
}

}  // namespace atlas
