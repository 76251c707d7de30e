#!/usr/bin/env python3
"""golden.py SLIPFIT [--update]: the whole document of each command and kind of recording, held against tests/golden/*.json.

Recordings are simulated with fixed seeds. Keys, strings, statuses and numbers of samples must be the same. Numbers may differ by 1e-6 of
their size, as rounding of another compiler does, or, where a fit made them, by a tenth of the standard error beside them (a
sum of squares is then 0.01 above its minimum at most); what a fit gives without a standard error by a thousandth. --update writes
the documents anew: look at `git diff` before committing them.
"""
import argparse
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).parent
COMMON = {"stiffness": 5000, "natural-frequency": 900, "damping-ratio": 0.05, "static-friction": 4, "sample-rate": 10000, "duration": 1,
          "noise": 0.01, "jitter": 0.03}
COULOMB = {"kinetic-friction": 3}
OF_SPEED = {"f0": 2.8, "f1": 0.2, "alpha": -20}
RECORDINGS = {  # name: options of `slipfit simulate` beside the common ones
    "damped": {"speed": 0.01, "seed": 1, **COULOMB},
    "undamped": {"speed": 0.01, "seed": 2, "damping-ratio": 0, **COULOMB},
    "contact": {"speed": 0.01, "seed": 3, "force-view": "contact", **COULOMB},
    "transmitted": {"speed": 0.01, "seed": 4, "force-view": "transmitted", **COULOMB},
    "sparse": {"speed": 0.01, "seed": 5, "sample-rate": 250, "duration": 4, **COULOMB},
    "steady": {"speed": 0.5, "seed": 6, "damping-ratio": 0.2, **COULOMB},
    "slow": {"speed": 0.005, "seed": 7, **OF_SPEED},
    "middle": {"speed": 0.015, "seed": 8, **OF_SPEED},
    "fast": {"speed": 0.045, "seed": 9, **OF_SPEED},
}
STEPS = "Step,Timestamp,Fx (N),Fz (N),Velocity (mm/s),State\n" + "".join(
    f"{step},{0.01 * i:.2f},{1 + (i % 7) / 10},{2 * step},{5 * step},on\n" for step in (1, 2) for i in range(60))
GROUPED = ["slow", "middle", "fast"]
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
LEFT_OUT = {"version", "commit", "input_digest", "input_bytes"}  # the bytes of a recording hang on the last digit of each sample
MEASURED = {"recording", "cycles"}  # no fit has a part in them


class Documents:
    def __init__(self, slipfit, folder):
        self.slipfit, self.folder = slipfit, folder

    def run(self, *arguments):
        done = subprocess.run([self.slipfit, *arguments], cwd=self.folder, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"slipfit {' '.join(arguments)}: exit code {done.returncode}\n{done.stderr}")
        return done.stdout

    def simulate(self):
        for name, own in RECORDINGS.items():
            options = [word for key, value in {**COMMON, **own}.items() for word in (f"--{key}", str(value))]
            (self.folder / f"{name}.csv").write_text(self.run("simulate", *options))
        rows = [f"{name},{name}.csv,{RECORDINGS[name]['speed']},pair" for name in GROUPED]
        (self.folder / "runs.csv").write_text("\n".join(["id,file,speed_m_per_s,group", *rows]) + "\n")

    def all(self):
        """Yields name and document; a prediction and a plan need the fit before."""
        self.simulate()
        for name in ("damped", "undamped", "contact", "transmitted", "sparse", "steady"):
            speed, view = str(RECORDINGS[name]["speed"]), RECORDINGS[name].get("force-view", "spring")
            yield f"fit_{name}", self.document("fit", f"{name}.csv", "--speed", speed, "--force-view", view)
        (self.folder / "steps.csv").write_text(STEPS)
        yield "info", self.document("info", "steps.csv")
        yield "analyze", self.document("analyze", "damped.csv", "--speed", "0.01")
        yield "fit_joint", self.document("fit", "--joint", "runs.csv", "--group", "pair")
        self.run("fit", "damped.csv", "--speed", "0.01", "--json", "--quiet", "--out", "damped.json")
        self.run("fit", "--joint", "runs.csv", "--json", "--quiet", "--out", "joint.json")
        for source in ("damped", "joint"):
            yield f"predict_{source}", self.document("predict", f"{source}.json", "--speeds", "2mm/s,20mm/s,1m/s")
            yield f"plan_{source}", self.document("plan", f"{source}.json")
        self.run("batch", "runs.csv", "--out", "out", "--jobs", "1", "--quiet")
        yield "batch_line", json.loads((self.folder / "out" / "results.jsonl").read_text().splitlines()[0])

    def document(self, *arguments):
        return json.loads(self.run(*arguments, "--json"))


