#!/usr/bin/env python3
"""make_profiles.py OUT [--count 1000] [--controls 300] [--seed 1]: simulated profiles and truth.jsonl. Needs numpy."""
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
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    with open(given.out / "truth.jsonl", "w", encoding="utf-8") as truth:
        for i in range(given.count + given.controls):
            rng = np.random.default_rng([given.seed, i])
            is_control = i >= given.count
            made = profiles.control(rng, profiles.CONTROLS[i % len(profiles.CONTROLS)]) if is_control else profiles.pattern(rng)
            file = f"{i:05d}.csv"
            profiles.write(made, given.out / file)
            row = {k: v for k, v in made.items() if k not in ("x_um", "z_um")}
            truth.write(json.dumps({"file": file, "control": is_control, **row}) + "\n")


if __name__ == "__main__":
    main()
