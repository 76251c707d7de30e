#!/usr/bin/env python3
"""limits.py SLIPFIT DEMO.csv [--long]: too little memory, full disks, endless lines, many columns and rows, odd names.

Each run must end in time with an answer or with one line of error, and leave nothing torn behind. --long: the full sizes
(4 GB lines, 10^6 columns, 10^8 rows), minutes and some gigabytes of memory."""

import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import threading

MEGABYTE = 1 << 20
LONGEST_S = 3600  # of wall clock, on a machine that may be busy


class Fault(Exception):
    """A promise that was not kept."""


def demand(holds, what):
    if not holds:
        raise Fault(what)


def run(command, memory=None, feed=None, cwd=None):
    """Runs without a shell; feed(stdin) writes the input from a thread of its own."""

    def limit():
        if memory:
            resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    process = subprocess.Popen(command, stdin=subprocess.PIPE if feed else subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, preexec_fn=limit, cwd=cwd)
    if feed:
        threading.Thread(target=feed_all, args=(feed, process.stdin), daemon=True).start()
        process.stdin = None
    out, err = process.communicate(timeout=LONGEST_S)
    return subprocess.CompletedProcess(command, process.returncode, out, err)


def feed_all(feed, stream):
    try:
        feed(stream)
        stream.close()
    except BrokenPipeError:
        pass


def demand_error(result, code, *words):
    message = result.stderr.decode("utf-8", errors="replace")
    demand(result.returncode == code, f"exit {result.returncode} in place of {code}: {message[:300]}")
    demand(message.startswith("slipfit: ") and message.count("\n") == 1, f"not one line: {message[:300]}")
    for word in words:
        demand(word in message, f"'{word}' is not in: {message[:300]}")


def answer_or_error(result):
    """The word for what happened."""
    if result.returncode == 0:
        return json.loads(result.stdout)["status"]
    demand_error(result, 3)
    demand("internal error" not in result.stderr.decode(), result.stderr.decode()[:300])
    return result.stderr.decode().strip()


def fit(arguments, file="/dev/stdin"):
    return [arguments.slipfit, "fit", file, "--speed", "10mm/s", "--json"]


def too_little_memory(arguments, folder):
    """From what just starts the program to plenty: never a signal, a torn document or a message from below."""
    if run([arguments.slipfit, "--version"], memory=1 << 30).returncode != 0:
        return "skipped: this program reserves addresses without limit (sanitizers)"
    least = 16 * MEGABYTE
    # Where the system places the stack is random: at the least size one start in five may fail.
    while any(run([arguments.slipfit, "--version"], memory=least).returncode != 0 for _ in range(20)):
        least += 4 * MEGABYTE
    said = set()
    for step in range(60 if arguments.long else 12):
        out = pathlib.Path(folder, "out.json")
        out.write_text("old")
        memory = least + (step * 2 if arguments.long else step * 8) * MEGABYTE
        result = run([*fit(arguments, arguments.demo), "--out", str(out), "--quiet"], memory=memory)
        if result.returncode == 0:
            json.loads(out.read_text())
            said.add("answer")
            continue
        demand_error(result, 3)
        demand("internal error" not in result.stderr.decode(), result.stderr.decode()[:300])
        demand(out.read_text() == "old" and len(os.listdir(folder)) == 1, "the old output is whole, and nothing beside it")
        said.add(result.stderr.decode().strip())
    return f"from {least // MEGABYTE} MB: " + "; ".join(sorted(said))


def full_disk(arguments, folder):
    """Standard output, a device and a table that cannot be written."""
    with open("/dev/full", "wb") as full:
        result = subprocess.run(fit(arguments, arguments.demo), stdout=full, stderr=subprocess.PIPE, check=False)
    demand_error(result, 2, "No space left")
    for option in ("--out", "--cycles", "--curve", "--report"):
        demand_error(run([*fit(arguments, arguments.demo), option, "/dev/full", "--quiet"]), 2, "No space left", option)
    return "one line each"


