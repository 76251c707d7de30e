#!/usr/bin/env python3
"""Draws recordings or sweeps with their truth: OUT/FAMILY-SEED.csv (of a sweep OUT/FAMILY-SEED/{manifest.csv, RUN.csv}) and OUT/truth.jsonl.

    make.py SET OUT [--count 10] [--seed 1] [--only plain,noisy] [--jobs 2]

SET: scenes, contacts and instruments of all kinds and negative controls; terms, the terms that measured recordings ask for, alone and
together; trends, a force level that rises or falls; clocks, uneven or rounded times with interference of the mains; strokes,
recordings of several parts, and coefficients of friction; sweeps, one sliding pair at several speeds.
"""
import concurrent.futures
import json
import pathlib
import sys
import zlib

import numpy as np

import families_clocks
import families_contacts
import families_controls
import families_exports
import families_inside
import families_outside
import families_strokes
import families_terms
import families_trends
import sweeps
from simulator import write_csv

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from study import parser  # noqa: E402

SCENES = families_inside, families_outside, families_contacts, families_exports, families_controls
SETS = {"scenes": {name: draw for module in SCENES for name, draw in module.FAMILIES.items()}, "terms": families_terms.FAMILIES,
        "trends": families_trends.FAMILIES, "clocks": families_clocks.FAMILIES, "strokes": families_strokes.FAMILIES, "sweeps": sweeps.FAMILIES}


def make(out, families, family, seed):
    made = SETS[families][family](np.random.default_rng([seed, zlib.crc32(family.encode())]))
    name = f"{family}-{seed}"
    if families == "sweeps":
        sweeps.write(made, out / name)
        return {"id": name, "family": family, "speeds_m_per_s": [run.speed for run in made.runs], **sweeps.truth_of(made)}
    write_csv(out / f"{name}.csv", made.time_s, made.force, made.displacement_m, made.normal_N, made.speed_m_per_s)
    return {"id": name, "family": family, "file": f"{name}.csv", **made.truth}


def main():
    words = parser(__doc__)
    words.add_argument("families", choices=SETS)
    words.add_argument("out", type=pathlib.Path)
    words.add_argument("--count", type=int, default=10)
    words.add_argument("--seed", type=int, default=1)
    words.add_argument("--only", default="")
    words.add_argument("--jobs", type=int, default=2)
    given = words.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    names = given.only.split(",") if given.only else SETS[given.families]
    tasks = [(given.out, given.families, name, seed) for name in names for seed in range(given.seed, given.seed + given.count)]
    with concurrent.futures.ProcessPoolExecutor(given.jobs) as pool, open(given.out / "truth.jsonl", "w", encoding="utf-8") as truths:
        for truth in pool.map(make, *zip(*tasks)):
            truths.write(json.dumps(truth, default=float) + "\n")


if __name__ == "__main__":
    main()
