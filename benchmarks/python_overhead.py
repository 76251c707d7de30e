#!/usr/bin/env python3
"""python_overhead.py SLIPFIT [--fits N]: what a fit costs through the module, beside the C++ call in it and beside the program as a subprocess.

PYTHONPATH is the folder of the module (build/release/python). Each quantity N times in turn, wall clock and time on the processor (which other
work on the machine does not lengthen as much): median and quartiles as CSV to standard output. overhead_ms is what sf.fit() of a Recording spends
outside of the C++ fit, in the same call; array_ms a Recording from arrays of doubles, after another process took the caches; array_again_ms the
same again and again; outside_ms the part of array_ms outside of the C++ call; copy_ms what copying the two arrays takes at that moment;
beyond_ms = overhead_ms + outside_ms + copy_ms: what a user of Python waits longer than one of C++ (who checks the samples by the same call);
stiffness_ms the first number read from the result (the document made and parsed); threads: fits a second with one thread and with two."""

import pathlib
import statistics
import time

import numpy
import slipfit as sf
from slipfit import _slipfit

from study import in_parallel, parser, run

DEMO = pathlib.Path(__file__).resolve().parents[1] / "testdata" / "demo.csv"


def now():
    """Milliseconds by the clock, and on the processor by this thread."""
    return 1e3 * numpy.array([time.perf_counter(), time.thread_time()])


def timed(work):
    begin = now()
    result = work()
    return now() - begin, result


def fits_per_second(recording, threads, fits):
    begin = time.perf_counter()
    in_parallel(threads, lambda _: sf.fit(recording), range(fits))
    return fits / (time.perf_counter() - begin)


class Inside:
    """A function of the extension, and the milliseconds of its last call."""

    def __init__(self, name):
        self.function, self.spent = getattr(_slipfit, name), numpy.zeros(2)
        setattr(_slipfit, name, self.call)

    def call(self, *arguments):
        self.spent, result = timed(lambda: self.function(*arguments))
        return result


def main():
    words = parser(__doc__)
    words.add_argument("program")
    words.add_argument("--fits", type=int, default=60)
    arguments = words.parse_args()
    recording = sf.read_recording(DEMO, speed="10 mm/s")
    recorded = (recording.time.copy(), recording.force.copy())
    fitting, taking = Inside("fit"), Inside("take_arrays")
    columns = {name: [] for name in ("cpp_ms", "overhead_ms", "array_ms", "outside_ms", "copy_ms", "beyond_ms", "stiffness_ms", "curve_ms", "read_and_fit_ms", "subprocess_ms", "array_again_ms")}
    for _ in range(arguments.fits):  # in turn, so that what else the machine does meets all alike
        spent, fit = timed(lambda: sf.fit(recording))
        columns["cpp_ms"].append(fitting.spent)
        columns["overhead_ms"].append(spent - fitting.spent)
        columns["array_ms"].append(timed(lambda: sf.Recording(*recorded, speed=0.01))[0])
        columns["outside_ms"].append(columns["array_ms"][-1] - taking.spent)
        columns["stiffness_ms"].append(timed(lambda: fit.stiffness)[0])
        columns["curve_ms"].append(timed(lambda: fit.curve)[0])
        columns["read_and_fit_ms"].append(timed(lambda: sf.fit(sf.read_recording(DEMO, speed="10 mm/s")).to_dict())[0])
        columns["subprocess_ms"].append(timed(lambda: run(arguments.program, "fit", DEMO, "--speed", "10mm/s"))[0])
        columns["copy_ms"].append(timed(lambda: (recorded[0].copy(), recorded[1].copy()))[0])  # as the extension does
        columns["beyond_ms"].append(columns["overhead_ms"][-1] + columns["outside_ms"][-1] + columns["copy_ms"][-1])
    for _ in range(50 * arguments.fits):
        columns["array_again_ms"].append(timed(lambda: sf.Recording(*recorded, speed=0.01))[0])
    print("quantity,lower_quartile,median,upper_quartile,cpu_median")
    print(f"samples,,{len(recording)},,")
    for name, values in columns.items():
        wall, cpu = zip(*values)
        print(name, *(f"{value:.3f}" for value in (*statistics.quantiles(wall, n=4), statistics.median(cpu))), sep=",")
    for threads in (1, 2):
        print(f"fits_per_second_{threads}_threads,,{fits_per_second(recording, threads, 4 * arguments.fits):.1f},,")


if __name__ == "__main__":
    main()
