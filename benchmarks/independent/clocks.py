#!/usr/bin/env python3
"""clocks.py SLIPFIT [--count 30] [--seed 1]: how often the 95 % interval of k contains the truth where a recording with
interference of the mains has lost a sample, or its clock is uneven or rounded. 10 001 samples at 5 kHz, about 50 slips;
simulated by simulator.cpp. A row of the table for each clock, a column for each amplitude of the interference, in N (the
noise is 0.015 N rms, the friction drop 1 N)."""
import argparse
import json
import pathlib
import subprocess
import tempfile

import numpy as np

from simulator import Model, simulate

RATE_HZ = 5000
SAMPLES = 10001
FINER = 10  # steps of the simulation in a sample: between them the force is taken from a straight line
AMPLITUDES = (0.0, 0.05, 0.02, 0.008, 0.004)


def draw(rng):
    """A trace in fine steps without noise, with its stiffness and speed."""
    k, omega, speed = 5000 * np.exp(rng.uniform(-0.3, 0.3)), 900 * np.exp(rng.uniform(-0.2, 0.2)), 0.01
    count = SAMPLES * FINER
    factors = np.maximum(0.5, 1 + 0.02 * rng.standard_normal(400))
    columns = [np.full(count, value) for value in (speed, 4.0, 3.0)]
    model = Model(stiffness=k, omega=omega, damping_ratio=rng.uniform(0.02, 0.1))
    motion = simulate(model, 1 / (RATE_HZ * FINER), *columns, factors, rng.uniform(2.3, 3.8))
    return k, speed, motion


def clocks(rng, even_s):
    """Times at which samples are taken, times that are written, and rows that are lost, by name."""
    step = 1 / RATE_HZ
    lost = int(rng.integers(1, SAMPLES - 1))
    jitter = {share: np.sort(np.clip(even_s + share * step * rng.standard_normal(SAMPLES), 0, even_s[-1])) for share in (0.05, 0.2)}
    written = lambda times: [f"{t:.9f}" for t in times]
    without = lambda rows: [row for i, row in enumerate(rows) if i != lost]
    whole = lambda rows: rows
    nan = lambda rows: [row.split(",")[0] + ",nan" if i == lost else row for i, row in enumerate(rows)]
    thousandth = lambda rows: [row for row, kept in zip(rows, rng.uniform(size=len(rows)) > 0.001) if kept]
    return {
        "even": (even_s, written(even_s), whole),
        "one sample lost": (even_s, written(even_s), without),
        "one sample nan": (even_s, written(even_s), nan),
        "0.1 % of the samples lost": (even_s, written(even_s), thousandth),
        "sampled unevenly, 5 % of a step": (jitter[0.05], written(jitter[0.05]), whole),
        "sampled unevenly, 20 % of a step": (jitter[0.2], written(jitter[0.2]), whole),
        "stamps off by 20 % of a step": (even_s, written(jitter[0.2]), whole),
        "stamps rounded to ms": (even_s, [f"{t:.3f}" for t in even_s], whole),
        "stamps rounded to ms, one sample lost": (even_s, [f"{t:.3f}" for t in even_s], without),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("slipfit")
    parser.add_argument("--count", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    holds, errors = {}, {}
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        rows, truth = ["id,file,speed_m_per_s"], {}
        for index in range(arguments.count):
            for column, amplitude in enumerate(AMPLITUDES):
                rng = np.random.default_rng([arguments.seed, index, column])
                k, speed, motion = draw(rng)
                even_s = np.arange(SAMPLES) / RATE_HZ
                mains_Hz = rng.choice((50, 60)) * (1 + 2e-4 * rng.standard_normal())
                phase, noise = rng.uniform(0, 2 * np.pi), 0.015 * rng.standard_normal(SAMPLES)
                for name, (taken_s, stamps, keep) in clocks(rng, even_s).items():
                    force = np.interp(taken_s, motion.time_s, motion.force) + noise
                    force += amplitude * np.sin(2 * np.pi * mains_Hz * taken_s + phase)
                    lines = keep([f"{stamp},{value:.6f}" for stamp, value in zip(stamps, force)])
                    key = f"{name.replace(' ', '_').replace('%', 'percent').replace(',', '')}.{column}.{index}"
                    (folder / f"{key}.csv").write_text("time_s,force_N\n" + "\n".join(lines) + "\n")
                    rows.append(f"{key},{key}.csv,{speed}")
                    truth[key] = (name, amplitude, k)
        (folder / "manifest.csv").write_text("\n".join(rows) + "\n")
        command = [arguments.slipfit, "batch", folder / "manifest.csv", "--out", folder / "out", "--quiet"]
        subprocess.run(command, check=False)
        for line in (folder / "out" / "results.jsonl").read_text().splitlines():
            document = json.loads(line)
            name, amplitude, k = truth[document["id"]]
            stiffness = document.get("parameters", {}).get("stiffness_N_per_m")
            ci95 = stiffness and stiffness["ci95"]
            inside = bool(ci95) and ci95[0] <= k <= ci95[1]
            holds[name, amplitude] = holds.get((name, amplitude), 0) + inside
            if ci95:
                errors.setdefault((name, amplitude), []).append(abs(stiffness["value"] / k - 1))
    print(f"k inside its 95 % interval, of {arguments.count} (median error in %)")
    print("| clock | " + " | ".join(f"{a} N" for a in AMPLITUDES) + " |")
    print("|---" * (len(AMPLITUDES) + 1) + "|")
    for name in dict.fromkeys(name for name, _ in holds):
        cells = [f"{holds[name, a]} ({100 * np.median(errors.get((name, a), [np.nan])):.2f})" for a in AMPLITUDES]
        print(f"| {name} | " + " | ".join(cells) + " |")


main()
