#!/usr/bin/env python3
"""make_profiles.py OUT [--count 1000] [--controls 300] [--machined 60] [--seed 1]: simulated profiles and truth.jsonl. Needs numpy."""
import argparse
import json
import pathlib

import numpy as np

import profiles


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--controls", type=int, default=300)
    parser.add_argument("--machined", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    with open(given.out / "truth.jsonl", "w", encoding="utf-8") as truth:
        for i in range(given.count + given.controls + given.machined):
            rng = np.random.default_rng([given.seed, i])
            kind = "pattern" if i < given.count else "control" if i < given.count + given.controls else "machined"
            if kind == "pattern":
                made = profiles.pattern(rng)
            elif kind == "control":
                made = profiles.control(rng, profiles.CONTROLS[i % len(profiles.CONTROLS)])
            else:
                made = profiles.machined(rng, profiles.MACHINED[i % len(profiles.MACHINED)])
            file = f"{i:05d}.csv"
            profiles.write(made, given.out / file)
            row = {k: v for k, v in made.items() if k not in ("x_um", "z_um")}
            truth.write(json.dumps({"file": file, "kind": kind, **row}) + "\n")


if __name__ == "__main__":
    main()
