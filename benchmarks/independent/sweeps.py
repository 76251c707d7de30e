"""Families of simulated sweeps with their truth: what happens at speeds that were not measured, and where stick-slip ends.

A sweep is one sliding pair at several speeds; a family bends one thing in it. Seeds from 5000 up are for reports.
"""
import dataclasses

import numpy as np

from scenes import families
from simulator import Model, simulate, write_csv

BEYOND = (2.0, 4.0)  # of the fastest recording


@dataclasses.dataclass
class Run:
    """One recording: what was driven, and what the manifest says of it."""
    speed: float
    model: Model
    drop: float
    kinetic: float
    stated_speed: float = None
    stated_load: float = None
    average: int = 0     # samples
    offset: float = 0.0  # N
    source: int = None   # the trace is that of this other recording
    per_slip: float = None  # samples; None: the sweep's
    start: float = None  # force; None: that of kinetic friction
    measured_load: float = None  # N, at the level of kinetic friction; None: there is no column of the normal force


@dataclasses.dataclass
class Sweep:
    """Proportions of a pair, its recordings, and the number of the one that is wrong (None: none is)."""
    rng: np.random.Generator
    runs: list
    noise: float
    per_slip: float
    bad: int = None
    slips: tuple = (14, 25)
    drop: float = None       # F_s - F_k at the speeds predicted; None: that of a sound recording
    model_at: object = None  # of a speed; None: that of a sound recording
    fastest: float = None  # m/s, of the recordings with slips; None: of all


def base_model(rng, zeta=(0.03, 0.2)):
    return Model(stiffness=10 ** rng.uniform(2, 4), omega=2 * np.pi * 10 ** rng.uniform(0.7, 1.8), damping_ratio=rng.uniform(*zeta))


def draw(rng, count, span, bend=None, fastest=(6, 20), zeta=(0.03, 0.2)):
    """`bend(model, drop)` changes the model; F_s - F_k(0+) stays `drop` after a stick of the middle speed, roughly."""
    model = base_model(rng, zeta)
    drop = 10 ** rng.uniform(-1.0, 0.7)
    top = drop / model.stiffness * model.omega / np.exp(rng.uniform(*np.log(fastest)))
    speeds = top * span ** (-np.arange(count)[::-1] / max(1, count - 1)) * np.exp(0.03 * rng.standard_normal(count) * (count > 2))
    kinetic = drop * rng.uniform(1.5, 5)
    if bend:
        drop, kinetic = bend(model, drop, kinetic, speeds)
    runs = [Run(v, model, drop, kinetic) for v in speeds]
    return Sweep(rng, runs, drop * np.exp(rng.uniform(*np.log((0.003, 0.03)))), rng.uniform(10, 30))


def stick_s(model, drop, speed):
    return 1.8 * drop / (model.stiffness * speed)


def ageing(rng, law=0, cut_off=(-4, -2), share=(0.03, 0.08), exponential=False):
    """Static friction grows by `share` of F_s - F_k a factor of e in stick time, by one of three functions of it; `cut_off`:
    powers of ten of the time below which ln(1 + t/t_c) ends, over the stick of the middle speed."""
    def bend(model, drop, kinetic, speeds):
        middle = stick_s(model, drop, np.sqrt(speeds[0] * speeds[-1]))
        amount = rng.uniform(*share) * drop
        model.ageing_law = law
        if law == 0:
            model.ageing, model.ageing_time = amount, middle * 10 ** rng.uniform(*cut_off)
            now = amount * np.log1p(middle / model.ageing_time)
        elif law == 1:
            model.ageing, model.ageing_time = amount / 0.25, middle
            now = model.ageing
        else:
            model.ageing, model.ageing_time = amount * 3, middle * 10 ** rng.uniform(-0.4, 0.4)
            now = -model.ageing * np.expm1(-middle / model.ageing_time)
        if exponential:
            velocity(rng, 0)(model, drop, kinetic, speeds)
        return max(0.2 * drop, drop - now), kinetic
    return bend


def velocity(rng, law, sign=1, share=(0.1, 0.4), decades=(-0.7, 0.5)):
    """`share` of F_s - F_k depends on the speed; `decades`: its speed over the fastest sliding speed, as powers of ten."""
    def bend(model, drop, kinetic, speeds):
        slip_speed = drop / model.stiffness * model.omega
        model.velocity_law = law
        if law == 1:
            model.stribeck_force, model.stribeck_speed = sign * drop * rng.uniform(0.02, 0.08), slip_speed * 10 ** rng.uniform(-2.5, -1)
        else:
            model.stribeck_force, model.stribeck_speed = sign * drop * rng.uniform(*share), slip_speed * 10 ** rng.uniform(*decades)
        return drop + max(0.0, model.stribeck_force), kinetic  # F_s - F_k(0+) = drop; the level stays positive
    return bend


