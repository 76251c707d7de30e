#!/usr/bin/env bash
# clean_debian.sh BUILD [MIRROR]: makes the Debian packages of BUILD, then installs, uses and removes them in a fresh Debian 12 made by
# debootstrap. Needs root, debootstrap and a mirror; some minutes.
set -euo pipefail
build=$(realpath "$1")
mirror=${2:-http://deb.debian.org/debian}
project=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
work=$(mktemp -d)
root="$work/root"
trap 'umount -q "$root/proc" 2>/dev/null || true; rm -rf --one-file-system "$work"' EXIT

cpack -G DEB --config "$build/CPackConfig.cmake" -B "$work" >"$work/cpack.log" || { cat "$work/cpack.log" >&2; exit 1; }
if command -v lintian >/dev/null; then
  echo "lintian, errors:"
  lintian --allow-root --fail-on error --display-level error "$work"/*.deb
fi
debootstrap --variant=minbase bookworm "$root" "$mirror" >"$work/debootstrap.log" || { tail "$work/debootstrap.log" >&2; exit 1; }
[ ! -d /etc/apt/apt.conf.d ] || cp /etc/apt/apt.conf.d/*proxy* "$root/etc/apt/apt.conf.d/" 2>/dev/null || true
cp "$work"/*.deb "$project/testdata/demo.csv" "$root/tmp/"
mount -t proc proc "$root/proc" 2>/dev/null || true
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive "$@"; }
inside apt-get update -qq
inside sh -c 'apt-get install -y -qq --no-install-recommends /tmp/*.deb >/tmp/install.log 2>&1 || { cat /tmp/install.log; exit 1; }'
inside sh -c 'slipfit fit /tmp/demo.csv --speed 10mm/s >/tmp/fit.txt && head -3 /tmp/fit.txt'  # a pipe to head would end it early
inside test -f /usr/share/man/man1/slipfit-fit.1.gz
inside test -f /usr/share/bash-completion/completions/slipfit
inside python3 -c "
import slipfit as sf
fit = sf.fit(sf.read_recording('/tmp/demo.csv', speed='10 mm/s'))
assert fit.stiffness.ci95[0] < 5000 < fit.stiffness.ci95[1]
print(repr(fit))"
inside apt-get remove -y -qq slipfit python3-slipfit >/dev/null
if inside sh -c 'command -v slipfit || ls /usr/lib/python3/dist-packages/slipfit' >/dev/null 2>&1; then
  echo "clean_debian.sh: something is left after removal" >&2
  exit 1
fi
echo "installed, used and removed in a clean Debian 12"