def small_disk(arguments, folder):
    """A file system of 64 kB that is really full: the old file stays whole, no temporary file is left."""
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", folder], capture_output=True, check=False)
    if mounted.returncode != 0:
        return "skipped: no right to mount"
    try:
        out = pathlib.Path(folder, "curve.csv")
        out.write_text("old")
        result = run([*fit(arguments, arguments.demo), "--curve", str(out), "--quiet"])
        demand_error(result, 2, "No space left")
        demand(out.read_text() == "old" and os.listdir(folder) == ["curve.csv"], "the old output is whole, and alone")
    finally:
        subprocess.run(["umount", folder], check=True)
    return "one line, old file whole"


def small_files_only(arguments, folder):
    """A limit on the size of files (ulimit -f) sends a signal, which must not tear the output."""

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))

    out = pathlib.Path(folder, "curve.csv")
    out.write_text("old")
    result = subprocess.run([*fit(arguments, arguments.demo), "--curve", str(out), "--quiet"], capture_output=True,
                            preexec_fn=limit, check=False)
    demand_error(result, 2, "File too large")
    demand(out.read_text() == "old" and os.listdir(folder) == ["curve.csv"], "the old output is whole, and alone")
    return "one line, old file whole"


def endless_line(arguments, folder):
    size = (4 << 30) if arguments.long else 64 * MEGABYTE
    block = b"7" * MEGABYTE

    def from_start(stream):
        for _ in range(size // len(block)):
            stream.write(block)

    def behind_rows(stream):
        stream.write(b"time_s,force_N\n" + b"".join(b"%d,%d\n" % (i, i % 7) for i in range(20_000)))
        from_start(stream)

    demand_error(run(fit(arguments), memory=arguments.memory, feed=from_start), 3)
    result = run(fit(arguments), memory=arguments.memory, feed=behind_rows)
    demand_error(result, 3, "longer than 16 MB")
    return f"{size >> 20} MB: " + result.stderr.decode().strip()


def many_columns(arguments, folder):
    count = 10**6 if arguments.long else 10**5
    said = []
    for name, row in (("zeros", b"0," * count + b"0\n"), ("numbers", b",".join(b"%d" % i for i in range(count)) + b"\n"),
                      ("names", b",".join(b"force_%d" % i for i in range(count)) + b"\n")):
        result = run(fit(arguments), memory=arguments.memory, feed=lambda stream, row=row: [stream.write(row) for _ in range(20)])
        said.append(f"{name}: {answer_or_error(result)[:160]}")
    return "; ".join(said)


def many_rows(arguments, folder):
    count = 10**8 if arguments.long else 10**6

    def zeros(stream):
        for _ in range(count // 10_000):
            stream.write(b"0,0\n" * 10_000)

    def standing_still(stream):
        stream.write(b"time_s,force_N\n")
        fractions = [b".%04d,0\n" % i for i in range(10_000)]
        for second in range(count // 10_000):
            stream.write(b"".join(b"%d%s" % (second, fraction) for fraction in fractions))

    said = [answer_or_error(run(fit(arguments), memory=arguments.memory, feed=zeros))[:160],
            answer_or_error(run(fit(arguments), memory=arguments.memory, feed=standing_still))[:160]]
    return f"{count} rows: " + "; ".join(said)


ODD_NAMES = ["with blank.csv", "line\nbreak.csv", "quote'\".csv", "$(touch hurt).csv", "`touch hurt`.csv", ";touch hurt.csv", "-dash.csv",
             "--speed", "größe µ.csv", "\udcff\udcfe.csv", "=1+1.csv", "%s%n.csv", "{}.csv", "*.csv", "\\.csv", "x" * 251 + ".csv"]


def odd_names(arguments, folder):
    demo = pathlib.Path(arguments.demo).read_bytes()
    slipfit = os.path.abspath(arguments.slipfit)
    for name in ODD_NAMES:
        encoded = os.fsencode(name)
        with open(os.path.join(os.fsencode(folder), encoded), "wb") as file:
            file.write(demo)
        for path in (b"./" + encoded, os.path.join(os.fsencode(folder), encoded)):
            result = run([slipfit, "fit", path, "--speed", "10mm/s", "--json"], cwd=folder)
            demand(answer_or_error(result) == "stick_slip", f"{name!r}: {result.stderr[:200]}")
        behind = run([slipfit, "fit", "--speed", "10mm/s", "--json", "--", encoded], cwd=folder)
        demand(behind.returncode == 0, f"{name!r} behind --: {behind.stderr[:200]}")
        for option in ("--out", "--cycles", "--curve", "--report"):
            output = b"./" + (encoded[:-6] + b"_.html" if option == "--report" else encoded[:-2] + b".o")
            result = run([slipfit, "fit", arguments.demo, "--speed", "10mm/s", "--quiet", option, output], cwd=folder)
            demand(result.returncode == 0, f"{option} {output!r}: {result.stderr[:200]}")
    demand(not os.path.exists(os.path.join(folder, "hurt")), "no name reaches a shell")
    return f"{len(ODD_NAMES)} names as input and output"


def links(arguments, folder):
    """Input and output through links: the output never is the input, a link stays a link, a loop is one line."""
    demo = pathlib.Path(folder, "demo.csv")
    content = pathlib.Path(arguments.demo).read_bytes()
    demo.write_bytes(content)
    pathlib.Path(folder, "link.csv").symlink_to("demo.csv")
    os.link(demo, pathlib.Path(folder, "hard.csv"))
    pathlib.Path(folder, "loop.csv").symlink_to("loop.csv")
    pathlib.Path(folder, "nowhere.csv").symlink_to("missing/file.csv")
    pathlib.Path(folder, "sub").symlink_to(".")
    for name in ("demo.csv", "link.csv", "hard.csv", "sub/demo.csv", "sub/../" + os.path.basename(folder) + "/demo.csv", "./demo.csv"):
        for option in ("--out", "--cycles", "--curve", "--report"):
            demand_error(run([*fit(arguments, str(demo)), option, os.path.join(folder, name)]), 2, option)
            demand_error(run([*fit(arguments, os.path.join(folder, name)), option, str(demo)]), 2, option)
    demand(demo.read_bytes() == content, "the recording is untouched")
    demand_error(run(fit(arguments, os.path.join(folder, "loop.csv"))), 3)
    demand_error(run(fit(arguments, os.path.join(folder, "nowhere.csv"))), 3)
    for name in ("loop.csv", "nowhere.csv"):
        result = run([*fit(arguments, str(demo)), "--out", os.path.join(folder, name), "--quiet"])
        demand(result.returncode in (0, 2), f"--out {name}: exit {result.returncode}")
    return "refused where they are the input"


def batch(arguments, folder, out, *options, **limits):
    return run([arguments.slipfit, "batch", os.path.join(folder, "runs.csv"), "--out", out, "--resume", "--quiet", *options], **limits)


def write_batch(arguments, folder):
    """Eight recordings, and what an undisturbed batch makes of them."""
    for i in range(8):
        model = "--stiffness 1000 --natural-frequency 200 --damping-ratio 0.05 --static-friction 6 --kinetic-friction 4".split()
        options = f"--speed 0.02 --duration 1 --sample-rate 1000 --noise 0.02 --seed {i + 1} --quiet".split()
        subprocess.run([arguments.slipfit, "simulate", *model, *options, "--out", f"{folder}/r{i}.csv"], check=True)
    pathlib.Path(folder, "runs.csv").write_text("id,file,speed_m_per_s\n" + "".join(f"x{i},r{i}.csv,0.02\n" for i in range(8)))
    whole = os.path.join(folder, "whole")
    demand(batch(arguments, folder, whole, "--report", whole + "/pages/index.html").returncode == 0, "the undisturbed batch")
    return contents(whole)


def contents(out):
    """Of every file but run.json."""
    return {str(file.relative_to(out)): file.read_bytes() for file in sorted(pathlib.Path(out).rglob("*"))
            if file.is_file() and file.name != "run.json"}


def batch_on_small_disk(arguments, folder, options, larger, sizes):
    """A batch on file systems that fill up at ever later places; enlarged, --resume brings the files of an undisturbed one."""
    whole = write_batch(arguments, folder)
    disk = os.path.join(folder, "disk")
    os.mkdir(disk)
    failed = 0
    for size in sizes:
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", options.format(size), "tmpfs", disk], capture_output=True, check=False)
        if mounted.returncode != 0:
            return "skipped: no right to mount"
        try:
            out = os.path.join(disk, "out")
            result = batch(arguments, folder, out, "--report", out + "/pages/index.html")
            if result.returncode != 0:
                failed += 1
                demand_error(result, 2, "No space left")
                left = [str(file) for file in pathlib.Path(disk).rglob(".*.new")]
                demand(not left, f"left over: {left}")
            subprocess.run(["mount", "-o", "remount," + larger, disk], check=True)
            result = batch(arguments, folder, out, "--report", out + "/pages/index.html")
            demand(result.returncode == 0, f"--resume at {size}: {result.stderr[:300]}")
            demand(contents(out) == whole, f"the files after a disk of {size} are not those of an undisturbed batch")
        finally:
            subprocess.run(["umount", disk], check=True)
    return f"{failed} of {len(sizes)} runs met the end of the disk with one line; --resume brought the same files in all"


def batch_full_disk(arguments, folder):
    step = 64 if arguments.long else 512
    return batch_on_small_disk(arguments, folder, "size={}k", "size=64m", list(range(8, 4096, step)))


def batch_without_inodes(arguments, folder):
    return batch_on_small_disk(arguments, folder, "nr_inodes={}", "nr_inodes=1000", list(range(2, 24, 1 if arguments.long else 4)))


def batch_little_memory(arguments, folder):
    """From what just starts the program: never an abort; recordings that found no memory are failures, fitted by --resume."""
    whole = write_batch(arguments, folder)
    if run([arguments.slipfit, "--version"], memory=1 << 30).returncode != 0:
        return "skipped: this program reserves addresses without limit (sanitizers)"
    said = {}
    for megabytes in range(40, 400, 12 if arguments.long else 60):
        out = os.path.join(folder, f"out{megabytes}")
        result = batch(arguments, folder, out, "--jobs", "64", memory=megabytes * MEGABYTE)
        demand(result.returncode in (0, 1, 2, 3, 127), f"{megabytes} MB: exit {result.returncode}: {result.stderr[:300]}")
        said[result.returncode] = said.get(result.returncode, 0) + 1
        result = batch(arguments, folder, out, "--report", out + "/pages/index.html")
        demand(result.returncode == 0 and contents(out) == whole, f"--resume after {megabytes} MB: {result.stderr[:300]}")
    return "exit codes and how often: " + str(said)


def batch_of_another_user(arguments, folder):
    """A lock that another user holds is told with process, host and user."""
    if os.getuid() != 0:
        return "skipped: not root"
    write_batch(arguments, folder)
    os.chmod(folder, 0o755)
    out = os.path.join(folder, "out")
    os.mkdir(out)
    os.chmod(out, 0o777)
    hold = ("import fcntl, os, sys, time; os.setuid(54321); f = open(sys.argv[1], 'w'); fcntl.lockf(f, fcntl.LOCK_EX); "
            "f.write('slipfit batch, process %d on here' % os.getpid()); f.flush(); print(os.getpid(), flush=True); time.sleep(600)")
    holder = subprocess.Popen([sys.executable, "-c", hold, out + "/lock"], stdout=subprocess.PIPE, text=True)
    try:
        process = holder.stdout.readline().strip()
        result = batch(arguments, folder, out)
        demand_error(result, 2, f"process {process}", "on here", "54321")
        return result.stderr.decode().strip()
    finally:
        holder.kill()
        holder.wait()


CHECKS = [batch_full_disk, batch_without_inodes, batch_little_memory, batch_of_another_user, too_little_memory, full_disk, small_disk, small_files_only, endless_line, many_columns, many_rows, odd_names, links]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("slipfit")
    parser.add_argument("demo")
    parser.add_argument("--long", action="store_true")
    parser.add_argument("--only", help="one check, by its name")
    arguments = parser.parse_args()
    arguments.slipfit = os.path.abspath(arguments.slipfit)
    arguments.demo = os.path.abspath(arguments.demo)
    # Enough for 10^8 rows, and an end before the machine's.
    starts = run([arguments.slipfit, "--version"], memory=16 << 30).returncode == 0
    arguments.memory = 16 << 30 if starts else None
    failed = 0
    for check in CHECKS:
        if arguments.only and check.__name__ != arguments.only:
            continue
        with tempfile.TemporaryDirectory() as folder:
            try:
                print(f"{check.__name__}: {check(arguments, folder)}", flush=True)
            except (Fault, ValueError, subprocess.TimeoutExpired) as fault:
                failed += 1
                print(f"{check.__name__}: FAILED, {fault}", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
