#!/usr/bin/env bash
# test-web.sh [BUILD]: the German words, which need no build; then the browser version of the last scripts/web.sh against the program
# of BUILD, in node, Chromium and Firefox. Skips, saying so, what is not there, or not of these sources. Screenshots are left in
# build/web-test.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

skip() {
  echo "test-web.sh: skipped, $1"
  exit 0
}

command -v node >/dev/null 2>&1 || skip "no node"
node --test tests/web/german.test.mjs  # needs no build
[ -f build/web/slipfit.html ] || skip "there is no build/web; scripts/web.sh makes it"
[ "$(scripts/web_sources.sh)" = "$(cat build/web/sources)" ] || skip "build/web is of other sources; scripts/web.sh makes it anew"
build=$(realpath "${1:-build/release}")
export SLIPFIT="$build/apps/slipfit"
node --test tests/web/module.test.mjs

(cd tests/browser && npm ci --silent --no-audit --no-fund) || skip "playwright-core cannot be had: the page"
mkdir -p build/web-test
export WEB_PAGE="$PWD/build/web/slipfit.html" SHOTS="$PWD/build/web-test"
for browser in chromium firefox-esr; do
  if ! command -v "$browser" >/dev/null 2>&1; then
    echo "test-web.sh: skipped, no $browser"
    continue
  fi
  BROWSER=$(command -v "$browser") node --test tests/browser/web.test.mjs
done
