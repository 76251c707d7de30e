#!/usr/bin/env bash
# fuzz.sh [SECONDS] [TARGET...]: runs each fuzz target (recording, manifest, unit, fit_document, surface, pipeline) for SECONDS (600), one
# after the other, from the corpus in testdata/fuzz_corpus. Needs clang. Inputs that broke something are left in
# build/fuzz-found/TARGET: mend, then keep a small one in testdata/fuzz_corpus/TARGET, where ctest replays it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

seconds="${1:-600}"
targets=("${@:2}")
[ ${#targets[@]} -gt 0 ] || targets=(pipeline recording fit_document manifest unit surface)

cmake --preset fuzz
cmake --build --preset fuzz --parallel "$(nproc 2>/dev/null || echo 2)"
for target in "${targets[@]}"; do
  found="build/fuzz-found/$target"
  mkdir -p "$found/corpus"
  # One worker that goes on behind a finding; 10 s and 2 GB an input.
  "build/fuzz/tests/fuzz/fuzz_$target" -fork=1 -ignore_crashes=1 -ignore_timeouts=1 -ignore_ooms=1 -print_funcs=0 \
    -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=16384 -artifact_prefix="$found/" \
    "$found/corpus" "testdata/fuzz_corpus/$target" 2>&1 | tee "$found/log" | tail -n 3 || true  # findings are counted below
  findings=$(find "$found" -maxdepth 1 -name '*-*' -type f | wc -l)
  echo "$target: $(grep -c . "$found/log") lines of log, $findings findings in $found"
done
