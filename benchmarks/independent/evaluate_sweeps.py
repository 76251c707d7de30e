#!/usr/bin/env python3
"""Fits the sweeps of make_sweeps.py, predicts at speeds that were not measured, and holds it against the truth: one row a family.

    evaluate_sweeps.py SLIPFIT SWEEPS [--misses] [--jobs 2]

bands: spacings at 2 and 4 times the fastest recording inside their 95 % interval, of those given with one; half: median half-width
(percent); none: rows with stick-slip that got no interval; wrong: off by more than twice a half-width below 25 %; silent: of those,
without any warning of the fit. V_c: inside its interval, of those with one; bracket: told as a bracket or a bound that holds, of
those told so. fit: sweeps that could be predicted from. warned: with any warning. named: warnings `recording_disagrees` that name
the wrong recording, of the sweeps that have one; alarm: that name one where none is wrong. se: median relative standard error of k
and half-width of F_s - F_k. k, w_n, zeta, dF, m: inside its interval, of the sweeps that call it identified or conditional; B, t_c (rate and cut-off of ageing): of all that give one. audit: pairs of the recordings' audits that contradict
themselves, of all.
"""
import collections
import json
import pathlib
import subprocess

import numpy as np

import command_line

NAMES = ("stiffness_N_per_m", "natural_frequency_rad_per_s", "damping_ratio", "friction_difference_N", "mass_kg")
AGEING = ("ageing_N", "ageing_time_s")


def run(command):
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    return (json.loads(done.stdout), "") if done.returncode == 0 else (None, done.stderr.strip())


def analysed(program, folder, truth):
    fit_file = folder / truth["id"] / f"fit-{pathlib.Path(program).name}.json"
    fit, error = run([program, "fit", "--joint", str(folder / truth["id"] / "manifest.csv"), "--json", "--quiet"])
    if fit is None:
        return {"error": error}
    fit_file.write_text(json.dumps(fit))
    speeds = ",".join(f"{row['speed_m_per_s']:.9g}" for row in truth["rows"])
    load = ["--normal-force", str(truth["load_N"])] if truth["load_N"] else []
    prediction, error = run([program, "predict", str(fit_file), "--speeds", speeds, "--json", *load])
    return {"fit": fit, "prediction": prediction, "error": error}


def scored(result, truth):
    row = collections.Counter()
    fit = result.get("fit") or {}
    row["warned"] = int(bool(fit.get("warnings")))
    named = {w["message"].split("'")[1] for w in fit.get("warnings", []) if w["code"] == "recording_disagrees"}
    bad = truth["bad"]
    wrong = {f"run{b}" for b in (bad if isinstance(bad, list) else [bad])} if bad is not None else set()
    row["named"] = int(bool(named & wrong))
    row["alarm"] = int(bool(named - wrong))
    pairs = [pair for one in fit.get("recordings", []) for pair in one.get("audit", [])]
    row["pairs"], row["contradict"] = len(pairs), sum(pair["contradicts"] for pair in pairs)
    half = []
    prediction = result.get("prediction")
    row["fit"] = int(prediction is not None)
    for i, expected in enumerate(truth["rows"]):
        if not expected["spacing_m"] or not prediction:
            continue
        spacing = prediction["rows"][i]["periodic_displacement_m"]
        if not spacing["ci95"]:
            row["none"] += 1
            continue
        low, high = spacing["ci95"]
        row["given"] += 1
        row["covered"] += low <= expected["spacing_m"] <= high
        width = 0.5 * (high - low) / expected["spacing_m"]
        half.append(width)
        off = abs(spacing["value"] / expected["spacing_m"] - 1)
        if off > 2 * width and width < 0.25:
            row["wrong"] += 1
            row["silent"] += not fit.get("warnings")
    critical = (prediction or fit.get("derived") or {}).get("critical_speed_m_per_s") or {}
    true = truth["critical_speed_m_per_s"]
    observed = (fit.get("derived") or {}).get("observed_end_m_per_s") or [None, None]
    if critical.get("value") is not None and critical.get("ci95") and not str(critical.get("note", "")).startswith("by the runs"):
        row["critical_given"] = 1
        row["critical_covered"] = int(true is not None and critical["ci95"][0] <= true <= critical["ci95"][1])
    elif observed[0]:
        row["bound_given"] = 1
        row["bound_holds"] = int((true is None or observed[0] <= 1.01 * true) and
                                 (not observed[1] or (true is not None and true <= 1.01 * observed[1])))
    parameters = fit.get("parameters") or {}
    for name, true in truth["parameters"].items():
        p = parameters.get(name) or {}
        if p.get("status") in ("identified", "conditional") or (name in AGEING and p.get("ci95")):
            row["identified " + name] = 1
            least, most = true if isinstance(true, list) else (true, true)
            row["held " + name] = int(p["ci95"][0] <= most and least <= p["ci95"][1])
    errors = {}
    for short, name in (("k", "stiffness_N_per_m"), ("dF", "friction_difference_N")):
        p = parameters.get(name) or {}
        if p.get("value") and p.get("se") is not None:
            errors[short] = p["se"] / p["value"]
    return row, half, errors


def line(family, rows):
    total = collections.Counter()
    half = [h for _, hs, _ in rows for h in hs]
    for row, _, _ in rows:
        total.update(row)
    errors = {s: [e[s] for _, _, e in rows if s in e] for s in ("k", "dF")}
    median = lambda values, factor: f"{factor * np.median(values):.2g}" if values else "-"
    return (f"{family:16} {total['fit']:3d} {total['covered']:4d}/{total['given']:<4d} {median(half, 100):>6} {total['none']:4d} "
            f"{total['wrong']:5d} {total['silent']:6d} {total['critical_covered']:4d}/{total['critical_given']:<4d} "
            f"{total['bound_holds']:4d}/{total['bound_given']:<4d} {total['warned']:6d} {total['named']:5d} {total['alarm']:5d} "
            f"{median(errors['k'], 100):>7} {median(errors['dF'], 100):>7}" +
            "".join(f" {total['held ' + name]:3d}/{total['identified ' + name]:<3d}" for name in NAMES + AGEING) +
            f" {total['contradict']:3d}/{total['pairs']}")


def main():
    arguments, truths, results = command_line.evaluated(__doc__, analysed)
    families = collections.defaultdict(list)
    misses = []
    for truth, result in zip(truths, results):
        scores = scored(result, truth)
        families[truth["family"]].append(scores)
        row = scores[0]
        if row["wrong"] or row["alarm"] or (truth["bad"] is not None and not row["named"]) or not row["fit"]:
            codes = [w["code"] for w in (result.get("fit") or {}).get("warnings", [])]
            misses.append(f"  {truth['id']:22} wrong {row['wrong']} alarm {row['alarm']} named {row['named']} bad {truth['bad']} {codes} {result['error'][:160]}")
    print(f"{'family':16} fit   bands    half none wrong silent     V_c   bracket warned named alarm   se k %  se dF %    k      w_n    zeta    dF      m       B      t_c   audit")
    for family, rows in families.items():
        print(line(family, rows))
    print(line("all", [row for rows in families.values() for row in rows]))
    if arguments.misses:
        print("\n".join(misses))


if __name__ == "__main__":
    main()
