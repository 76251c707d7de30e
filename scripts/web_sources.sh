#!/usr/bin/env bash
# web_sources.sh: one line that stands for everything that the browser version is made of.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
find src include apps web cmake CMakeLists.txt CMakePresets.json scripts/web*.sh -type f -print0 | sort -z | xargs -0 sha256sum | sha256sum
