#!/usr/bin/env python3
"""commands.py SLIPFIT PROJECT: runs every command line of README.md, docs/*.md and docs/howto/*.md, and holds README's excerpt against the
demo.

A command is an indented line that begins with a program; each document's run in its order, in a folder of their own where the
files that they name were simulated. A command that is neither run nor on the list of exceptions is a failure."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

# Why a line that begins so is not run here.
ELSEWHERE = {
    "scripts/demo.sh": "builds the program again",
    "scripts/web.sh": "builds the browser version; scripts/test-web.sh",
    "scripts/test.sh": "runs this test",
    "array=$(sbatch": "the test batch: Slurm",
    "sbatch": "the test batch: Slurm",
    "python3 examples/dask_batch.py": "tests/python/test_dask.py",
    "coverage": "an hour; benchmarks",
    "python3 benchmarks/": "hours; benchmarks",
    "pip install": "builds the program again; tests/packages/pip_install.sh",
    "cmake --preset": "builds the program again; every build",
    "PYTHONPATH=": "a test or a benchmark in itself",
    "N=20": "the test batch: Slurm",
}
PROGRAMS = re.compile(r"^    ((?:(?:slipfit|coverage|sbatch|cmake|ctest|pip|python3) |array=\$\(sbatch|N=|PYTHONPATH=|scripts/).*)$")
MODEL = ["--stiffness", "1000", "--natural-frequency", "200", "--damping-ratio", "0.05", "--static-friction", "6", "--noise", "0.01"]
COULOMB = [*MODEL, "--kinetic-friction", "4"]
WEAKENING = [*MODEL, "--f0", "3", "--f1", "1", "--alpha=-10"]


def commands_in(document):
    for number, line in enumerate(document.read_text().splitlines(), 1):
        match = PROGRAMS.match(line)
        if match:
            yield number, match.group(1)


def simulate(slipfit, folder, name, options):
    subprocess.run([slipfit, "simulate", *options, "--quiet", "--out", name], cwd=folder, check=True, capture_output=True)


def make_files(slipfit, folder):
    """run7.csv, wet.csv, log.txt (no clock), sweep.csv with a group dry, runs.csv, profile.csv, heights.txt: the names that the documents use."""
    simulate(slipfit, folder, "run7.csv", [*COULOMB, "--speed", "10mm/s", "--duration", "62", "--sample-rate", "500"])
    simulate(slipfit, folder, "wet.csv", [*MODEL, "--kinetic-friction", "4.5", "--speed", "10mm/s", "--duration", "62", "--sample-rate", "500"])
    simulate(slipfit, folder, "slow.csv", [*COULOMB, "--speed", "1.2mm/s", "--duration", "200", "--sample-rate", "4"])
    forces = [line.split(",")[1] for line in (folder / "slow.csv").read_text().splitlines()[2:]]
    (folder / "log.txt").write_text("force_N\n" + "\n".join(forces) + "\n")
    rows = []
    for speed in ("0.02", "0.04", "0.08"):
        simulate(slipfit, folder, f"v{speed}.csv", [*WEAKENING, "--speed", speed, "--duration", "3", "--sample-rate", "1000"])
        rows.append(f"v{speed},v{speed}.csv,{speed},dry\n")
    (folder / "sweep.csv").write_text("id,file,speed_m_per_s,group\n" + "".join(rows))
    (folder / "runs.csv").write_text("id,file,speed_m_per_s\nrun7,run7.csv,0.01\n")
    heights = [(i % 40) / 20 + 0.01 * (i * 7919 % 13) for i in range(2000)]
    (folder / "profile.csv").write_text("x [um],z [um]\n" + "".join(f"{0.5 * i},{h:.3f}\n" for i, h in enumerate(heights)))
    (folder / "heights.txt").write_text("".join(f"{h:.3f}\n" for h in heights))
    os.symlink(slipfit, folder / "slipfit")
    os.symlink(sys.executable, folder / "python3")  # what is checked for its modules is what runs


def is_elsewhere(command):
    word = command.split()[0]
    if word == "scripts/plot_fit.py":
        return subprocess.run([sys.executable, "-c", "import matplotlib"], capture_output=True, check=False).returncode != 0
    return command.startswith(tuple(ELSEWHERE))


def run_document(slipfit, project, document):
    """How many commands ran, and what failed."""
    ran, faults = 0, []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make_files(slipfit, folder)
        os.symlink(project / "scripts", folder / "scripts")
        environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "MPLBACKEND": "Agg"}
        for number, command in commands_in(document):
            if is_elsewhere(command):
                continue
            result = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, capture_output=True, text=True, check=False)
            ran += 1
            if result.returncode != 0:
                faults.append(f"{document.name}:{number}: exit {result.returncode}: {command}\n  {result.stderr.strip()}")
    return ran, faults


def excerpt_faults(slipfit, project):
    """Lines of README's excerpt that the demo does not print."""
    excerpt = re.search(r"The demo prints.*?```\n(.*?)```", (project / "README.md").read_text(), re.S).group(1)
    printed = subprocess.run([slipfit, "fit", "testdata/demo.csv", "--speed", "10mm/s"], cwd=project, capture_output=True, text=True,
                             check=True).stdout.splitlines()
    return [f"README.md: the demo does not print: {line}" for line in excerpt.splitlines() if line != "..." and line not in printed]


def main():
    slipfit, project = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
    total, faults = 0, excerpt_faults(slipfit, project)
    for document in [project / "README.md", *sorted((project / "docs").glob("*.md")), *sorted((project / "docs" / "howto").glob("*.md"))]:
        if not any(not is_elsewhere(command) for _, command in commands_in(document)):
            continue
        ran, failed = run_document(slipfit, project, document)
        total += ran
        faults += failed
    print(f"{total} commands")
    print("\n".join(faults))
    sys.exit(1 if faults or total == 0 else 0)


if __name__ == "__main__":
    main()
