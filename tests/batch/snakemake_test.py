#!/usr/bin/env python3
"""snakemake_test.py SLIPFIT SNAKEFILE: the rules for Snakemake, against one machine. Exit code 77, saying why, where there is no Snakemake."""

import pathlib
import shutil
import subprocess
import sys
import tempfile

FILES = ("results.jsonl", "summary.csv", "failures.csv")
MODEL = "--stiffness 1000 --natural-frequency 200 --damping-ratio 0.05 --static-friction 6 --kinetic-friction 4".split()
RECORDINGS = 12
PARTS = 3


def write_manifest(slipfit, folder):
    """One of the recordings is missing."""
    rows = ["id,file,speed_m_per_s"]
    for i in range(RECORDINGS):
        if i != 5:
            subprocess.run([slipfit, "simulate", *MODEL, "--speed", "0.02", "--duration", "1", "--sample-rate", "500", "--noise", "0.02",
                            "--seed", str(i + 1), "--out", str(folder / f"r{i}.csv")], check=True, stderr=subprocess.DEVNULL)
        rows.append(f"r{i},r{i}.csv,0.02")
    (folder / "runs.csv").write_text("\n".join(rows) + "\n")


def main():
    slipfit, snakefile = sys.argv[1:]
    if shutil.which("snakemake") is None:
        print("skipped: there is no snakemake")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_manifest(slipfit, folder)
        single = subprocess.run([slipfit, "batch", "runs.csv", "--out", "single", "--quiet"], cwd=folder, check=False)
        assert single.returncode == 1, single
        command = ["snakemake", "--snakefile", snakefile, "--cores", "2", "--quiet", "--config", "manifest=runs.csv", "out=results",
                   f"parts={PARTS}", f"slipfit={slipfit}"]
        for _ in range(2):  # the second time there is nothing to do
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
            assert done.returncode == 0, done.stdout + done.stderr
            for file in FILES:
                assert (folder / "results/all" / file).read_bytes() == (folder / "single" / file).read_bytes(), file
    print(f"{RECORDINGS} recordings in {PARTS} parts by Snakemake: the files of one machine")


if __name__ == "__main__":
    main()
