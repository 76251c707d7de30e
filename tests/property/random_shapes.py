#!/usr/bin/env python3
"""random_shapes.py SLIPFIT [--draws N] [--seed S] [--largest SAMPLES] [--jobs J] [--keep DIR]: noisy stick-slip of random shape, and what
slipfit fit, fit --joint and compare answer.

The shapes are made here, without the library: sticks and slips of several forms with 3 to 200 cycles, 2 to 100 samples in a slip, noise of
0.3 to 30 % of the drop, scatter, drift, gaps and defects. Each command must end within its processor time with exit code 0 and one valid
document (numbers finite, values inside their intervals, a share checked against the schema), or with exit code 2 or 3 and one line of
error. Prints a table of commands and outcomes; exit 1 where a draw broke the rule (its files are kept in DIR). A draw is reproduced by its
seed and --draws 1."""

import argparse
import collections
import concurrent.futures
import math
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "mutation"))
import mutate  # noqa: E402

LONGEST_S = {"fit": 5, "compare": 10, "joint": 15}  # of processor time
FEWEST_SAMPLES = 40
VALIDATED = 25  # documents of each schema: its validation takes longer than the fit


def log_uniform(rng, low, high):
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def fall_of(form, phase):
    """Share of the drop that is left at a phase (0 to 1) of the slip."""
    if form == "cosine":
        return 0.5 * (1 + math.cos(math.pi * phase))
    if form == "line":
        return 1 - phase
    if form == "decay":
        return (math.exp(-4 * phase) - math.exp(-4)) / (1 - math.exp(-4))
    if form == "late":
        return 1 - phase**3
    return 1 - phase + 0.3 * math.sin(4 * math.pi * phase) * (1 - phase)  # "swings"


class Shape:
    """What the recordings of a draw have in common."""

    def __init__(self, rng):
        self.form = rng.choice(["cosine", "cosine", "line", "decay", "late", "swings"])
        self.slip = log_uniform(rng, 2, 100)  # in samples
        self.stick = self.slip * log_uniform(rng, 0.5, 20)
        self.cycles = round(log_uniform(rng, 3, 200))
        self.bend = rng.choice([0, 0, rng.uniform(-0.5, 0.5)])  # of the sticks
        self.drop = log_uniform(rng, 1e-3, 1e3)
        self.noise = log_uniform(rng, 0.003, 0.3)  # in drops, as all below
        self.scatter = rng.choice([0, 0.02, 0.1, 0.4])
        self.drift = rng.choice([0, 0, rng.uniform(-1, 1), rng.uniform(-10, 10)])
        self.wander = rng.choice([0, 0, 0.05, 0.3])
        self.hum = rng.choice([0, 0, 0, rng.uniform(0.01, 0.3)])
        self.step_s = log_uniform(rng, 1e-5, 0.05)


def force_of(shape, rng, largest):
    """Force at even times, at most `largest` samples."""
    force = []
    level = rng.choice([0, 0.5, 3])
    trough = level
    samples = max(FEWEST_SAMPLES, round(min(largest, shape.cycles * (shape.slip + shape.stick))))
    hum_turns = rng.uniform(0.001, 0.4)
    begin = 0.0  # of the cycle
    while len(force) < samples:
        level += shape.wander * rng.gauss(0, 1)
        drop = 1 + shape.scatter * rng.gauss(0, 1)
        peak = level + drop
        stick = shape.stick * max(0.05, (peak - trough))
        while len(force) < min(samples, begin + stick):
            share = (len(force) - begin) / stick
            share += shape.bend * share * (1 - share)
            force.append(trough + (peak - trough) * share)
        begin += stick
        while len(force) < min(samples, begin + shape.slip):
            force.append(level + drop * fall_of(shape.form, (len(force) - begin) / shape.slip))
        begin += shape.slip
        trough = level
    return [shape.drop * (f + shape.drift * i / samples + shape.hum * math.sin(2 * math.pi * hum_turns * i)
                          + shape.noise * rng.gauss(0, 1)) for i, f in enumerate(force)]


