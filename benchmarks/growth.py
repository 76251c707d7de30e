#!/usr/bin/env python3
"""What a whole `slipfit fit` costs over the floor of reading the file at all: parsing its two columns with fast-cpp-csv-parser and one FFT of that
length, measured in turn (medians). In processor time too, which other users of the machine move less but in which threads add up; and memory.

growth.py SLIPFIT FLOOR [--largest 7] [--cycle-samples 407]     how it grows with the samples: simulated recordings of 10^4 to 10^7 samples, static
                                                                friction that scatters by 5 %, noise of 1 % of F_s - F_k
growth.py SLIPFIT FLOOR --file FILE --speed 10mm/s [--runs 15]  one recording: a names row, then time and force separated by a comma

FLOOR: the program of floor.cpp. Prints a line for each recording and the power of the samples with which the processor time grows (least squares of
the logarithms; the steps between sizes too). The recordings, 200 MB at 10^7, are made in a folder that is deleted."""
import pathlib
import statistics
import subprocess
import tempfile

import numpy

from study import cost, parser

MODEL = ("--stiffness 5000 --natural-frequency 900 --damping-ratio 0.05 --static-friction 4 --kinetic-friction 3 "
         "--sample-rate 10000 --noise 0.01 --jitter 0.05 --seed 7").split()
PERIOD_S = 0.0407  # at 10 mm/s
KEYS = ("samples", "parse_ms", "transform_ms", "whole_command_ms", "ratio", "processor_ms", "processor_ratio", "peak_memory_MB", "bytes_a_sample_above_60_MB")


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


def measure(slipfit, floor, file, speed, runs):
    """The values of KEYS."""
    found, peak_MB = [], 0.0
    for _ in range(runs + 1):
        samples, parse_ms, transform_ms, floor_ms = map(float, cost(floor, file).out.split())
        whole = cost(slipfit, "fit", file, "--speed", speed, "--json")
        if whole.code != 0:
            raise SystemExit(f"growth.py: {whole.error}")
        found.append((parse_ms, transform_ms, 1e3 * whole.wall_s, 1e3 * whole.wall_s / (parse_ms + transform_ms), 1e3 * whole.cpu_s,
                      1e3 * whole.cpu_s / floor_ms))
        peak_MB = max(peak_MB, whole.peak_MB)
    medians = [statistics.median(values) for values in zip(*found[1:])]  # the first warms up
    return (samples, *medians, peak_MB, max(0.0, (peak_MB - 60.0) * 1048576.0 / samples))


def slope(points):
    return numpy.polyfit(*numpy.log(numpy.transpose(points)), 1)[0]


def main():
    words = parser(__doc__)
    words.add_argument("slipfit")
    words.add_argument("floor")
    words.add_argument("--largest", type=int, default=7, help="power of ten")
    words.add_argument("--cycle-samples", type=float, default=407.0)
    words.add_argument("--file")
    words.add_argument("--speed", default="10mm/s")
    words.add_argument("--runs", type=int, default=15)
    given = words.parse_args()
    print(",".join(KEYS), flush=True)
    if given.file:
        print(",".join(f"{value:.4g}" for value in measure(given.slipfit, given.floor, given.file, given.speed, given.runs)))
        return
    speed_m_per_s = round(0.01 * PERIOD_S * 10000 / given.cycle_samples, 6)
    points = []
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "recording.csv"
        for power in range(4, given.largest + 1):
            simulate(given.slipfit, 10 ** power, speed_m_per_s, file)
            found = measure(given.slipfit, given.floor, file, f"{speed_m_per_s} m/s", 3 if power > 6 else 7)
            print(",".join(f"{value:.4g}" for value in found), flush=True)
            points.append((found[0], found[KEYS.index("processor_ms")]))
    for first, second in zip(points, points[1:]):
        print(f"{first[0]:.0f} to {second[0]:.0f}: power {slope([first, second]):.3f}")
    print(f"processor time grows as samples to the power {slope(points):.3f}")


if __name__ == "__main__":
    main()
