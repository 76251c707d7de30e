#!/usr/bin/env python3
"""widths.py SLIPFIT FOLDER [--count 60] [--seed 1]: what the intervals cost that allow for averaging which nobody stated.

Recordings of undisturbed stick-slip with 6, 12 and 25 samples in a slip are fitted twice: as they are, and with `--sensor-average 0`, where the
rms error is that of the Cramer-Rao bound (benchmarks/results/coverage.txt). A line of the table for each number of samples: width of the
interval over that of the second fit (median), intervals that hold, those that are given, and those of parameters that are identified or
conditional.
"""
import pathlib
import sys

import numpy as np

from families_inside import undisturbed
from scenes import PARAMETERS
from simulator import write_csv

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from study import Row, in_parallel, median, parser, print_table, run, share  # noqa: E402

SHORT = dict(zip(PARAMETERS, ("k", "dF", "w_n", "zeta")))


def interval(document, name):
    parameter = (document.get("parameters") or {}).get(name) or {}
    return parameter["ci95"] if parameter.get("ci95") and parameter["value"] is not None else None


def is_known(document, name):
    return ((document.get("parameters") or {}).get(name) or {}).get("status") in ("identified", "conditional")


def main():
    words = parser(__doc__)
    words.add_argument("program")
    words.add_argument("folder", type=pathlib.Path)
    words.add_argument("--count", type=int, default=60)
    words.add_argument("--seed", type=int, default=1)
    given = words.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)

    def row_of(task):
        samples, seed = task
        made = undisturbed(np.random.default_rng([seed, samples]), per_slip=(samples, samples))
        file = given.folder / f"{samples}-{seed}.csv"
        write_csv(file, made.time_s, made.force)
        speed = ("--speed", made.truth["speed_m_per_s"])
        as_it_is, stated = (run(given.program, "fit", file, *speed, *more) for more in ((), ("--sensor-average", 0)))
        row = Row()
        for name, short in SHORT.items():
            seen, best, true = interval(as_it_is, name), interval(stated, name), made.truth["parameters"].get(name)
            row.add(f"{short} given", seen is not None)
            row.add(f"{short} known", is_known(as_it_is, name))
            if seen is None or best is None or true is None:
                continue
            row.add(f"{short} width", (seen[1] - seen[0]) / (best[1] - best[0]))
            row.add(f"{short} holds", seen[0] <= true <= seen[1])
            row.add(f"{short} holds, stated", best[0] <= true <= best[1])
        return samples, row

    rows = in_parallel(2, row_of, [(samples, seed) for samples in (6, 12, 25) for seed in range(given.seed, given.seed + given.count)])
    columns = {f"{short} {what}": how for short in SHORT.values()
               for what, how in (("width", median), ("holds", share), ("holds, stated", share), ("given", share), ("known", share))}
    print_table(columns, {samples: [row for of, row in rows if of == samples] for samples in (6, 12, 25)}, name="samples", whole="")


if __name__ == "__main__":
    main()
