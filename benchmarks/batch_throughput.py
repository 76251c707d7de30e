#!/usr/bin/env python3
"""batch_throughput.py SLIPFIT [--recordings 2000] [--samples 4000] [--missing 1000000]: throughput, processor time and memory of `slipfit batch`.

Simulated recordings at 1 kHz, each with its own seed and stiffness, with one job and two; and a manifest whose files are all missing, with which only
the batch itself remains. The processor time, of all threads and processes, does not depend on who else uses the machine."""
import pathlib
import subprocess
import tempfile

from study import cost, in_parallel, parser

SPEED_M_PER_S, RATE_HZ = 0.02, 1000


def write_manifest(file, rows):
    file.write_text("id,file,speed_m_per_s\n" + "".join(f"{name},{path},{SPEED_M_PER_S}\n" for name, path in rows))
    return file


def simulate(slipfit, file, number, samples):
    model = {"stiffness": 800 + number % 17 * 25, "natural-frequency": 200, "damping-ratio": 0.05, "static-friction": 6, "kinetic-friction": 4,
             "speed": SPEED_M_PER_S, "duration": samples / RATE_HZ, "sample-rate": RATE_HZ, "noise": 0.02, "jitter": 0.05, "seed": number + 1}
    options = [word for name, value in model.items() for word in (f"--{name}", str(value))]
    subprocess.run([slipfit, "simulate", *options, "--out", file, "--quiet"], check=True)


def report(slipfit, name, manifest, out, count, jobs):
    found = cost(slipfit, "batch", manifest, "--out", out, "--jobs", jobs, "--quiet")
    print(f"{name},{found.wall_s:.3f},{count / found.wall_s:.1f},{1e3 * found.cpu_s / count:.3f},{found.peak_MB:.1f}", flush=True)


def main():
    words = parser(__doc__)
    words.add_argument("slipfit")
    words.add_argument("--recordings", type=int, default=2000)
    words.add_argument("--samples", type=int, default=4000)
    words.add_argument("--missing", type=int, default=1000000)
    given = words.parse_args()
    print(f"# {given.recordings} recordings of {given.samples} samples\nwhat,seconds,recordings_per_s,processor_ms_per_recording,resident_MB")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        in_parallel(2, lambda i: simulate(given.slipfit, folder / f"r{i}.csv", i, given.samples), range(given.recordings))
        manifest = write_manifest(folder / "runs.csv", [(f"r{i}", f"r{i}.csv") for i in range(given.recordings)])
        for jobs in (1, 2):
            report(given.slipfit, f"batch --jobs {jobs}", manifest, folder / f"out{jobs}", given.recordings, jobs)
        manifest = write_manifest(folder / "long.csv", [(f"recording-{i}", f"none/{i}.csv") for i in range(given.missing)])
        report(given.slipfit, f"{given.missing} rows of missing files --jobs 2", manifest, folder / "long", given.missing, 2)


if __name__ == "__main__":
    main()
