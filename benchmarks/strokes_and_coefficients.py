#!/usr/bin/env python3
"""strokes_and_coefficients.py SLIPFIT [--runs N]: recordings of a simulator that shares no code with slipfit (benchmarks/independent).

Reciprocating tests: what `fit --strokes` says against the truth. Runs that begin at rest, with a load: how often the intervals of
coefficients.static_first_peak and coefficients.static_mean_peak hold the F_s of the first slip and its mean. Needs numpy and gcc."""
import argparse
import collections
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent / "independent"))
import simulator  # noqa: E402


def draw(rng):
    """A slider with 8 to 12 slips in a stroke, well sampled."""
    k, omega, fk = rng.uniform(200, 2000), rng.uniform(60, 150), rng.uniform(0.5, 2.0)
    difference = rng.uniform(0.2, 0.6) * fk
    zeta = rng.uniform(0.03, 0.2)
    speed = difference / k * omega / rng.uniform(8, 20)
    return {"k": k, "omega": omega, "zeta": zeta, "fk": fk, "fs": fk + difference, "speed": speed,
            "duration_s": 20 * 2 * difference / (k * speed), "rate_Hz": omega * 6, "noise": 0.01 * difference, "scatter": 0.04}


def one_way(p, rng, start_force, factors):
    samples = int(p["duration_s"] * p["rate_Hz"])
    model = simulator.Model(stiffness=p["k"], omega=p["omega"], damping_ratio=p["zeta"])
    full = np.full(samples, 1.0)
    return simulator.simulate(model, 1 / p["rate_Hz"], p["speed"] * full, p["fs"] * full, p["fk"] * full, factors, start_force).force


def factors_of(p, rng):
    return 1 + p["scatter"] * rng.standard_normal(200)


def write(path, force, p):
    simulator.write_csv(path, np.arange(len(force)) / p["rate_Hz"], force)


def fit(program, path, p, *options):
    done = subprocess.run([program, "fit", str(path), "--speed", repr(p["speed"]), "--json", "--quiet", *options], capture_output=True, text=True)
    return json.loads(done.stdout) if done.returncode == 0 else {"status": done.stderr.strip()}


def note(counts, name, estimate, truth):
    if not estimate or not estimate.get("ci95"):
        counts[name, "unknown"] += 1
        return
    low, high = estimate["ci95"]
    counts[name, "held" if low <= truth <= high else "missed"] += 1


def strokes(program, folder, rng, counts):
    p = draw(rng)
    force, end = [], 0.0
    for side in (1, -1) * 3:
        # The spring is loaded the other way from where the stroke before left it; the first begins at rest.
        one = one_way(p, rng, -end, factors_of(p, rng))
        end = one[-1]
        force.append(side * one)
    force = np.concatenate(force)
    path = folder / "strokes.csv"
    write(path, force + p["noise"] * rng.standard_normal(len(force)), p)
    document = fit(program, path, p, "--strokes", "--zero", "0")
    counts["joint fit of strokes", document["status"][:60]] += 1
    parameters = document.get("parameters", {})
    for name, truth in (("stiffness_N_per_m", p["k"]), ("natural_frequency_rad_per_s", p["omega"]), ("damping_ratio", p["zeta"]),
                        ("kinetic_friction_N", p["fk"]), ("friction_difference_N", p["fs"] - p["fk"])):
        note(counts, "strokes: " + name, parameters.get(name), truth)


def from_rest(program, folder, rng, counts):
    p = draw(rng)
    factors = factors_of(p, rng)
    force = one_way(p, rng, 0.0, factors)
    path = folder / "rest.csv"
    write(path, force + p["noise"] * rng.standard_normal(len(force)), p)
    load = 2.0 * p["fs"]
    coefficients = fit(program, path, p, "--normal-force", repr(load), "--zero", "0").get("coefficients") or {}
    first = p["fk"] + factors[0] * (p["fs"] - p["fk"])
    # The spring shows F_s less the viscous force of the frame at the driving speed, 2 zeta k V / omega.
    shown = first - 2 * p["zeta"] * p["k"] * p["speed"] / p["omega"]
    note(counts, "static_first_peak", coefficients.get("static_first_peak"), shown / load)
    note(counts, "static_mean_peak", coefficients.get("static_mean_peak"), p["fs"] / load)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=100)
    arguments = parser.parse_args()
    counts = collections.Counter()
    rng = np.random.default_rng(20)
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(arguments.runs):
            strokes(str(arguments.program.resolve()), pathlib.Path(folder), rng, counts)
            from_rest(str(arguments.program.resolve()), pathlib.Path(folder), rng, counts)
    names = dict.fromkeys(name for name, _ in counts)
    print("| quantity | held | missed | unknown |\n|---|---|---|---|")
    for name in names:
        if name == "joint fit of strokes":
            continue
        print(f"| {name} | {counts[name, 'held']} | {counts[name, 'missed']} | {counts[name, 'unknown']} |")
    print("\njoint fit of strokes:", {what: n for (name, what), n in counts.items() if name == "joint fit of strokes"})


main()
