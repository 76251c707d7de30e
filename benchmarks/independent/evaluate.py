#!/usr/bin/env python3
"""Runs slipfit over the recordings or sweeps of make.py and compares its answers with the truth: one row a family.

    evaluate.py SLIPFIT FOLDER [--table audit] [--only plain,noisy] [--misses] [--jobs 2]

FOLDER may also hold manifest.csv and truth.csv, as ../shared/data/synthetic does. Shares are of the answers that have the number.

motion (default for recordings)
    verdict: right kinds of motion. f, x: frequency and spacing V / f, within 5 % of the truth, inside the interval, and absurd (off by a
    factor of 2 or more; any number where there is none). stretch: both ends within 1.5 periods, where part of the recording slides otherwise.
    k ... l: intervals that contain the truth, of those given; !!: confidently wrong, that is `identified` and off by more than the width of the
    interval (4 standard errors) and 2 %. extra: terms taken (average T_b, D_c, rise A, k that changes) that the scene does not have.
sweeps (default for sweeps)
    fit: sweeps that can be predicted from. bands: spacings at 2 and 4 times the fastest recording inside their interval; half: median
    half-width (percent); off: median of |spacing / truth - 1| (percent), with an interval or without; none: no interval; wrong: off by more than
    twice a half-width below 25 %; silent: of those, without a warning. V_c: inside its interval; bracket: bounds of V_c that hold. warned:
    with any warning. named, alarm: warnings `recording_disagrees` that name a recording that is wrong, and one that is not. se k, se dF:
    relative standard error, half-width (percent). k ... t_c: intervals that contain the truth, of the sweeps that call it identified or
    conditional (B, t_c: of all that give one). audit: pairs that contradict themselves.
trends
    fits: fitted as stick-slip. k, w_n, zeta: inside the interval; ident.: of these, identified. off: median of |k / truth - 1|, half: median
    half-width of k, percent. F_s: intervals that contain what F_s was at the start, in the middle or at the end. reading: of the trend.
audit
    A row a pair. wrong: the parameter (or the frequency) that the pair checks is off by more than 4 standard errors and 1 %; found: of the
    wrong ones, contradicted; alarms: of the others, contradicted.
stated
    The audit of a stated mass that is k / w_n^2 of the truth times 1 and 1.5, and of a displacement column that moves at the driving speed times
    1, 1.03 and 1000 (with noise of 1 um, 0.1 % of the way at most). weak: of the contradicted, with no parameter of the pair identified.
"""
import collections
import csv
import json
import pathlib
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from study import Row, counts, in_parallel, is_answer, median, parser, print_table, read_truths, run, share, total  # noqa: E402

SHORT = {"stiffness_N_per_m": "k", "friction_difference_N": "dF", "natural_frequency_rad_per_s": "w_n", "damping_ratio": "zeta",
         "mass_kg": "m", "sensor_average_s": "T_b", "slip_distance_m": "D_c", "reload_force_N": "A", "reload_length_m": "l", "stiffness_ratio": "k_e/k_s"}
ALSO = {"kinetic_friction_N": "F_k", "alpha_s_per_m": "alpha", "static_first_peak": "mu_first", "static_mean_peak": "mu_mean"}  # where known
TERMS = ("sensor_average_s", "slip_distance_m", "reload_force_N", "stiffness_ratio")
NO_SLIPS = {"oscillatory_slip", "undetermined", "steady_sliding"}
RIGHT = {"stick_slip": {"stick_slip"}, "reciprocating": {"stick_slip"}, "joint": {"stick_slip"}, "steady": {"steady_sliding"}, "wave": NO_SLIPS, "ringdown": NO_SLIPS}


def fit(program, file, truth, *options):
    speed = [] if truth["speed_m_per_s"] is None else ["--speed", f"{truth['speed_m_per_s']:.9g}"]
    return run(program, "fit", file, *speed, *options, timeout=120)


def inside(interval, low, high=None):
    """Whether an interval contains a number, or reaches into a range; None without an interval."""
    return None if not interval else int(interval[0] <= (low if high is None else high) and low <= interval[1])


# -- motion

def fit_motion(program, folder, truth):
    return fit(program, folder / truth["file"], truth, *truth.get("options", []))


