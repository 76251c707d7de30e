#!/usr/bin/env python3
"""What a file costs by the shape of its trace: `slipfit fit` on recordings of the same number of rows, in processor time
and memory over those of an ordinary recording (first row).

shapes.py SLIPFIT [--rows 1000000] [--limit 120] [--only NAME,...] [--instructions]

Prints a line a shape: name, processor seconds, ratio to the ordinary one, greatest memory in MB, ratio, kind of motion.
With --instructions these are counted by valgrind in place of the seconds, in 10^9, and the memory is valgrind's: what
the check_shapes target does, which does not depend on who else uses the machine. Needs numpy. No recording costs more than three times the ordinary one: exit 1 where one does.
"""

import json
import math
import pathlib
import re
import sys
import tempfile

import numpy

from study import cost, parser

RATE_HZ = 10000.0
SPEED = "10mm/s"
MOST = 3.0
COUNTING = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]


def saw(n, cycle, fall, noise, random, drop_sd=0.0):
    """Straight sticks and falls along half a cosine, in samples; drop 1, middle 3."""
    force = numpy.empty(n)
    at, level = 0, 0.0
    while at < n:
        drop = max(0.1, 1.0 + drop_sd * random.standard_normal())
        stick = max(1, int(round(drop * (cycle - fall))))
        rise = level + drop * numpy.arange(stick) / stick
        down = rise[-1] - drop * 0.5 * (1.0 - numpy.cos(math.pi * numpy.arange(1, fall + 1) / fall)) if fall else []
        piece = numpy.concatenate([rise, down])[: n - at]
        force[at : at + len(piece)] = piece
        at += len(piece)
    return 3.0 + force + noise * random.standard_normal(n)