def exponential_strong(rng):
    """Kinetic friction that falls by half of F_s - F_k and more within the speeds of a slip; recordings with little noise."""
    sweep = draw(rng, 5, 8, velocity(rng, 0, share=(0.5, 1.0), decades=(-0.4, 0.2)))
    sweep.noise, sweep.per_slip = 0.3 * sweep.noise, 2.0 * sweep.per_slip
    return sweep


def age_terms(rng):
    """Static friction that ages, seen through an average, beside sticks that rise more steeply after a slip."""
    sweep = draw(rng, 5, rng.uniform(5, 10), ageing(rng, cut_off=(-0.7, 0.3), share=(0.05, 0.1)))
    first = sweep.runs[0]
    first.model.reload_force = first.drop * rng.uniform(0.1, 0.3)
    first.model.reload_length = first.drop / first.model.stiffness * rng.uniform(0.2, 0.5)
    for run in sweep.runs:
        run.average = max(1, round(0.3 * sweep.per_slip))
    return sweep


def trended(rng):
    """k changes with ln V, by 5 to 15 % over the sweep."""
    sweep = draw(rng, 4, rng.uniform(4, 8))
    total = rng.uniform(0.05, 0.15) * rng.choice([-1, 1])
    speeds = np.array([r.speed for r in sweep.runs])
    for run in sweep.runs:
        run.model = trended_model(sweep.runs[0].model, speeds, total, run.speed)
    sweep.model_at = lambda v, first=sweep.runs[0].model: trended_model(first, speeds, total, v)
    return sweep


def trended_model(first, speeds, total, speed):
    share = np.log(speed / speeds[0]) / np.log(speeds[-1] / speeds[0])
    model = Model.from_buffer_copy(first)
    model.stiffness *= 1 + total * share
    model.omega *= np.sqrt(1 + total * share)
    return model


def with_stiffness(first, factor):
    """Another k and the same mass."""
    model = Model.from_buffer_copy(first)
    model.stiffness *= factor
    model.omega *= np.sqrt(factor)
    return model


def grown(rng, scatter=0.0):
    """k goes as a power of the speed, and scatters between the runs."""
    sweep = draw(rng, int(rng.integers(4, 7)), rng.uniform(4, 12))
    exponent = rng.uniform(0.02, 0.12) * rng.choice([-1, 1])
    first, slowest = sweep.runs[0].model, sweep.runs[0].speed
    sweep.model_at = lambda v: with_stiffness(first, (v / slowest) ** exponent)
    for run in sweep.runs:
        run.model = with_stiffness(sweep.model_at(run.speed), np.exp(scatter * rng.standard_normal()))
    return sweep


def loose(rng):
    """k scatters between the runs, and does not go with the speed."""
    sweep = draw(rng, int(rng.integers(4, 7)), rng.uniform(4, 12))
    first, scatter = sweep.runs[0].model, rng.uniform(0.01, 0.06)
    sweep.model_at = lambda v: first
    for run in sweep.runs:
        run.model = with_stiffness(first, np.exp(scatter * rng.standard_normal()))
    return sweep


def relaxing(rng):
    """A standard linear solid in place of the spring; its time is one of the contact, whatever the speed."""
    sweep = draw(rng, 5, rng.uniform(5, 20))
    first, middle = sweep.runs[0], sweep.runs[2]
    first.model.relax_share = np.exp(rng.uniform(np.log(0.05), np.log(0.7)))
    period = 1.1 * np.pi / first.model.omega + stick_s(first.model, first.drop, middle.speed)
    first.model.relax_time = 10 ** rng.uniform(-2, 1) * period
    return sweep


def averaging(rng):
    sweep = draw(rng, 4, rng.uniform(4, 8))
    width = int(rng.integers(3, 9))
    for run in sweep.runs:
        run.average = width
    return sweep


def _rings(rng, times):
    """Seen through an average that hides w_n, with a run beyond the end of stick-slip that rings down after its first slip.
    `times`: w_n there over that of the slips."""
    sweep = draw(rng, 4, rng.uniform(4, 8))
    width = max(1, round(rng.uniform(1, 3.5) * sweep.per_slip / (1.1 * np.pi)))
    first = sweep.runs[0]
    ringing = Model(stiffness=first.model.stiffness, omega=times * first.model.omega, damping_ratio=first.model.damping_ratio)
    beyond = first.drop * ringing.omega / ringing.stiffness / 0.3
    sweep.fastest = max(run.speed for run in sweep.runs)
    sweep.runs.append(Run(beyond, ringing, first.drop, first.kinetic, start=0.0))
    for run in sweep.runs:
        run.average = width
    return sweep


