#!/usr/bin/env python3
"""single_speed.py SLIPFIT [--shared ../shared] [--reference OTHER]: predictions from recordings at one speed.

Measured: printed plastic of two masses at eight speeds (FOLDER/data/real/fdm), each recording fitted on its own, in several ways, and
predicted at the speeds of the others. A band is held against V / f of slipfit at that speed and against the spacing that the
authors published. Skips, and says so, without the folder.
Simulated: constant friction, so that a prediction from one speed is right; bands against those of OTHER (an earlier build), and
how many hold the spacing of the model."""
import csv
import json
import math
import pathlib
import subprocess
import tempfile

from study import is_answer, parser, run

SPEEDS_MM_MIN = (10, 30, 50, 100, 150, 200, 300, 400)
WAYS = {"as it is": [], "mass": ["--mass"], "mass, zeta = 0.05": ["--mass", "--fix", "damping_ratio=0.05"],
        "mass, zeta = 0.2": ["--mass", "--fix", "damping_ratio=0.2"], "zeta = 0.1": ["--fix", "damping_ratio=0.1"],
        "w_n from k and m": ["--fix", "natural_frequency", "--fix", "damping_ratio=0.1"]}


def answer(program, *words):
    """The document; None where the program refuses."""
    document = run(program, *words, "--quiet")
    return document if is_answer(document) else None


def predicted(program, document, speeds):
    """Rows, or none where the fit leaves open what a prediction needs."""
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump(document, file)
        file.flush()
        found = answer(program, "predict", file.name, "--speeds", ",".join(speeds))
    return found["rows"] if found else None


def options_of(way, mass_g):
    stiffness = 310.0  # of the ring-down and the slow runs: README of the recordings
    options = []
    for word in WAYS[way]:
        if word == "--mass":
            options += ["--mass", f"{mass_g}g"]
        elif word == "natural_frequency":
            options += [f"natural_frequency_rad_per_s={math.sqrt(1e3 * stiffness / mass_g):.4g}"]
        else:
            options += [word]
    return options


def measured(program, folder):
    published = {(int(row["mass_g"]), int(row["speed_mm_min"])): float(row["published_spacing_mm"])
                 for row in csv.DictReader((folder / "published_spacing.csv").open())}
    print("printed plastic: ratio of the speeds | bands | hold V / f | hold the published spacing | mean factor of a band")
    for way in WAYS:
        tally = {}
        sources = 0
        for mass in (77, 232):
            documents = {v: answer(program, "fit", folder / f"fdm_{mass}g_{v}mm_min.csv", "--speed", f"{v}mm/min", *options_of(way, mass))
                         for v in SPEEDS_MM_MIN}
            for own in SPEEDS_MM_MIN:
                rows = predicted(program, documents[own], [f"{v}mm/min" for v in SPEEDS_MM_MIN]) if documents[own] else None
                sources += rows is not None
                for v, row in zip(SPEEDS_MM_MIN, rows or []):
                    band = row["periodic_displacement_m"]["ci95"]
                    if v == own or not band or not documents[v]:
                        continue
                    ratio = max(v / own, own / v)
                    key = "to 1.5" if ratio <= 1.5 else "to 4" if ratio <= 4 else "to 40"
                    frequency = documents[v]["frequency"]["value_Hz"]
                    hit = tally.setdefault(key, [0, 0, 0, 0, 0.0])
                    hit[0] += 1
                    hit[1] += frequency is not None
                    hit[2] += frequency is not None and band[0] <= v / 6e4 / frequency <= band[1]
                    hit[3] += band[0] <= 1e-3 * published[mass, v] <= band[1]
                    hit[4] += math.log(band[1] / band[0]) / 2
        print(f"{way}: {sources} of 16 recordings predict")
        for key, (bands, given, own, theirs, width) in sorted(tally.items()):
            print(f"  {key:8} {bands:4} {own:4} of {given:<4} {theirs:4} of {bands:<4} {math.exp(width / bands):6.3f}")


def simulated(program, reference):
    """Constant friction: the true spacing by the model itself."""
    print("constant friction: ratio of the speeds | bands | hold | factor of a band | of the reference | hold there")
    tally = {}
    for seed in range(12):
        zeta, speed = (0.02, 0.05, 0.1)[seed % 3], (0.002, 0.005, 0.01, 0.02)[seed % 4]
        model = ["--stiffness", 5000, "--natural-frequency", 600, "--damping-ratio", zeta, "--static-friction", 4, "--kinetic-friction", 3]
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "run.csv"
            subprocess.run([program, "simulate", *map(str, model), "--speed", str(speed), "--duration", "2", "--sample-rate", "10000",
                            "--noise", "0.01", "--jitter", "0.05", "--seed", str(seed), "--out", str(file), "--quiet"], check=True, capture_output=True)
            document = answer(program, "fit", file, "--speed", speed)
        ratios = (0.1, 0.25, 0.5, 0.7, 1.4, 2, 4, 10)
        speeds = [f"{speed * r:.6g}" for r in ratios]
        truth = answer(program, "predict", *model, "--speeds", ",".join(speeds))["rows"]
        rows = {name: predicted(build, document, speeds) for name, build in (("new", program), ("old", reference)) if build}
        for i, ratio in enumerate(ratios):
            true = truth[i]["periodic_displacement_m"]["value"]
            hit = tally.setdefault(ratio, {"new": [0, 0, 0.0], "old": [0, 0, 0.0]})
            for name, answers in rows.items():
                band = answers[i]["periodic_displacement_m"]["ci95"] if answers else None
                if band and true:
                    hit[name][0] += 1
                    hit[name][1] += band[0] <= true <= band[1]
                    hit[name][2] += math.log(band[1] / band[0]) / 2
    for ratio, hit in tally.items():
        cells = [f"{n:4} {h:4} {math.exp(w / n):7.3f}" if n else "   -    -       -" for n, h, w in (hit["new"], hit["old"])]
        print(f"  {ratio:<5} " + " | ".join(cells))


def main():
    words = parser(__doc__)
    words.add_argument("program")
    words.add_argument("--shared", type=pathlib.Path, default=pathlib.Path(__file__).parents[2] / "shared")
    words.add_argument("--reference")
    arguments = words.parse_args()
    folder = arguments.shared / "data/real/fdm"
    if folder.is_dir():
        measured(arguments.program, folder)
    else:
        print(f"skipped: no {folder}")
    simulated(arguments.program, arguments.reference)


main()
