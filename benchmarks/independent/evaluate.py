#!/usr/bin/env python3
"""Runs slipfit over the recordings of make_scenes.py and holds its answers against the truth: one row a family.

    evaluate.py SLIPFIT SCENES [--misses] [--jobs 2]

verdict: share of right kinds of motion. freq, space: of recordings that have one, the share quoted within 5 % of the truth
(space: V / f), the share of intervals that hold the truth, and how many are absurd (off by a factor of 2 or more; any number
where there is none). stretch: both ends within 1.5 periods, where part of the recording slides otherwise. k ... zeta: share of
intervals that hold the truth, of those given; !!: surely wrong, that is `identified` and off by more than the width of the
interval (4 standard errors) and 2 %. extra: terms taken
(average T_b, D_c, rise A) that the scene does not have.
"""
import collections
import json
import subprocess

import command_line

SHORT = {"stiffness_N_per_m": "k", "friction_difference_N": "dF", "natural_frequency_rad_per_s": "w_n", "damping_ratio": "zeta",
         "mass_kg": "m",
         "sensor_average_s": "T_b", "slip_distance_m": "D_c", "reload_force_N": "A", "reload_length_m": "l"}
TERMS = ("sensor_average_s", "slip_distance_m", "reload_force_N")
RIGHT = {"stick_slip": {"stick_slip"}, "reciprocating": {"stick_slip"},
         "steady": {"steady_sliding"}, "wave": {"oscillatory_slip", "undetermined", "steady_sliding"},
         "ringdown": {"oscillatory_slip", "undetermined", "steady_sliding"}}


def analysed(program, folder, truth):
    command = [program, "fit", str(folder / truth["file"]), "--speed", f"{truth['speed_m_per_s']:.9g}", "--json",
               *truth.get("options", [])]
    try:
        run = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    except subprocess.TimeoutExpired:
        return {"status": "timeout"}
    if run.returncode == 0:
        return json.loads(run.stdout)
    return {"status": "refused", "message": run.stderr.strip()}


def judged(estimate, truth):
    """within 5 %, interval holds (None: no interval), absurd, for one quoted number."""
    value = estimate.get("value") if estimate else None
    if value is None:
        return None
    if not truth:
        return {"within": 0, "holds": None, "absurd": 1}
    interval = estimate.get("ci95")
    holds = int(interval[0] <= truth <= interval[1]) if interval else None
    return {"within": int(abs(value / truth - 1) <= 0.05), "holds": holds, "absurd": int(not 0.5 < value / truth < 2)}


def stretch_found(document, truth):
    period = 1 / truth["frequency_Hz"] if truth["frequency_Hz"] else 0
    used = document.get("recording", {}).get("sliding_s")
    if not used or truth.get("any_stretch"):
        return None
    return int(all(abs(a - b) < 1.5 * period for a, b in zip(used, truth["stretch_s"])))


def against_truth(estimate, expected, warned):
    """`expected`: the lowest and the highest value that are right."""
    low, high = estimate["ci95"]
    value = estimate["value"]
    off = 0.0 if value is None else max(expected[0] - value, value - expected[1], 0.0)
    wrong = estimate["status"] == "identified" and off > max(high - low, 0.02 * expected[1])
    return {"holds": int(low <= expected[1] and expected[0] <= high), "wrong": int(wrong), "silent": int(wrong and not warned),
            "known": 1, "far": int(estimate["status"] == "identified" and off > 0.05 * expected[1])}


