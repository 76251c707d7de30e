#!/usr/bin/env python3
"""Fits the recordings of make_scenes.py, make_terms.py or make_trends.py and counts how often each pair of the audit contradicts itself.

    evaluate_audit.py SLIPFIT SCENES [--misses] [--jobs 2]

compared: recordings that have both values. wrong: of these, the parameter (or the frequency) that the pair checks is off by more than 4
standard errors and 1 %; found: of the wrong ones, contradicted; alarms: of the others, contradicted. The last rows are by family.
"""
import collections

import command_line
from evaluate import analysed

CHECKS = {"stiffness_and_sticks": "stiffness_N_per_m", "speed_and_displacement": "stiffness_N_per_m",
          "mass_and_stated_mass": "natural_frequency_rad_per_s", "frequency_and_count": None, "frequency_and_spectrum": None}


def is_off(value, se, true):
    return abs(value - true) > 4 * se and abs(value - true) > 0.01 * abs(true)


def is_wrong(pair, document, truth):
    """None: the scene has no truth of it."""
    name = CHECKS[pair["pair"]]
    true = truth["parameters"].get(name) if name else truth["frequency_Hz"]
    if true is None:
        return None
    if pair["pair"] == "mass_and_stated_mass":
        estimate = document["parameters"].get(name) or {}
        if estimate.get("value") is None or estimate.get("se") is None:
            return None
        return is_off(estimate["value"], estimate["se"], true)
    return is_off(pair["values"][0]["value"], pair["values"][0]["se"] or 0.0, true)


def main():
    arguments, truths, documents = command_line.evaluated(__doc__, analysed)
    counts = collections.defaultdict(collections.Counter)
    families, misses = collections.defaultdict(collections.Counter), []
    for truth, document in zip(truths, documents):
        for pair in document.get("audit") or []:
            wrong = is_wrong(pair, document, truth)
            if wrong is None:
                continue
            row = counts[pair["pair"]]
            row["compared"] += 1
            row["wrong"] += wrong
            row["found"] += wrong and pair["contradicts"]
            row["alarms"] += (not wrong) and pair["contradicts"]
            families[truth["family"]][pair["pair"]] += pair["contradicts"]
            if pair["contradicts"] or wrong:
                values = " ".join(f"{v['value']:.5g}({v['se'] or 0:.2g})" for v in pair["values"])
                misses.append(f"  {truth['id']:22} {pair['pair']:24} wrong {int(wrong)} contradicts {int(pair['contradicts'])} {values}")
    print(f"{'pair':26} {'compared':>9} {'wrong':>6} {'found':>6} {'alarms':>7}")
    for name, row in counts.items():
        print(f"{name:26} {row['compared']:>9} {row['wrong']:>6} {row['found']:>6} {row['alarms']:>3}/{row['compared'] - row['wrong']}")
    for family, row in families.items():
        if sum(row.values()):
            print(f"  {family:20} " + " ".join(f"{name}:{count}" for name, count in row.items() if count))
    if arguments.misses:
        print("\n".join(misses))


if __name__ == "__main__":
    main()