def drifting(rng):
    """The surface changes from recording to recording, as with its temperature: F_s - F_k by 5 to 20 % over the sweep."""
    sweep = draw(rng, 5, 8)
    total = rng.uniform(0.05, 0.2) * rng.choice([-1, 1])
    in_order = rng.random() < 0.5
    for i, place in enumerate(np.arange(5) if in_order else rng.permutation(5)):
        sweep.runs[i].drop *= 1 + total * (place / 4 - 0.5)
    sweep.drop = sweep.runs[-1].drop if in_order else float(np.mean([r.drop for r in sweep.runs]))
    return sweep


def scattered(rng, bend=None, scatter=(0.03, 0.2)):
    """Every recording finds its own static friction, as on another part of the surface; few recordings."""
    sweep = draw(rng, int(rng.integers(3, 6)), rng.uniform(4, 8), bend)
    sweep.drop = sweep.runs[0].drop
    spread = np.exp(rng.uniform(*np.log(scatter)))
    for run in sweep.runs:
        run.drop *= np.exp(spread * rng.standard_normal())
    return sweep


def zeros(rng):
    sweep = draw(rng, 5, 8)
    for run in sweep.runs:
        run.offset = run.drop * 0.3 * rng.standard_normal()
    return sweep


def wrong_loads(rng):
    """Loads differ twofold; the stated ones are off by 5 %."""
    sweep = draw(rng, 5, 8)
    for i, run in enumerate(sweep.runs):
        load = 1.0 if i == 0 else rng.uniform(1, 2)
        run.drop, run.kinetic = run.drop * load, run.kinetic * load
        run.stated_load = 5.0 * load * (1 if i == 0 else 1 + 0.05 * rng.standard_normal())
    return sweep


def adhesion(rng):
    """Loads differ up to threefold, and both frictions are proportional to the load and an adhesion of 0.2 to 1 of the first."""
    sweep = draw(rng, 5, 8)
    offset = rng.uniform(0.2, 1.0)
    for i, run in enumerate(sweep.runs):
        load = 1.0 if i == 0 else rng.uniform(1, 3)
        share = (load + offset) / (1 + offset)
        run.drop, run.kinetic, run.stated_load = run.drop * share, run.kinetic * share, 5.0 * load
    return sweep


def undersampled(rng):
    """Recordings over a factor of 1000 in speed, the slowest with as many samples as a logger keeps: 0.2 to 0.7 of a sample a slip;
    half of them under an exponential law."""
    sweep = draw(rng, 5, 1000, velocity(rng, 0) if rng.random() < 0.5 else None)
    for run, per_slip in zip(sweep.runs, (rng.uniform(0.2, 0.7), rng.uniform(0.2, 0.7))):
        run.per_slip = per_slip
    return sweep


def flash(rng):
    """The heat of the slip lowers the kinetic friction by 10 to 50 % of F_s - F_k, and leaves within the stick."""
    def bend(model, drop, kinetic, speeds):
        model.heat_slope = rng.uniform(0.1, 0.5) * drop / (2 * drop / model.stiffness)
        model.heat_time = np.pi / model.omega * rng.uniform(0.5, 2)
        return drop, kinetic
    return draw(rng, 4, rng.uniform(4, 8), bend)


def depth(rng):
    """The bending of the holder changes the load as it changes the force."""
    def bend(model, drop, kinetic, speeds):
        model.load_slope = rng.choice([-1, 1]) * rng.uniform(0.03, 0.2)
        return drop, kinetic
    return draw(rng, 4, rng.uniform(4, 8), bend)


def depth_measured(rng):
    """The same with a column of the normal force."""
    sweep = depth(rng)
    load = sweep.runs[0].kinetic / rng.uniform(0.3, 1.0)
    for run in sweep.runs:
        run.measured_load = load
    return sweep


def _bad(rng, change):
    sweep = draw(rng, 5, 8)
    sweep.bad = int(rng.integers(0, 5))
    change(sweep, sweep.runs[sweep.bad])
    return sweep


def other_material(rng):
    def change(sweep, run):
        run.drop *= rng.choice([0.6, 0.7, 1.4, 1.6])
        run.model = Model.from_buffer_copy(run.model)
        run.model.stiffness *= rng.uniform(1.2, 1.6)
        run.model.omega *= rng.uniform(0.8, 1.2)
    return _bad(rng, change)


