#!/usr/bin/env python3
"""Draws sweeps of every family with their truth: OUT/FAMILY-SEED/{manifest.csv, RUN.csv} and OUT/truth.jsonl.

    make_sweeps.py OUT [--count 25] [--seed 1] [--only coulomb5,two]
"""
import concurrent.futures
import json
import zlib

import numpy as np

import command_line
import sweeps
from simulator import write_csv

FAMILIES = {f.__name__: f for f in sweeps.FAMILIES}


def make(out, family, seed):
    sweep = FAMILIES[family](np.random.default_rng([seed, zlib.crc32(family.encode())]))
    folder = out / f"{family}-{seed}"
    folder.mkdir(parents=True, exist_ok=True)
    traces = [sweeps.trace(sweep, run) for run in sweep.runs]
    loads = any(run.stated_load for run in sweep.runs)
    with open(folder / "manifest.csv", "w", encoding="utf-8") as manifest:
        manifest.write("id,file,speed_m_per_s" + (",normal_force_N" if loads else "") + "\n")
        for i, run in enumerate(sweep.runs):
            time_s, force, normal_N = traces[i if run.source is None else run.source]
            write_csv(folder / f"run{i}.csv", time_s, force, normal_N=normal_N)
            load = f",{run.stated_load:.6g}" if loads else ""
            manifest.write(f"run{i},run{i}.csv,{run.stated_speed or run.speed:.9g}{load}\n")
    return {"id": folder.name, "family": family, "speeds_m_per_s": [r.speed for r in sweep.runs], **sweeps.truth_of(sweep)}


def main():
    arguments, tasks = command_line.drawing(__doc__, FAMILIES, count=25)
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as pool, open(arguments.out / "truth.jsonl", "w", encoding="utf-8") as truths:
        for truth in pool.map(make, *zip(*[(arguments.out, *task) for task in tasks])):
            truths.write(json.dumps(truth, default=float) + "\n")


if __name__ == "__main__":
    main()
