#!/usr/bin/env python3
"""processes.py SLIPFIT: whatever ends a batch or a fit, no program that it started outlives it, not even one that is stopped; and a batch
that is suspended suspends its processes and loses no recording to --timeout.

Linux. Exit 77 where slipfit was built without its reader of MATLAB files."""

import array
import contextlib
import os
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import time

SLIPFIT = pathlib.Path(sys.argv[1]).resolve()
READER = "slipfit-hdf5"
LONGEST_S = 30
MODEL = ["--stiffness", "1000", "--natural-frequency", "200", "--damping-ratio", "0.05", "--static-friction", "6", "--kinetic-friction", "4",
         "--speed", "0.02", "--duration", "2", "--sample-rate", "2000", "--noise", "0.02"]


def wait_until(condition, what):
    """The first true value of the condition."""
    end = time.monotonic() + LONGEST_S
    while time.monotonic() < end:
        if value := condition():
            return value
        time.sleep(0.002)
    raise AssertionError(f"{what}: not within {LONGEST_S} s")


def stat_of(pid):
    """Name, state and parent of a process, or None."""
    try:
        text = pathlib.Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return None
    name, rest = text.split("(", 1)[1].rsplit(")", 1)
    state, parent = rest.split()[:2]
    return name, state, int(parent)


def is_alive(pid):
    stat = stat_of(pid)
    return stat is not None and stat[1] not in "ZX"


def descendants(pid):
    stats = {int(entry.name): stat_of(entry.name) for entry in pathlib.Path("/proc").iterdir() if entry.name.isdigit()}
    found = [pid]
    for parent in found:
        found += [child for child, stat in stats.items() if stat is not None and stat[2] == parent]
    return found[1:]


def is_set_up(pid):
    """Whether the reader has come past the start of its main function, where it limits itself."""
    try:
        limits = pathlib.Path(f"/proc/{pid}/limits").read_text()
    except OSError:
        return False
    return any(line.startswith("Max cpu time") and "unlimited" not in line for line in limits.splitlines())


def reader_of(pid):
    return next((child for child in descendants(pid) if (stat_of(child) or [""])[0] == READER and is_set_up(child)), None)


def mat_file(file, count=2_000_000):
    """Large enough that the reader is still at work when it is found."""
    def element(kind, content):
        return struct.pack("<II", kind, len(content)) + content + bytes(-len(content) % 8)
    content = b"MATLAB 5.0 MAT-file, by hand".ljust(124) + struct.pack("<HH", 0x0100, 0x4D49)
    for name in (b"time_s", b"force_N"):
        values = array.array("d", range(count)).tobytes()
        content += element(14, element(6, struct.pack("<II", 6, 0)) + element(5, struct.pack("<ii", count, 1)) + element(1, name) + element(9, values))
    file.write_bytes(content)


@contextlib.contextmanager
def started(*arguments):
    process = subprocess.Popen([SLIPFIT, *map(str, arguments)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


@contextlib.contextmanager
def stopped_reader(process):
    """The reader that the process has started, stopped by a signal: only being killed ends it now."""
    reader = wait_until(lambda: reader_of(process.pid), READER)
    os.kill(reader, signal.SIGSTOP)
    try:
        yield reader
        wait_until(lambda: not is_alive(reader), f"the end of {READER}")
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.kill(reader, signal.SIGKILL)


def check_ends(name, send, *arguments):
    """`send` ends the process in some way; the reader ends, too."""
    print(name)
    with started(*arguments) as process, stopped_reader(process):
        send(process)
        process.wait(LONGEST_S)


def check_signals_of_reader(folder, manifest):
    with started("batch", manifest, "--out", folder / "signals", "--jobs", "1") as process:
        reader = wait_until(lambda: reader_of(process.pid), READER)
        status = pathlib.Path(f"/proc/{reader}/status").read_text()
        ignored = int(next(line for line in status.splitlines() if line.startswith("SigIgn:")).split()[1], 16)
        for number in (signal.SIGINT, signal.SIGTERM):
            assert not ignored >> (number - 1) & 1, f"{READER} ignores {number!r}"


def fifo_batch(folder):
    os.mkfifo(folder / "fifo.csv")
    manifest = folder / "fifo_runs.csv"
    manifest.write_text("id,file,speed_m_per_s\nfifo,fifo.csv,0.02\n")
    return manifest



def check_suspended(folder, how):
    """`how`: SIGSTOP, which reaches the batch alone, or SIGTSTP (Ctrl-Z)."""
    print(f"suspended by {how.name}")
    manifest = folder / "fifo_runs.csv"
    recording = subprocess.run([SLIPFIT, "simulate", *MODEL], capture_output=True, check=True).stdout
    with started("batch", manifest, "--out", folder / how.name, "--timeout", "2s") as process:
        child = wait_until(lambda: next(iter(descendants(process.pid)), None), "a process of the batch")
        time.sleep(0.3)  # until it waits for the recording
        process.send_signal(how)
        wait_until(lambda: stat_of(process.pid)[1] == "T", "suspension")
        if how == signal.SIGTSTP:
            wait_until(lambda: stat_of(child)[1] == "T", "suspension of the fits")
        time.sleep(3)
        process.send_signal(signal.SIGCONT)
        time.sleep(0.3)
        with open(os.open(folder / "fifo.csv", os.O_WRONLY | os.O_NONBLOCK), "wb") as pipe:  # fails if nobody reads it
            os.set_blocking(pipe.fileno(), True)
            pipe.write(recording)
        _, messages = process.communicate(timeout=LONGEST_S)
        assert process.returncode == 0, f"exit {process.returncode}: {messages}"


def main():
    if not SLIPFIT.with_name(READER).exists():
        sys.exit(77)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        mat_file(folder / "long.mat")
        manifest = folder / "runs.csv"
        manifest.write_text("id,file,speed_m_per_s\nlong,long.mat,0.02\n")
        batch = ["batch", manifest, "--jobs", "1", "--out"]
        check_signals_of_reader(folder, manifest)
        check_ends("fit, killed", lambda process: process.kill(), "fit", folder / "long.mat", "--speed", "0.02")
        check_ends("batch, killed", lambda process: process.kill(), *batch, folder / "killed")
        check_ends("batch, terminated", lambda process: process.terminate(), *batch, folder / "terminated")
        check_ends("batch, timed out", lambda process: None, *batch, folder / "timed_out", "--timeout", "1s")
        fifo_batch(folder)
        for how in (signal.SIGSTOP, signal.SIGTSTP):
            check_suspended(folder, how)
    print("nothing outlives slipfit")


main()
