"""Families with a stage that starts, stops and turns, and with friction that is not Coulomb's."""
import math

from families_inside import K_ONLY, NONE
from scenes import PARAMETERS, SLIP, Motion, draw_rig, families, lines, np, scene, simulate, simulate_lugre

SHARED = ("stiffness_N_per_m", "natural_frequency_rad_per_s")


def _release(rig, force, rng):
    """Free ring-down to the zero of the force after the release, then rest: values after the last one of `force`."""
    t = np.arange(int(rng.uniform(2, 5) * rig.period_s / rig.step)) * rig.step
    ring = rig.model.omega * rng.uniform(2, 5)
    return force[-1] * np.exp(-0.05 * ring * t) * np.cos(ring * t)


def extended(rig, motion, rng, stretch, known):
    """Rest before and release after a motion."""
    rest = np.full(int(rng.uniform(0.5, 3) * rig.period_s / rig.step), motion.force[0])
    force = np.concatenate([rest, motion.force, _release(rig, motion.force, rng)])
    shift = len(rest) * rig.step
    slips = motion.slips.copy()
    slips["onset_s"] += shift
    slips["end_s"] += shift
    whole = Motion(np.arange(len(force)) * rig.step, force, slips)
    return scene(rig, whole, stretch=(stretch[0] + shift, stretch[1] + shift), known=known)


def stage_run(rng, rig=None, known=("stiffness_N_per_m", "friction_difference_N", "natural_frequency_rad_per_s", "damping_ratio")):
    """Rest, loading ramp, sliding, release with a ring-down, rest."""
    rig = rig or draw_rig(rng)
    motion = rig.run((rig.count + 1) * rig.period_s + rig.kinetic / (rig.model.stiffness * rig.speed), start=0.0)
    first = motion.slips["onset_s"][0] if len(motion.slips) else 0.0
    return extended(rig, motion, rng, (first, motion.time_s[-1]), known)


def soft_run_up(rng):
    """The line tightens first: a loading ramp that bends upward, with the friction of small slips in it."""
    result = stage_run(rng)
    begin = result.truth["stretch_s"][0]
    first = np.searchsorted(result.time_s, begin)
    ramp = result.force[:first]
    top = ramp[-50:].mean()
    result.force[:first] = ramp * np.clip(np.abs(ramp) / abs(top), 0, 1) ** 0.7
    return result


def pause(rng):
    """The stage stops in the middle for some periods."""
    rig = draw_rig(rng, slips=(20, 40))
    seconds = (rig.count + 8) * rig.period_s
    time_s, speed, static, kinetic = rig.course(seconds)
    begin = rng.uniform(0.3, 0.6) * seconds
    end = begin + rng.uniform(2, 6) * rig.period_s
    speed[(time_s > begin) & (time_s < end)] = 0.0
    motion = simulate(rig.model, rig.step, speed, static, kinetic, start_force=rig.start_force())
    result = scene(rig, motion)
    onset = motion.slips["onset_s"]
    gaps = np.diff(onset[1:])
    inside = ~((onset[1:-1] < end) & (onset[2:] > begin))
    result.truth["frequency_Hz"] = float(1 / gaps[inside].mean())
    result.truth["spacing_m"] = rig.speed / result.truth["frequency_Hz"]
    result.truth["any_stretch"] = True
    return result


def _strokes(rng, strokes):
    rig = draw_rig(rng, slips=(10, 16))
    one = (rig.count + 3) * rig.period_s + 2 * rig.kinetic / (rig.model.stiffness * rig.speed)
    time_s, speed, static, kinetic = rig.course(strokes * one)
    speed = np.where((time_s / one).astype(int) % 2 == 0, speed, -speed)
    motion = simulate(rig.model, rig.step, speed, static, kinetic, start_force=rig.start_force())
    result = scene(rig, motion)
    gaps = np.diff(result.truth["slips_s"])
    within = gaps[gaps < 2.0 * np.median(gaps)]  # not from the last slip of a stroke to the first of the next
    result.truth |= {"kind": "reciprocating", "frequency_Hz": float(1 / within.mean()), "spacing_m": float(rig.speed * within.mean()),
                     "any_stretch": True}
    return result


