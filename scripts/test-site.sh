#!/usr/bin/env bash
# test-site.sh [SITE]: opens the site of scripts/docs.sh (build/site) in a headless Chromium and searches it, from disk and from a static
# server. Screenshots to look at are left in build/site-test. Skips, saying so, where chromium or npm cannot be had.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

skip() {
  echo "test-site.sh: skipped, $1"
  exit 0
}

site=$(realpath "${1:-build/site}")
[ -f "$site/index.html" ] || skip "no $site/index.html; scripts/docs.sh makes it"
scripts/install_dependencies.sh browser || skip "chromium or npm cannot be installed"
command -v chromium >/dev/null 2>&1 || skip "no chromium"
(cd tests/browser && npm ci --silent --no-audit --no-fund) || skip "playwright-core cannot be had"
rm -rf build/site-test
SITE=$site CHROMIUM=$(command -v chromium) SHOTS="$PWD/build/site-test" node --test tests/browser/site.test.mjs
