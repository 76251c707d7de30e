#!/usr/bin/env python3
"""Accuracy against CPU time for slipfit, reduced slipfit settings, and own implementations of other methods.

front.py SLIPFIT FOLDER [--count N] [--csv FILE] [--scenes A,B]    measures recordings; FOLDER is written by benchmarks/independent/make.py scenes
front.py SLIPFIT FOLDER --sweeps [--count N] [--csv FILE]          measures alpha of sweeps; FOLDER is written by make.py sweeps

`benchmarks/draw.py front` draws the table. The time is CPU time: that of slipfit's command minus that of its start, that of
the other methods without reading the file. The error is the median of the relative errors. The coverage is the share of
the 95 % intervals that contain the truth; a fit by scipy has the intervals of its own covariance. Needs python3-scipy.
"""

import argparse
import csv
import json
import pathlib
import sys
import tempfile
import time

import numpy

import compare

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from study import cost, parser, read_truths  # noqa: E402

# name: key in the fit document and in the truth
QUANTITIES = {"k": "stiffness_N_per_m", "spacing": "pattern_spacing_m", "w_n": "natural_frequency_rad_per_s", "zeta": "damping_ratio",
              "alpha": "alpha_s_per_m"}
OF_A_RECORDING = ("k", "spacing", "w_n", "zeta")


def read_estimate(document, key):
    estimate = (document.get("parameters") or {}).get(key) or (document.get("derived") or {}).get(key) or {}
    return estimate.get("value"), estimate.get("ci95")


def run_command(slipfit, *words):
    """CPU seconds of a command without those of the program's start, and its document; None if it fails."""
    start, whole = cost(slipfit, "--version"), cost(slipfit, "fit", *words, "--json", "--quiet")
    return (whole.cpu_s - start.cpu_s, json.loads(whole.out)) if whole.code == 0 else None


def command(slipfit, file, truth, *options):
    done = run_command(slipfit, str(file), "--speed", f"{truth['speed_m_per_s']:.9g}", *options)
    if done is None:
        return None
    return done[0], {name: read_estimate(done[1], QUANTITIES[name]) for name in OF_A_RECORDING}