def add_quoted(row, name, value, interval, true):
    """Within 5 %, inside the interval, absurd: for one quoted number."""
    if value is None:
        return
    row.add(name + " 5 %", int(bool(true) and abs(value / true - 1) <= 0.05))
    row.add(name + " in", inside(interval, true) if true else None)
    row.add(name + " abs", int(not true or not 0.5 < value / true < 2))


def is_stretch_found(document, truth):
    period = 1 / truth["frequency_Hz"] if truth["frequency_Hz"] else 0
    used = document.get("recording", {}).get("sliding_s")
    if not used or truth["kind"] != "stick_slip" or truth.get("any_stretch"):
        return None
    return int(all(abs(a - b) < 1.5 * period for a, b in zip(used, truth["stretch_s"])))


def add_parameter(row, symbol, estimate, expected, warned):
    """`expected`: the lowest and the highest value that are right."""
    low, high = estimate["ci95"]
    value = estimate["value"]
    off = 0.0 if value is None else max(expected[0] - value, value - expected[1], 0.0)
    identified = estimate.get("status") == "identified"
    row.add(symbol, inside((low, high), *expected))
    wrong = int(identified and off > max(high - low, 0.02 * expected[1]))
    for column, number in ((symbol + " !!", wrong), ("wrong", wrong), ("silent", int(wrong and not warned)),
                           (symbol + " far", int(identified and off > 0.05 * expected[1]))):
        row.add(column, number)


def score_motion(document, truth):
    row = Row(verdict=int(document["status"] in RIGHT[truth["kind"]]), stretch=is_stretch_found(document, truth))
    frequency = document.get("frequency") or {}
    spacing = (document.get("derived") or {}).get("pattern_spacing_m") or {}
    if truth["kind"] != "joint":
        add_quoted(row, "f", frequency.get("value_Hz"), frequency.get("ci95_Hz"), truth["frequency_Hz"])
        add_quoted(row, "x", spacing.get("value"), spacing.get("ci95"), truth["spacing_m"])
    row.add("extra", 0)
    estimates = {**(document.get("parameters") or {}), **(document.get("coefficients") or {})}
    for name, symbol in (SHORT | {name: symbol for name, symbol in ALSO.items() if name in truth["parameters"]}).items():
        estimate = estimates.get(name)
        if not estimate or not estimate.get("ci95"):
            continue
        expected = truth["parameters"].get(name)
        if truth["kind"] not in ("stick_slip", "reciprocating", "joint"):
            row.add(symbol + " !!", int(estimate["status"] == "identified"))
        elif expected is None:
            row.add("extra", int(name in TERMS))
        else:
            add_parameter(row, symbol, estimate, expected if isinstance(expected, list) else [expected, expected], bool(document["warnings"]))
    return row


def describe_motion(row, document, truth):
    wrong = [symbol for symbol in SHORT.values() if any(row[symbol + " !!"])]
    if row["verdict"] == [1] and not wrong and not any(row["f abs"] + row["x abs"]) and all(row["f 5 %"] + row["x 5 %"]):
        return None
    frequency = document.get("frequency") or {}
    quoted, true = frequency.get("value_Hz"), truth["frequency_Hz"]
    return (f"{document['status']:18} f {quoted and round(quoted, 4)} true {true and round(true, 4)} {frequency.get('method')} wrong {wrong} "
            f"{document.get('status_reason') or document.get('message', '')[:150]}")


def summarise_motion(rows):
    wrong, silent, far = ([value for row in rows for value in row[name]] for name in ("wrong", "silent", "m far"))
    print(f"of {len(wrong)} answers that the data determine, {sum(wrong)} confidently wrong, {sum(silent)} of them without a warning; "
          f"{sum(far)} of {len(far)} masses identified and off by more than 5 %")


MOTION = {"verdict": share, **{f"{name} {what}": total if what == "abs" else share for name in "fx" for what in ("5 %", "in", "abs")},
          "stretch": share, **{symbol + mark: total if mark else share for symbol in [*SHORT.values(), *ALSO.values()] for mark in ("", " !!")}, "extra": total}


# -- sweeps

OF_SWEEPS = {"stiffness_N_per_m": "k", "natural_frequency_rad_per_s": "w_n", "damping_ratio": "zeta", "friction_difference_N": "dF",
             "mass_kg": "m", "ageing_N": "B", "ageing_time_s": "t_c"}
