#!/usr/bin/env bash
# compare_builds.sh REFERENCE OTHER...: the same recordings through builds of slipfit (the programs; other compilers, -O2, -O3).
# Fails where a parameter differs by more than 1 % of its standard error, or a status or verdict differs.
set -euo pipefail
project="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
[ $# -ge 2 ] || { sed -n '2,3s/^# //p' "$0" >&2; exit 2; }

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp "$project/testdata/demo.csv" "$folder"
seed=0
for noise in 0.003 0.02 0.08; do
  for zeta in 0.01 0.06 0.15; do
    for rate in 100 700 2000; do
      seed=$((seed + 1))
      "$1" simulate --stiffness 1000 --natural-frequency 200 --damping-ratio $zeta --static-friction 6 --kinetic-friction 4 --speed 0.01 \
        --duration 10 --sample-rate $rate --noise $noise --jitter 0.05 --seed $seed --quiet --out "$folder/$seed.csv"
    done
  done
done

number=0
for program in "$@"; do
  mkdir "$folder/$number"
  for recording in "$folder"/*.csv; do
    "$program" fit "$recording" --speed 10mm/s --json --quiet --out "$folder/$number/$(basename "$recording" .csv).json"
  done
  number=$((number + 1))
done

python3 - "$folder" "$@" <<'PYTHON'
import json
import pathlib
import sys

folder, programs = pathlib.Path(sys.argv[1]), sys.argv[2:]
faults = 0
for number, program in enumerate(programs[1:], 1):
    worst, compared = 0.0, 0
    for file in sorted((folder / "0").glob("*.json")):
        first, second = json.loads(file.read_text()), json.loads((folder / str(number) / file.name).read_text())
        if first["status"] != second["status"] or first.get("parameters", {}).keys() != second.get("parameters", {}).keys():
            faults += 1
            print(f"{file.stem}: {first['status']} and {second['status']}, or other parameters")
            continue
        for name, one in first.get("parameters", {}).items():
            other = second["parameters"][name]
            if one["status"] != other["status"]:
                faults += 1
                print(f"{file.stem} {name}: {one['status']} and {other['status']}")
            elif one["se"] and other["se"]:
                off = max(abs(one["value"] - other["value"]), abs(one["se"] - other["se"])) / one["se"]
                worst, compared = max(worst, off), compared + 1
    faults += worst > 0.01
    print(f"{program}: {compared} parameters, largest difference {100 * worst:.2g} % of a standard error")
sys.exit(1 if faults else 0)
PYTHON
