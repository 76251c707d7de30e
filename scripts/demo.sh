#!/usr/bin/env bash
# Installs what is missing, builds the tool and fits the recording that the project ships.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install_dependencies.sh build
log=$(mktemp)
trap 'rm -f "$log"' EXIT
echo "building slipfit into build/tool ..." >&2
build() { cmake --preset tool && cmake --build --preset tool --parallel "$(nproc 2>/dev/null || echo 2)"; }
if ! build >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi

echo '$ slipfit fit testdata/demo.csv --speed 10mm/s' >&2
build/tool/apps/slipfit fit testdata/demo.csv --speed 10mm/s

cat >&2 <<'END'

To call slipfit from anywhere, with its man pages and completion:
cmake --install build/tool (as root into /usr/local), or
cmake --install build/tool --prefix ~/.local (then ~/.local/bin has to be on the PATH).
END
