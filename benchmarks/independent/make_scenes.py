#!/usr/bin/env python3
"""Draws recordings of every family with their truth: OUT/FAMILY-SEED.csv and OUT/truth.jsonl.

    make_scenes.py OUT [--count 10] [--seed 1] [--only plain,noisy]
"""
import json
import zlib

import numpy as np

import command_line
import families_contacts
import families_controls
import families_exports
import families_inside
import families_outside
from simulator import write_csv


def draw(description, families):
    named = {family.__name__: family for family in families}
    arguments, tasks = command_line.drawing(description, named, count=10)
    with open(arguments.out / "truth.jsonl", "w", encoding="utf-8") as truths:
        for family, seed in tasks:
            rng = np.random.default_rng([seed, zlib.crc32(family.encode())])
            scene = named[family](rng)
            name = f"{family}-{seed}"
            write_csv(arguments.out / f"{name}.csv", scene.time_s, scene.force, scene.displacement_m, scene.normal_N)
            truths.write(json.dumps({"id": name, "family": family, "file": f"{name}.csv", **scene.truth}) + "\n")


if __name__ == "__main__":
    draw(__doc__, families_inside.FAMILIES + families_outside.FAMILIES + families_contacts.FAMILIES + families_exports.FAMILIES +
         families_controls.FAMILIES)
