#!/usr/bin/env bash
# tidy.sh [--changed | FILE...]: clang-tidy by .clang-tidy over src, apps and python/src (half an hour on two cores), over what differs
# from origin/main, or over the files named. Without clang-tidy --changed does nothing; without pybind11 python/src is left out.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

files=("$@")
if [ "${1:-}" = --changed ]; then
  command -v clang-tidy >/dev/null || exit 0
  base=$(git merge-base HEAD origin/main 2>/dev/null || true)
  [ "$base" != "$(git rev-parse HEAD)" ] && [ -n "$base" ] || base=HEAD~1
  mapfile -t files < <(git diff --name-only --diff-filter=d "$base" -- 'src/*.cpp' 'apps/*.cpp' 'python/src/*.cpp' ':!apps/slipfit-web')  # which needs emscripten
  [ ${#files[@]} -gt 0 ] || exit 0
  if [ ${#files[@]} -gt 12 ]; then
    echo "${#files[@]} files differ from origin/main: scripts/tidy.sh takes a while, run it by hand" >&2
    exit 0
  fi
elif [ ${#files[@]} -eq 0 ]; then
  mapfile -t files < <(find src apps python/src -name '*.cpp' -not -path 'apps/slipfit-web/*' | sort)
fi
commands=build/tidy-commands
configure() { cmake --preset dev -B "$commands" -DCMAKE_CXX_COMPILER_LAUNCHER= "$@" >/dev/null; }
if ! configure -DSLIPFIT_PYTHON=ON 2>/dev/null; then
  configure -DSLIPFIT_PYTHON=OFF
  echo "tidy.sh: python/src is left out: no pybind11 (scripts/install_dependencies.sh python)" >&2
  mapfile -t files < <(printf '%s\n' "${files[@]}" | grep -v '^python/src/' || true)
  [ ${#files[@]} -gt 0 ] || exit 0
fi
cmake --build "$commands" --target src/core/remedies.hpp src/report/commit_identity.hpp src/batch/build_identity.hpp >/dev/null
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$(nproc 2>/dev/null || echo 2)" clang-tidy -p "$commands" --quiet
