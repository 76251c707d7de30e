"""Families whose clock is uneven or rounded, or has lost a sample, alone and with interference of the mains: 10 001 samples at 5 kHz, about 50
slips, noise of 0.015 of the friction drop. A family for each clock and amplitude of the interference over the drop, in thousandths."""
import functools

from families_inside import K_ONLY
from scenes import Model, Rig, Scene, np, truth_of

RATE_HZ, SAMPLES = 5000, 10001
FINER = 10  # steps of the simulation in a sample: between them the force is taken from a straight line
AMPLITUDES = (0.0, 0.05, 0.02, 0.008, 0.004)


def _jitter(rng, even_s, share):
    return np.sort(np.clip(even_s + share / RATE_HZ * rng.standard_normal(SAMPLES), 0, even_s[-1]))


def _as_taken(rng, taken_s, force):
    return taken_s, force


def _without_one(rng, written_s, force):
    lost = int(rng.integers(1, SAMPLES - 1))
    return np.delete(written_s, lost), np.delete(force, lost)


def _nan(rng, written_s, force):
    return written_s, np.where(np.arange(SAMPLES) == rng.integers(1, SAMPLES - 1), np.nan, force)


def _without_some(rng, written_s, force):
    kept = rng.uniform(size=SAMPLES) > 0.001
    return written_s[kept], force[kept]


CLOCKS = {  # name: (scatter of the times at which samples are taken, in samples; what is written of times and force)
    "even": (0.0, _as_taken), "one_lost": (0.0, _without_one), "one_nan": (0.0, _nan), "some_lost": (0.0, _without_some),
    "sampled_unevenly_5": (0.05, _as_taken), "sampled_unevenly_20": (0.2, _as_taken),
    "stamps_off_20": (0.0, lambda rng, taken_s, force: (_jitter(rng, taken_s, 0.2), force)),
    "stamps_in_ms": (0.0, lambda rng, taken_s, force: (np.round(taken_s, 3), force)),
    "stamps_in_ms_one_lost": (0.0, lambda rng, taken_s, force: _without_one(rng, np.round(taken_s, 3), force))}


def _recording(rng, clock, amplitude):
    k, omega = 5000 * np.exp(rng.uniform(-0.3, 0.3)), 900 * np.exp(rng.uniform(-0.2, 0.2))
    model = Model(stiffness=k, omega=omega, damping_ratio=rng.uniform(0.02, 0.1))
    rig = Rig(rng, model, 1.0, 3.0, 0.01, 2.0 / k / 0.01, 1 / (RATE_HZ * FINER), 50, 0.015)
    motion = rig.run(SAMPLES / RATE_HZ, np.maximum(0.5, 1 + 0.02 * rng.standard_normal(400)))
    share, written = CLOCKS[clock]
    taken_s = _jitter(rng, np.arange(SAMPLES) / RATE_HZ, share)
    mains_Hz = rng.choice((50, 60)) * (1 + 2e-4 * rng.standard_normal())
    force = np.interp(taken_s, motion.time_s, motion.force) + rig.white(SAMPLES)
    force += amplitude * np.sin(2 * np.pi * mains_Hz * taken_s + rng.uniform(0, 2 * np.pi))
    return Scene(*written(rng, taken_s, force), truth_of(rig, motion.slips, (0.0, taken_s[-1]), K_ONLY))


FAMILIES = {f"{clock}.{1000 * amplitude:g}": functools.partial(_recording, clock=clock, amplitude=amplitude)
            for clock in CLOCKS for amplitude in AMPLITUDES}
