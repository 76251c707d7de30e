#!/usr/bin/env python3
"""Fits the recordings of make_trends.py and holds intervals against the truth: one row a family.

    evaluate_trends.py SLIPFIT SCENES [--misses] [--jobs 2]

fits: recordings that are fitted as stick-slip. k, w_n, zeta: intervals that hold the truth, of those given; identified: of these,
how many are called so, and among them how many hold. off: median of |k / truth - 1|, percent; half: median half-width of k, percent.
F_s: intervals that reach a value that F_s had at the start, in the middle or at the end; identified. reading: how the trend was read.
"""
import collections
import json
import statistics
import subprocess

import command_line

NAMES = {"stiffness_N_per_m": "k", "natural_frequency_rad_per_s": "w_n", "damping_ratio": "zeta"}


def analysed(program, folder, truth):
    command = [program, "fit", str(folder / truth["file"]), "--speed", f"{truth['speed_m_per_s']:.9g}", "--zero", "0", "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    return json.loads(done.stdout) if done.returncode == 0 else {"status": done.stderr.strip()}


def scored(document, truth):
    row = {"fits": document["status"] == "stick_slip"}
    parameters = document.get("parameters") or {}
    for name, symbol in NAMES.items():
        estimate, true = parameters.get(name) or {}, truth["parameters"][name]
        if not estimate.get("ci95") or not estimate.get("value"):
            continue
        low, high = estimate["ci95"]
        row[symbol] = (low <= true <= high, estimate["status"] == "identified")
        if symbol == "k":
            row["off"], row["half"] = 100 * abs(estimate["value"] / true - 1), 50 * (high - low) / estimate["value"]
    static = parameters.get("static_friction_N") or {}
    if static.get("ci95"):
        low, high = static["ci95"]
        row["F_s"] = (any(low <= true <= high for true in truth["static_friction_N"]), static["status"] == "identified")
    row["reading"] = (document.get("level_trend") or {}).get("reading") or "-"
    return row


def line(family, rows):
    cells = [f"{family:14}", f"{sum(r['fits'] for r in rows):>3}/{len(rows)}"]
    for symbol in (*NAMES.values(), "F_s"):
        given = [r[symbol] for r in rows if symbol in r]
        named = [holds for holds, identified in given if identified]
        cells.append(f"{sum(h for h, _ in given):>4}/{len(given):<3} {sum(named):>3}/{len(named):<3}")
    for name in ("off", "half"):
        found = [r[name] for r in rows if name in r]
        cells.append(f"{statistics.median(found):6.2f}" if found else "     -")
    readings = collections.Counter(r["reading"] for r in rows)
    return " ".join(cells) + "  " + " ".join(f"{name}:{count}" for name, count in sorted(readings.items()))


def main():
    arguments, truths, documents = command_line.evaluated(__doc__, analysed)
    families, misses = collections.defaultdict(list), []
    for truth, document in zip(truths, documents):
        row = scored(document, truth)
        families[truth["family"]].append(row)
        wrong = [symbol for symbol in (*NAMES.values(), "F_s") if symbol in row and not row[symbol][0]]
        if wrong or not row["fits"]:
            misses.append(f"  {truth['id']:20} {document['status'][:60]:20} misses {wrong} reading {row['reading']}")
    print(f"{'family':14} {'fits':>6} " + " ".join(f"{s:>8} {'ident.':>7}" for s in (*NAMES.values(), "F_s")) + "    off   half  reading")
    for family, rows in families.items():
        print(line(family, rows))
    if arguments.misses:
        print("\n".join(misses))


if __name__ == "__main__":
    main()
