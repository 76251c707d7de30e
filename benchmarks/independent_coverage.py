#!/usr/bin/env python3
"""Intervals against a simulator that shares no code with slipfit: the motion by an integrator with event location.

    independent_coverage.py SLIPFIT TRUTH.csv --ids clean-02,jitter-04 [--count 100] [--seed 1]

For each named row of TRUTH.csv (k, wn, zeta, Fs, Fk, V, sample rate, number of slips) draws `count` recordings with new noise and
phase and prints mean and spread of z = (estimate - truth) / se, and how often the interval holds the truth. Needs numpy and scipy.
"""
import argparse
import csv
import json
import os
import subprocess
import tempfile

import numpy as np
from scipy.integrate import solve_ivp

NAMES = {"stiffness_N_per_m": "k", "natural_frequency_rad_per_s": "wn", "damping_ratio": "zeta"}


def slip(model, static_force):
    """Dense slip from stick at the speed of the drive: spring force above F_k over time, and when it sticks again."""
    k, omega, zeta, speed = model["k"], model["wn"], model["zeta"], model["V"]
    onset = static_force - model["Fk"] - 2 * zeta * k / omega * speed

    def motion(_, state):  # spring stretch above F_k / k, sliding speed of the slider
        stretch, velocity = state
        return [speed - velocity, omega**2 * stretch + 2 * zeta * omega * (speed - velocity)]

    def rest(_, state):
        return state[1]

    rest.terminal, rest.direction = True, -1
    begin = 1e-9 / omega  # just after the onset, so that v = 0 there is not the event
    start = [onset / k, 1e-9 * omega * (static_force - model["Fk"]) / k]
    result = solve_ivp(motion, (begin, 20 / omega), start, "DOP853", events=rest, rtol=1e-11, atol=1e-15, dense_output=True)
    end = result.t_events[0][0]
    return onset, end, k * result.sol(end)[0], lambda t: k * result.sol(np.maximum(t, begin))[0]


def recording(model, rng):
    rate = model["k"] * model["V"]
    count = int(model["n_slips"]) + 2
    forces = model["Fs"] * np.ones(count) + model["scatter"] * rng.standard_normal(count)
    step = 1 / model["sample_rate_hz"]
    pieces, time = [], rng.random() * step
    if model["scatter"] == 0:
        one = slip(model, model["Fs"])
    previous = None
    for force in forces:
        onset, end, left, wave = slip(model, force) if model["scatter"] else one
        level = previous if previous is not None else left  # the first ramp starts where a slip would have ended
        stick = (onset - level) / rate
        first = np.arange(np.ceil(time / step), np.ceil((time + stick) / step)) * step
        pieces.append((first, level + rate * (first - time)))
        time += stick
        second = np.arange(np.ceil(time / step), np.ceil((time + end) / step)) * step
        pieces.append((second, wave(second - time)))
        time += end
        previous = left
    times, values = (np.concatenate(part) for part in zip(*pieces))
    return times, values + model["Fk"] + model["noise"] * rng.standard_normal(len(values))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("slipfit")
    parser.add_argument("truth")
    parser.add_argument("--ids", required=True)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--noise", type=float, default=0.01, help="over F_s - F_k")
    arguments = parser.parse_args()
    rng = np.random.default_rng(arguments.seed)
    rows = {row["id"]: row for row in csv.DictReader(open(arguments.truth, encoding="utf-8"))}
    print(f"{'id':12} {'quantity':28} {'n':>4} {'z mean':>7} {'z sd':>6} {'inside %':>8}")
    for name in arguments.ids.split(","):
        row = rows[name]
        model = {key: float(row[key]) for key in ("k", "wn", "zeta", "Fs", "Fk", "V", "sample_rate_hz", "n_slips")}
        model["noise"] = arguments.noise * (model["Fs"] - model["Fk"])
        model["scatter"] = 0.03 * (model["Fs"] - model["Fk"]) if row["family"] == "jitter" else 0.0
        tally = {key: [] for key in NAMES}
        for _ in range(arguments.count):
            with tempfile.NamedTemporaryFile("w", suffix=".csv", delete=False) as file:
                np.savetxt(file, np.column_stack(recording(model, rng)), delimiter=",", header="time_s,force_N", comments="",
                           fmt="%.12g")
            run = subprocess.run([arguments.slipfit, "fit", file.name, "--speed", row["V"], "--json"], capture_output=True,
                                 text=True, check=False)
            os.unlink(file.name)
            found = json.loads(run.stdout).get("parameters", {}) if run.returncode == 0 else {}
            for key, symbol in NAMES.items():
                estimate = found.get(key)
                if estimate and estimate["se"]:
                    low, high = estimate["ci95"]
                    tally[key].append(((estimate["value"] - model[symbol]) / estimate["se"], low <= model[symbol] <= high))
        for key, results in tally.items():
            if results:
                z = np.array([r[0] for r in results])
                inside = 100 * np.mean([r[1] for r in results])
                print(f"{name:12} {key:28} {len(z):4} {z.mean():+7.2f} {z.std(ddof=1):6.2f} {inside:8.1f}")


if __name__ == "__main__":
    main()
