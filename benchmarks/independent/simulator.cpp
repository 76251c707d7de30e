#include "simulator.hpp"

#include <cmath>
#include <cstddef>
#include <cstdio>

namespace independent {
namespace {

struct State {
  double force, velocity, slid, sensor, sensor_rate, since_slip, relaxing, behind, slow, heat, drawn;
};

double sign_of(double x) {
  return x < 0 ? -1.0 : 1.0;
}

double friction(const Model* m, double kinetic, double excess, double speed, double slid) {
  double f = kinetic + m->quadratic * speed * speed;
  if (m->stribeck_speed > 0) {
    const double x = std::fabs(speed) / m->stribeck_speed;
    f += m->stribeck_force * (m->velocity_law == 0   ? std::exp(-x)
                              : m->velocity_law == 1 ? -std::log1p(x)
                                                     : 1.0 / (1.0 + x));
  }
  if (m->weakening_length > 0 && slid < m->weakening_length) f += excess * (1.0 - slid / m->weakening_length);
  return f;
}

// The normal force over its mean, where the deflection of the spring changes it.
double load(const Model* m, double force, double kinetic) {
  return m->load_slope != 0.0 ? 1.0 + m->load_slope * (std::fabs(force) - kinetic) / kinetic : 1.0;
}

double aged(const Model* m, double stick_s) {
  if (m->ageing_time <= 0) return 0.0;
  const double x = stick_s / m->ageing_time;
  return m->ageing * (m->ageing_law == 0 ? std::log1p(x) : m->ageing_law == 1 ? std::pow(x, 0.25) : -std::expm1(-x));
}

double tangent(const Model* m, const State* s, int sliding) {
  double k = m->stiffness;
  if (m->stiffening > 0) k += 3.0 * m->stiffening * std::pow(s->force / m->stiffness, 2);
  if (m->reload_length > 0 && !sliding)
    k += m->reload_force / m->reload_length * std::exp(-s->since_slip / m->reload_length);
  if (m->line_length != 0) k /= 1.0 - s->drawn / m->line_length;
  return k;
}

// The speed of a drive that falls behind by its compliance times the force, within its time constant.
double actual(const Model* m, const State* s, double commanded) {
  if (m->servo_time <= 0) return commanded;
  return commanded - (m->servo_compliance * s->force - s->behind) / m->servo_time;
}

State rate(const Model* m, const State* s, double commanded, double kinetic, double static_friction, int sliding,
           double direction) {
  State d{};
  const double mass = m->stiffness / (m->omega * m->omega);
  const double damper = 2.0 * m->damping_ratio * m->stiffness / m->omega;
  const double drive = actual(m, s, commanded);
  double velocity = 0.0;
  d.behind = commanded - drive;
  d.drawn = drive;
  if (sliding) {
    velocity = s->velocity;
    const double f = direction * load(m, s->force, kinetic) *
                     (friction(m, kinetic, static_friction - kinetic, velocity, s->slid) - m->heat_slope * s->heat);
    d.velocity = (s->force + damper * (drive - velocity) - f) / mass;
    d.slid = std::fabs(velocity);
    d.heat = std::fabs(velocity);
  } else {
    d.since_slip = std::fabs(drive);
    if (m->creep_force > 0)
      velocity = m->creep_share * drive * std::exp(-(static_friction - std::fabs(s->force)) / m->creep_force);
  }
  d.force = tangent(m, s, sliding) * (drive - velocity);
  if (m->relax_time > 0) {
    d.force -= s->relaxing / m->relax_time;
    d.relaxing = m->relax_share * m->stiffness * (drive - velocity) - s->relaxing / m->relax_time;
  }
  if (m->slow_time > 0) {
    d.force -= s->slow / m->slow_time;
    d.slow = m->slow_share * m->stiffness * (drive - velocity) - s->slow / m->slow_time;
  }
  if (m->heat_time > 0) d.heat -= s->heat / m->heat_time;
  if (m->sensor_omega > 0) {
    d.sensor = s->sensor_rate;
    d.sensor_rate = m->sensor_omega * m->sensor_omega * (s->force - s->sensor) -
                    2.0 * m->sensor_damping * m->sensor_omega * s->sensor_rate;
  }
  return d;
}

State moved(State s, State d, double h) {
  auto* a = reinterpret_cast<double*>(&s);
  const auto* b = reinterpret_cast<const double*>(&d);
  for (std::size_t i = 0; i < sizeof(State) / sizeof(double); ++i) a[i] += h * b[i];
  return s;
}

State stepped(const Model* m, State s, double h, double drive, double kinetic, double fs, int sliding,
              double direction) {
  const State a = rate(m, &s, drive, kinetic, fs, sliding, direction);
  State p = moved(s, a, 0.5 * h);
  const State b = rate(m, &p, drive, kinetic, fs, sliding, direction);
  p = moved(s, b, 0.5 * h);
  const State c = rate(m, &p, drive, kinetic, fs, sliding, direction);
  p = moved(s, c, h);
  const State d = rate(m, &p, drive, kinetic, fs, sliding, direction);
  s = moved(s, a, h / 6), s = moved(s, b, h / 3), s = moved(s, c, h / 3);
  return moved(s, d, h / 6);
}

struct Motion {
  State state;
  int sliding, precursor_due, aftershock_due;
  double direction, stick_s, low_force, drop, fs;
  long slips;
};

void small_falls(const Model* m, Motion* o) {
  const double size = std::fabs(o->state.force);
  if (o->precursor_due && size > o->low_force + m->precursor_at * (o->fs - o->low_force)) {
    o->state.force -= sign_of(o->state.force) * m->precursor_share * (o->fs - o->low_force);
    o->precursor_due = 0;
  }
  if (o->aftershock_due && o->stick_s > m->aftershock_s) {
    o->state.force -= sign_of(o->state.force) * m->aftershock_share * o->drop;
    o->aftershock_due = 0;
  }
}

void begin_slip(const Model* m, Motion* o, double commanded, double now, Slip* slips) {
  const double drive = actual(m, &o->state, commanded);
  const double damper = 2.0 * m->damping_ratio * m->stiffness / m->omega;
  o->sliding = 1;
  o->direction = sign_of(o->state.force + damper * drive);
  o->state.velocity = 0.0;
  o->state.slid = 0.0;
  slips[o->slips].onset_s = now;
  slips[o->slips].onset_force = o->state.force;
  slips[o->slips].end_s = -1.0;
}

void end_slip(const Model* m, Motion* o, double now, Slip* slips) {
  slips[o->slips].end_s = now;
  slips[o->slips].end_force = o->state.force;
  o->drop = std::fabs(slips[o->slips].onset_force - o->state.force);
  ++o->slips;
  o->sliding = 0;
  o->state.velocity = 0.0;
  o->state.since_slip = 0.0;
  o->stick_s = 0.0;
  o->low_force = std::fabs(o->state.force);
  o->precursor_due = m->precursor_share > 0;
  o->aftershock_due = m->aftershock_share > 0;
}

}  // namespace

// `force`: what the sensor shows at every sample; `behind`: how far the drive is behind its command, in m. Returns the
// number of slips (at most `most`); the last may be open.
extern "C" long simulate(const Model* m, const Course* course, double start_force, double* force, double* behind,
                         Slip* slips, long most) {
  Motion o{};
  o.state.force = o.state.sensor = start_force;
  o.low_force = start_force;
  o.state.since_slip = 1e9;
  o.state.behind = m->servo_compliance * start_force;
  const double h = course->step / course->substeps;
  const double damper = 2.0 * m->damping_ratio * m->stiffness / m->omega;
  for (long i = 0; i < course->samples; ++i) {
    force[i] = m->sensor_omega > 0 ? o.state.sensor : o.state.force;
    behind[i] = o.state.behind;
    const double drive = course->speed[i], kinetic = course->kinetic_friction[i];
    for (int j = 0; j < course->substeps && o.slips < most - 1; ++j) {
      const double now = (static_cast<double>(i) + static_cast<double>(j) / course->substeps) * course->step;
      if (!o.sliding) {
        o.fs = course->static_friction[i] * course->slip_factor[o.slips % course->factors] +
               kinetic * (1.0 - course->slip_factor[o.slips % course->factors]);
        o.fs += aged(m, o.stick_s);
        small_falls(m, &o);
        if (std::fabs(o.state.force + damper * actual(m, &o.state, drive)) >= o.fs * load(m, o.state.force, kinetic))
          begin_slip(m, &o, drive, now, slips);
      }
      const State before = o.state;
      o.state = stepped(m, before, h, drive, kinetic, o.fs, o.sliding, o.direction);
      if (o.sliding && o.direction * o.state.velocity <= 0.0 && o.state.slid > 0.0 && before.velocity != 0.0) {
        const double share = before.velocity / (before.velocity - o.state.velocity);
        o.state = stepped(m, before, share * h, drive, kinetic, o.fs, 1, o.direction);
        end_slip(m, &o, now + share * h, slips);
        o.state = stepped(m, o.state, (1.0 - share) * h, drive, kinetic, o.fs, 0, o.direction);
      } else if (!o.sliding) {
        const double tension = std::fabs(before.force + damper * actual(m, &before, drive));
        const double next = std::fabs(o.state.force + damper * actual(m, &o.state, drive));
        const double first = o.fs * load(m, before.force, kinetic);
        const double last = (o.fs + aged(m, o.stick_s + h) - aged(m, o.stick_s)) * load(m, o.state.force, kinetic);
        if (next >= last && next > tension) {  // within this step: both are straight over it
          const double share = (first - tension) / ((next - tension) - (last - first));
          o.state = stepped(m, before, share * h, drive, kinetic, o.fs, 0, o.direction);
          begin_slip(m, &o, drive, now + share * h, slips);
          o.state = stepped(m, o.state, (1.0 - share) * h, drive, kinetic, o.fs, 1, o.direction);
        }
        o.stick_s += h;
      }
    }
  }
  return o.slips;
}

// LuGre friction: bristles of stiffness sigma0 (N/m), damping sigma1, Stribeck level between static and kinetic.
extern "C" void simulate_lugre(double k, double omega, double zeta, double fs, double fk, double stribeck_speed,
                               double sigma0, double sigma1, double speed, double step, long samples, int substeps,
                               double* force) {
  const double mass = k / (omega * omega), damper = 2.0 * zeta * k / omega, h = step / substeps;
  double s = fk / k, v = 0.0, z = fk / sigma0;
  for (long i = 0; i < samples; ++i) {
    force[i] = k * s;
    for (int j = 0; j < substeps; ++j) {
      const double g = (fk + (fs - fk) * std::exp(-std::pow(v / stribeck_speed, 2))) / sigma0;
      // z is stiff: exponential step at constant v; the body semi-implicitly
      const double decay = std::fabs(v) / g;
      const double zdot = v - decay * z;
      const double znew =
          decay * h > 1e-12 ? z * std::exp(-decay * h) + v / decay * (1.0 - std::exp(-decay * h)) : z + v * h;
      const double f = sigma0 * znew + sigma1 * zdot;
      v += h * (k * s + damper * (speed - v) - f) / mass;
      s += h * (speed - v);
      z = znew;
    }
  }
}

extern "C" int write_csv(const char* path, const double* time, const double* force, long samples) {
  std::FILE* file = std::fopen(path, "w");
  if (!file) return 1;
  std::fputs("time_s,force_N\n", file);
  for (long i = 0; i < samples; ++i) std::fprintf(file, "%.9g,%.7g\n", time[i], force[i]);
  return std::fclose(file);
}

}  // namespace independent
