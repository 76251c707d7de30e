#!/usr/bin/env python3
"""compare_builds.py REFERENCE OTHER MANIFEST...: the recordings and groups of manifests through two builds of slipfit.

REFERENCE and OTHER are the programs; each manifest goes through `batch --joint-groups` of both. Prints every kind of motion,
status and refusal that differs, the parameters that differ by more than 5 % of a standard error, and a summary; exit 1
where anything differs."""

import json
import pathlib
import subprocess
import sys
import tempfile

BOUND = 0.05  # of a standard error: far below what an interval can show


def results(program, manifest, folder):
    """Documents and failure lines by id."""
    command = [program, "batch", manifest, "--out", str(folder), "--joint-groups", "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(f"{program}: {done.stderr.strip()}")
    documents = [json.loads(line) for line in (folder / "results.jsonl").read_text().splitlines()]
    failures = (folder / "failures.csv").read_text().splitlines()[1:]
    return {d["id"]: d for d in documents} | {line.split(",")[0]: line for line in failures}


def difference(one, other):
    """Of two estimates, in standard errors (where there is none: in widths of the interval)."""
    if (one["value"] is None) != (other["value"] is None):
        return float("inf")
    pairs = list(zip(one["ci95"] or [], other["ci95"] or [])) + ([(one["value"], other["value"])] if one["value"] is not None else [])
    unit = one["se"] or (one["ci95"][1] - one["ci95"][0] if one["ci95"] else 0.0)
    return max((0.0 if a == b else abs(a - b) / unit if unit else float("inf") for a, b in pairs), default=0.0)


def compare(name, one, other):
    """Lines that tell what differs, and the differences of all parameters."""
    if isinstance(one, str) or isinstance(other, str):
        return ([] if one == other else [f"{name}: {one if isinstance(one, str) else 'answered'} | {other if isinstance(other, str) else 'answered'}"]), []
    lines, offs = [], []
    if one.get("status") != other.get("status"):
        lines.append(f"{name}: {one.get('status')} | {other.get('status')}")
    mine, theirs = one.get("parameters", {}), other.get("parameters", {})
    for key in sorted(set(mine) | set(theirs)):
        a, b = mine.get(key), theirs.get(key)
        if a is None or b is None:
            lines.append(f"{name} {key}: {'absent' if a is None else a['status']} | {'absent' if b is None else b['status']}")
            continue
        if a["status"] != b["status"]:
            lines.append(f"{name} {key}: {a['status']} | {b['status']}  ({a['value']} {a['ci95']} | {b['value']} {b['ci95']})")
        off = difference(a, b)
        offs.append((off, f"{name} {key}"))
        if off > BOUND:
            lines.append(f"{name} {key}: off by {off:.2g} se: {a['value']} {a['ci95']} | {b['value']} {b['ci95']}")
    return lines, offs


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    reference, other, manifests = sys.argv[1], sys.argv[2], sys.argv[3:]
    lines, offs, documents = [], [], 0
    for manifest in manifests:
        with tempfile.TemporaryDirectory() as folder:
            one = results(reference, manifest, pathlib.Path(folder) / "one")
            two = results(other, manifest, pathlib.Path(folder) / "two")
        for name in sorted(set(one) | set(two)):
            said, off = compare(name, one.get(name, "missing"), two.get(name, "missing"))
            lines, offs, documents = lines + said, offs + off, documents + 1
    print("\n".join(lines))
    worst = max(offs, default=(0.0, "none"))
    print(f"{documents} documents, {len(offs)} parameters, {sum(off > BOUND for off, _ in offs)} off by more than {BOUND} se, worst {worst[0]:.2g} se ({worst[1]}), {len(lines)} lines")
    sys.exit(1 if lines else 0)


main()