SWEEPS = {"fit": total, "bands": share, "half": median, "off": median, "none": total, "wrong": total, "silent": total, "V_c": share, "bracket": share,
          "warned": total, "named": total, "alarm": total, "se k": median, "se dF": median, **dict.fromkeys(OF_SWEEPS.values(), share),
          "audit": share}


def fit_and_predict(program, folder, truth):
    fitted = run(program, "fit", "--joint", folder / truth["id"] / "manifest.csv", "--quiet")
    if not is_answer(fitted):
        return {"error": fitted.get("message", "")}
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump(fitted, file)
        file.flush()
        speeds = ",".join(f"{row['speed_m_per_s']:.9g}" for row in truth["rows"])
        load = ["--normal-force", truth["load_N"]] if truth["load_N"] else []
        prediction = run(program, "predict", file.name, "--speeds", speeds, *load)
    return {"fit": fitted, "prediction": prediction if is_answer(prediction) else None, "error": prediction.get("message", "")}


def add_bands(row, prediction, truth, warned):
    for expected, found in zip(truth["rows"], prediction["rows"]):
        true, spacing = expected["spacing_m"], found["periodic_displacement_m"]
        if not true:
            continue
        if spacing["value"]:
            row.add("off", 100 * abs(spacing["value"] / true - 1))
        row.add("none", int(not spacing["ci95"]))
        if not spacing["ci95"]:
            continue
        low, high = spacing["ci95"]
        half = 0.5 * (high - low) / true
        wrong = abs(spacing["value"] / true - 1) > 2 * half and half < 0.25
        for column, value in (("bands", inside((low, high), true)), ("half", 100 * half), ("wrong", int(wrong)), ("silent", int(wrong and not warned))):
            row.add(column, value)


def add_critical_speed(row, fitted, prediction, true):
    critical = (prediction or fitted.get("derived") or {}).get("critical_speed_m_per_s") or {}
    least, most = (fitted.get("derived") or {}).get("observed_end_m_per_s") or [None, None]
    if critical.get("value") is not None and critical.get("ci95") and not str(critical.get("note", "")).startswith("by the runs"):
        row.add("V_c", int(true is not None and inside(critical["ci95"], true)))
    elif least:
        row.add("bracket", int((true is None or least <= 1.01 * true) and (not most or (true is not None and true <= 1.01 * most))))


def wrong_recordings(truth):
    bad = truth["bad"]
    return {f"run{b}" for b in (bad if isinstance(bad, list) else [] if bad is None else [bad])}


def score_sweep(result, truth):
    fitted, prediction = result.get("fit") or {}, result.get("prediction")
    warnings = fitted.get("warnings", [])
    named = {w["message"].split("'")[1] for w in warnings if w["code"] == "recording_disagrees"}
    wrong = wrong_recordings(truth)
    row = Row(fit=int(prediction is not None), warned=int(bool(warnings)), named=int(bool(named & wrong)), alarm=int(bool(named - wrong)))
    for recording in fitted.get("recordings", []):
        row["audit"] += [int(pair["contradicts"]) for pair in recording.get("audit", [])]
    if prediction:
        add_bands(row, prediction, truth, warnings)
    add_critical_speed(row, fitted, prediction, truth["critical_speed_m_per_s"])
    parameters = fitted.get("parameters") or {}
    for name, symbol in OF_SWEEPS.items():
        estimate, true = parameters.get(name) or {}, truth["parameters"].get(name)
        if symbol in ("k", "dF") and estimate.get("value") and estimate.get("se") is not None:
            row.add("se " + symbol, 100 * estimate["se"] / estimate["value"])
        if true is not None and (estimate.get("status") in ("identified", "conditional") or (symbol in ("B", "t_c") and estimate.get("ci95"))):
            row.add(symbol, inside(estimate["ci95"], *(true if isinstance(true, list) else [true])))
    return row


def describe_sweep(row, result, truth):
    if row["fit"] == [1] and not any(row["wrong"] + row["alarm"]) and (row["named"] == [1] or not wrong_recordings(truth)):
        return None
    codes = [w["code"] for w in (result.get("fit") or {}).get("warnings", [])]
    return f"wrong {sum(row['wrong'])} alarm {row['alarm'][0]} named {row['named'][0]} bad {truth['bad']} {codes} {result['error'][:160]}"


# -- trends

