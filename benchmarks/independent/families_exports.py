"""Families of testers and their exports: clocks and numbers that software made coarser or finer, sensors that drop out, noise that is
not white, and slips in other proportions than those of the other families."""
from families_inside import K_ONLY, undisturbed, averaged
from scenes import Scene, draw_rig, families, np, red, scene, simulate

EFFECTS = ("relaxes", "weakens", "ages", "stribeck", "reloads", "creeps", "heats", "wave", "trend", "scatter", "averaged", "line", "smooth")


def _again(result, time_s, force):
    return Scene(time_s, force, result.truth)


def interpolated(rng):
    """Exported on a finer clock, by lines between the samples."""
    rig = draw_rig(rng, per_slip=(8, 25))
    result = scene(rig, rig.run())
    factor = rng.uniform(2, 10)
    time_s = np.arange(result.time_s[0], result.time_s[-1], rig.step / factor)
    return _again(result, time_s, np.interp(time_s, result.time_s, result.force))


def decimated(rng):
    """Averaged by software over as many samples as it keeps one."""
    rig = draw_rig(rng, per_slip=(60, 200))
    result = scene(rig, rig.run(), known=K_ONLY)
    factor = int(rng.integers(3, 10))
    n = len(result.force) // factor * factor
    force = result.force[:n].reshape(-1, factor).mean(axis=1)
    return _again(result, result.time_s[:n].reshape(-1, factor).mean(axis=1), force)


def rounded_times(rng):
    """Times of a millisecond or so: several samples share one."""
    rig = draw_rig(rng)
    result = scene(rig, rig.run(), known=K_ONLY)
    digit = rig.step * rng.uniform(1.2, 4)
    return _again(result, np.floor(result.time_s / digit) * digit, result.force)


def large_offset(rng):
    """A preload of a thousand times the drop, on a sensor of 16 bits."""
    rig = draw_rig(rng)
    result = scene(rig, rig.run())
    step = rig.drop * rng.uniform(0.01, 0.05)
    return _again(result, result.time_s, np.round((result.force + 1000 * rig.drop) / step) * step)


def drop_outs(rng):
    """The sensor reads nought for some samples now and then."""
    rig = draw_rig(rng)
    result = scene(rig, rig.run())
    force = result.force.copy()
    for begin in rng.integers(0, len(force) - 10, rng.integers(2, 8)):
        force[begin: begin + rng.integers(1, 8)] = 0.0
    return _again(result, result.time_s, force)


def pink_noise(rng):
    """Noise of 1/f."""
    rig = draw_rig(rng)
    motion = rig.run()
    n = len(motion.force)
    spectrum = np.fft.rfft(rng.standard_normal(n)) / np.sqrt(np.maximum(1, np.arange(n // 2 + 1)))
    noise = np.fft.irfft(spectrum, n)
    return scene(rig, motion, motion.force + rig.drop * rng.uniform(0.01, 0.05) * noise / noise.std(), noise=False)


def smooth_noise(rng):
    """Noise of a filter of first order over 2 to 20 samples."""
    rig = draw_rig(rng)
    motion = rig.run()
    noise = red(rng, len(motion.force), rng.uniform(2, 20))
    return scene(rig, motion, motion.force + rig.drop * rng.uniform(0.003, 0.03) * noise, noise=False)


def _that_sticks(rng, **proportions):
    """The first rig whose stick-slip does not end by itself."""
    while True:
        rig = draw_rig(rng, **proportions)
        motion = rig.run()
        if len(motion.slips) > 5 and motion.slips["onset_s"][-1] > motion.time_s[-1] - 3 * rig.period_s:
            return scene(rig, motion)


def mixture(rng):
    """Each of what the other families have with a chance of a third, in moderation."""
    while True:
        result = _mixed(rng)
        frequency = result.truth["frequency_Hz"]
        if frequency and 0.5 < frequency * result.truth["period_s"] < 2:  # else it slips in another rhythm, or ends
            return result


def _mixed(rng):
    rig = draw_rig(rng, per_slip=(6, 60))
    model, drop = rig.model, rig.drop
    drawn = rng.random(len(EFFECTS)) < 1 / 3
    chances = iter(drawn)
    has = lambda: next(chances)
    if has():
        model.relax_share, model.relax_time = rng.uniform(0.05, 0.4), rig.period_s * 10 ** rng.uniform(-1.5, 0.5)
    if has():
        model.weakening_length = rng.uniform(0.05, 0.4) * drop / model.stiffness
    if has():
        model.ageing, model.ageing_time = drop * rng.uniform(0.03, 0.1), rig.period_s * rng.uniform(0.01, 0.3)
    if has():
        model.stribeck_force, model.stribeck_speed = drop * rng.uniform(0.05, 0.4), drop / model.stiffness * model.omega * rng.uniform(0.1, 1)
        rig.drop += model.stribeck_force
    if has():
        model.reload_force, model.reload_length = drop * rng.uniform(0.1, 0.3), drop / model.stiffness * rng.uniform(0.1, 0.5)
    if has():
        model.creep_force, model.creep_share = 0.3 * drop, rng.uniform(0.05, 0.3)
    if has():
        model.heat_slope, model.heat_time = rng.uniform(0.05, 0.3) * model.stiffness / 2, np.pi / model.omega * rng.uniform(0.5, 2)
    seconds = (rig.count + 1) * rig.period_s
    time_s, speed, static, kinetic = rig.course(seconds)
    level = np.zeros(len(time_s))
    if has():
        level += drop * rng.uniform(0.1, 0.5) * np.sin(2 * np.pi * rng.uniform(0.5, 4) * time_s / seconds + rng.uniform(0, 6))
    if has():
        level += drop * rng.uniform(-1, 1) * time_s / seconds
    factors = np.maximum(0.3, np.exp((rng.uniform(0.02, 0.2) if has() else 0.0) * rng.standard_normal(200)))
    motion = simulate(model, rig.step, speed, static + level, kinetic + level, factors, rig.start_force())
    force = motion.force
    if has():
        width = int(rng.integers(2, 8))
        force = averaged(force, np.ones(width) / width)
    if has():
        force = force + drop * rng.uniform(0.01, 0.1) * np.sin(2 * np.pi * rng.uniform(0.3, 30) / rig.period_s * time_s)
    noise = rig.noise * red(rng, len(force), rng.uniform(1, 8)) if has() else rig.white(len(force))
    result = scene(rig, motion, force + noise, known=K_ONLY, noise=False)
    result.truth |= {"period_s": rig.period_s, "has": [name for name, is_in in zip(EFFECTS, drawn) if is_in]}
    return result


FAMILIES = families(
    interpolated, decimated, rounded_times, large_offset, drop_outs, pink_noise, smooth_noise, mixture,
    short_sticks=lambda rng: _that_sticks(rng, ratio=(0.2, 2), zeta=(0.01, 0.1)),  # sticks of a fifth to twice the slip
    damped=lambda rng: _that_sticks(rng, zeta=(0.3, 0.8)),
    long_sticks=lambda rng: undisturbed(rng, ratio=(50, 400), slips=(8, 15), per_slip=(5, 15)),
    six_slips=lambda rng: undisturbed(rng, slips=(5, 8)),
    many_slips=lambda rng: undisturbed(rng, slips=(400, 900), per_slip=(5, 15), ratio=(3, 8)),
)
