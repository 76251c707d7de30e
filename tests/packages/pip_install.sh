#!/usr/bin/env bash
# pip_install.sh: makes an sdist of a fresh clone of HEAD (without git: of a copy of the sources) and a wheel of that, installs it by pip
# into a virtual environment of its own, uses module and command from another folder, and names the libraries that it needs beside those
# of its own packages. Some minutes: the library is built.
set -euo pipefail
project=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if git -C "$project" rev-parse HEAD >/dev/null 2>&1; then
  git clone --quiet "$project" "$work/slipfit"
else
  mkdir "$work/slipfit"
  tar -C "$project" --exclude=./build -c . | tar -x -C "$work/slipfit"
fi
/usr/bin/python3 -m venv --system-site-packages "$work/environment"
begin=$SECONDS
(cd "$work/slipfit" && PYTHONPATH=python/packaging /usr/bin/python3 -c "import sys, slipfit_backend; slipfit_backend.build_sdist(sys.argv[1])" "$work/dist" > "$work/sdist.log")
grep '^slipfit: built by' "$work/sdist.log"
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
