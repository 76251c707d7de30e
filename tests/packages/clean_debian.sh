#!/usr/bin/env bash
# clean_debian.sh RELEASE [--tests] [MIRROR]: in a fresh Debian made by debootstrap (bookworm: 12, trixie: 13) runs scripts/demo.sh of
# this checkout, with --tests scripts/test.sh and tests/packages/pip_install.sh too, and makes the Debian packages; then installs, uses and
# removes these in another fresh one. Says how long each took. Needs root, debootstrap and a mirror; about twenty minutes on two cores,
# with --tests twice that.
set -euo pipefail
usage() {
  echo "clean_debian.sh RELEASE [--tests] [MIRROR]; RELEASE: bookworm or trixie" >&2
  exit 2
}
[[ ${1:-} =~ ^[a-z]+$ ]] || usage
release=$1
shift
with_tests=
if [ "${1:-}" = --tests ]; then with_tests=1 && shift; fi
mirror=${1:-http://deb.debian.org/debian}
project=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
work=$(mktemp -d)
leave() {
  local root
  for root in "$work/builder" "$work/clean"; do
    umount -q "$root/dev/pts" "$root/proc" 2>/dev/null || true
  done
  rm -rf --one-file-system "$work"
}
trap leave EXIT

fresh() {  # ROOT
  debootstrap --variant=minbase "$release" "$1" "$mirror" >"$work/debootstrap.log" || { tail "$work/debootstrap.log" >&2; exit 1; }
  [ ! -d /etc/apt/apt.conf.d ] || cp /etc/apt/apt.conf.d/*proxy* "$1/etc/apt/apt.conf.d/" 2>/dev/null || true
  mount -t proc proc "$1/proc" 2>/dev/null || true
  mount -t devpts -o ptmxmode=0666 devpts "$1/dev/pts" 2>/dev/null || true  # tests open a terminal
}
inside() {  # ROOT COMMAND...
  chroot "$1" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive "${@:2}"
}
timed() {  # NAME COMMAND...
  local begin=$SECONDS
  "${@:2}"
  echo "$release, $1: $((SECONDS - begin)) s"
}

builder="$work/builder"
timed debootstrap fresh "$builder"
mkdir "$builder/slipfit"
(cd "$project" && git ls-files -z --cached --others --exclude-standard | xargs -0 tar -c --ignore-failed-read --) | tar -x -C "$builder/slipfit"
timed scripts/demo.sh inside "$builder" /slipfit/scripts/demo.sh
if [ -n "$with_tests" ]; then
  timed scripts/test.sh inside "$builder" /slipfit/scripts/test.sh
  timed pip_install.sh inside "$builder" /slipfit/tests/packages/pip_install.sh
fi
build_packages() {
  inside "$builder" /slipfit/scripts/install_dependencies.sh build python
  inside "$builder" sh -c 'apt-get install -y -qq --no-install-recommends dpkg-dev file >/dev/null && cd /slipfit &&
    cmake --preset tool -DSLIPFIT_PYTHON=ON >/dev/null && cmake --build build/tool >/tmp/build.log && cpack -G DEB \
      --config build/tool/CPackConfig.cmake -B /tmp/packages >/tmp/cpack.log || { cat /tmp/build.log /tmp/cpack.log; exit 1; }'
}
timed packages build_packages
if command -v lintian >/dev/null; then
  echo "lintian, errors:"
  lintian --allow-root --fail-on error --display-level error "$builder"/tmp/packages/*.deb
fi

root="$work/clean"
fresh "$root"
cp "$builder"/tmp/packages/*.deb "$project/testdata/demo.csv" "$root/tmp/"
inside "$root" apt-get update -qq
inside "$root" sh -c 'apt-get install -y -qq --no-install-recommends /tmp/*.deb >/tmp/install.log 2>&1 || { cat /tmp/install.log; exit 1; }'
inside "$root" sh -c 'slipfit fit /tmp/demo.csv --speed 10mm/s >/tmp/fit.txt && head -3 /tmp/fit.txt'  # a pipe to head would end it early
inside "$root" test -f /usr/share/man/man1/slipfit-fit.1.gz
for file in bash-completion/completions/slipfit zsh/vendor-completions/_slipfit fish/vendor_completions.d/slipfit.fish; do
  inside "$root" test -f "/usr/share/$file"
done
inside "$root" python3 -c "
import slipfit as sf
fit = sf.fit(sf.read_recording('/tmp/demo.csv', speed='10 mm/s'))
assert fit.stiffness.ci95[0] < 5000 < fit.stiffness.ci95[1]
print(repr(fit))"
inside "$root" apt-get remove -y -qq slipfit python3-slipfit >/dev/null
if inside "$root" sh -c 'command -v slipfit || ls /usr/lib/python3/dist-packages/slipfit' >/dev/null 2>&1; then
  echo "clean_debian.sh: something is left after removal" >&2
  exit 1
fi
echo "built, installed, used and removed in a clean Debian ($release)"