OF_TRENDS = {"stiffness_N_per_m": "k", "natural_frequency_rad_per_s": "w_n", "damping_ratio": "zeta", "static_friction_N": "F_s"}
TRENDS = {"fits": share, **{symbol + mark: share for symbol in OF_TRENDS.values() for mark in ("", " ident.")}, "off": median, "half": median,
          "reading": counts}


def score_trend(document, truth):
    row = Row(fits=int(document["status"] == "stick_slip"), reading=(document.get("level_trend") or {}).get("reading") or "-")
    for name, symbol in OF_TRENDS.items():
        estimate, true = (document.get("parameters") or {}).get(name) or {}, truth["parameters"].get(name) or truth["static_friction_N"]
        if not estimate.get("ci95") or not (estimate.get("value") or symbol == "F_s"):
            continue
        low, high = estimate["ci95"]
        row.add(symbol, int(any(low <= one <= high for one in (true if isinstance(true, list) else [true]))))
        row.add(symbol + " ident.", row[symbol][0] if estimate["status"] == "identified" else None)
        if symbol == "k":
            row.add("off", 100 * abs(estimate["value"] / true - 1))
            row.add("half", 50 * (high - low) / estimate["value"])
    return row


def describe_trend(row, document, _):
    missed = [symbol for symbol in OF_TRENDS.values() if row[symbol] == [0]]
    return f"{document['status']:20} misses {missed} reading {row['reading'][0]}" if missed or row["fits"] == [0] else None


# -- audit

CHECKS = {"stiffness_and_sticks": "stiffness_N_per_m", "speed_and_displacement": "stiffness_N_per_m",
          "mass_and_stated_mass": "natural_frequency_rad_per_s", "frequency_and_count": None, "frequency_and_spectrum": None}
CONCERNS = {"mass_and_stated_mass": ("mass_kg", "natural_frequency_rad_per_s"),
            "speed_and_displacement": ("stiffness_N_per_m", "mass_kg", "damping_coefficient_N_s_per_m")}
AUDIT = {"compared": total, "wrong": total, "found": total, "alarms": share}
STATED = {"refused": total, "compared": total, "contradicts": total, "weak": total}


def is_wrong(pair, document, truth):
    """None: the scene has no truth of it."""
    name = CHECKS[pair["pair"]]
    true, estimate = truth["parameters"].get(name) if name else truth["frequency_Hz"], pair["values"][0]
    if pair["pair"] == "mass_and_stated_mass":
        estimate = document["parameters"].get(name) or {}
        if estimate.get("value") is None or estimate.get("se") is None:
            return None
    if true is None:
        return None
    low, high = true if isinstance(true, list) else (true, true)
    off = max(low - estimate["value"], estimate["value"] - high, 0.0)
    return int(off > 4 * (estimate["se"] or 0.0) and off > 0.01 * abs(high))


def score_audit(document, truth):
    for pair in document.get("audit") or []:
        wrong, contradicts = is_wrong(pair, document, truth), int(pair["contradicts"])
        if wrong is not None:
            row = Row(compared=1, wrong=wrong, found=wrong and contradicts, alarms=None if wrong else contradicts)
            values = " ".join(f"{v['value']:.5g}({v['se'] or 0:.2g})" for v in pair["values"])
            yield pair["pair"], row, f"{pair['pair']:24} wrong {wrong} contradicts {contradicts} {values}" if wrong or contradicts else None


def with_displacement(file, out, truth, factor):
    rows = np.loadtxt(file, delimiter=",", skiprows=1)
    way = factor * truth["speed_m_per_s"] * (rows[:, 0] - rows[0, 0])
    noise = min(1e-6, 1e-3 * way[-1]) * np.random.default_rng(1).standard_normal(len(way))
    table = np.column_stack([rows[:, 0], way + noise, rows[:, 1]])
    np.savetxt(out, table, fmt="%.12g", delimiter=",", header="time [s],displacement [m],force [N]", comments="")
    return out


def fit_stated(program, folder, truth):
    file, of = folder / truth["file"], truth["parameters"]
    documents = {}
    if of.get("stiffness_N_per_m") and of.get("natural_frequency_rad_per_s"):
        mass = of["stiffness_N_per_m"] / of["natural_frequency_rad_per_s"] ** 2
        for factor in (1.0, 1.5):
            documents["mass_and_stated_mass", factor] = fit(program, file, truth, "--mass", f"{factor * mass:.9g}kg")
    with tempfile.TemporaryDirectory() as scratch:
        for factor in (1.0, 1.03, 1000.0):
            moved = with_displacement(file, pathlib.Path(scratch) / "moved.csv", truth, factor)
            documents["speed_and_displacement", factor] = fit(program, moved, truth)
    return documents


