#!/usr/bin/env bash
# web.sh: slipfit for browsers. Leaves build/web/slipfit.html (one page that opens from disk) and build/web/slipfit.mjs with
# slipfit.wasm (a module for pages and node). The first time it fetches and builds the libraries: docs/browser.md.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install_dependencies.sh web
NODE_PATH="/usr/share/nodejs${NODE_PATH:+:$NODE_PATH}" && export NODE_PATH  # where Debian's emscripten finds acorn
scripts/web_libraries.sh
cmake --preset web
cmake --build --preset web --parallel "${SLIPFIT_JOBS:-2}"
node web/assemble.mjs build/web
scripts/web_sources.sh >build/web/sources