def swapped(rng):
    sweep = draw(rng, 5, 8)
    a, b = rng.choice(5, 2, replace=False)
    sweep.runs[a].source, sweep.runs[b].source = int(b), int(a)
    sweep.bad = (int(a), int(b))
    return sweep


def trace(sweep, run):
    model, rng = run.model, sweep.rng
    per_slip = run.per_slip or sweep.per_slip
    fine = max(1, int(np.ceil(10 / per_slip)))  # steps of the simulation a sample
    step = 1.1 * np.pi / model.omega / per_slip
    period = 1.1 * np.pi / model.omega + stick_s(model, run.drop, run.speed)
    n = int(np.ceil(rng.integers(*sweep.slips) * period / step))
    full = np.full(fine * n, run.speed)
    motion = simulate(model, step / fine, full, run.kinetic + run.drop, run.kinetic,
                      start_force=run.kinetic if run.start is None else run.start)
    force = motion.force[::fine] + run.offset
    if run.average:
        force = np.convolve(np.pad(force, run.average, "edge"), np.ones(run.average) / run.average, "same")[run.average:-run.average]
    measured = force + sweep.noise * rng.standard_normal(n)
    if run.measured_load is None:
        return motion.time_s[::fine], measured, None
    follows = 1 + model.load_slope * (motion.force[::fine] - run.kinetic) / run.kinetic
    return motion.time_s[::fine], measured, run.measured_load * (follows + 1e-3 * rng.standard_normal(n))