def written(value):
    """Nine digits, a line for each key: short, and a difference shows where it is."""
    def short(value):
        if isinstance(value, float):
            return float(f"{value:.9g}")
        if isinstance(value, dict):
            return {key: short(part) for key, part in value.items() if key not in LEFT_OUT}
        return [short(part) for part in value] if isinstance(value, list) else value
    return "{\n" + ",\n".join(f"{json.dumps(k)}: {json.dumps(v)}" for k, v in short(value).items()) + "\n}\n"


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def close(expected, found, fitted, error):
    if isinstance(expected, int) and isinstance(found, int):
        return expected == found
    size = max(abs(expected), abs(found))
    return abs(expected - found) <= max((1e-3 if fitted and error is None else 1e-6) * size, 0.1 * (error or 0.0), 1e-12)


def same_text(expected, found):
    """Words exactly; numbers in a sentence are rounded and may differ by their last digit."""
    if NUMBER.sub("#", expected) != NUMBER.sub("#", found):
        return False
    pairs = zip(NUMBER.findall(expected), NUMBER.findall(found))
    return all(math.isclose(float(a), float(b), rel_tol=0.12 if len(a.strip("-0.")) < 3 else 0.02) for a, b in pairs)


def differences(expected, found, place, fitted=True, error=None):
    if isinstance(expected, dict) and isinstance(found, dict):
        found = {key: part for key, part in found.items() if key not in LEFT_OUT}
        if set(expected) != set(found):
            yield f"{place}: keys {list(expected)}, now {list(found)}"
            return
        own = expected.get("se") or expected.get("se_Hz")
        if own is None and expected.get("ci95"):
            own = (expected["ci95"][1] - expected["ci95"][0]) / 4.0
        for key in expected:
            of_key = 0.01 if key == "matrix" else own  # correlations
            yield from differences(expected[key], found[key], f"{place}/{key}", fitted and key not in MEASURED, of_key)
    elif isinstance(expected, list) and isinstance(found, list) and len(expected) == len(found):
        for i, pair in enumerate(zip(expected, found)):
            yield from differences(*pair, f"{place}/{i}", fitted, error)
    elif is_number(expected) and is_number(found):
        if not close(expected, found, fitted, error):
            yield f"{place}: {expected}, now {found} (standard error {error})"
    elif isinstance(expected, str) and isinstance(found, str):
        if not same_text(expected, found):
            yield f"{place}: '{expected}', now '{found}'"
    elif expected != found:
        yield f"{place}: {expected}, now {found}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("slipfit", type=pathlib.Path)
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()
    wrong = []
    names = set()
    with tempfile.TemporaryDirectory() as folder:
        for name, document in Documents(arguments.slipfit.resolve(), pathlib.Path(folder)).all():
            file = HERE / f"{name}.json"
            names.add(file)
            if arguments.update:
                file.write_text(written(document))
            elif not file.exists():
                wrong.append(f"{file} is missing: run with --update")
            else:
                wrong.extend(differences(json.loads(file.read_text()), document, name))
    wrong.extend(f"{file} belongs to no command" for file in set(HERE.glob("*.json")) - names)
    print("\n".join(wrong) or f"{len(names)} documents as they were")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