def scored(document, truth):
    row = {"verdict": int(document["status"] in RIGHT[truth["kind"]])}
    frequency = dict(document.get("frequency") or {})
    frequency["value"], frequency["ci95"] = frequency.get("value_Hz"), frequency.get("ci95_Hz")
    row["freq"] = judged(frequency, truth["frequency_Hz"])
    row["space"] = judged((document.get("derived") or {}).get("pattern_spacing_m"), truth["spacing_m"])
    row["stretch"] = stretch_found(document, truth) if truth["kind"] == "stick_slip" else None
    for name, symbol in SHORT.items():
        estimate = (document.get("parameters") or {}).get(name)
        if not estimate or not estimate.get("ci95"):
            continue
        identified = estimate["status"] == "identified"
        expected = truth["parameters"].get(name)
        if truth["kind"] not in ("stick_slip", "reciprocating"):
            row[symbol] = {"holds": None, "wrong": int(identified)}
        elif expected is None:
            row["extra"] = row.get("extra", 0) + int(name in TERMS)
        else:
            row[symbol] = against_truth(estimate, expected if isinstance(expected, list) else [expected, expected], bool(document["warnings"]))
    if truth.get("changes"):
        codes = {warning["code"] for warning in document.get("warnings", [])}
        row["said"] = int("changes_on_the_way" in codes or "period_drifts" in codes)
    return row


def share(values):
    values = [v for v in values if v is not None]
    return f"{sum(values)}/{len(values)}" if values else "-"


def line(family, rows):
    cells = [f"{family:16}", f"{share([r['verdict'] for r in rows]):>7}"]
    for name in ("freq", "space"):
        found = [r[name] for r in rows if r[name]]
        cells += [f"{share([f[what] for f in found]):>7}" for what in ("within", "holds")]
        cells.append(f"{sum(f['absurd'] for f in found):>3}")
    cells.append(f"{share([r['stretch'] for r in rows]):>6}")
    for symbol in SHORT.values():
        found = [r[symbol] for r in rows if symbol in r]
        cells.append(f"{share([f['holds'] for f in found]):>7}")
        cells.append(f"{sum(f['wrong'] for f in found):>2}")
    cells.append(f"{sum(r.get('extra', 0) for r in rows):>5}")
    return " ".join(cells)


def summary(rows):
    found = [row[symbol] for row in rows for symbol in SHORT.values() if row.get(symbol, {}).get("known")]
    masses = [row["m"] for row in rows if row.get("m", {}).get("known")]
    return (f"of {len(found)} knowable answers {sum(f['wrong'] for f in found)} surely wrong, {sum(f['silent'] for f in found)} of them without "
            f"a warning; {sum(m['far'] for m in masses)} of {len(masses)} masses identified and off by more than 5 %")


def describe(truth, document, row):
    quoted = (document.get("frequency") or {}).get("value_Hz")
    wrong = [symbol for symbol in SHORT.values() if row.get(symbol, {}).get("wrong")]
    return (f"  {truth['id']:22} {document['status']:18} f {quoted and round(quoted, 4)} true {truth['frequency_Hz'] and round(truth['frequency_Hz'], 4)}"
            f" {(document.get('frequency') or {}).get('method')} wrong {wrong} {document.get('status_reason') or document.get('message', '')[:150]}")


def main():
    arguments, truths, documents = command_line.evaluated(__doc__, analysed)
    families = collections.defaultdict(list)
    misses = []
    for truth, document in zip(truths, documents):
        row = scored(document, truth)
        families[truth["family"]].append(row)
        bad = not row["verdict"] or any((row[n] or {}).get("absurd") or (row[n] or {}).get("within") == 0 for n in ("freq", "space"))
        if bad or any(row.get(s, {}).get("wrong") for s in SHORT.values()):
            misses.append(describe(truth, document, row))
    titles = ["verdict", "f 5 %", "f in", "abs", "x 5 %", "x in", "abs", "strtch"]
    print(f"{'family':16} " + " ".join(f"{t:>{w}}" for t, w in zip(titles, (7, 7, 7, 3, 7, 7, 3, 6))) + " "
          + " ".join(f"{s:>7} !!" for s in SHORT.values()) + " extra")
    for family, rows in families.items():
        print(line(family, rows))
    print(line("all", [row for rows in families.values() for row in rows]))
    print(summary([row for rows in families.values() for row in rows]))
    if arguments.misses:
        print("\n".join(misses))


if __name__ == "__main__":
    main()
