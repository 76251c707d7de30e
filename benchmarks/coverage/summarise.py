#!/usr/bin/env python3
"""summarise.py ROWS.csv...: how often the intervals contain the truth in what `coverage` prints, a line for each family (and kind) and parameter.

given: with an interval; cover%: of these, that contain the truth; p: binomial chance of so few, ! below 1 %; bias, z sd: of (value - truth) / se;
rms/CR: error over the Cramer-Rao bound; wrong: identified and off by more than 4 standard errors and 2 %; median, 95 %: of the relative errors.
Pooled are the families without defects, correlated noise and sweeps. Needs scipy."""
import collections
import csv
import pathlib
import sys

import numpy as np
from scipy.stats import binom

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from study import Row, counts, parser, print_table, share, total  # noqa: E402

WITHOUT_SLIPS = ("ringdown", "steady")


def chance(inside):
    if not inside:
        return "-"
    p = binom.cdf(sum(inside), len(inside), 0.95)
    return f"{p:.4f}{'!' if p < 0.01 else ' '}"


def of(how, text):
    return lambda values: text.format(how(values)) if values else "-"


COLUMNS = {"n": total, "given": total, "cover%": ("inside", of(lambda v: 100 * np.mean(v), "{:.1f}")), "p": ("inside", chance),
           "bias": ("z", of(np.mean, "{:+.2f}")), "z sd": ("z", of(np.std, "{:.2f}")),
           "rms/CR": ("excess", of(lambda v: np.sqrt(np.mean(np.square(v))), "{:.3f}")), "ident%": ("identified", of(lambda v: 100 * np.mean(v), "{:.1f}")),
           "wrong": total, "median": ("error", of(np.median, "{:.4f}")), "95 %": ("error", of(lambda v: np.quantile(v, 0.95), "{:.4f}"))}


def scored(line):
    value, se, low, high, bound = (float(line[name]) if line[name] else None for name in ("value", "se", "lo", "hi", "cramer_rao"))
    truth, identified = float(line["truth"]), line["status"] == "identified"
    row = Row(n=1, given=int(low is not None), inside=None if low is None else int(low <= truth <= high), identified=int(identified))
    if value is not None:
        row.add("error", abs(value / truth - 1))
        row.add("z", (value - truth) / se if se else None)
        row.add("excess", (value - truth) / bound if se is not None and bound else None)
    row.add("wrong", int(identified and None not in (value, se) and abs(value - truth) > max(4 * se, 0.02 * abs(truth))))
    return row


def main():
    words = parser(__doc__)
    words.add_argument("rows", nargs="+")
    tables, motion = collections.defaultdict(list), collections.defaultdict(list)
    for line in (line for name in words.parse_args().rows for line in csv.DictReader(open(name, encoding="utf-8"))):
        family, kind = line["family"], f"{line['family']} {line['note']}".strip()
        if line["parameter"] == "spacing":
            right = (line["motion"] == "stick_slip") != (family in WITHOUT_SLIPS)
            row = Row(right=int(right))
            row["warnings"] += line["warnings"].split()
            motion[kind].append(row)
        if family in WITHOUT_SLIPS:
            continue
        groups = {family, kind} | ({"pooled"} if family not in ("defect", "ar1", "sweeps") else set())
        for group in groups:
            tables[f"{group:20} {line['parameter']}"].append(scored(line))
    order = sorted(tables, key=lambda name: (name.startswith("pooled"), name))
    print_table(COLUMNS, {name: tables[name] for name in order}, "family               parameter", whole=None)
    if motion:
        print("\nkind of motion")
        print_table({"right": share, "warnings": counts}, dict(sorted(motion.items())), whole=None)


if __name__ == "__main__":
    main()
