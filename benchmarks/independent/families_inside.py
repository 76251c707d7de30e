"""Families inside the model, with other instruments, and with irregular slips."""
from scipy.signal import lfilter

from scenes import Scene, counted, draw_rig, families, lines, np, red, scene, simulate

K_ONLY = ("stiffness_N_per_m",)
NONE = ()


def undisturbed(rng, **proportions):
    rig = draw_rig(rng, **proportions)
    return scene(rig, rig.run())


def noise_in_slips(rng):
    rig = draw_rig(rng)
    motion = rig.run()
    force = motion.force.copy()
    for slip in motion.slips:
        inside = (motion.time_s > slip["onset_s"]) & (motion.time_s < 2 * slip["end_s"] - slip["onset_s"])
        force[inside] += 9 * rig.white(inside.sum())
    return scene(rig, motion, force)


def _scattered(rng, spread):
    rig = draw_rig(rng)
    factors = np.maximum(0.3, np.exp(spread * rng.standard_normal(200) - 0.5 * spread**2))
    motion = rig.run(factors=factors)
    result = scene(rig, motion, known=K_ONLY if spread > 0.5 else ("stiffness_N_per_m", "natural_frequency_rad_per_s", "damping_ratio"))
    return result


def clustered(rng):
    """Drops, and with them waiting times, that change slowly from slip to slip."""
    rig = draw_rig(rng)
    walk = red(rng, 200, 4)
    return scene(rig, rig.run(factors=np.exp(0.5 * walk)), known=K_ONLY)


def wear_in(rng):
    rig = draw_rig(rng)
    seconds = (rig.count + 1) * rig.period_s
    time_s, speed, static, kinetic = rig.course(seconds)
    end = rng.uniform(0.35, 0.6)
    static = kinetic + rig.drop * (1 - (1 - end) * time_s / seconds)
    motion = simulate(rig.model, rig.step, speed, static, kinetic, start_force=rig.kinetic)
    return scene(rig, motion, known=("stiffness_N_per_m", "natural_frequency_rad_per_s", "damping_ratio"))


def _level(rng, level_of):
    rig = draw_rig(rng)
    seconds = (rig.count + 1) * rig.period_s
    time_s, speed, static, kinetic = rig.course(seconds)
    level = rig.drop * level_of(time_s, seconds)
    motion = simulate(rig.model, rig.step, speed, static + level, kinetic + level, start_force=rig.start_force())
    return scene(rig, motion)


