#!/usr/bin/env python3
"""Truth against estimate for simulated recordings: one row a parameter, with z and whether the interval holds it.

    truth_table.py SLIPFIT DIR [--misses]

DIR holds manifest.csv (what an analyst knows) and truth.csv (what was put in). F_s - F_k is compared with the
population's, spacing with the mean over the cycles that occurred. The recordings of a speed sweep are fitted one by one: one speed does
not distinguish friction that depends on it, and no `identified` F_s - F_k or damping ratio of theirs may miss (exit code 1).
"""
import argparse
import collections
import csv
import json
import pathlib
import subprocess
import sys


def number(row, name):
    return float(row[name]) if row.get(name) else None


def truth_of(row):
    k, mass = number(row, "k"), number(row, "m")
    if k is None:
        return {}
    sweep = number(row, "alpha") is not None
    friction = number(row, "f0") + number(row, "f1") if sweep else number(row, "Fk")
    return {
        "stiffness_N_per_m": k,
        "friction_difference_N": number(row, "Fs") - friction,
        "natural_frequency_rad_per_s": number(row, "wn") or (k / mass) ** 0.5,
        "damping_ratio": number(row, "zeta"),
        "periodic_displacement_m": number(row, "dx_population"),
        "pattern_spacing_m": number(row, "dx"),
    }


def fit(slipfit, folder, row):
    command = [slipfit, "fit", str(folder / row["file"]), "--speed", row["speed_m_per_s"], "--json"]
    if row.get("force_view"):
        command += ["--force-view", row["force_view"]]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    return json.loads(run.stdout) if run.returncode == 0 else None


def right_verdict(row, status):
    if row["steady"] == "1" or row["family"] in ("ringdown", "steady"):
        return status in ("steady_sliding", "oscillatory_slip", "undetermined")
    return status == "stick_slip"


def rows_of(truth, document):
    found = {**document.get("parameters", {}), **document.get("derived", {})}
    for name, true_value in truth_of(truth).items():
        estimate = found.get(name)
        if true_value is None or not estimate or estimate.get("ci95") is None:
            continue
        low, high = estimate["ci95"]
        value, se = estimate["value"], estimate.get("se")
        z = (value - true_value) / se if value is not None and se else None
        yield name, true_value, value, se, z, low <= true_value <= high, estimate.get("status", "")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("slipfit")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--misses", action="store_true", help="only what misses, and the counts")
    arguments = parser.parse_args()
    truths = {row["id"]: row for row in csv.DictReader(open(arguments.folder / "truth.csv", encoding="utf-8"))}
    tally, of_sweeps = {}, collections.Counter()
    right = total = 0
    print(f"{'id':14} {'quantity':28} {'truth':>12} {'estimate':>12} {'se':>9} {'z':>6}  inside status")
    for row in csv.DictReader(open(arguments.folder / "manifest.csv", encoding="utf-8")):
        truth = truths[row["id"]]
        document = fit(arguments.slipfit, arguments.folder, row)
        status = document["status"] if document else "refused"
        total += 1
        right += right_verdict(truth, status)
        codes = ",".join(sorted({warning["code"] for warning in document["warnings"]})) if document else ""
        if not arguments.misses or not right_verdict(truth, status):
            print(f"{row['id']:14} {truth['note'] or truth['family']}: {status} [{codes}]")
        if not document:
            continue
        for name, true_value, value, se, z, inside, grade in rows_of(truth, document):
            count = tally.setdefault(name, [0, 0, []])
            count[0] += inside
            count[1] += 1
            count[2] += [z] if z is not None else []
            if truth["family"] == "sweep" and name in ("friction_difference_N", "damping_ratio"):
                of_sweeps[name, grade, inside] += 1
            if arguments.misses and inside:
                continue
            texts = (f"{value:12.5g}" if value is not None else f"{'':12}", f"{se:9.2g}" if se else f"{'':9}",
                     f"{z:+6.2f}" if z is not None else f"{'':6}")
            print(f"{row['id']:14} {name:28} {true_value:12.5g} {' '.join(texts)}  {'yes' if inside else 'NO ':6} {grade}")
    print(f"\nverdicts right: {right} of {total}")
    for name, (inside, count, zs) in tally.items():
        mean = sum(zs) / len(zs) if zs else 0.0
        spread = (sum((z - mean) ** 2 for z in zs) / max(1, len(zs) - 1)) ** 0.5
        print(f"{name:28} inside {inside} of {count}   z mean {mean:+.2f} sd {spread:.2f}")
    for (name, grade, inside), count in sorted(of_sweeps.items()):
        print(f"one recording of a sweep: {name:24} {grade:12} {'holds' if inside else 'misses':7} {count}")
    sys.exit(any(grade == "identified" and not inside for _, grade, inside in of_sweeps))


if __name__ == "__main__":
    main()
