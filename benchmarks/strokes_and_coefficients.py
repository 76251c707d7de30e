#!/usr/bin/env python3
"""strokes_and_coefficients.py SLIPFIT [--runs N] [--seed S] [--slips N] [--only STUDY]: recordings of a simulator that shares no code with
slipfit (benchmarks/independent).

strokes: reciprocating tests, what `fit --strokes` says against the truth; --slips in a stroke. rest: runs that begin at rest, with a load: how
often the intervals of coefficients.static_first_peak and coefficients.static_mean_peak hold the F_s of the first slip and its mean. segments:
five speeds one after another, as one file (`fit --segments`) and as five (`fit --joint`). Needs numpy and g++."""
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


def draw(rng, slips=20):
    """A slider with about `slips` slips in a stroke, well sampled."""
    k, omega, fk = rng.uniform(200, 2000), rng.uniform(60, 150), rng.uniform(0.5, 2.0)
    difference = rng.uniform(0.2, 0.6) * fk
    zeta = rng.uniform(0.03, 0.2)
    speed = difference / k * omega / rng.uniform(8, 20)
    return {"k": k, "omega": omega, "zeta": zeta, "fk": fk, "fs": fk + difference, "speed": speed,
            "duration_s": slips * 2 * difference / (k * speed), "rate_Hz": omega * 6, "noise": 0.01 * difference, "scatter": 0.04}


def one_way(p, rng, start_force, factors):
    samples = int(p["duration_s"] * p["rate_Hz"])
    model = simulator.Model(stiffness=p["k"], omega=p["omega"], damping_ratio=p["zeta"])
    full = np.full(samples, 1.0)
    return simulator.simulate(model, 1 / p["rate_Hz"], p["speed"] * full, p["fs"] * full, p["fk"] * full, factors, start_force).force


def factors_of(p, rng):
    return 1 + p["scatter"] * rng.standard_normal(200)


def write(path, force, p):
    simulator.write_csv(path, np.arange(len(force)) / p["rate_Hz"], force)


def document_of(program, *words):
    done = subprocess.run([program, "fit", *map(str, words), "--json", "--quiet"], capture_output=True, text=True)
    return json.loads(done.stdout) if done.returncode == 0 else {"status": done.stderr.strip()}


def fit(program, path, p, *options):
    return document_of(program, path, "--speed", repr(p["speed"]), *options)


def note(counts, name, estimate, truth):
    if not estimate or not estimate.get("ci95"):
        counts[name, "unknown"] += 1
        return
    low, high = estimate["ci95"]
    counts[name, "held" if low <= truth <= high else "missed"] += 1


def strokes(program, folder, rng, counts, slips):
    p = draw(rng, slips)
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


def from_rest(program, folder, rng, counts, _slips):
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


def sweep(p, rng):
    """Force and speed over time at five speeds one after another; F_k(v) = F_k + f1 (exp(alpha v) - 1), which slips see."""
    scale = (p["fs"] - p["fk"]) / p["k"] * p["omega"]
    f1, alpha = rng.uniform(0.2, 0.5) * (p["fs"] - p["fk"]), -1 / (rng.uniform(0.15, 0.4) * scale)
    speeds = scale / np.geomspace(20, 4, 5)
    samples = [int(20 * 2 * (p["fs"] - p["fk"]) / (p["k"] * v) * p["rate_Hz"]) for v in speeds]
    speed = np.repeat(speeds, samples)
    model = simulator.Model(stiffness=p["k"], omega=p["omega"], damping_ratio=p["zeta"], stribeck_force=f1, stribeck_speed=-1 / alpha)
    full = np.ones(len(speed))
    force = simulator.simulate(model, 1 / p["rate_Hz"], speed, p["fs"] * full, (p["fk"] - f1) * full, 1 + p["scatter"] * rng.standard_normal(1000)).force
    return force + p["noise"] * rng.standard_normal(len(force)), speed, np.split(np.arange(len(speed)), np.cumsum(samples)[:-1]), alpha


def write_sweep(folder, force, speed, parts, p):
    """One file with a column of speeds, and a manifest of one file for each speed."""
    time = np.arange(len(force)) / p["rate_Hz"]
    table = lambda rows: "".join(f"{t!r},{f!r},{v!r}\n" for t, f, v in zip(time[rows].tolist(), force[rows].tolist(), speed[rows].tolist()))
    header = "time [s],force [N],speed [m/s]\n"
    (folder / "sweep.csv").write_text(header + table(slice(None)))
    lines = ["id,file,speed_m_per_s,zero_force_N\n"]
    for i, rows in enumerate(parts):
        (folder / f"part{i}.csv").write_text(header + table(rows))
        lines.append(f"{i},part{i}.csv,,0\n")
    (folder / "parts.csv").write_text("".join(lines))


def segments(program, folder, rng, counts, _slips):
    p = draw(rng)
    force, speed, parts, alpha = sweep(p, rng)
    write_sweep(folder, force, speed, parts, p)
    one = document_of(program, folder / "sweep.csv", "--segments", "--zero", "0")
    many = document_of(program, "--joint", folder / "parts.csv")
    for name, truth in (("stiffness_N_per_m", p["k"]), ("natural_frequency_rad_per_s", p["omega"]), ("damping_ratio", p["zeta"]),
                        ("kinetic_friction_N", p["fk"]), ("friction_difference_N", p["fs"] - p["fk"]), ("alpha_s_per_m", alpha)):
        a, b = (document.get("parameters", {}).get(name) or {} for document in (one, many))
        note(counts, "one file: " + name, a, truth)
        note(counts, "five files: " + name, b, truth)
        if a.get("se") and b.get("se"):
            agree = abs(a["value"] - b["value"]) <= 0.1 * b["se"]
            counts["the same within 0.1 standard errors: " + name, "held" if agree else "missed"] += 1


STUDIES = {"strokes": strokes, "rest": from_rest, "segments": segments}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--seed", type=int, default=20)
    parser.add_argument("--slips", type=float, default=20)
    parser.add_argument("--only", choices=STUDIES)
    arguments = parser.parse_args()
    counts = collections.Counter()
    rng = np.random.default_rng(arguments.seed)
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(arguments.runs):
            for name in [arguments.only] if arguments.only else STUDIES:
                STUDIES[name](str(arguments.program.resolve()), pathlib.Path(folder), rng, counts, arguments.slips)
    names = dict.fromkeys(name for name, _ in counts)
    print("| quantity | held | missed | unknown |\n|---|---|---|---|")
    for name in names:
        if name == "joint fit of strokes":
            continue
        print(f"| {name} | {counts[name, 'held']} | {counts[name, 'missed']} | {counts[name, 'unknown']} |")
    print("\njoint fit of strokes:", {what: n for (name, what), n in counts.items() if name == "joint fit of strokes"})


main()