def short_strokes(rng):
    """A reciprocating test on a soft sample: two to eight slips a stroke, and a reversal that takes as long as one to six of them."""
    rig = draw_rig(rng, slips=(2, 9), ratio=(4, 15), noise=(0.005, 0.03))
    rig.kinetic = rig.drop * rng.uniform(0.8, 4)
    one = rig.count * rig.period_s + 2 * rig.kinetic / (rig.model.stiffness * rig.speed)
    time_s, speed, static, kinetic = rig.course(int(rng.integers(6, 20)) * one)
    speed = np.where((time_s / one).astype(int) % 2 == 0, speed, -speed)
    factors = np.maximum(0.4, 1 + rng.uniform(0.02, 0.15) * rng.standard_normal(400))
    motion = simulate(rig.model, rig.step, speed, static, kinetic, factors, rig.start_force())
    result = scene(rig, motion)
    same = (motion.slips["onset_s"] / one).astype(int)
    gaps = np.diff(motion.slips["onset_s"])[np.diff(same) == 0]
    result.truth |= {"kind": "reciprocating", "frequency_Hz": float(1 / gaps.mean()), "spacing_m": float(rig.speed * gaps.mean()),
                     "any_stretch": True}
    return result


def speed_step(rng):
    """Twice as fast in the second half: changes on the way, and is to be said so."""
    rig = draw_rig(rng, slips=(30, 50), ratio=(8, 30))
    time_s, speed, static, kinetic = rig.course((0.75 * rig.count + 1) * rig.period_s)
    speed[time_s > 0.66 * time_s[-1]] *= 2.0
    motion = simulate(rig.model, rig.step, speed, static, kinetic, start_force=rig.start_force())
    result = scene(rig, motion, known=NONE)
    result.truth["changes"] = True
    return result


def late_onset(rng):
    """Steady sliding first, stick-slip from the middle on."""
    rig = draw_rig(rng)
    time_s, speed, static, kinetic = rig.course((1.6 * rig.count + 1) * rig.period_s)
    begin = rng.uniform(0.3, 0.45) * time_s[-1]
    static = np.where(time_s < begin, kinetic + 1e-3 * rig.drop, static)
    speed[(time_s > begin - 0.3 * rig.period_s) & (time_s < begin)] = 0.0  # comes to rest, and so can stick
    motion = simulate(rig.model, rig.step, speed, static, kinetic, start_force=rig.kinetic)
    return scene(rig, motion, stretch=(begin, time_s[-1]), known=SHARED)


def dies_out(rng):
    """Stick-slip first, steady sliding after the middle."""
    rig = draw_rig(rng)
    time_s, speed, static, kinetic = rig.course((1.6 * rig.count + 1) * rig.period_s)
    end = rng.uniform(0.55, 0.7) * time_s[-1]
    static = np.where(time_s > end, kinetic + 1e-3 * rig.drop, static)
    motion = simulate(rig.model, rig.step, speed, static, kinetic, start_force=rig.start_force())
    return scene(rig, motion, stretch=(0.0, end), known=SHARED)


def ripple(rng):
    """A stepper's ripple in the drive."""
    rig = draw_rig(rng)
    time_s, speed, static, kinetic = rig.course((rig.count + 1) * rig.period_s)
    frequency = rng.uniform(3, 9) / rig.period_s
    speed = speed * (1 + rng.uniform(0.1, 0.5) * np.cos(2 * np.pi * frequency * time_s))
    return scene(rig, simulate(rig.model, rig.step, speed, static, kinetic, start_force=rig.start_force()))


def _measured_drive(rig, motion, rng):
    """With a column of the drive's position, read in steps of an encoder."""
    result = scene(rig, motion)
    step = rig.drop / rig.model.stiffness * 10 ** rng.uniform(-3.5, -2)
    result.displacement_m = step * np.round(motion.drive_m / step)
    return result


def servo_dips(rng):
    """A servo gives way under the force and catches up after each slip; its position is measured."""
    rig = draw_rig(rng)
    rig.model.servo_compliance = rng.uniform(0.1, 1.0) / rig.model.stiffness
    rig.model.servo_time = rig.period_s * 10 ** rng.uniform(-1.5, 0.0)
    return _measured_drive(rig, rig.run(), rng)


def measured_ripple(rng):
    """A ripple of the drive whose position is measured."""
    rig = draw_rig(rng)
    time_s, speed, static, kinetic = rig.course((rig.count + 1) * rig.period_s)
    speed = speed * (1 + rng.uniform(0.1, 0.5) * np.cos(2 * np.pi * rng.uniform(0.3, 5) / rig.period_s * time_s))
    return _measured_drive(rig, simulate(rig.model, rig.step, speed, static, kinetic, start_force=rig.start_force()), rng)


