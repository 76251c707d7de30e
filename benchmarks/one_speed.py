#!/usr/bin/env python3
"""one_speed.py SLIPFIT [FOLDER]: the recordings of the speed sweeps in FOLDER (../shared/data/synthetic), each fitted alone: how many
F_s - F_k and damping ratios are called `identified`, and how many of these miss the truth. One speed cannot tell friction that depends
on it: none may."""
import collections
import csv
import json
import pathlib
import subprocess
import sys


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "../shared/data/synthetic")
    with open(folder / "manifest.csv") as file:
        manifest = {row["id"]: row for row in csv.DictReader(file)}
    with open(folder / "truth.csv") as file:
        truths = [row for row in csv.DictReader(file) if row["family"] == "sweep"]
    counts = collections.Counter()
    missed = collections.Counter()
    for truth in truths:
        row = manifest[truth["id"]]
        done = subprocess.run([program, "fit", str(folder / row["file"]), "--speed", row["speed_m_per_s"], "--json", "--quiet"],
                              capture_output=True, text=True)
        parameters = json.loads(done.stdout).get("parameters", {}) if done.returncode == 0 else {}
        for name, true in (("friction_difference_N", difference(truth)), ("damping_ratio", number(truth, "zeta", "damping_ratio"))):
            parameter = parameters.get(name)
            status = parameter["status"] if parameter else "absent"
            counts[name, status] += 1
            interval = parameter["ci95"] if parameter else None
            if interval and true is not None and not interval[0] <= true <= interval[1]:
                missed[name, status] += 1
    print(f"{len(truths)} recordings\n\n| parameter | status | recordings | interval misses the truth |\n|---|---|---|---|")
    for (name, status), count in sorted(counts.items()):
        print(f"| `{name}` | {status} | {count} | {missed[name, status]} |")
    sys.exit(any(status == "identified" for _, status in missed))


def number(row, *names):
    return next((float(row[n]) for n in names if row.get(n)), None)


def difference(row):
    direct = number(row, "dF", "friction_difference_N")
    if direct is not None:
        return direct
    static, f0, f1 = number(row, "Fs", "static_friction_N"), number(row, "f0", "f0_N"), number(row, "f1", "f1_N")
    return static - f0 - f1 if None not in (static, f0, f1) else None


main()
