#!/usr/bin/env bash
# Installs what is missing, builds everything and runs every test; the last lines are ctest's own.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install_dependencies.sh test
jobs=$(nproc 2>/dev/null || echo 2)
cmake --preset release -DSLIPFIT_PYTHON=ON
cmake --build --preset release --parallel "$jobs"
ctest --preset release --parallel "$jobs"
