#!/usr/bin/env bash
# pip_install.sh: installs the Python module by pip from a fresh clone of HEAD into a virtual environment of its own, uses it from another
# folder, and names the libraries that it needs beside those of its own packages. Some minutes: the library is built.
set -euo pipefail
project=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

git clone --quiet "$project" "$work/slipfit"
/usr/bin/python3 -m venv --system-site-packages "$work/environment"
begin=$SECONDS
(cd "$work/slipfit" && "$work/environment/bin/pip" install --quiet . --no-build-isolation)
echo "pip install: $((SECONDS - begin)) s"
cd "$work"
env -u PYTHONPATH environment/bin/python -c "
import slipfit as sf
fit = sf.fit(sf.read_recording('slipfit/testdata/demo.csv', speed='10 mm/s'))
assert fit.stiffness.ci95[0] < 5000 < fit.stiffness.ci95[1]
assert '/environment/' in sf.__file__, sf.__file__
print(repr(fit))"
module=$(echo environment/lib/python3*/site-packages/slipfit/_slipfit*.so)
if ldd "$module" | grep 'not found'; then exit 1; fi
echo "needs: $(objdump -p "$module" | awk '/NEEDED/ {print $2}' | tr '\n' ' ')"
environment/bin/pip uninstall --quiet --yes slipfit
[ ! -e "$module" ] || { echo "pip_install.sh: something is left after removal" >&2; exit 1; }
echo "installed, used and removed by pip"
