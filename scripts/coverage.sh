#!/usr/bin/env bash
# coverage.sh: builds with counters, runs the tests and prints line and branch coverage of src/ and include/, folder by folder
# (needs gcovr); the page with every line is build/coverage/report/index.html. Left out are the tests that kill the program or
# limit its files: what they leave of the counters' files spoils the counts of all others.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

jobs=$(nproc 2>/dev/null || echo 2)
cmake --preset coverage
cmake --build --preset coverage --parallel "$jobs"
find build/coverage -name '*.gcda' -delete
# Else messages about counters stand between those of the program, which tests count.
export GCOV_ERROR_FILE="$PWD/build/coverage/gcov_messages"
ctest --preset coverage --parallel "$jobs" --exclude-regex 'killed and resumed|Slurm|^limits:|a full disk ends' --quiet || echo "coverage.sh: some tests failed; the figures are of those that ran" >&2
mkdir -p build/coverage/report
# Branches that only exceptions take are the compiler's, not ours.
gcovr --root . --filter 'src/' --filter 'include/' --exclude-throw-branches \
  --gcov-ignore-parse-errors --csv build/coverage/report/files.csv --html-details build/coverage/report/index.html \
  build/coverage/src build/coverage/apps build/coverage/tests
python3 - build/coverage/report/files.csv <<'PYTHON'
import collections
import csv
import sys

folders = collections.defaultdict(lambda: [0, 0, 0, 0])
for row in csv.DictReader(open(sys.argv[1])):
    parts = row["filename"].split("/")
    name = "/".join(parts[:2]) if len(parts) > 2 else parts[0]
    for total in (folders[name], folders["all"]):
        for i, key in enumerate(("line_covered", "line_total", "branch_covered", "branch_total")):
            total[i] += int(row[key])
print("| folder | lines | of | % | branches | of | % |\n|---|---|---|---|---|---|---|")
for name, (lines, all_lines, branches, all_branches) in sorted(folders.items(), key=lambda item: (item[0] == "all", item[0])):
    print(f"| {name} | {lines} | {all_lines} | {100 * lines / max(1, all_lines):.1f} | {branches} | {all_branches} | "
          f"{100 * branches / max(1, all_branches):.1f} |")
PYTHON
