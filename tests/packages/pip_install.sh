#!/usr/bin/env bash
# pip_install.sh: makes an sdist of a fresh clone of HEAD and a wheel of that, installs it by pip into a virtual environment of its own, uses
# module and command from another folder, and names the libraries that it needs beside those of its own packages. Some minutes: the library is built.
set -euo pipefail
project=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

git clone --quiet "$project" "$work/slipfit"
/usr/bin/python3 -m venv --system-site-packages "$work/environment"
begin=$SECONDS
(cd "$work/slipfit" && /usr/bin/python3 -c "import sys; from setuptools import build_meta; build_meta.build_sdist(sys.argv[1])" "$work/dist" > "$work/sdist.log")
"$work/environment/bin/pip" wheel --quiet --no-deps --no-build-isolation -w "$work/dist" "$work"/dist/slipfit-*.tar.gz
"$work/environment/bin/pip" install --quiet --no-deps "$work"/dist/slipfit-*.whl
echo "sdist, wheel and pip install: $((SECONDS - begin)) s; $(cd "$work/dist" && du -h --apparent-size ./* | tr '\n\t' '  ')"
cd "$work"
env -u PYTHONPATH environment/bin/python -c "
import slipfit as sf
fit = sf.fit(sf.read_recording('slipfit/testdata/demo.csv', speed='10 mm/s'))
assert fit.stiffness.ci95[0] < 5000 < fit.stiffness.ci95[1]
assert '/environment/' in sf.__file__, sf.__file__
print(repr(fit))"
environment/bin/slipfit fit slipfit/testdata/demo.csv --speed 10mm/s --json > by_command.json
environment/bin/python -m slipfit fit slipfit/testdata/demo.csv --speed 10mm/s --json | cmp - by_command.json
module=$(echo environment/lib/python3*/site-packages/slipfit/_slipfit*.so)
if ldd "$module" | grep 'not found'; then exit 1; fi
echo "needs: $(objdump -p "$module" | awk '/NEEDED/ {print $2}' | tr '\n' ' ')"
environment/bin/pip uninstall --quiet --yes slipfit
[ ! -e "$module" ] || { echo "pip_install.sh: something is left after removal" >&2; exit 1; }
echo "installed, used and removed by pip"
