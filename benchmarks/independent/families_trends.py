"""Families whose force level rises or falls over the recording: friction that changes (run-in, a rising load) or a sensor that drifts.
The load is written where a column of it belongs to the family."""
from scenes import draw_rig, families, np, scene, simulate


def _course(rng):
    """A rig of enough cycles to see a trend, its times from 0 to 1, and its course."""
    rig = draw_rig(rng, slips=(20, 60))
    seconds = (rig.count + 1) * rig.period_s
    time_s, speed, static, kinetic = rig.course(seconds)
    return rig, time_s / seconds, speed, static, kinetic


def _known(rig, motion, force, factor):
    """Truth of the parameters; the forces are those at the start, in the middle and at the end."""
    result = scene(rig, motion, force, known=("stiffness_N_per_m", "natural_frequency_rad_per_s", "damping_ratio"))
    result.truth["static_friction_N"] = [float((rig.kinetic + rig.drop) * f) for f in (factor[0], factor[len(factor) // 2], factor[-1])]
    return result


def _changing(rng, factor_of):
    """Friction, static and kinetic, times a factor that changes."""
    rig, share, speed, static, kinetic = _course(rng)
    factor = factor_of(share)
    motion = simulate(rig.model, rig.step, speed, static * factor, kinetic * factor, start_force=rig.kinetic * factor[0])
    return rig, motion, factor


def run_in(rng):
    """Friction approaches its final value as an exponential."""
    size, rate = rng.uniform(0.1, 0.6) * rng.choice([-1, 1]), 1 / rng.uniform(0.2, 1.0)
    return _known(*_with_force(_changing(rng, lambda x: 1 + size * np.exp(-rate * x))))


def _with_force(made):
    rig, motion, factor = made
    return rig, motion, motion.force, factor


def _rise(rng):
    end = rng.uniform(1.2, 2.5)
    return lambda x: 1 + (end - 1) * x


def rising_load(rng):
    """The load rises in proportion to time, and no column tells it."""
    return _known(*_with_force(_changing(rng, _rise(rng))))


def load_column(rng):
    """The same with the load in a column."""
    rig, motion, factor = _changing(rng, _rise(rng))
    load = rng.uniform(2, 50) * factor
    result = _known(rig, motion, motion.force, factor)
    result.normal_N = load + 0.002 * load[0] * rng.standard_normal(len(load))
    return result


def steady_load(rng):
    """A sensor that drifts under a load that a column shows to be steady."""
    result = drift(rng)
    load = rng.uniform(2, 50)
    result.normal_N = load * (1 + 0.002 * rng.standard_normal(len(result.time_s)))
    return result


def drift(rng):
    """The sensor drifts in proportion to time, by 0.2 to 2 times the friction drop."""
    rig, share, speed, static, kinetic = _course(rng)
    motion = simulate(rig.model, rig.step, speed, static, kinetic, start_force=rig.start_force())
    change = rig.drop * rng.uniform(0.2, 2.0) * rng.choice([-1, 1])
    return _known(rig, motion, motion.force + change * share, np.ones(len(share)))


def drift_settles(rng):
    """The sensor settles as an exponential from its zero at the start."""
    rig, share, speed, static, kinetic = _course(rng)
    motion = simulate(rig.model, rig.step, speed, static, kinetic, start_force=rig.start_force())
    change = rig.drop * rng.uniform(0.5, 2.0) * rng.choice([-1, 1]) * -np.expm1(-share / rng.uniform(0.2, 1.0))
    return _known(rig, motion, motion.force + change, np.ones(len(share)))


def level(rng):
    """No trend."""
    rig, share, speed, static, kinetic = _course(rng)
    motion = simulate(rig.model, rig.step, speed, static, kinetic, start_force=rig.start_force())
    return _known(rig, motion, motion.force, np.ones(len(share)))


FAMILIES = families(
    run_in, rising_load, load_column, steady_load, drift, drift_settles, level,

)
