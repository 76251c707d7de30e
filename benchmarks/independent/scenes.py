"""Families of simulated recordings with their truth, each drawn from a seed. Used by make.py.

A scene is a rig (stiffness, natural frequency, ...) in proportions drawn at random; a family bends one thing in it.
Rules of the library are set on seeds below 1000 and reported on seeds from 5000 up.
"""
import dataclasses

import numpy as np

from simulator import SLIP, Model, Motion, simulate, simulate_lugre

PARAMETERS = ("stiffness_N_per_m", "friction_difference_N", "natural_frequency_rad_per_s", "damping_ratio")


@dataclasses.dataclass
class Rig:
    """Proportions of a stick-slip motion; time constants follow from the natural frequency."""
    rng: np.random.Generator
    model: Model
    drop: float       # F_s - F_k, N
    kinetic: float    # F_k, N
    speed: float      # m/s
    period_s: float   # about
    step: float       # s a sample
    count: int        # slips wanted
    noise: float      # N rms

    def samples(self, seconds):
        return int(np.ceil(seconds / self.step))

    def course(self, seconds):
        """Time and constant speed, static and kinetic friction over so many seconds."""
        n = self.samples(seconds)
        return np.arange(n) * self.step, np.full(n, self.speed), np.full(n, self.kinetic + self.drop), np.full(n, self.kinetic)

    def run(self, seconds=None, factors=(1.0,), start=None):
        seconds = seconds or (self.count + 1) * self.period_s
        _, speed, static, kinetic = self.course(seconds)
        return simulate(self.model, self.step, speed, static, kinetic, factors, self.start_force() if start is None else start)

    def start_force(self):
        return self.kinetic + self.drop * self.rng.uniform(-0.8, 0.8)

    def white(self, n):
        return self.noise * self.rng.standard_normal(n)


def draw_rig(rng, per_slip=(10, 50), slips=(15, 40), noise=(0.003, 0.03), ratio=(3, 25), zeta=(0.02, 0.2)):
    stiffness = 10 ** rng.uniform(2, 4.2)
    omega = 2 * np.pi * 10 ** rng.uniform(0.5, 2)
    drop = 10 ** rng.uniform(-1.5, 0.7)
    damping = rng.uniform(*zeta)
    slip_s = 1.1 * np.pi / omega
    stick_s = slip_s * np.exp(rng.uniform(*np.log(ratio)))
    fall = drop * (1 + np.exp(-np.pi * damping))
    model = Model(stiffness=stiffness, omega=omega, damping_ratio=damping)
    return Rig(rng, model, drop, drop * rng.uniform(1.5, 6), fall / stiffness / stick_s, slip_s + stick_s,
               slip_s / rng.uniform(*per_slip), int(rng.integers(*slips)), drop * np.exp(rng.uniform(*np.log(noise))))


def families(*functions, **short):
    """Families by name: functions of the random numbers that have a name, and short ones that get theirs here."""
    return {**{function.__name__: function for function in functions}, **short}


@dataclasses.dataclass
class Scene:
    time_s: np.ndarray
    force: np.ndarray
    truth: dict
    displacement_m: np.ndarray = None
    normal_N: np.ndarray = None
    speed_m_per_s: np.ndarray = None


def counted(slips, share=0.25):
    """Slips whose fall is at least a quarter of the median fall."""
    falls = np.abs(slips["onset_force"] - slips["end_force"])
    return slips[falls >= share * np.median(falls)] if len(slips) else slips


def truth_of(rig, slips, stretch, known=PARAMETERS):
    inside = counted(slips[(slips["onset_s"] >= stretch[0]) & (slips["end_s"] <= stretch[1]) & (slips["end_s"] > 0)])
    onset = inside["onset_s"][1:] if len(inside) > 3 else inside["onset_s"]
    frequency = (len(onset) - 1) / (onset[-1] - onset[0]) if len(onset) > 2 else None
    model = rig.model
    values = dict(zip(PARAMETERS, (model.stiffness, rig.drop, model.omega, model.damping_ratio)))
    values["mass_kg"] = model.stiffness / model.omega**2
    if model.relax_time > 0:
        values["stiffness_N_per_m"] = [model.stiffness * (1 - model.relax_share - model.slow_share), model.stiffness]
    if rig.model.weakening_length > 0:
        values["slip_distance_m"], known = rig.model.weakening_length, (*known, "slip_distance_m")
    if rig.model.reload_length:
        values["reload_force_N"], values["reload_length_m"] = rig.model.reload_force, rig.model.reload_length
        known = (*known, "reload_force_N", "reload_length_m")
    if {"stiffness_N_per_m", "natural_frequency_rad_per_s"} <= set(known):
        known = (*known, "mass_kg")
    return {"kind": "stick_slip", "speed_m_per_s": rig.speed, "frequency_Hz": frequency, "stretch_s": [float(s) for s in stretch],
            "spacing_m": rig.speed / frequency if frequency else None,
            "parameters": {name: values[name] for name in known}, "slips_s": [float(t) for t in onset]}


def scene(rig, motion, force=None, stretch=None, known=PARAMETERS, noise=True):
    force = motion.force if force is None else force
    force = force + rig.white(len(force)) if noise else force
    whole = (motion.time_s[0], motion.time_s[-1])
    return Scene(motion.time_s, force, truth_of(rig, motion.slips, stretch or whole, known))


def control(rig, kind, force, time_s=None, noise=True, frequency=None):
    """A recording without stick-slip; `frequency`: of an oscillation that may be quoted as such."""
    force = force + rig.white(len(force)) if noise else force
    time_s = np.arange(len(force)) * rig.step if time_s is None else time_s
    return Scene(time_s, force, {"kind": kind, "speed_m_per_s": rig.speed, "frequency_Hz": frequency,
                                 "spacing_m": rig.speed / frequency if frequency else None,
                                 "stretch_s": [float(time_s[0]), float(time_s[-1])], "parameters": {}, "slips_s": []})


def red(rng, n, correlation):
    """Red noise of standard deviation 1, first order."""
    from scipy.signal import lfilter
    a = np.exp(-1 / correlation)
    return lfilter([np.sqrt(1 - a * a)], [1, -a], rng.standard_normal(n + int(10 * correlation)))[int(10 * correlation):]


def lines(rng, time_s, frequency, swings):
    """Harmonics of a pick-up line; `swings`: peak to peak."""
    return sum(0.5 * s * np.cos(2 * np.pi * (i + 1) * frequency * time_s + rng.uniform(0, 6.3)) for i, s in enumerate(swings))


__all__ = ["SLIP", "Model", "Motion", "Rig", "Scene", "control", "counted", "draw_rig", "families", "lines", "red", "scene", "simulate",
           "simulate_lugre", "truth_of", "np"]
