#!/usr/bin/env python3
"""Draws recordings of every family with their truth: OUT/FAMILY-SEED.csv and OUT/truth.jsonl.

    make_scenes.py OUT [--count 10] [--seed 1] [--only plain,noisy]
"""
import argparse
import json
import pathlib
import zlib

import numpy as np

import families_controls
import families_inside
import families_outside
from simulator import write_csv

FAMILIES = {f.__name__: f for f in families_inside.FAMILIES + families_outside.FAMILIES + families_controls.FAMILIES}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default=",".join(FAMILIES))
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    with open(arguments.out / "truth.jsonl", "w", encoding="utf-8") as truths:
        for family in arguments.only.split(","):
            for seed in range(arguments.seed, arguments.seed + arguments.count):
                rng = np.random.default_rng([seed, zlib.crc32(family.encode())])
                scene = FAMILIES[family](rng)
                name = f"{family}-{seed}"
                write_csv(arguments.out / f"{name}.csv", scene.time_s, scene.force)
                truths.write(json.dumps({"id": name, "family": family, "file": f"{name}.csv", **scene.truth}) + "\n")


if __name__ == "__main__":
    main()
