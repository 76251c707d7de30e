#!/usr/bin/env python3
"""evaluate.py SLIPFIT PROFILES [--jobs 2] [--chart FILE.svg]: slipfit surface over the profiles of profiles.py against their truth.

coverage: percent of the intervals that contain the mean spacing; half: median half-width, percent. wrong: an interval of less than 10 % of the value, off
by more than twice that. The rms errors (percent) are those of slipfit, the peak of the autocorrelation, the peak of the spectrum and RSm on the profiles
that slipfit answers, form taken off; the other methods always answer. Controls: those that get a spacing, and one with an interval of less than 10 %.
Marks of machining are patterns with a true spacing, and listed apart. The chart shows error over time. Needs numpy."""
import collections
import pathlib
import sys
import time

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from draw import draw_points  # noqa: E402
from study import Row, cost, in_parallel, is_answer, parser, print_table, read_truths, run, total  # noqa: E402


def spacing_um(document):
    """Value and both ends of the interval; None where there is no spacing."""
    spacing = document["spacing_m"] if is_answer(document) else {"value": None}
    return None if spacing["value"] is None else tuple(1e6 * number for number in (spacing["value"], *spacing["ci95"]))


def is_narrow(found):
    value, low, high = found
    return (high - low) / 2 < 0.1 * value


def control_row(found):
    return Row(n=1, **{"any spacing": int(found is not None), "below 10 %": int(found is not None and is_narrow(found))})


CONTROLS = {"n": total, "any spacing": total, "below 10 %": total}
EDGES = {"scatter": (0, 0.001, 0.1, 0.2, 0.3, 0.41), "roughness": (0, 0.001, 0.2, 0.4, 0.6, 0.81), "count": (5, 8, 15, 40, 100, 201),
         "per_ridge": (10, 20, 40, 80, 201)}


def without_form(z):
    t = np.linspace(-1, 1, len(z))
    return z - np.polyval(np.polyfit(t, z, 2), t)


def by_autocorrelation(z):
    """First maximum behind the first passage through zero, the highest of those above half of it."""
    f = np.fft.rfft(z - z.mean(), 2 * len(z))
    a = np.fft.irfft(np.abs(f) ** 2)[: len(z) // 2]
    below = np.flatnonzero(a < 0)
    if len(below) == 0:
        return np.nan
    return float(below[0] + np.argmax(a[below[0]:]))


def by_spectrum(z):
    power = np.abs(np.fft.rfft((z - z.mean()) * np.hanning(len(z)), 8 * len(z))) ** 2
    first = 8 * 4  # at least four ridges
    return 8 * len(z) / (first + np.argmax(power[first:]))


METHODS = {"autocorrelation": by_autocorrelation, "spectrum": by_spectrum}


def pattern_row(truth, document, file, taken):
    """`taken`: the processor times of the other methods, which this adds to."""
    true, found = truth["spacing_um"], spacing_um(document)
    row = Row(n=1, answered=int(found is not None))
    data = np.loadtxt(file, delimiter=",", skiprows=1)
    pitch, z = (data[-1, 0] - data[0, 0]) / (len(data) - 1), without_form(data[:, 1])
    for name, method in METHODS.items():
        began = time.process_time()
        row.add(name, pitch * method(z) / true - 1)
        taken[name].append(time.process_time() - began)
    if found is None:
        return Row(n=1, answered=0)
    value, low, high = found
    row.add("coverage", int(low <= true <= high))
    row.add("wrong", int(is_narrow(found) and abs(value - true) > high - low))
    row.add("half", (high - low) / 2 / value)
    row.add("rms", value / true - 1)
    row.add("RSm", document["rsm_m"] * 1e6 / true - 1 if document["rsm_m"] else None)
    return row


def rms(errors):
    errors = np.array([e for e in errors if np.isfinite(e)])
    return float(np.sqrt(np.mean(np.clip(errors, -1, 1) ** 2))) if len(errors) else np.nan


def percent(how):
    return lambda values: f"{100 * how(values):.1f}" if values else "nan"


PATTERNS = {"n": total, "answered": total, "coverage": percent(np.mean), "wrong": total, "half": percent(np.median),
            **dict.fromkeys(("rms", "autocorrelation", "spectrum", "RSm"), percent(rms))}


def grouped(cases):
    """Rows by scatter, roughness, number of ridges, samples in a ridge, and shape."""
    groups = {"with scatter": [row for truth, row in cases if truth["scatter"] > 0.001]}
    for key, edges in EDGES.items():
        for low, high in zip(edges, edges[1:]):
            groups[f"{key} {low:g}-{high:g}"] = [row for truth, row in cases if low <= truth[key] < high]
    for shape in sorted({truth["family"] for truth, _ in cases}):
        groups[shape] = [row for truth, row in cases if truth["family"] == shape]
    return groups


def machined_row(true, document):
    found = spacing_um(document)
    if found is None:
        return Row(n=1, answered=0)
    codes = [warning["code"] for warning in document.get("warnings", [])]
    return Row(n=1, answered=1, inside=int(found[1] <= true <= found[2]), **{"within 2 %": int(abs(found[0] / true - 1) < 0.02),
                                                                            "warned of machining": int("origin_not_known" in codes)})


def main():
    words = parser(__doc__)
    words.add_argument("program")
    words.add_argument("profiles", type=pathlib.Path)
    words.add_argument("--jobs", type=int, default=2)
    words.add_argument("--chart")
    given = words.parse_args()
    truths = read_truths(given.profiles)
    cases, taken, controls, machined = [], collections.defaultdict(list), collections.defaultdict(list), collections.defaultdict(list)
    for truth, found in zip(truths, in_parallel(given.jobs, lambda t: run(given.program, "surface", given.profiles / t["file"]), truths)):
        if truth["kind"] == "machined":
            machined[truth["family"]].append(machined_row(truth["spacing_um"], found))
        elif truth["kind"] == "control":
            controls[truth["family"]].append(control_row(spacing_um(found)))
        else:
            cases.append((truth, pattern_row(truth, found, given.profiles / truth["file"], taken)))
    rows = [row for _, row in cases]
    print_table(PATTERNS, {"all": rows, **grouped(cases)}, "profiles", whole=None)
    print()
    print_table(CONTROLS, dict(sorted(controls.items())), "controls")
    print()
    print_table({"n": total, "answered": total, "inside": total, "within 2 %": total, "warned of machining": total}, dict(sorted(machined.items())),
                "machined", whole=None)
    program_s = float(np.mean([cost(given.program, "surface", given.profiles / truth["file"], "--json").cpu_s for truth in truths[:100]]))
    times_s = {name: float(np.median(seconds)) for name, seconds in taken.items()}
    print(f"\nprocessor time of a profile: the whole program {1e3 * program_s:.1f} ms; without reading, by numpy: "
          + ", ".join(f"{name} {1e3 * seconds:.2f} ms" for name, seconds in times_s.items()))
    if given.chart:
        errors = {name: rms([value for row in rows for value in row[name]]) for name in ("rms", *METHODS, "RSm")}
        draw_points(given.chart, "CPU time for a profile [ms]", "rms error of the spacing where slipfit answers [%]",
                    {"slipfit (with interval, program and reading)": (1e3 * program_s, 100 * errors["rms"]),
                     **{name: (1e3 * seconds, 100 * errors[name]) for name, seconds in times_s.items()},
                     "RSm (in slipfit)": (1e3 * program_s, 100 * errors["RSm"])})


if __name__ == "__main__":
    main()
