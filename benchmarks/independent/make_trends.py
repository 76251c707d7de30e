#!/usr/bin/env python3
"""Draws recordings whose force level rises or falls, with their truth, as make_scenes.py does.

    make_trends.py OUT [--count 25] [--seed 1] [--only run_in,drift]
"""
import json
import zlib

import numpy as np

import command_line
import families_trends
from simulator import write_csv


def write(path, scene):
    load = getattr(scene, "load", None)
    if load is None:
        return write_csv(path, scene.time_s, scene.force)
    rows = np.column_stack([scene.time_s, scene.force, load])
    return np.savetxt(path, rows, fmt="%.12g", delimiter=",", header="time_s,friction_N,normal_force_N", comments="")


def main():
    named = {family.__name__: family for family in families_trends.FAMILIES}
    arguments, tasks = command_line.drawing(__doc__, named, count=25)
    with open(arguments.out / "truth.jsonl", "w", encoding="utf-8") as truths:
        for family, seed in tasks:
            scene = named[family](np.random.default_rng([seed, zlib.crc32(family.encode())]))
            name = f"{family}-{seed}"
            write(arguments.out / f"{name}.csv", scene)
            truths.write(json.dumps({"id": name, "family": family, "file": f"{name}.csv", **scene.truth}) + "\n")


if __name__ == "__main__":
    main()
