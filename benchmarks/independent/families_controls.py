"""Negative controls: steady sliding, waves, a ring-down."""
from families_inside import NONE
from families_outside import extended
from scenes import control, draw_rig, families, lines, np, red


def _steady(rng, noise_of):
    rig = draw_rig(rng)
    n = int(rng.integers(4000, 12000))
    return control(rig, "steady", rig.kinetic + rig.drop * noise_of(n, np.arange(n) * rig.step, rig))


def steady_run(rng):
    """Rest, loading ramp, steady sliding with pick-up, release."""
    rig = draw_rig(rng)
    rig.drop, drop = 1e-6 * rig.drop, rig.drop
    motion = rig.run((rig.count + 1) * rig.period_s, start=0.0)
    rig.drop = drop
    motion.force += lines(rng, motion.time_s, rng.uniform(0.02, 0.3) / rig.step, [rng.uniform(0.05, 0.4) * drop])
    motion.slips = motion.slips[:0]
    result = extended(rig, motion, rng, (0, motion.time_s[-1]), NONE)
    return control(rig, "steady", result.force, result.time_s, noise=False)


def _wave(rng, shape):
    rig = draw_rig(rng)
    frequency = 10 ** rng.uniform(-2.3, -1) / rig.step
    t = np.arange(int(rng.uniform(15, 60) / frequency / rig.step)) * rig.step
    return control(rig, "wave", rig.kinetic + rig.drop * shape(2 * np.pi * frequency * t + rng.uniform(0, 6)), frequency=frequency)


def sine_harmonics(rng):
    a, b, p, q = rng.uniform(0, 0.4), rng.uniform(0, 0.2), rng.uniform(0, 6), rng.uniform(0, 6)
    return _wave(rng, lambda w: np.sin(w) + a * np.sin(2 * w + p) + b * np.sin(3 * w + q))


def ringdown(rng):
    """One breakaway, then free decay to steady sliding."""
    rig = draw_rig(rng)
    w, z = rig.model.omega, rng.uniform(0.01, 0.05)
    t = np.arange(int(rng.uniform(3, 8) / (z * w) / rig.step)) * rig.step
    ramp = np.linspace(0.3, 1, int(6 / w / rig.step)) * rig.drop
    ring = rig.drop * np.exp(-z * w * t) * np.cos(w * np.sqrt(1 - z * z) * t)
    return control(rig, "ringdown", rig.kinetic + np.concatenate([ramp, ring]), frequency=w / 2 / np.pi)


def texture_trace(rng):
    """Steady sliding over ridges of random heights and spacings, each steeper on one side."""
    rig = draw_rig(rng)
    count, steep, spread = int(rng.integers(20, 60)), rng.uniform(1.5, 8), rng.uniform(0.05, 0.6)
    heights, widths = np.exp(spread * rng.standard_normal((2, count)))
    edges = np.concatenate([[0.0], np.cumsum(widths)]) * int(rng.uniform(40, 200))
    force = np.zeros(int(edges[-1]))
    for height, begin, end in zip(heights, edges[:-1], edges[1:]):
        i = np.arange(int(begin), min(int(np.ceil(end)), len(force)))
        x = (i - begin) / (end - begin)
        rise = steep / (1 + steep)
        phase = np.where(x < rise, x / rise, (1 - x) / (1 - rise))
        force[i] = height * 0.5 * (1 - np.cos(np.pi * np.clip(phase, 0, 1)))
    return control(rig, "wave", rig.kinetic + rig.drop * force)


def texture_bumps(rng):
    """Steady sliding over a random surface with a band of wavelengths."""
    rig = draw_rig(rng)
    n, wave = int(rng.integers(4000, 12000)), rng.uniform(30, 200)
    frequency = np.fft.rfftfreq(n)
    shape = np.exp(-0.5 * (np.log(np.maximum(frequency, 1e-9) * wave) / rng.uniform(0.1, 0.5)) ** 2)
    force = np.fft.irfft(shape * np.fft.rfft(rng.standard_normal(n)), n)
    force = np.expm1(rng.uniform(0, 1.2) * force / force.std())  # ridges stand out more than grooves
    return control(rig, "wave", rig.kinetic + rig.drop * force / force.std())


def chirp(rng):
    """An oscillation whose frequency changes by a factor of 1.5 to 4."""
    rig = draw_rig(rng)
    n, low, ratio = int(rng.integers(4000, 12000)), 10 ** rng.uniform(-2.3, -1.5), rng.uniform(1.5, 4)
    x = np.arange(n) / n
    phase = 2 * np.pi * low * n * (ratio**x - 1) / np.log(ratio)
    result = control(rig, "wave", rig.kinetic + rig.drop * np.sin(phase))
    result.truth["changes"] = True
    return result


FAMILIES = families(
    texture_trace, texture_bumps, chirp, steady_run, sine_harmonics, ringdown,
    steady_white=lambda rng: _steady(rng, lambda n, t, r: 0.0 * t),
    steady_red=lambda rng: _steady(rng, lambda n, t, r: 0.3 * red(rng, n, 10 ** rng.uniform(0.5, 3))),
    steady_walk=lambda rng: _steady(rng, lambda n, t, r: np.cumsum(rng.standard_normal(n)) / np.sqrt(n)),
    steady_pickup=lambda rng: _steady(rng, lambda n, t, r: lines(rng, t, 10 ** rng.uniform(-2.5, -0.5) / r.step, [0.3, 0.1 * rng.integers(0, 2)])),
    steady_ripple=lambda rng: _steady(rng, lambda n, t, r: 0.05 * red(rng, n, 30) + lines(rng, t, 0.01 / r.step, [0.05, 0.1]) + lines(rng, t, 0.25 / r.step, [0.1])),
    sine=lambda rng: _wave(rng, np.sin),
    square=lambda rng: _wave(rng, lambda w: np.sign(np.sin(w))),
    triangle=lambda rng: _wave(rng, lambda w: 2 / np.pi * np.arcsin(np.sin(w))),
)
