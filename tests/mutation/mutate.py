#!/usr/bin/env python3
"""mutate.py SLIPFIT RECORDINGS... [--mutants N] [--seed S] [--report] [--plots] [--keep DIR]: recordings damaged at random, and what
slipfit fit says.

RECORDINGS are files or folders. Each mutant must end within 5 s of processor time (other work on the machine does not count):
with exit code 0 and one JSON document whose numbers keep their promises, or with 2 or 3 and one line of error. With --report and
--plots it writes the page and the pictures too, in which no number is infinite. Prints a table by damage and outcome; exit 1
where one broke the rule (kept in DIR)."""

import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile

LONGEST_S = 5
LARGEST_BYTES = 1_000_000  # a quick test needs no long recordings
ENDINGS = {".csv", ".txt", ".tsv", ".dat", ".log", ".asc"}


def lines_of(data):
    return data.splitlines(keepends=True) or [data]


def truncated(data, rng):
    return data[: rng.randrange(len(data))]


def beheaded(data, rng):
    return data[rng.randrange(len(data)):]


def lines_deleted(data, rng):
    lines = lines_of(data)
    share = rng.choice([0.001, 0.05, 0.5, 0.95])
    return b"".join(line for line in lines if rng.random() > share)


def lines_doubled(data, rng):
    share = rng.choice([0.001, 0.05, 0.5])
    return b"".join(line * (2 if rng.random() < share else 1) for line in lines_of(data))


def lines_swapped(data, rng):
    lines = lines_of(data)
    for _ in range(rng.choice([1, 10, 1000])):
        i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
        lines[i], lines[j] = lines[j], lines[i]
    return b"".join(lines)


def bytes_flipped(data, rng):
    changed = bytearray(data)
    for _ in range(rng.choice([1, 10, 1000])):
        changed[rng.randrange(len(changed))] = rng.randrange(256)
    return bytes(changed)


def digits_changed(data, rng):
    changed = bytearray(data)
    for _ in range(rng.choice([1, 10, 1000])):
        at = rng.randrange(len(changed))
        if 48 <= changed[at] <= 57:
            changed[at] = rng.choice(b"0123456789-+.eE")
    return bytes(changed)


def bytes_removed(data, rng):
    start = rng.randrange(len(data))
    return data[:start] + data[start + rng.choice([1, 7, 300, 20000]):]


def glued(data, rng):
    return data + data[rng.randrange(len(data)):]


def encoded(data, rng):
    text = data.decode("utf-8", errors="replace")
    encoding = rng.choice(["utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-8-sig", "cp037", "utf-7"])
    return text.encode(encoding, errors="replace")


def line_ends_changed(data, rng):
    end = rng.choice([b"\r\n", b"\r", b"\n\r", b"\r\r\n", b"\n\n", b"", b"\x00\n", b"\xe2\x80\xa8"])
    return b"\n".join(data.splitlines()).replace(b"\n", end)


def delimiters_changed(data, rng):
    new = rng.choice([b";", b"\t", b" ", b"|", b",,", b"", b'","'])
    data = data.replace(b",", new)
    return data.replace(b".", b",") if new == b";" else data


def quoted_badly(data, rng):
    changed = bytearray(data)
    for _ in range(rng.choice([1, 20])):
        changed.insert(rng.randrange(len(changed)), 34)
    return bytes(changed)


DAMAGE = [truncated, beheaded, lines_deleted, lines_doubled, lines_swapped, bytes_flipped, digits_changed, bytes_removed, glued,
          encoded, line_ends_changed, delimiters_changed, quoted_badly]


def refuse_constant(name):
    raise ValueError(f"{name} is no JSON")


NO_NUMBER = re.compile(r"(?<!\w)(inf|nan)(?!\w)")
MAY_BE_NEGATIVE = re.compile(r"_force_N$|^(static|kinetic)_friction|^(clip|zero)_|^f[01]_N$|^mu[01]$|^alpha|^friction_slope|^ageing_N$|_En$|^(mean_steady|measured)|^level_trend$")


ANY_MAY_BE_NEGATIVE = re.compile("")


def broken_promises(node, key="document", signed=MAY_BE_NEGATIVE):
    """Of a document: a value outside its interval, an interval below 0 where the quantity cannot be, an infinite number in words."""
    if isinstance(node, str) and NO_NUMBER.search(node):
        yield f"{key}: {node}"
    if isinstance(node, list):
        for item in node:
            yield from broken_promises(item, key, signed)
    if not isinstance(node, dict):
        return
    unit = "_Hz" if "value_Hz" in node else ""
    value, ends = node.get("value" + unit), node.get("ci95" + unit)
    if ends and not ends[0] <= (ends[0] if value is None else value) <= ends[1]:
        yield f"{key}: {value} outside {ends}"
    if ends and ends[0] < 0 and not signed.search(key):
        yield f"{key}: {ends} reaches below 0"
    status = node.get("status") if "note" in node else None
    if status in ("identified", "weak", "fixed") and (value is None or ends is None):
        yield f"{key}: {status} without a value or an interval"
    if status == "bounded" and (value is not None or ends is None):
        yield f"{key}: bounded with a value, or without an interval"
    for name, child in node.items():
        yield from broken_promises(child, name, signed)


