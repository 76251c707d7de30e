#!/usr/bin/env bash
# draw.sh [BUILD]: the pictures of docs/report.md, from the demo recording; the batch's from the screenshot that
# scripts/test-report.sh leaves, where there is one.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."
slipfit="${1:-build/release}/apps/slipfit"
"$slipfit" fit testdata/demo.csv --speed 10mm/s --plots docs/pictures/report --quiet >/dev/null
shot=build/report-test/batch-top.png
if [[ -f $shot ]]; then cp "$shot" docs/pictures/report/batch.png; fi