def third(slipfit, file, truth):
    slips_s = truth["slips_s"]
    count = max(8, len(slips_s) // 3)
    return command(slipfit, file, truth, "--window", f"{slips_s[0]:.9g}:{slips_s[min(count, len(slips_s) - 1)]:.9g}")


def thinned(file):
    lines = pathlib.Path(file).read_text().splitlines()
    return "\n".join([lines[0], *lines[1::4]]) + "\n"


def every_fourth(slipfit, file, truth):
    with tempfile.NamedTemporaryFile("w", suffix=".csv") as thin:
        thin.write(thinned(file))
        thin.flush()
        return command(slipfit, thin.name, truth)


def load(file, truth):
    """Samples in the time of a drive at compare.SPEED: forces are unchanged, frequencies larger by the ratio."""
    rows = numpy.loadtxt(file, delimiter=",", skiprows=1)
    first, last = truth["slips_s"][0], truth["slips_s"][-1]
    rows = rows[(rows[:, 0] >= first) & (rows[:, 0] <= last)]
    ratio = truth["speed_m_per_s"] / compare.SPEED
    return rows[:, 0] * ratio, rows[:, 1], ratio


def features(_, file, truth):
    """Medians over the slips: the slope between them (k), their distance (spacing), the fall from 80 to 20 % as half a cosine (w_n)."""
    time_s, force, ratio = load(file, truth)
    begin = time.process_time()
    period = (time_s[-1] - time_s[0]) / (len(truth["slips_s"]) - 1)
    high, low = numpy.percentile(force, (98.0, 2.0))
    drop, step = high - low, (time_s[-1] - time_s[0]) / (len(time_s) - 1)
    near = max(2, int(0.25 * period / step))
    falls = []
    middle = numpy.flatnonzero((force[:-1] >= 0.5 * (high + low)) & (force[1:] < 0.5 * (high + low)))
    for i in middle:
        piece = force[max(0, i - near): i + near]
        above = numpy.flatnonzero(piece > high - 0.2 * drop)
        above = above[above < min(near, i)]
        below = numpy.flatnonzero(piece < low + 0.2 * drop)
        below = below[below > min(near, i)]
        if len(above) and len(below):
            falls.append((below[0] - above[-1]) * step)
    omega = 2.0 * numpy.arcsin(0.6) / max(numpy.median(falls), 0.5 * step) * ratio if falls else None
    place = numpy.flatnonzero((force > high - 0.3 * drop) | (force < low + 0.3 * drop))
    is_low = force[place] < low + 0.3 * drop
    onsets_s = time_s[place[:-1][~is_low[:-1] & is_low[1:]]]  # last sample near the peak before one near the trough
    spacing = numpy.mean(numpy.diff(onsets_s)) * compare.SPEED if len(onsets_s) > 1 else None
    lag = max(1, int(0.1 * period / step))
    stiffness = numpy.median(force[lag:] - force[:-lag]) / (lag * step * compare.SPEED)  # most of the time it sticks
    seconds = time.process_time() - begin
    return seconds, {"k": (stiffness, None), "spacing": (spacing, None), "w_n": (omega, None), "zeta": (None, None)}


def with_interval(result, place, factor):
    """A parameter of a fit by scipy and the interval of its covariance, both times a factor."""
    value = result.x[place] * factor
    try:
        covariance = numpy.linalg.inv(result.jac.T @ result.jac) * 2.0 * result.cost / (len(result.fun) - len(result.x))
    except numpy.linalg.LinAlgError:
        return value, None
    reach = 1.96 * numpy.sqrt(max(0.0, covariance[place, place])) * factor
    return value, [value - reach, value + reach]


def parameters_of(result, ratio):
    return {name: with_interval(result, place, factor) for name, place, factor in (("k", 0, 1.0), ("w_n", 1, ratio), ("zeta", 2, 1.0))}


def whole_trace(_, file, truth):
    time_s, force, ratio = load(file, truth)
    seconds, result = compare.fit_with_search(time_s, force)
    spacing = compare.SPEED * compare.cycle_of(*result.x[:4])[4] / result.x[1]
    return seconds, {**parameters_of(result, ratio), "spacing": (spacing, None)}


def blocks(_, file, truth):
    time_s, force, ratio = load(file, truth)
    begin = time.process_time()
    model = compare.Blocks(compare.searched_start(time_s, force), time_s)
    seconds = time.process_time() - begin
    fit_s, result = compare.fit(model, model.start, time_s, force, max_nfev=30)
    onsets_s = result.x[4:4 + model.count]
    spacing = compare.SPEED * numpy.mean(numpy.diff(onsets_s[1:-1])) if model.count > 3 else None  # the outer cycles are cut off
    return seconds + fit_s, {**parameters_of(result, ratio), "spacing": (spacing, None)}


RUN = {"slipfit fit": command, "slipfit, a third of the cycles": third, "slipfit, every fourth sample": every_fourth,
       "slipfit --tier damped": lambda s, f, t: command(s, f, t, "--tier", "damped"), "features of the slips": features,
       "scipy, whole trace": whole_trace, "scipy, cycles as blocks": blocks}


def joint(slipfit, folder, _):
    done = run_command(slipfit, "--joint", str(folder / "manifest.csv"))
    return None if done is None else (done[0], {"alpha": read_estimate(done[1], "alpha_s_per_m")})


def joint_every_fourth(slipfit, folder, truth):
    with tempfile.TemporaryDirectory() as name:
        thin = pathlib.Path(name)
        (thin / "manifest.csv").write_text((folder / "manifest.csv").read_text())
        for file in folder.glob("run*.csv"):
            (thin / file.name).write_text(thinned(file))
        return joint(slipfit, thin, truth)


def exponential_through(folder, truth, sliding):
    """alpha of F_k(v) = f0 + f1 exp(alpha v) through the kinetic friction of each recording at its fastest sliding speed.

    `sliding` gives the CPU time of one recording, its fastest sliding speed and its kinetic friction."""
    from scipy.optimize import curve_fit
    seconds, speeds, frictions = 0.0, [], []
    for i, speed in enumerate(truth["speeds_m_per_s"]):
        spent, fastest, friction = sliding(folder / f"run{i}.csv", speed)
        seconds += spent
        speeds.append(fastest)
        frictions.append(friction)
    begin = time.process_time()
    v, f = numpy.array(speeds), numpy.array(frictions)
    try:
        (_, _, alpha), covariance = curve_fit(lambda v, f0, f1, alpha: f0 + f1 * numpy.exp(alpha * v), v, f,
                                              p0=(f[-1], f[0] - f[-1], -2.0 / numpy.mean(v)), maxfev=2000)
    except RuntimeError:
        return seconds + time.process_time() - begin, {"alpha": (None, None)}
    reach = 1.96 * numpy.sqrt(covariance[2, 2])
    interval = [alpha - reach, alpha + reach] if numpy.isfinite(reach) else None
    return seconds + time.process_time() - begin, {"alpha": (alpha, interval)}


def sliding_by_features(file, speed):
    """Undamped slip: kinetic friction midway between peak and trough, fastest sliding half the drop times w_n/k."""
    rows = numpy.loadtxt(file, delimiter=",", skiprows=1)
    slope_lag = max(1, len(rows) // 2000)
    begin = time.process_time()
    time_s, force = rows[len(rows) // 10:, 0], rows[len(rows) // 10:, 1]
    high, low = numpy.percentile(force, (98.0, 2.0))
    step = time_s[1] - time_s[0]
    fastest_fall = -numpy.min(force[slope_lag:] - force[:-slope_lag]) / (slope_lag * step)
    rise = numpy.median(force[slope_lag:] - force[:-slope_lag]) / (slope_lag * step)
    return time.process_time() - begin, speed * (1.0 + fastest_fall / rise), 0.5 * (high + low)


def sliding_by_whole_trace(file, speed):
    rows = numpy.loadtxt(file, delimiter=",", skiprows=1)
    rows = rows[len(rows) // 10:]
    seconds, result = compare.fit_with_search(rows[:, 0] * speed / compare.SPEED, rows[:, 1])
    k, omega, _, drop, level, _ = result.x
    return seconds, speed * (1.0 + omega * drop / (k * compare.SPEED)), level


SWEEP_RUN = {"slipfit fit": joint,
             "slipfit, every fourth sample": joint_every_fourth,
             "features of the slips": lambda s, f, t: exponential_through(f, t, sliding_by_features),
             "scipy, whole trace": lambda s, f, t: exponential_through(f, t, sliding_by_whole_trace)}


def true_value(truth, quantity):
    return truth["spacing_m"] if quantity == "spacing" else truth["parameters"].get(QUANTITIES[quantity])


def rows_of(scene, method, answers, truths, quantities):
    """Rows of the table, one for each quantity; an answer is None if the method failed."""
    times_ms = [1e3 * answer[0] for answer in answers if answer is not None]
    for quantity in quantities:
        errors, held = [], []
        known = [(answer[1].get(quantity, (None, None)), true_value(truth, quantity))
                 for answer, truth in zip(answers, truths) if answer is not None and true_value(truth, quantity)]
        for (value, interval), true in known:
            if value is not None:
                errors.append(abs(value / true - 1.0))
            if interval is not None:
                held.append(min(interval) <= true <= max(interval))
        enough = 2 * len(errors) > len(truths)
        yield [scene, method, quantity, len(truths), len(errors), f"{numpy.median(times_ms):.4g}" if times_ms else "",
               f"{numpy.median(errors):.4g}" if enough else "", f"{numpy.mean(held):.3f}" if held else ""]


def measure(arguments):
    truths = read_truths(arguments.folder)
    out = csv.writer(arguments.csv, lineterminator="\n")
    out.writerow(["scene", "method", "quantity", "recordings", "answered", "median_cpu_ms", "median_error", "covered"])
    methods = SWEEP_RUN if arguments.sweeps else RUN
    for scene in arguments.scenes.split(",") if arguments.scenes else dict.fromkeys(t["family"] for t in truths):
        chosen = [t for t in truths if t["family"] == scene][: arguments.count]
        for method, run in methods.items():
            answers = []
            for truth in chosen:
                place = truth["id"] if arguments.sweeps else truth["file"]
                try:
                    answers.append(run(arguments.slipfit, arguments.folder / place, truth))
                except (ValueError, TypeError, IndexError, RuntimeError, MemoryError):  # the search found no start
                    answers.append(None)
            out.writerows(rows_of(scene, method, answers, chosen, ("alpha",) if arguments.sweeps else OF_A_RECORDING))
            arguments.csv.flush()


def main():
    words = parser(__doc__)
    words.add_argument("slipfit")
    words.add_argument("folder", type=pathlib.Path)
    words.add_argument("--count", type=int, default=20, help="recordings of a scene")
    words.add_argument("--sweeps", action="store_true", help="measure sweeps")
    words.add_argument("--csv", type=argparse.FileType("w"), default=sys.stdout)
    words.add_argument("--scenes", default="", help="names, separated by commas")
    measure(words.parse_args())


if __name__ == "__main__":
    main()
