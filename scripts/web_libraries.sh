#!/usr/bin/env bash
# web_libraries.sh: builds the libraries of the browser version for WebAssembly into build/web-libraries/prefix, each once.
# Their sources are Debian's, pinned by checksum; headers alone are taken from Debian's packages on this machine.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

mirror=${SLIPFIT_DEBIAN_MIRROR:-http://deb.debian.org/debian}/pool/main
jobs=${SLIPFIT_JOBS:-2}
root="$PWD/build/web-libraries"
prefix="$root/prefix"
flags=(-O3 -fwasm-exceptions)
export NODE_PATH="/usr/share/nodejs${NODE_PATH:+:$NODE_PATH}"  # where Debian's emscripten finds acorn
mkdir -p "$root/download" "$root/done" "$prefix/include" "$prefix/lib" "$prefix/share/cmake"

fetch() {  # NAME PATH CHECKSUM: unpacked into $root/NAME
  local file
  file="$root/download/$(basename "$2")"
  [ -f "$file" ] || curl -fsSL --retry 3 -o "$file" "$mirror/$2"
  if ! echo "$3  $file" | sha256sum --check --status; then
    rm -f "$file"
    echo "web_libraries.sh: the checksum of $2 is not the expected one; the file was removed, try again" >&2
    exit 1
  fi
  rm -rf "${root:?}/$1" "$root/$1-build"
  mkdir "$root/$1" "$root/$1-build"
  tar -xf "$file" -C "$root/$1" --strip-components=1
}

with_cmake() {  # NAME OPTION...
  local name=$1
  shift
  emcmake cmake -S "$root/$name" -B "$root/$name-build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS=-w \
    -DCMAKE_C_FLAGS_RELEASE="${flags[*]} -DNDEBUG" -DCMAKE_CXX_FLAGS_RELEASE="${flags[*]} -DNDEBUG" \
    -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_FIND_ROOT_PATH="$prefix" -DBUILD_SHARED_LIBS=OFF "$@"
  cmake --build "$root/$name-build" --target install --parallel "$jobs"
}

with_files() {  # NAME ARGUMENT...: C sources as one archive, their headers beside them
  local name=$1
  shift
  cd "$root/$name-build"
  for argument in "$@"; do
    [[ $argument == *.c ]] && set -- "$@" "../$name/$argument" && continue
    set -- "$@" "$argument"
  done
  shift $(($# / 2))
  emcc "${flags[@]}" -DNDEBUG -I"$prefix/include" -c "$@"
  emar rcs "$prefix/lib/lib$name.a" ./*.o
}

with_hdf5() {  # its own CMake tries hundreds of compilations: cmake/web/H5pubconf.h is what they would find
  local source="$root/hdf5/src"
  cd "$root/hdf5-build"
  cp "$root/../../cmake/web/H5pubconf.h" .
  emcc -w -I. -I"$source" "$source/H5detect.c" -s NODERAWFS=1 -s SINGLE_FILE=1 -o detect.js
  node detect.js H5Tinit.c
  echo 'char H5libhdf5_settings[] = "";' >H5lib_settings.c
  find "$source" . -name 'H5*.c' ! -name H5detect.c ! -name H5make_libsettings.c -print0 |
    xargs -0 -P "$jobs" -n 20 emcc -Oz -fwasm-exceptions -DNDEBUG -w -I. -I"$source" -I"$prefix/include" -c
  emar rcs "$prefix/lib/libhdf5.a" ./*.o
  cp "$source"/*.h H5pubconf.h "$prefix/include/"
}

library() {  # NAME PATH CHECKSUM HOW OPTION...: unless it was made so before
  local name=$1
  [ "$(cat "$root/done/$name" 2>/dev/null)" != "$* ${flags[*]}" ] || return 0
  fetch "$1" "$2" "$3"
  ("$4" "$1" "${@:5}")
  if [ "$name" = z ]; then cp "$root"/z/z{lib,conf}.h "$prefix/include/"; fi
  if [ "$name" = minizip ]; then mkdir -p "$prefix/include/minizip" && cp "$root"/minizip/{unzip,ioapi}.h "$prefix/include/minizip/"; fi
  rm -rf "${root:?}/$name" "$root/$name-build"
  echo "$* ${flags[*]}" >"$root/done/$name"
}

# Headers alone: by links, because the folder /usr/include itself belongs to another C library.
for header in boost eigen3 nlohmann CLI fast_float xxhash.h libfccp; do
  ln -sfn "/usr/include/$header" "$prefix/include/$header"
done
cp -r /usr/share/cmake/{nlohmann_json,CLI11} "$prefix/share/cmake/"
mkdir -p "$prefix/share/eigen3" && cp -r /usr/share/eigen3/cmake "$prefix/share/eigen3/"

library z z/zlib/zlib_1.2.13.dfsg.orig.tar.bz2 71feb7947e3c00ef125f83b79a4e529bde31171e5babe48b391f06758d1ab0a1 \
  with_files -DHAVE_UNISTD_H adler32.c compress.c crc32.c deflate.c inffast.c inflate.c inftrees.c trees.c zutil.c
library minizip m/minizip/minizip_1.1.orig.tar.xz 7d8da446d3b6799e7851f077a66551a46b80fc3de708549e79dbd3e49e842ba1 \
  with_files -DUSE_FILE32API unzip.c ioapi.c
library fmt f/fmtlib/fmtlib_9.1.0%2bds1.orig.tar.gz 84ce1c2d0be3a9863935137969dcec6970125caac032f82474640bfc81463583 \
  with_cmake -DFMT_TEST=OFF -DFMT_DOC=OFF
library pugixml p/pugixml/pugixml_1.13.orig.tar.gz 5c5ad5d7caeb791420408042a7d88c2c6180781bf218feca259fd9d840a888e1 with_cmake
library hdf5 h/hdf5/hdf5_1.10.8%2brepack1.orig.tar.gz 7b38e58ff83b13fd8959a90b13bf896bc318ba096c940ab0847abf3ad41a0b31 with_hdf5 \
  "$(sha256sum <cmake/web/H5pubconf.h)"
library fftw3 f/fftw3/fftw3_3.3.10.orig.tar.gz 56c932549852cddcfafdab3820b0200c7742675be92179e59e6215b340e26467 \
  with_cmake -DBUILD_TESTS=OFF -DDISABLE_FORTRAN=ON
library ceres c/ceres-solver/ceres-solver_2.1.0%2breally2.1.0%2bdfsg.orig.tar.xz \
  acd5774187a8ea92bdf9e6d1faeb22c00bf30b1ad226ef6e2ade8b7636bbc336 \
  with_cmake -DMINIGLOG=ON -DMINIGLOG_MAX_LOG_LEVEL=-4 -DGFLAGS=OFF -DSUITESPARSE=OFF -DCXSPARSE=OFF -DLAPACK=OFF \
  -DEIGENSPARSE=ON -DCERES_THREADING_MODEL=NO_THREADS -DSCHUR_SPECIALIZATIONS=OFF -DBUILD_TESTING=OFF -DBUILD_EXAMPLES=OFF \
  -DBUILD_BENCHMARKS=OFF