def averaged(force, kernel):
    return np.convolve(np.pad(force, (len(kernel) // 2, len(kernel) - 1 - len(kernel) // 2), "edge"), kernel, "valid")


def boxcar(rng):
    rig = draw_rig(rng, per_slip=(20, 60))
    motion = rig.run()
    width = int(rng.integers(3, 12))
    return scene(rig, motion, averaged(motion.force + rig.white(len(motion.force)), np.ones(width) / width), noise=False)


def first_order(rng):
    rig = draw_rig(rng, per_slip=(20, 60))
    motion = rig.run()
    a = np.exp(-1 / rng.uniform(1.5, 6))
    start = motion.force[0]
    return scene(rig, motion, start + lfilter([1 - a], [1, -a], motion.force - start))


def sinc3(rng):
    rig = draw_rig(rng, per_slip=(20, 60))
    motion = rig.run()
    box = np.ones(int(rng.integers(3, 8)))
    kernel = np.convolve(np.convolve(box, box), box)
    return scene(rig, motion, averaged(motion.force, kernel / kernel.sum()))


def sensor_ring(rng):
    """The load cell rings after each slip, at 2 to 6 times the slip's own frequency."""
    rig = draw_rig(rng, per_slip=(40, 100), slips=(12, 25), zeta=(0.1, 0.4))
    rig.model.sensor_omega = rig.model.omega * rng.uniform(2, 6)
    rig.model.sensor_damping = rng.uniform(0.02, 0.08)
    return scene(rig, rig.run(), known=K_ONLY)


def _pickup(rng, frequency, swings):
    """`swings` of the harmonics over the drop."""
    rig = draw_rig(rng)
    motion = rig.run()
    if frequency * 2.5 * rig.step > 1:  # the sampling must resolve the line
        frequency = 0.3 / rig.step
    return scene(rig, motion, motion.force + lines(rng, motion.time_s, frequency, rig.drop * np.array(swings)))


def mains_drifting(rng):
    rig = draw_rig(rng)
    motion = rig.run()
    mains = 50 + np.cumsum(rng.standard_normal(len(motion.time_s))) * 0.1 / np.sqrt(len(motion.time_s))
    phase = 2 * np.pi * np.cumsum(mains) * rig.step
    if 120 * rig.step > 1:
        phase *= 0.3 / rig.step / 50
    return scene(rig, motion, motion.force + rig.drop * rng.uniform(0.05, 0.3) * 0.5 * np.cos(phase))


def lost_chunks(rng):
    """The clock runs on while a buffer is lost: a true gap in the force, none in the time column."""
    rig = draw_rig(rng, slips=(25, 45))
    motion = rig.run()
    keep = np.ones(len(motion.time_s), bool)
    for start in rng.choice(len(keep), int(rng.integers(1, 4)), replace=False):
        keep[start:start + int(rng.uniform(0.3, 1.5) * rig.period_s / rig.step)] = False
    result = scene(rig, motion)
    time_s = motion.time_s[:keep.sum()]
    slips = counted(motion.slips[motion.slips["end_s"] > 0])["onset_s"]
    truth = result.truth
    truth["frequency_Hz"] = (len(slips) - 2) / (slips[-1] - slips[1])
    truth["spacing_m"] = rig.speed / truth["frequency_Hz"]
    truth["slips_s"] = []
    truth["stretch_s"] = [float(time_s[0]), float(time_s[-1])]
    return Scene(time_s, result.force[keep], truth)


def held_values(rng):
    """The logger is faster than the converter: values repeat."""
    rig = draw_rig(rng, per_slip=(30, 60))
    result = scene(rig, rig.run())
    hold = int(rng.integers(2, 5))
    result.force = np.repeat(result.force[::hold], hold)[:len(result.force)]
    return result


def quantised(rng):
    rig = draw_rig(rng)
    result = scene(rig, rig.run())
    step = rig.drop / rng.uniform(8, 30)
    result.force = np.round(result.force / step) * step
    return result


FAMILIES = families(
    noise_in_slips, clustered, wear_in, boxcar, first_order, sinc3, sensor_ring, mains_drifting, lost_chunks, held_values, quantised,
    plain=lambda rng: undisturbed(rng),
    few_samples=lambda rng: undisturbed(rng, per_slip=(4, 7)),
    many_samples=lambda rng: undisturbed(rng, per_slip=(100, 200), slips=(8, 14)),
    noisy=lambda rng: undisturbed(rng, noise=(0.08, 0.15)),
    scatter10=lambda rng: _scattered(rng, 0.1),
    scatter30=lambda rng: _scattered(rng, 0.3),
    scatter80=lambda rng: _scattered(rng, 0.8),
    level_waves=lambda rng: _level(rng, lambda t, T: rng.uniform(0.2, 0.8) * np.sin(2 * np.pi * rng.uniform(1, 5) * t / T + rng.uniform(0, 6))),
    level_walk=lambda rng: _level(rng, lambda t, T: rng.uniform(0.3, 1.0) * np.cumsum(rng.standard_normal(len(t))) / np.sqrt(len(t))),
    pickup_1000=lambda rng: _pickup(rng, 1000.0, [rng.uniform(0.05, 0.3)]),
    pickup_100=lambda rng: _pickup(rng, 100.0, [rng.uniform(0.05, 0.3), 0.05]),
    pickup_37=lambda rng: _pickup(rng, 37.0, [rng.uniform(0.05, 0.3), 0.03]),
    pickup_10=lambda rng: _pickup(rng, 10.0, [rng.uniform(0.05, 0.3), 0.1, 0.05]),
)
