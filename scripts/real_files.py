#!/usr/bin/env python3
"""real_files.py SLIPFIT [FOLDER]: every file below FOLDER (../shared/data/real) by `info` and `fit`, as a table: rows and columns, steps,
motion, frequency, warnings, and the options that were needed. Where the file has no speed it is taken from the name (`50mm_min`, `v42`
in um/s, `V-10mmps`) or from the README of the recordings; --force-column, --sample-rate only where slipfit refuses the file."""
import json
import pathlib
import re
import subprocess
import sys

# Of folders whose names do not tell it, by their README.
SPEEDS = {"clutch": "0.5mm/s", "giacomel": "10um/s", "guldstrand": "1.198mm/s", "umt": "10mm/s"}


def speed_of(file):
    name = file.name
    for pattern, unit in ((r"(\d+)mm_min", "mm/min"), (r"V-?(\d+)mmps", "mm/s"), (r"_v(\d+)\.", "um/s")):
        match = re.search(pattern, name)
        if match:
            return match[1] + unit
    return SPEEDS.get(file.parent.name)


def run(program, command, file, options):
    done = subprocess.run([program, command, str(file), "--json", "--quiet", *options], capture_output=True, text=True, timeout=600)
    return json.loads(done.stdout) if done.returncode == 0 else None, done.stderr.strip()


def fit(program, file):
    """The document, and the options that it took; more where a message asks for more."""
    options = []
    for _ in range(4):
        document, message = run(program, "fit", file, options)
        if document:
            return document, options, ""
        if "--speed is missing" in message and speed_of(file):
            options += ["--speed", speed_of(file)]
        elif "may each be the force" in message and "channel1" in message:
            options += ["--force-column", "channel1"]
        elif "no time column" in message and file.suffix == ".txt":
            options += ["--sample-rate", "4"]
        else:
            return None, options, message
    return None, options, message


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "../shared/data/real")
    print("| file | rows x columns, steps | options | motion | frequency | warnings |\n|---|---|---|---|---|---|")
    for file in sorted(f for f in folder.rglob("*") if f.is_file()):
        info, message = run(program, "info", file, [])
        held = f"{info['rows']} x {len(info['columns'])}, {len(info['steps'])}" if info else message
        document, options, message = fit(program, file)
        if document:
            hertz = document["frequency"]["value_Hz"]
            told = [document["status"], f"{hertz:.4g} Hz" if hertz else "-", " ".join(w["code"] for w in document["warnings"])]
        else:
            told = ["refused", "-", message.removeprefix("slipfit: ")[:160]]
        print("| " + " | ".join([str(file.relative_to(folder)), held, " ".join(options) or "-", *told]) + " |", flush=True)


main()