def measured_steady(rng):
    """A steady drive whose position is measured."""
    rig = draw_rig(rng)
    return _measured_drive(rig, rig.run(), rng)


def _friction(rng, known, **terms):
    rig = draw_rig(rng)
    for name, value in terms.items():
        setattr(rig.model, name, value(rig) if callable(value) else value)
    return scene(rig, rig.run(), known=known)


def reload(rng):
    return _friction(rng, PARAMETERS, reload_force=lambda r: 0.3 * r.drop * rng.uniform(0.3, 1), reload_length=lambda r: 0.3 * r.drop / r.model.stiffness)


def stiffening(rng):
    return _friction(rng, NONE, stiffening=lambda r: r.model.stiffness * 0.1 * (r.model.stiffness / (r.kinetic + r.drop)) ** 2)


def stribeck(rng):
    rig = draw_rig(rng)
    rig.model.stribeck_force = rng.uniform(0.1, 0.4) * rig.drop
    rig.model.stribeck_speed = rng.uniform(0.1, 0.5) * rig.drop / rig.model.stiffness * rig.model.omega
    return scene(rig, rig.run(), known=K_ONLY)


def quadratic(rng):
    rig = draw_rig(rng)
    fastest = rig.drop / rig.model.stiffness * rig.model.omega
    rig.model.quadratic = rng.uniform(0.1, 0.5) * rig.drop / fastest**2
    return scene(rig, rig.run(), known=SHARED)


def ageing(rng):
    return _friction(rng, SHARED, ageing=lambda r: r.drop * rng.uniform(0.03, 0.1), ageing_time=lambda r: r.period_s * rng.uniform(0.01, 0.3))


def weakening(rng):
    """Friction falls over a slip distance of 0.02 to 0.6 of (F_s - F_k) / k."""
    share = math.exp(rng.uniform(math.log(0.02), math.log(0.6)))
    return _friction(rng, PARAMETERS, weakening_length=lambda r: share * r.drop / r.model.stiffness)


def lugre(rng):
    rig = draw_rig(rng, ratio=(5, 20))
    k, omega = rig.model.stiffness, rig.model.omega
    sigma0 = 60 * k
    force = simulate_lugre(k, omega, rig.model.damping_ratio, rig.kinetic + rig.drop, rig.kinetic,
                           0.02 * rig.drop / k * omega, sigma0, 0.3 * math.sqrt(sigma0 * k) / omega, rig.speed, rig.step,
                           rig.samples((rig.count + 1) * rig.period_s))
    slips = _falls(force, 0.5 * rig.drop)
    times = np.array([(a * rig.step, b * rig.step, force[a], force[b]) for a, b in slips], SLIP)
    return scene(rig, Motion(np.arange(len(force)) * rig.step, force, times), known=NONE)


def _falls(force, least):
    """Turning points of a noise-free trace: peak and trough of every fall of at least `least`."""
    falls, high, low, falling = [], 0, 0, False
    for i, f in enumerate(force):
        if falling and f < force[low]:
            low = i
        elif falling and f > force[low] + least:
            falls.append((high, low))
            falling, high = False, i
        elif not falling and f > force[high]:
            high = i
        elif not falling and f < force[high] - least:
            falling, low = True, i
    return falls


def aftershocks(rng):
    return _friction(rng, K_ONLY, aftershock_s=lambda r: r.period_s * rng.uniform(0.05, 0.3), aftershock_share=rng.uniform(0.05, 0.15))


def texture(rng):
    """The counterface repeats with V t."""
    rig = draw_rig(rng, slips=(25, 45))
    time_s, speed, static, kinetic = rig.course((rig.count + 1) * rig.period_s)
    wave = rig.drop * rng.uniform(0.1, 0.3) * np.sin(2 * np.pi * time_s / (rig.period_s * rng.uniform(4, 9)))
    return scene(rig, simulate(rig.model, rig.step, speed, static + wave, kinetic + wave, start_force=rig.start_force()))


def two_saws(rng):
    """Two bodies that slip on their own, on one sensor."""
    rig = draw_rig(rng, slips=(20, 40), ratio=(6, 25))
    factors = np.exp(rng.uniform(0, 0.15) * rng.standard_normal(200))
    one = rig.run(factors=factors)
    rig.drop *= rng.uniform(0.3, 0.8)
    other = rig.run((rig.count + 1) * rig.period_s, factors=factors[::-1])
    motion = Motion(one.time_s, one.force + other.force[: len(one.force)], one.slips)
    result = scene(rig, motion, known=NONE)
    result.truth |= {"frequency_Hz": None, "spacing_m": None, "any_stretch": True}
    return result