def score_stated(documents, _):
    for (name, factor), document in documents.items():
        row = Row(refused=int(document["status"] == "refused"))
        for pair in document.get("audit") or []:
            if pair["pair"] == name:
                statuses = [document["parameters"].get(concern, {}).get("status") for concern in CONCERNS[name]]
                row.add("compared", 1)
                row.add("contradicts", int(pair["contradicts"]))
                row.add("weak", int(pair["contradicts"] and "identified" not in statuses))
        yield f"{name} x {factor:g}", row, None


# -- tables

def by_family(score, describe):
    def scored(result, truth):
        row = score(result, truth)
        yield truth["family"], row, describe(row, result, truth)
    return scored


Table = collections.namedtuple("Table", "analyse score columns whole")
TABLES = {"motion": Table(fit_motion, by_family(score_motion, describe_motion), MOTION, "all"),
          "sweeps": Table(fit_and_predict, by_family(score_sweep, describe_sweep), SWEEPS, "all"),
          "trends": Table(lambda program, folder, truth: fit(program, folder / truth["file"], truth, "--zero", "0"),
                          by_family(score_trend, describe_trend), TRENDS, None),
          "audit": Table(fit_motion, score_audit, AUDIT, None), "stated": Table(fit_stated, score_stated, STATED, None)}


def synthetic_truths(folder):
    """Truths of a folder with manifest.csv (what an analyst knows) and truth.csv (what was put in)."""
    truths = {row["id"]: row for row in csv.DictReader(open(folder / "truth.csv", encoding="utf-8"))}
    for row in csv.DictReader(open(folder / "manifest.csv", encoding="utf-8")):
        of = {name: float(text) for name, text in truths[row["id"]].items() if text and name not in ("id", "family", "note")}
        family = truths[row["id"]]["family"]
        parameters = {}
        if "k" in of:
            kinetic = of["f0"] + of["f1"] if "alpha" in of else of["Fk"]
            values = (of["k"], of["Fs"] - kinetic, of.get("wn") or (of["k"] / of["m"]) ** 0.5, of["zeta"])
            parameters = dict(zip(list(SHORT)[:4], values))
        frequency = of["wn"] / (2 * np.pi) if family == "ringdown" else of.get("f")
        kind = "ringdown" if of["steady"] == 1 or family in ("ringdown", "steady") else "stick_slip"
        yield {"id": row["id"], "family": family, "file": row["file"], "kind": kind, "speed_m_per_s": float(row["speed_m_per_s"]),
               "frequency_Hz": frequency, "spacing_m": float(row["speed_m_per_s"]) / frequency if frequency else None, "parameters": parameters, "any_stretch": True,
               "options": ["--force-view", row["force_view"]] if row.get("force_view") else []}


def main():
    words = parser(__doc__)
    words.add_argument("slipfit")
    words.add_argument("folder", type=pathlib.Path)
    words.add_argument("--table", choices=TABLES)
    words.add_argument("--misses", action="store_true", help="name what went wrong")
    words.add_argument("--jobs", type=int, default=2)
    words.add_argument("--only", default="", help="families, comma-separated")
    given = words.parse_args()
    truths = list(synthetic_truths(given.folder)) if (given.folder / "truth.csv").exists() else read_truths(given.folder, given.only)
    name = given.table or ("sweeps" if "speeds_m_per_s" in truths[0] else "motion")
    table = TABLES[name]
    groups, misses = collections.defaultdict(list), []
    for truth, result in zip(truths, in_parallel(given.jobs, lambda t: table.analyse(given.slipfit, given.folder, t), truths)):
        for group, row, miss in table.score(result, truth):
            groups[group].append(row)
            misses += [f"  {truth['id']:22} {miss}"] if miss else []
    print_table(table.columns, groups, "pair" if name in ("audit", "stated") else "family", table.whole)
    if name == "motion":
        summarise_motion([row for rows in groups.values() for row in rows])
    if given.misses:
        print("\n".join(misses))


if __name__ == "__main__":
    main()
