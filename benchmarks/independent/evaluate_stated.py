#!/usr/bin/env python3
"""Counts how often the audit contradicts a mass and a displacement column that are right, and others that are wrong.

    evaluate_stated.py SLIPFIT SCENES [--only plain,scatter10] [--jobs 2]

Of recordings that are fitted as stick-slip: the mass is k / w_n^2 of the truth times 1 and 1.5, the displacement moves at the driving
speed times 1, 1.03 and 1000 (with noise of 1 um, 0.1 % of the way at most). weak: of the contradicted, with no parameter of the pair identified.
"""
import collections
import json
import pathlib
import subprocess
import tempfile

import numpy as np

import command_line

CONCERNS = {"mass_and_stated_mass": ("mass_kg", "natural_frequency_rad_per_s"),
            "speed_and_displacement": ("stiffness_N_per_m", "mass_kg", "damping_coefficient_N_s_per_m")}


def fitted(program, file, truth, *options):
    command = [program, "fit", str(file), "--speed", f"{truth['speed_m_per_s']:.9g}m/s", "--json", *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    return json.loads(done.stdout) if done.returncode == 0 else {"status": "refused", "message": done.stderr}


def with_displacement(file, out, truth, factor):
    rows = np.loadtxt(file, delimiter=",", skiprows=1)
    way = factor * truth["speed_m_per_s"] * (rows[:, 0] - rows[0, 0])
    noise = min(1e-6, 1e-3 * way[-1]) * np.random.default_rng(1).standard_normal(len(way))
    table = np.column_stack([rows[:, 0], way + noise, rows[:, 1]])
    np.savetxt(out, table, fmt="%.12g", delimiter=",", header="time [s],displacement [m],force [N]", comments="")
    return out


def analysed(program, folder, truth):
    file, of = folder / truth["file"], truth["parameters"]
    documents = {}
    if of.get("stiffness_N_per_m") and of.get("natural_frequency_rad_per_s"):
        mass = of["stiffness_N_per_m"] / of["natural_frequency_rad_per_s"] ** 2
        for factor in (1.0, 1.5):
            documents["mass_and_stated_mass", factor] = fitted(program, file, truth, "--mass", f"{factor * mass:.9g}kg")
    with tempfile.TemporaryDirectory() as scratch:
        for factor in (1.0, 1.03, 1000.0):
            moved = with_displacement(file, pathlib.Path(scratch) / "moved.csv", truth, factor)
            documents["speed_and_displacement", factor] = fitted(program, moved, truth)
    return documents


def main():
    _, _, documents = command_line.evaluated(__doc__, analysed)
    counts = collections.defaultdict(collections.Counter)
    for recording in documents:
        for (name, factor), document in recording.items():
            row = counts[name, factor]
            row["refused"] += document["status"] == "refused"
            for pair in document.get("audit") or []:
                if pair["pair"] != name:
                    continue
                row["compared"] += 1
                row["contradicts"] += pair["contradicts"]
                statuses = [document["parameters"].get(concern, {}).get("status") for concern in CONCERNS[name]]
                row["weak"] += pair["contradicts"] and "identified" not in statuses
    print(f"{'pair':26} {'factor':>7} {'refused':>8} {'compared':>9} {'contradicts':>12} {'weak':>5}")
    for (name, factor), row in sorted(counts.items()):
        print(f"{name:26} {factor:>7g} {row['refused']:>8} {row['compared']:>9} {row['contradicts']:>12} {row['weak']:>5}")


if __name__ == "__main__":
    main()
