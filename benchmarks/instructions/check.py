#!/usr/bin/env python3
"""Instructions of the hot paths, counted by valgrind's callgrind, against those that expected.json keeps.

check.py HOT_PATHS [--write]

A count does not depend on who else uses the machine, but on compiler and libraries: a path may take a third more before
it fails. --write keeps the counts of this run (a change that moves them says why in its commit).
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

EXPECTED = pathlib.Path(__file__).with_name("expected.json")
MARGIN = 1.33


def count(program, path, folder):
    run = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/out", "--collect-atstart=no",
                          f"--toggle-collect=measured_{path}", program, path, folder], capture_output=True, text=True)
    collected = re.search(r"Collected : (\d+)", run.stderr)
    if run.returncode != 0 or not collected or collected[1] == "0":
        sys.exit(f"check.py: {path} was not counted:\n{run.stderr}")
    return int(collected[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    expected = json.loads(EXPECTED.read_text())
    slower = []
    for path, kept in expected.items():
        with tempfile.TemporaryDirectory() as folder:
            expected[path] = count(arguments.program, path, folder)
        ratio = expected[path] / kept if kept else 1.0
        print(f"{path}: {expected[path]:,} instructions, {ratio:.2f} of what was kept")
        if ratio > MARGIN:
            slower.append(path)
    if arguments.write:
        EXPECTED.write_text(json.dumps(expected, indent=2) + "\n")
    elif slower:
        sys.exit(f"check.py: more than {MARGIN} times the instructions kept: {', '.join(slower)}")


if __name__ == "__main__":
    main()
