#!/usr/bin/env bash
# compare_builds.sh REFERENCE OTHER... [-- FILE_OR_FOLDER...]: the same recordings through builds of slipfit (the programs; other
# compilers, -O2, -O3): testdata/demo.csv, 27 simulated ones, and those named or found in the folders, all at 10 mm/s.
# Fails where a parameter differs by more than 1 % of its standard error (without one: of its interval), or a status, a verdict
# or a refusal differs.
set -euo pipefail
project="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
programs=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  programs+=("$1")
  shift
done
[ ${#programs[@]} -ge 2 ] || { sed -n '2,5s/^# //p' "$0" >&2; exit 2; }

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp "$project/testdata/demo.csv" "$folder"
seed=0
for noise in 0.003 0.02 0.08; do
  for zeta in 0.01 0.06 0.15; do
    for rate in 100 700 2000; do
      seed=$((seed + 1))
      "${programs[0]}" simulate --stiffness 1000 --natural-frequency 200 --damping-ratio $zeta --static-friction 6 --kinetic-friction 4 --speed 0.01 \
        --duration 10 --sample-rate $rate --noise $noise --jitter 0.05 --seed $seed --quiet --out "$folder/$seed.csv"
    done
  done
done

mapfile -t recordings < <(
  ls "$folder"/*.csv
  [ $# -lt 2 ] || find "${@:2}" -type f \( -name '*.csv' -o -name '*.txt' -o -name '*.tsv' \) | sort
)

number=0
for program in "${programs[@]}"; do
  mkdir "$folder/$number"
  for i in "${!recordings[@]}"; do
    said="$folder/$number/$i"
    "$program" fit "${recordings[$i]}" --speed 10mm/s --json --quiet --out "$said.json" 2>"$said.err" || mv "$said.err" "$said.refused"
  done
  number=$((number + 1))
done

printf '%s\n' "${recordings[@]}" >"$folder/recordings"
python3 - "$folder" "${programs[@]}" <<'PYTHON'
import json
import pathlib
import sys

folder, programs = pathlib.Path(sys.argv[1]), sys.argv[2:]
recordings = (folder / "recordings").read_text().splitlines()


def answer(number, i):
    refused = folder / str(number) / f"{i}.refused"
    return refused.read_text() if refused.exists() else json.loads((folder / str(number) / f"{i}.json").read_text())


def difference(one, other):
    """In units of the standard error, or of the interval where there is none."""
    if (one["value"] is None, one["se"] is None, one["ci95"] is None) != (other["value"] is None, other["se"] is None, other["ci95"] is None):
        return float("inf")
    pairs = list(zip(one["ci95"] or [], other["ci95"] or []))
    pairs += [(one[key], other[key]) for key in ("value", "se") if one[key] is not None]
    unit = one["se"] or (one["ci95"][1] - one["ci95"][0] if one["ci95"] else 0.0)
    return max((0.0 if a == b else abs(a - b) / unit if unit else float("inf") for a, b in pairs), default=0.0)


faults = 0
for number, program in enumerate(programs[1:], 1):
    worst, where, compared, refused, same = 0.0, "", 0, 0, 0
    for i, recording in enumerate(recordings):
        first, second = answer(0, i), answer(number, i)
        same += first == second
        if isinstance(first, str) or isinstance(second, str):
            refused += 1
            if first != second:
                faults += 1
                print(f"{recording}: refused by one alone, or in other words")
            continue
        parameters, others = first.get("parameters", {}), second.get("parameters", {})
        statuses = [(one["status"], {name: p["status"] for name, p in one.get("parameters", {}).items()}) for one in (first, second)]
        if statuses[0] != statuses[1]:
            faults += 1
            print(f"{recording}: {statuses[0]} and {statuses[1]}")
            continue
        for name, one in parameters.items():
            off = difference(one, others[name])
            compared += 1
            if off > worst:
                worst, where = off, f", {name} of {recording}"
    faults += worst > 0.01
    print(f"{program}: {len(recordings)} recordings ({refused} refused by both, {same} the same in every digit), {compared} parameters, "
          f"largest difference {100 * worst:.2g} % of a standard error{where}")
sys.exit(1 if faults else 0)
PYTHON
