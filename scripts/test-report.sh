#!/usr/bin/env bash
# test-report.sh [BUILD]: opens HTML reports in a headless Chromium, as a test of ctest. Skips, saying so and with exit code 77, where chromium
# or npm is missing; only with CI in the environment it installs them.
# Screenshots to look at are left in build/report-test.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

skip() {
  echo "test-report.sh: skipped, $1"
  exit 77
}

if [ -n "${CI:-}" ] && { ! command -v chromium >/dev/null 2>&1 || ! command -v npm >/dev/null 2>&1; }; then
  scripts/install_dependencies.sh browser || skip "chromium or npm cannot be installed"
fi
command -v chromium >/dev/null 2>&1 || skip "no chromium"
command -v npm >/dev/null 2>&1 || skip "no npm"
(cd tests/browser && npm ci --silent --no-audit --no-fund) || skip "playwright-core cannot be had"

build=$(realpath "${1:-build/release}")
shots="$PWD/build/report-test"
rm -rf "$shots"
SLIPFIT="$build/apps/slipfit" CHROMIUM=$(command -v chromium) SHOTS=$shots \
  node --test tests/browser/report.test.mjs
