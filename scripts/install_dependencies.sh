#!/usr/bin/env bash
# install_dependencies.sh [build|python|test|docs|browser|web]...: what the build needs on Debian 12 or 13, also the Python module, also
# the tests (the default), or what scripts/docs.sh, scripts/test-report.sh or scripts/web.sh need.
# Installs only what is missing, as root or through sudo; says what it installs, and nothing when all is there. Waits up to ten
# minutes while another program (a desktop's updates, the first start of a cloud machine) holds the lock of the packages.
set -euo pipefail

build=(g++ cmake ninja-build libboost-dev libceres-dev libeigen3-dev libfftw3-dev libfccp-dev libcli11-dev
  nlohmann-json3-dev libfmt-dev libxxhash-dev zlib1g-dev libminizip-dev libpugixml-dev
  libhdf5-dev libleptonica-dev python3)
python=(pybind11-dev python3-dev python3-numpy python3-pip python3-venv)
if [ "$(. /etc/os-release 2>/dev/null && echo "${VERSION_ID:-}")" = 12 ]; then  # what makes the wheel
  python+=(python3-skbuild python3-setuptools python3-wheel)
else
  python+=(python3-scikit-build-core)
fi
notebooks=(python3-nbconvert jupyter-nbconvert python3-ipykernel python3-pandas python3-matplotlib python3-scipy)
packages=()
for group in "${@:-test}"; do
  [ "$group" = browser ] || packages+=("${build[@]}")
  case "$group" in
    python) packages+=("${python[@]}") ;;
    test) packages+=(catch2 libfast-float-dev python3 python3-jsonschema python3-openpyxl python3-scipy python3-h5py
      slurm-wlm munge locales zsh fish dpkg-dev file "${python[@]}" "${notebooks[@]}" python3-pytest mypy python3-dask python3-distributed python3-xarray) ;;
    docs) packages+=("${python[@]}" "${notebooks[@]}" mkdocs mkdocs-material doxygen) ;;
    web)
      packages+=(emscripten libfast-float-dev curl ca-certificates xz-utils bzip2 make)
      command -v node >/dev/null 2>&1 || packages+=(nodejs)
      ;;
    browser)
      packages+=(chromium)
      command -v npm >/dev/null 2>&1 || packages+=(nodejs npm)
      ;;
  esac
done

if ! command -v dpkg-query >/dev/null 2>&1; then
  echo "install_dependencies.sh: no Debian here; needed, by their Debian names: ${packages[*]}" >&2
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  state=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$state" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null 2>&1; then
    echo "install_dependencies.sh: run as root, or install: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "installing: ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
install_missing() {
  "${as_root[@]}" env LC_ALL=C apt-get update -qq &&
    "${as_root[@]}" env LC_ALL=C DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
}
deadline=$((SECONDS + 600))
until install_missing >"$log" 2>&1; do
  if grep -qi 'could not get lock\|unable to lock' "$log" && [ "$SECONDS" -lt "$deadline" ]; then
    echo "another program installs packages; waiting ..." >&2
    sleep 5
    continue
  fi
  cat "$log" >&2
  echo "install_dependencies.sh: apt-get could not install: ${missing[*]}" >&2
  exit 1
done