def shapes(n):
    """Name -> function of a random generator that gives force, or (time, force)."""
    t = numpy.arange(n) / RATE_HZ
    i = numpy.arange(n)

    def ordinary(random, **changes):
        return saw(n, **{"cycle": 402, "fall": 36, "noise": 0.01, "random": random, "drop_sd": 0.05, **changes})

    def at_kept(kept, force):
        return t[kept], force[kept]

    def walk(random):
        return numpy.cumsum(random.standard_normal(n))

    def impulses(random):
        force = ordinary(random)
        force[::10] += 20.0
        return force

    def outliers(random):
        force = ordinary(random)
        force[random.random(n) < 0.05] += 5.0
        return force

    def pauses(random):
        force = ordinary(random)
        force[(i // (n // 20)) % 2 == 1] = 3.0
        return force

    def averaged(random):
        return numpy.convolve(ordinary(random, noise=0.0), numpy.ones(40) / 40, "same") + 0.01 * random.standard_normal(n)

    return {
        "ordinary": ordinary,
        "ordinary_without_noise": lambda random: ordinary(random, noise=0.0),
        "ordinary_alike_to_the_digit": lambda random: ordinary(random, noise=0.0, drop_sd=0.0),
        "ramps_5_Hz": lambda random: saw(n, 2000, 0, 0.01, random),
        "ramps_20_Hz": lambda random: saw(n, 500, 0, 0.01, random),
        "ramps_20_Hz_without_noise": lambda random: saw(n, 500, 0, 0.0, random),
        "ramps_that_scatter": lambda random: saw(n, 2000, 0, 0.01, random, 0.2),
        "cycles_of_4_samples": lambda random: saw(n, 4, 1, 0.01, random),
        "cycles_of_8_samples": lambda random: saw(n, 8, 2, 0.01, random),
        "cycles_of_30_samples": lambda random: saw(n, 30, 4, 0.01, random),
        "five_cycles": lambda random: saw(n, n // 5, n // 60, 0.01, random),
        "fifty_cycles": lambda random: saw(n, n // 50, n // 600, 0.01, random),
        "slow_slips": lambda random: ordinary(random, fall=200),
        "drops_that_scatter": lambda random: ordinary(random, drop_sd=0.5),
        "noise": lambda random: 3.0 + random.standard_normal(n),
        "noise_as_large_as_slips": lambda random: ordinary(random, noise=0.3),
        "random_walk": walk,
        "constant": lambda random: numpy.full(n, 3.0),
        "one_ramp": lambda random: 1e-5 * i + 0.01 * random.standard_normal(n),
        "sine": lambda random: 3.0 + numpy.sin(2.0 * math.pi * 25.0 * t),
        "noisy_sine": lambda random: 3.0 + numpy.sin(2.0 * math.pi * 25.0 * t) + 0.05 * random.standard_normal(n),
        "chirp": lambda random: 3.0 + numpy.sin(2.0 * math.pi * (5.0 + 2.0 * t) * t) + 0.01 * random.standard_normal(n),
        "square_wave": lambda random: 3.0 + numpy.sign(numpy.sin(2.0 * math.pi * 25.0 * t)) + 0.01 * random.standard_normal(n),
        "two_values": lambda random: (ordinary(random) > 3.5).astype(float),
        "ten_values": lambda random: numpy.round(ordinary(random), 1),
        "impulses": impulses,
        "outliers": outliers,
        "clipped": lambda random: numpy.minimum(ordinary(random), 3.8),
        "wandering_level": lambda random: ordinary(random) + 0.003 * walk(random),
        "hum": lambda random: ordinary(random) + 0.3 * numpy.sin(2.0 * math.pi * 50.0 * t),
        "hum_in_step": lambda random: ordinary(random, cycle=200, drop_sd=0.0) + 0.2 * numpy.sin(2.0 * math.pi * 50.0 * t),
        "pick_up": lambda random: ordinary(random) + 0.3 * numpy.sin(2.0 * math.pi * 1000.0 * t),
        "every_sample_twice": lambda random: numpy.repeat(ordinary(random), 2)[:n],
        "every_sample_ten_times": lambda random: numpy.repeat(ordinary(random), 10)[:n],
        "averaged": averaged,
        "one_gap": lambda random: (t + numpy.where(i > n // 2, 1000.0, 0.0), ordinary(random)),
        "rows_missing": lambda random: at_kept(random.random(n) > 0.01, ordinary(random)),
        "uneven_clock": lambda random: (t + 0.2 / RATE_HZ * random.random(n), ordinary(random)),
        "clock_to_10_ms": lambda random: (numpy.round(t, 2), ordinary(random)),
        "pauses": pauses,
        "speed_that_steps": lambda random: numpy.concatenate(
            [saw(n // 2, 402, 36, 0.01, random), saw(n - n // 2, 1200, 36, 0.01, random)]),
        "there_and_back": lambda random: ordinary(random) * numpy.where((i // (n // 10)) % 2 == 1, -1.0, 1.0),
    }


def write(made, file):
    time_s, force = made if isinstance(made, tuple) else (numpy.arange(len(made)) / RATE_HZ, made)
    with open(file, "w") as out:
        out.write("time_s,force_N\n")
        for begin in range(0, len(force), 100000):
            rows = zip(time_s[begin : begin + 100000], force[begin : begin + 100000])
            out.write("".join(f"{time:.5f},{value:.7f}\n" for time, value in rows))


def measure(command, file, limit_s):
    """Processor seconds or instructions in 10^9, MB, kind of motion."""
    done = cost(*command, "fit", file, "--speed", SPEED, "--json", "--quiet", limit_s=limit_s)
    motion = json.loads(done.out)["status"] if done.out else "refused" if done.error.strip() else "not ended"
    counted = re.search(r"I +refs: +([0-9,]+)", done.error)
    return 1e-9 * int(counted[1].replace(",", "")) if counted else done.cpu_s, done.peak_MB, motion


def main():
    words = parser(__doc__)
    words.add_argument("slipfit")
    words.add_argument("--rows", type=int, default=1000000)
    words.add_argument("--limit", type=int, default=120, help="processor seconds")
    words.add_argument("--instructions", action="store_true")
    words.add_argument("--only", help="names, separated by commas")
    arguments = words.parse_args()
    made = shapes(arguments.rows)
    command, runs = ([*COUNTING, arguments.slipfit], 1) if arguments.instructions else ([arguments.slipfit], 3)
    names = list(made) if not arguments.only else ["ordinary", *arguments.only.split(",")]
    usual = None
    worst = 0.0
    print(f"shape,{'giga_instructions' if arguments.instructions else 'processor_s'},ratio,memory_MB,memory_ratio,motion", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            file = pathlib.Path(folder) / "recording.csv"
            write(made[name](numpy.random.default_rng(7)), file)
            measured = min((measure(command, file, arguments.limit) for _ in range(runs)), key=lambda m: m[0])
            usual = usual or measured
            ratios = measured[0] / usual[0], measured[1] / usual[1]
            worst = max(worst, *ratios)
            print(f"{name},{measured[0]:.2f},{ratios[0]:.2f},{measured[1]:.0f},{ratios[1]:.2f},{measured[2]}", flush=True)
    return 1 if worst > MOST else 0


if __name__ == "__main__":
    sys.exit(main())