def clipped_saw(rng):
    """The sensor saturates below the peaks."""
    rig = draw_rig(rng)
    motion = rig.run(factors=np.maximum(0.4, 1 + rng.uniform(0, 0.1) * rng.standard_normal(200)))
    top = rig.kinetic + rng.uniform(0.2, 0.9) * rig.drop
    return scene(rig, motion, np.minimum(motion.force + rig.white(len(motion.force)), top), known=K_ONLY, noise=False)


def swings_with_jumps(rng):
    """Slips of mixed sizes on a level that swings by several of them."""
    rig = draw_rig(rng, slips=(25, 45))
    time_s, speed, static, kinetic = rig.course((rig.count + 1) * rig.period_s)
    wave = rig.drop * rng.uniform(0.5, 2) * np.sin(2 * np.pi * time_s / (rig.period_s * rng.uniform(6, 15)))
    factors = np.exp(rng.uniform(0.1, 0.6) * rng.standard_normal(200))
    return scene(rig, simulate(rig.model, rig.step, speed, static + wave, kinetic + wave, factors, rig.start_force()), known=NONE)


def clocked(rng):
    """A periodic change of the static friction takes the slips along."""
    rig = draw_rig(rng)
    time_s, speed, static, kinetic = rig.course((rig.count + 1) * rig.period_s)
    static = static + rig.drop * 0.3 * np.sin(2 * np.pi * time_s / rig.period_s * rng.uniform(0.97, 1.03))
    return scene(rig, simulate(rig.model, rig.step, speed, static, kinetic, start_force=rig.start_force()), known=SHARED)


def clutch_like(rng):
    """All that the measured clutch shows: run-up, creep, ring, pick-up, ripple, scatter, release."""
    rig = draw_rig(rng, per_slip=(60, 120), slips=(12, 22), ratio=(6, 15), noise=(0.02, 0.06), zeta=(0.1, 0.3))
    rig.model.creep_force, rig.model.creep_share = 0.5 * rig.drop, 0.5
    rig.model.sensor_omega, rig.model.sensor_damping = rig.model.omega * rng.uniform(2, 4), 0.05
    spread = rng.uniform(0.05, 0.4)
    motion = rig.run((rig.count + 1) * rig.period_s + rig.kinetic / (rig.model.stiffness * rig.speed), start=0.0,
                     factors=np.exp(spread * rng.standard_normal(200)))
    pick = lines(rng, motion.time_s, 3 * rig.model.sensor_omega / 6.28, [rig.drop * rng.uniform(0.05, 0.2)])
    motion.force += pick + lines(rng, motion.time_s, rng.uniform(2, 5) / rig.period_s, [rig.drop * 0.1])
    return extended(rig, motion, rng, (motion.slips["onset_s"][0], motion.time_s[-1]), NONE)


def all_mild(rng):
    rig = draw_rig(rng)
    rig.model.creep_force, rig.model.creep_share = 0.2 * rig.drop, 0.2
    rig.model.weakening_length = 0.05 * rig.drop / rig.model.stiffness
    motion = rig.run(factors=np.exp(0.1 * rng.standard_normal(200)))
    t = motion.time_s
    force = motion.force + lines(rng, t, min(50.0, 0.3 / rig.step), [0.05 * rig.drop]) + 0.2 * rig.drop * np.sin(8 * t / t[-1])
    return scene(rig, motion, force, known=NONE)


FAMILIES = families(
    stage_run, soft_run_up, pause, short_strokes, speed_step, late_onset, dies_out, ripple, servo_dips, measured_ripple, measured_steady, reload,
    stiffening, stribeck, quadratic, ageing, weakening, lugre, aftershocks, texture, two_saws, clipped_saw, swings_with_jumps, clocked, clutch_like,
    all_mild,
    there_and_back=lambda rng: _strokes(rng, 2),
    reversals=lambda rng: _strokes(rng, int(rng.integers(3, 7))),
    creep=lambda rng: _friction(rng, NONE, creep_force=lambda r: r.drop * rng.uniform(0.2, 0.8), creep_share=rng.uniform(0.3, 0.8)),
    precursors=lambda rng: _friction(rng, K_ONLY, precursor_at=rng.uniform(0.5, 0.9), precursor_share=rng.uniform(0.05, 0.15)),
)