def bad_pictures(folder):
    """Pages (their scripts aside) and pictures with an infinite number."""
    for file in sorted(pathlib.Path(folder).rglob("*.*ml")) + sorted(pathlib.Path(folder).rglob("*.svg")):
        text = re.sub(r"<script.*?</script>", "", file.read_text(encoding="utf-8", errors="strict"), flags=re.DOTALL)
        found = NO_NUMBER.search(text)
        if found:
            yield f"{file.name}: ...{text[max(0, found.start() - 60):found.end() + 20]}..."


def outcome(slipfit, file, pictures):
    """A word for the table, and what is wrong (None: nothing). `pictures`: options that write them into the folder FILE.out."""
    folder = pathlib.Path(file + ".out")
    folder.mkdir()
    places = {"--report": folder / "page.html", "--plots": folder / "plots"}
    command = ["prlimit", f"--cpu={LONGEST_S}", "--as=4000000000", "--", slipfit, "fit", file, "--speed", "10mm/s", "--json", "--quiet"]
    command += [word for option in pictures for word in (option, str(places[option]))]
    try:
        return outcome_of(command, folder)
    finally:
        shutil.rmtree(folder)


def outcome_of(command, folder):
    run = subprocess.run(command, capture_output=True, timeout=100 * LONGEST_S, check=False)
    word, fault = judged(run, LONGEST_S)
    broken = [*bad_pictures(folder)] if run.returncode == 0 and fault is None else []
    return ("broken promise", "; ".join(broken)) if broken else (word, fault)


def judged(run, longest_s, signed=MAY_BE_NEGATIVE):
    """A word for what a finished command answered, and what is wrong with it (None: nothing). `longest_s`: its processor time. `signed`:
    keys of quantities that may be negative."""
    if -run.returncode in (signal.SIGXCPU, signal.SIGKILL):
        return "too long", f"no end within {longest_s} s"
    if run.returncode == 0:
        try:
            document = json.loads(run.stdout, parse_constant=refuse_constant)
        except ValueError as error:
            return "bad JSON", str(error)
        broken = [*broken_promises(document, signed=signed)]
        return ("broken promise", "; ".join(broken)) if broken else (document.get("status", "compared"), None)
    message = run.stderr.decode("utf-8", errors="replace")
    if run.returncode not in (2, 3):
        return f"exit {run.returncode}", f"exit {run.returncode} {message}"  # a program that crashes says nothing
    is_one_line = message.startswith("slipfit: ") and message.endswith("\n") and message.count("\n") == 1
    if "internal error" in message or not is_one_line or run.stdout:
        return "bad error", message
    return f"exit {run.returncode}", None


def files_in(places):
    files = []
    for place in map(pathlib.Path, places):
        found = sorted(place.rglob("*")) if place.is_dir() else [place]
        files += [file for file in found if file.suffix.lower() in ENDINGS and "fuzz_corpus" not in file.parts]
    return files


def mutant(source, seed):
    """One to three damages; reproducible from its seed."""
    rng = random.Random(seed)
    data = source.read_bytes()[:LARGEST_BYTES]
    chosen = rng.choices(DAMAGE, k=rng.choice([1, 1, 2, 3]))
    for damage in chosen:
        data = damage(data, rng) if data else data
    return data, chosen[0].__name__


def try_mutant(slipfit, folder, source, seed, pictures):
    data, damage = mutant(source, seed)
    file = pathlib.Path(folder) / f"{seed}.csv"
    file.write_bytes(data)
    word, fault = outcome(slipfit, str(file), pictures)
    file.unlink()
    return source, seed, damage, word, fault, None if fault is None else data


def print_table(counts):
    words = sorted({word for row in counts.values() for word in row})
    print("| first damage | " + " | ".join(words) + " |")
    print("|---|" + "---|" * len(words))
    rows = [*counts.items(), ("all", sum(counts.values(), collections.Counter()))]
    for damage, row in rows:
        print(f"| {damage} | " + " | ".join(str(row[word]) for word in words) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("slipfit")
    parser.add_argument("recordings", nargs="+")
    parser.add_argument("--mutants", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--report", action="store_true")
    parser.add_argument("--plots", action="store_true")
    parser.add_argument("--keep")
    arguments = parser.parse_args()
    pictures = [option for option in ("--report", "--plots") if getattr(arguments, option[2:])]
    files = files_in(arguments.recordings)
    if not files:
        sys.exit("no recordings found")
    if arguments.keep:
        pathlib.Path(arguments.keep).mkdir(parents=True, exist_ok=True)
    counts = collections.defaultdict(collections.Counter)
    faults = 0
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        jobs = [pool.submit(try_mutant, arguments.slipfit, folder, files[i % len(files)], arguments.seed * 1_000_000 + i, pictures)
                for i in range(arguments.mutants)]
        for job in concurrent.futures.as_completed(jobs):
            source, seed, damage, word, fault, data = job.result()
            counts[damage][word] += 1
            if fault is None:
                continue
            faults += 1
            print(f"{source} seed {seed} ({damage}): {fault}")
            if arguments.keep:
                pathlib.Path(arguments.keep, f"{seed}.csv").write_bytes(data)
    print(f"{arguments.mutants} mutants of {len(files)} recordings, seed {arguments.seed}, {faults} broke the rule\n")
    print_table(dict(sorted(counts.items())))
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