def write(sweep, folder):
    """The recordings and the manifest, as the person who measured states them."""
    folder.mkdir(parents=True, exist_ok=True)
    traces = [trace(sweep, run) for run in sweep.runs]
    loads = any(run.stated_load for run in sweep.runs)
    lines = ["id,file,speed_m_per_s" + (",normal_force_N" if loads else "")]
    for i, run in enumerate(sweep.runs):
        time_s, force, normal_N = traces[i if run.source is None else run.source]
        write_csv(folder / f"run{i}.csv", time_s, force, normal_N=normal_N)
        lines.append(f"run{i},run{i}.csv,{run.stated_speed or run.speed:.9g}" + (f",{run.stated_load:.6g}" if loads else ""))
    (folder / "manifest.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def limit_period(model, drop, kinetic, speed):
    """Of the last ten slips of forty; None: sticking has ended."""
    period = 1.1 * np.pi / model.omega + stick_s(model, drop, speed)
    step = 0.02 / model.omega
    slips = 40
    n = int(slips * 1.5 * period / step) + 1
    n = min(n, 4_000_000)
    motion = simulate(model, step, np.full(n, speed), kinetic + drop, kinetic, start_force=kinetic + drop)
    onset = motion.slips["onset_s"]
    if len(onset) < 15 or onset[-1] < (n * step - 3 * period):
        return None
    return (onset[-1] - onset[-11]) / 10


def truth_of(sweep):
    sound = next(r for i, r in enumerate(sweep.runs) if i != sweep.bad and (r.stated_load or 5.0) == 5.0)
    fastest = sweep.fastest or max(r.speed for r in sweep.runs)
    model_at = sweep.model_at or (lambda v: sound.model)
    drop = sweep.drop or sound.drop  # of the first recording where loads differ
    rows = []
    for times in BEYOND:
        v = times * fastest
        period = limit_period(model_at(v), drop, sound.kinetic, v)
        rows.append({"speed_m_per_s": v, "spacing_m": v * period if period else None})
    slow, fast = 0.2 * fastest, 400 * fastest
    if limit_period(model_at(slow), drop, sound.kinetic, slow) is None:
        critical = None
    else:
        while fast > 1.0005 * slow:
            middle = np.sqrt(slow * fast)
            if limit_period(model_at(middle), drop, sound.kinetic, middle):
                slow = middle
            else:
                fast = middle
        critical = middle if slow < 390 * fastest else None
    return {"rows": rows, "critical_speed_m_per_s": critical, "bad": sweep.bad, "load_N": sound.stated_load,
            "parameters": parameters_of(sweep, sound)}


def parameters_of(sweep, sound):
    """What all recordings share, k and w_n at the mean of ln V; F_s - F_k(0+) where they do, by the manifest's mean load."""
    model = sweep.model_at(np.exp(np.mean([np.log(r.speed) for r in sweep.runs]))) if sweep.model_at else sound.model
    truth = {"stiffness_N_per_m": model.stiffness, "natural_frequency_rad_per_s": model.omega, "damping_ratio": model.damping_ratio}
    truth["mass_kg"] = model.stiffness / model.omega**2
    if model.relax_share > 0:  # k between the relaxed and the instantaneous one is right; what relaxes damps, too
        truth["stiffness_N_per_m"] = [model.stiffness * (1 - model.relax_share), model.stiffness]
        del truth["damping_ratio"], truth["natural_frequency_rad_per_s"]
    if model.stribeck_speed > 0 and model.velocity_law == 0:
        truth["alpha_s_per_m"] = -1.0 / model.stribeck_speed
    if model.ageing_time > 0 and model.ageing_law == 0:
        truth |= {"ageing_N": model.ageing, "ageing_time_s": model.ageing_time}
    loads = [r.stated_load / sound.stated_load if r.stated_load else 1.0 for r in sweep.runs]
    drops = [r.drop / load for r, load in zip(sweep.runs, loads)]
    if model.ageing_time <= 0 and max(drops) < 1.2 * min(drops) and sweep.bad is None:
        at_rest = model.stribeck_force if model.stribeck_speed > 0 and model.velocity_law != 1 else 0.0
        truth["friction_difference_N"] = float(np.mean(drops) * np.mean(loads)) - at_rest
    return truth


FAMILIES = families(
    exponential_strong, age_terms, trended, grown, loose, averaging, drifting, scattered, zeros, wrong_loads, adhesion, undersampled, relaxing, flash, depth,
    depth_measured, other_material, swapped,
    coulomb5=lambda rng: draw(rng, 5, 8),
    coulomb3=lambda rng: draw(rng, 3, rng.uniform(4, 8)),
    exponential=lambda rng: draw(rng, 5, 8, velocity(rng, 0)),
    age_ln3=lambda rng: draw(rng, 3, rng.uniform(4, 8), ageing(rng)),
    age_ln4=lambda rng: draw(rng, 4, rng.uniform(4, 8), ageing(rng)),
    age_ln6=lambda rng: draw(rng, 6, rng.uniform(8, 20), ageing(rng)),
    age_cutoff=lambda rng: draw(rng, 4, rng.uniform(4, 8), ageing(rng, cut_off=(-0.7, 0.3))),
    age_wide=lambda rng: draw(rng, 6, rng.uniform(30, 60), ageing(rng, cut_off=(-1.0, 0.3), share=(0.05, 0.1))),  # sticks that span a factor of 30 and more: they determine the cut-off
    age_power=lambda rng: draw(rng, 4, rng.uniform(4, 8), ageing(rng, 1)),
    age_saturating=lambda rng: draw(rng, 4, rng.uniform(4, 8), ageing(rng, 2)),
    age_exponential=lambda rng: draw(rng, 4, rng.uniform(4, 8), ageing(rng, exponential=True)),
    log_falling=lambda rng: draw(rng, 4, rng.uniform(4, 8), velocity(rng, 1)),
    log_rising=lambda rng: draw(rng, 4, rng.uniform(4, 8), velocity(rng, 1, -1)),
    hyperbolic=lambda rng: draw(rng, 4, rng.uniform(4, 8), velocity(rng, 2)),
    two=lambda rng: draw(rng, 2, rng.uniform(4, 8), ageing(rng)),
    two_coulomb=lambda rng: draw(rng, 2, rng.uniform(4, 8)),
    narrow=lambda rng: draw(rng, 4, 1.2, ageing(rng)),
    near_critical=lambda rng: draw(rng, 6, rng.uniform(20, 40), zeta=(0.1, 0.3), fastest=(1.0, 2.5)),  # the fastest recordings are near the end of stick-slip and above it
    age_loosely=lambda rng: scattered(rng, ageing(rng, cut_off=(-0.7, 0.3), share=(0.05, 0.2)), scatter=(0.01, 0.1)),
    grown_loosely=lambda rng: grown(rng, rng.uniform(0.005, 0.03)),
    rings=lambda rng: _rings(rng, 1.0),
    rings_otherwise=lambda rng: _rings(rng, rng.uniform(1.4, 2.0)),
    bad_speed=lambda rng: _bad(rng, lambda s, r: setattr(r, "stated_speed", 1.1 * r.speed)),
    bad_unit=lambda rng: _bad(rng, lambda s, r: setattr(r, "stated_speed", r.speed / 60)),
    one_file_twice=lambda rng: _bad(rng, lambda s, r: setattr(r, "source", (s.bad + 1) % 5)),
    level_only=lambda rng: _bad(rng, lambda s, r: setattr(r, "kinetic", 1.15 * r.kinetic)),
)
