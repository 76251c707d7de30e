#!/usr/bin/env bash
# tidy.sh [FILE...]: clang-tidy over src and apps (or the files named) by .clang-tidy; needs clang-tidy. Half an hour on two cores.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

files=("$@")
[ ${#files[@]} -gt 0 ] || mapfile -t files < <(find src apps -name '*.cpp' | sort)
cmake --preset dev -DCMAKE_CXX_COMPILER_LAUNCHER= >/dev/null
cmake --build --preset dev --target slipfit_report >/dev/null # the sources that the build makes
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$(nproc 2>/dev/null || echo 2)" clang-tidy -p build/dev --quiet
