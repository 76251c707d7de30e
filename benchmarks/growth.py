#!/usr/bin/env python3
"""How the time and memory of a whole `slipfit fit` grow with the samples: command_ratio on simulated recordings of 10^4
to 10^7 samples, 407 to a cycle, static friction that scatters by 5 %, noise of 1 % of F_s - F_k.

growth.py SLIPFIT COMMAND_RATIO [--largest 7] [--cycle-samples 407]

Prints a line for each size and the power of the samples with which the processor time grows (least squares of the
logarithms; the steps between sizes too). The recordings, 200 MB at 10^7, are made in a folder that goes again.
"""

import argparse
import math
import pathlib
import subprocess
import tempfile

MODEL = ("--stiffness 5000 --natural-frequency 900 --damping-ratio 0.05 --static-friction 4 --kinetic-friction 3 "
         "--sample-rate 10000 --noise 0.01 --jitter 0.05 --seed 7").split()
PERIOD_S = 0.0407  # at 10 mm/s
KEYS = ["samples", "whole_command_ms", "ratio_median", "processor_ms", "processor_ratio_median",
        "bytes_a_sample_above_60_MB"]


def simulate(slipfit, samples, speed_m_per_s, file):
    """Names row, then `%.4f,%.7f`."""
    command = [slipfit, "simulate", *MODEL, "--speed", str(speed_m_per_s), "--duration", str(samples / 10000)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as run, open(file, "w") as out:
        out.write("time_s,force_N\n")
        rows = (line for line in run.stdout if line[0].isdigit())
        for _, line in zip(range(samples), rows):
            time_s, force_N = line.split(",")
            out.write(f"{float(time_s):.4f},{float(force_N):.7f}\n")
        run.stdout.read()


def measure(ratio, slipfit, file, speed_m_per_s, runs):
    run = subprocess.run([ratio, slipfit, file, f"{speed_m_per_s} m/s", str(runs)], capture_output=True, text=True,
                         check=True)
    return dict(line.split(maxsplit=1) for line in run.stdout.splitlines())


def slope(points):
    x = [math.log(samples) for samples, _ in points]
    y = [math.log(ms) for _, ms in points]
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("slipfit")
    parser.add_argument("command_ratio")
    parser.add_argument("--largest", type=int, default=7, help="power of ten")
    parser.add_argument("--cycle-samples", type=float, default=407.0)
    arguments = parser.parse_args()
    speed_m_per_s = round(0.01 * PERIOD_S * 10000 / arguments.cycle_samples, 6)
    points = []
    print(",".join(KEYS), flush=True)
    with tempfile.TemporaryDirectory() as folder:
        file = str(pathlib.Path(folder) / "recording.csv")
        for power in range(4, arguments.largest + 1):
            simulate(arguments.slipfit, 10 ** power, speed_m_per_s, file)
            found = measure(arguments.command_ratio, arguments.slipfit, file, speed_m_per_s, 3 if power > 6 else 7)
            print(",".join(found[key] for key in KEYS), flush=True)
            points.append((float(found["samples"]), float(found["processor_ms"])))
    for first, second in zip(points, points[1:]):
        print(f"{first[0]:.0f} to {second[0]:.0f}: power {slope([first, second]):.3f}")
    print(f"processor time grows as samples to the power {slope(points):.3f}")


if __name__ == "__main__":
    main()