def with_defects(time_s, force, shape, rng):
    """Rows of a file: gaps, a clock that jitters, impulses, a range that clips, steps of a converter, cells without numbers."""
    kept = [True] * len(force)
    for _ in range(rng.choice([0, 0, 1, 3])):
        begin = rng.randrange(len(kept))
        kept[begin:begin + rng.randrange(1, 1 + len(kept) // 5)] = []
        kept[begin:begin] = [False] * (len(force) - len(kept))
    if rng.random() < 0.15:
        time_s = [t + shape.step_s * 0.3 * rng.uniform(-1, 1) for t in time_s]
    for _ in range(rng.choice([0, 0, 0, 1, 10])):
        force[rng.randrange(len(force))] += shape.drop * rng.uniform(-20, 20)
    if rng.random() < 0.1:
        top = sorted(force)[int(0.9 * len(force))]
        force = [min(f, top) for f in force]
    step = rng.choice([0, 0, 0, 0.01, 0.1]) * shape.drop
    rows = []
    for is_kept, t, f in zip(kept, time_s, force):
        f = step * round(f / step) if step else f
        if is_kept:
            rows.append(f"{t:.9g},{f:.7g}" if rng.random() > 0.0005 else f"{t:.9g},nan")
    return rows


def write_recording(path, shape, rng, largest):
    force = force_of(shape, rng, largest)
    time_s = [shape.step_s * i for i in range(len(force))]
    path.write_text("\n".join(["time_s,force_N", *with_defects(time_s, force, shape, rng)]) + "\n")


def stated(shape, rng):
    """Options of one recording beside its speed."""
    options = []
    for chance, words in ((0.2, ["--normal-force", f"{shape.drop * rng.uniform(1, 10):.4g}"]), (0.2, ["--zero", "0"]),
                          (0.1, ["--sensor-average", f"{shape.step_s * rng.uniform(0.5, 30):.4g}"]), (0.1, ["--force-view", "contact"]),
                          (0.1, ["--force-view", "transmitted"]), (0.1, ["--mass", f"{log_uniform(rng, 1e-3, 10):.4g}"]),
                          (0.05, ["--fix", "damping_ratio=0.05"]),
                          (0.15, ["--tier", rng.choice(["sawtooth", "undamped", "damped", "velocity"])])):
        if rng.random() < chance and words[0] not in options:
            options += words
    return options


def command_of(folder, rng, largest):
    """Writes the files of a draw; the kind of command and its words."""
    shape = Shape(rng)
    speed = f"{log_uniform(rng, 1e-4, 0.1):.4g}"
    kind = rng.choices(["fit", "compare", "joint"], weights=[70, 12, 18])[0]
    count = {"fit": 1, "compare": 2}.get(kind) or rng.choice([2, 3, 3])
    for i in range(count):
        if i > 0 and rng.random() < 0.3:
            shape = Shape(rng)
        write_recording(folder / f"{i}.csv", shape, rng, largest)
    if kind == "fit":
        return kind, ["fit", folder / "0.csv", "--speed", speed, *stated(shape, rng)]
    if kind == "compare":
        return kind, ["compare", folder / "0.csv", folder / "1.csv", "--speed", speed]
    rows = ["id,file,speed_m_per_s,normal_force_N,zero_force_N,sensor_average_s"]
    average = rng.choice(["", "", f"{shape.step_s * rng.uniform(0.5, 30):.4g}"])
    for i in range(count):
        own_speed = rng.choice([float(speed), log_uniform(rng, 1e-4, 0.1)])
        rows.append(f"i{i},{i}.csv,{own_speed:.4g},{rng.choice(['', '', '5', '10'])},{rng.choice(['', '0.1'])},{average}")
    (folder / "m.csv").write_text("\n".join(rows) + "\n")
    return kind, ["fit", "--joint", folder / "m.csv", *rng.choice([[], [], ["--tier", "velocity"]])]


def try_draw(slipfit, seed, largest, keep):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        kind, words = command_of(folder, random.Random(seed), largest)
        command = ["prlimit", f"--cpu={LONGEST_S[kind]}", "--as=4000000000", "--", slipfit, *map(str, words), "--json"]
        run = subprocess.run(command, capture_output=True, check=False)
        word, fault = mutate.judged(run, LONGEST_S[kind], mutate.ANY_MAY_BE_NEGATIVE if kind == "compare" else mutate.MAY_BE_NEGATIVE)
        if fault and keep:
            shutil.copytree(folder, pathlib.Path(keep, str(seed)), dirs_exist_ok=True)
            fault += " | " + " ".join(map(str, words))
        return seed, kind, word, fault, run.stdout if run.returncode == 0 else b""


def invalid_documents(documents):
    """What the schemas say of some documents of each kind."""
    with tempfile.TemporaryDirectory() as name:
        for kind, texts in documents.items():
            schema = "compare" if kind == "compare" else "fit"
            files = []
            for i, text in enumerate(texts):
                files.append(pathlib.Path(name, f"{kind}{i}.json"))
                files[-1].write_bytes(text)
            validate = [sys.executable, HERE.parent / "cli/validate_schema.py", HERE.parents[1] / f"docs/{schema}.schema.json", *files]
            run = subprocess.run(validate, capture_output=True, text=True, check=False)
            if run.returncode not in (0, 77):
                yield f"{kind}: {run.stdout}{run.stderr}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("slipfit")
    parser.add_argument("--draws", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--largest", type=int, default=4000)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep")
    arguments = parser.parse_args()
    counts = collections.defaultdict(collections.Counter)
    documents = collections.defaultdict(list)
    faults = []
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        seeds = range(arguments.seed, arguments.seed + arguments.draws)
        for seed, kind, word, fault, document in pool.map(
                lambda seed: try_draw(arguments.slipfit, seed, arguments.largest, arguments.keep), seeds):
            counts[kind][word] += 1
            if fault:
                faults.append(seed)
                print(f"seed {seed} ({kind}): {fault}", flush=True)
            elif document and len(documents[kind]) < VALIDATED:
                documents[kind].append(document)
    for fault in invalid_documents(documents):
        faults.append("schema")
        print(fault)
    print(f"{arguments.draws} draws from seed {arguments.seed} on, {len(faults)} broke the rule\n")
    mutate.print_table(dict(sorted(counts.items())))
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
