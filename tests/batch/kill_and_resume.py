#!/usr/bin/env python3
"""kill_and_resume.py SLIPFIT [--kills N] [--recordings N] [--seed N] [--report] [--joint-groups]

Kills `slipfit batch` with SIGKILL at random moments, cuts off random bytes that a crash of the machine could have taken,
resumes, and compares the final files, pages included, with those of a run that nobody disturbed. Exit code 1 where they differ.
"""

import argparse
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

MODEL = "--stiffness 1000 --natural-frequency 200 --damping-ratio 0.05 --static-friction 6 --kinetic-friction 4".split()
DISTINCT = 20
SPEEDS = ("0.02", "0.03")  # of the recordings, in turn
GROUP = 6


def simulate(slipfit, folder):
    for i in range(DISTINCT):
        options = f"--speed {SPEEDS[i % len(SPEEDS)]} --duration 2 --sample-rate 1000 --noise 0.02 --jitter 0.05 --seed {i + 1}".split()
        subprocess.run([slipfit, "simulate", *MODEL, *options, "--out", folder / f"r{i}.csv", "--quiet"], check=True)


def write_manifest(folder, recordings):
    """Every 50th file is missing, so that there are failures."""
    rows = ["id,file,speed_m_per_s,group"]
    for i in range(recordings):
        group = f"g{i // GROUP}" if i // GROUP % 4 == 0 else ""
        rows.append(f"x{i},{'none' if i % 50 == 49 else f'r{i % DISTINCT}'}.csv,{SPEEDS[i % len(SPEEDS)]},{group}")
    manifest = folder / "runs.csv"
    manifest.write_text("\n".join(rows) + "\n")
    return manifest


def start(slipfit, manifest, out, options):
    report = [word.replace("PAGES", str(out) + "-pages") for word in options]
    return subprocess.Popen([slipfit, "batch", manifest, "--out", out, "--resume", "--jobs", "2", "--quiet", *report],
                            stderr=subprocess.PIPE, text=True)


def finish(slipfit, manifest, out, options):
    process = start(slipfit, manifest, out, options)
    message = process.communicate()[1]
    if process.returncode not in (0, 1):
        sys.exit(f"batch ended with {process.returncode}: {message}")


def lose_some_bytes(file, chance):
    """What was written less than a second ago may be lost with the machine."""
    size = file.stat().st_size if file.exists() else 0
    if size and chance.random() < 0.5:
        with file.open("r+b") as stream:
            stream.truncate(size - chance.randrange(min(size, 9000)))


def content(out):
    """Every file but run.json, by its name; the pages beside it too."""
    folders = [out, pathlib.Path(str(out) + "-pages")]
    return {str(file.relative_to(folder)): file.read_bytes() for folder in folders for file in sorted(folder.rglob("*"))
            if file.is_file() and file.name != "run.json"}


def differing(first, second):
    return sorted(name for name in first.keys() | second.keys() if first.get(name) != second.get(name))


def kill_once(slipfit, manifest, out, options, seconds, chance):
    """Whether there was a batch left to kill."""
    process = start(slipfit, manifest, out, options)
    time.sleep(chance.uniform(0.0, seconds))
    process.kill()
    process.communicate()
    lose_some_bytes(out / "journal", chance)
    return process.returncode < 0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("slipfit")
    parser.add_argument("--kills", type=int, default=30)
    parser.add_argument("--recordings", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--report", action="store_true")
    parser.add_argument("--joint-groups", action="store_true")
    arguments = parser.parse_args()
    options = ["--joint-groups"] * arguments.joint_groups + ["--report", "PAGES/index.html"] * arguments.report
    chance = random.Random(arguments.seed)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="slipfit-kill-"))
    try:
        simulate(arguments.slipfit, folder)
        manifest = write_manifest(folder, arguments.recordings)
        begin = time.monotonic()
        finish(arguments.slipfit, manifest, folder / "whole", options)
        seconds = time.monotonic() - begin
        whole = content(folder / "whole")
        kills = attempts = rounds = three = 0
        while kills < arguments.kills and attempts < 20 * arguments.kills:
            # Several kills a round, spread over the whole of a run: the end, where files change places, included.
            rounds += 1
            for _ in range(chance.randint(1, 4)):
                attempts += 1
                if kills < arguments.kills:
                    kills += kill_once(arguments.slipfit, manifest, folder / "out", options, 1.05 * seconds, chance)
            finish(arguments.slipfit, manifest, folder / "out", options)
            if b",crashed," in (folder / "out" / "failures.csv").read_bytes():  # three kills hit the same fit
                three += 1
                finish(arguments.slipfit, manifest, folder / "out", options)
            names = differing(whole, content(folder / "out"))
            if names:
                sys.exit(f"seed {arguments.seed}: {names[:5]} differ after {kills} kills; they are in {folder}")
            for name in ("out", "out-pages"):
                shutil.rmtree(folder / name, ignore_errors=True)
        lines = len((folder / "whole" / "results.jsonl").read_text().splitlines())
        print(f"seed {arguments.seed}: {kills} kills in {rounds} batches of {arguments.recordings} recordings "
              f"({lines} results, {seconds:.2f} s undisturbed): all {len(whole)} final files are the same; "
              f"{three} times three kills hit the same fit, which a further --resume tried again")
        sys.exit(0 if kills == arguments.kills else f"only {kills} kills found a batch at work")
    finally:
        if sys.exc_info()[0] is SystemExit and sys.exc_info()[1].code in (0, None):
            shutil.rmtree(folder)


main()
