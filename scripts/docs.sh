#!/usr/bin/env bash
# docs.sh: the documents as a site, build/site/index.html; a broken link is an error. Installs what is missing, and builds the program
# and the Python module for the pages that are made of them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install_dependencies.sh build docs
cmake --preset release -DSLIPFIT_PYTHON=ON >/dev/null
cmake --build --preset release --target slipfit_cli slipfit_python
PYTHONPATH="$PWD/build/release/python" /usr/bin/python3 scripts/site_pages.py build/release/apps/slipfit build/site-source
mkdocs build --strict --clean --quiet
(printf 'var searchIndex = ' && cat build/site/search/search_index.json) >build/site/search/search_index.js
scripts/site_links.py build/site
echo "wrote build/site/index.html"
