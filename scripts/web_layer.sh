#!/usr/bin/env bash
# web_layer.sh [LAYER...]: checks layers of src (by default all that compute or read) against the C++ library of the browser version, libc++ 13,
# which lacks much that g++ 12 has: by emscripten's compiler where it is installed, else by clang or g++ with the headers of
# Debian's libc++-13-dev. That package is unpacked into build/web-layer, not installed, because it conflicts with what libceres-dev
# needs. Nothing is built, and no library of scripts/web_libraries.sh is needed: a minute. Skips, saying so, where neither is.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

skip() {
  echo "web_layer.sh: skipped, $1"
  exit 0
}

layers=("$@")
[ ${#layers[@]} -gt 0 ] || layers=(core io signal model fit predict analysis surface)
headers_of_libcxx() {  # unpacked once, from what apt-get verifies; prints their folder
  local folder="$PWD/build/web-layer" headers="usr/lib/llvm-13/include/c++/v1"
  if [ ! -f "$folder/$headers/version" ]; then
    rm -rf "$folder"
    mkdir -p "$folder"
    (cd "$folder" && apt-get -q download libc++-13-dev && dpkg-deb -x libc++-13-dev_*.deb .) >&2 || return 1
  fi
  echo "$folder/$headers"
}

if command -v em++ >/dev/null 2>&1; then
  compiler=(em++ -fwasm-exceptions)
  export NODE_PATH="/usr/share/nodejs${NODE_PATH:+:$NODE_PATH}"  # where Debian's emscripten finds acorn
elif libcxx=$(headers_of_libcxx 2>/dev/null); then
  compiler=("$(command -v clang++ || command -v g++)" -nostdinc++ -isystem "$libcxx")
else
  skip "there is no emscripten, and no libc++-13-dev to be had"
fi
[ -d /usr/include/fast_float ] || skip "libfast-float-dev is not installed"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/include" "$work/core"
for header in boost ceres fast_float fftw3.h fmt libfccp xxhash.h zlib.h zconf.h; do  # by links: /usr/include is of another C library
  ln -s "/usr/include/$header" "$work/include/$header"
done
mkdir "$work/include/glog"  # which knows no such platform; headers of ceres include it
{
  echo '#pragma once'
  echo '#include <string>'
  echo 'namespace google { enum { GLOG_FATAL }; }'
  echo 'inline int FLAGS_minloglevel, FLAGS_v; inline std::string FLAGS_vmodule;'
  echo 'struct NoLog { template <class T> const NoLog& operator<<(const T&) const { return *this; } };'
  printf '#define %s(...) NoLog()\n' {,D}CHECK{,_EQ,_NE,_GE,_GT,_LE,_LT} {,V}LOG
} >"$work/include/glog/logging.h"
[ ! -d /usr/include/hdf5/serial ] || ln -s /usr/include/hdf5/serial "$work/include/hdf5"
cmake -DINPUT=docs/formats.md -DOUTPUT="$work/core/remedies.hpp" -P cmake/remedies.cmake

for layer in "${layers[@]}"; do  # a folder is one translation unit, as in the build
  while read -r folder; do
    [ "$folder" != src/io/arrays ] || [ -d "$work/include/hdf5" ] || continue
    find "$PWD/$folder" -maxdepth 1 -name '*.cpp' ! -name helper.cpp | sort | sed 's/.*/#include "&"/' >"$work/$(tr / _ <<<"$folder").cpp"
  done < <(find "src/$layer" -name '*.cpp' -printf '%h\n' | sort -u)
done
if ! printf '%s\0' "$work"/*.cpp | xargs -0 -n 1 -P "$(nproc 2>/dev/null || echo 2)" "${compiler[@]}" -std=c++20 -fsyntax-only -w \
  -DSLIPFIT_SINGLE_PROCESS -DSLIPFIT_USE_FAST_FLOAT -DFMT_HEADER_ONLY -Iinclude -Isrc -I"$work" -isystem "$work/include" \
  -isystem "$work/include/libfccp" -isystem "$work/include/hdf5" -isystem /usr/include/eigen3 -include cmake/web/missing_ranges.hpp; then
  echo "web_layer.sh: the browser version will not compile; cmake/web/missing_ranges.hpp adds what its C++ library lacks" >&2
  exit 1
fi
echo "web_layer.sh: ${layers[*]} compile for the browser version, by $(basename "${compiler[0]}")"
