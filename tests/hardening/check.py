#!/usr/bin/env python3
"""check.py SLIPFIT LIBRARY LICENCES.md: how a release executable, and the library of its own code, are hardened, and whether each
library that it is linked with is named.

Exit 1 with one line for each thing that is missing, 77 without readelf and ldd."""

import pathlib
import re
import shutil
import subprocess
import sys


def output_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def missing_hardening(executable, library):
    segments = output_of("readelf", "-W", "-l", executable)
    dynamic = output_of("readelf", "-W", "-d", executable)
    symbols = output_of("nm", library)  # of own code alone: Debian's static Ceres in the executable is hardened anyway
    if "Type is DYN" not in segments and "DYN (" not in output_of("readelf", "-h", executable):
        yield "not a position-independent executable"
    if "GNU_RELRO" not in segments:
        yield "no read-only relocations (RELRO)"
    if not re.search(r"BIND_NOW|FLAGS_1.*\bNOW\b", dynamic):
        yield "no binding at start (BIND_NOW): RELRO is partial"
    if re.search(r"GNU_STACK\s.*\sRWE\s", segments):
        yield "the stack is executable"
    if "__stack_chk_fail" not in symbols:
        yield "no stack protector"
    if not re.search(r"\b__\w+_chk\b", symbols):
        yield "no checked functions (_FORTIFY_SOURCE)"


def missing_licences(executable, licences):
    named = licences.read_text(encoding="utf-8")
    for name in re.findall(r"^\s*(?:/\S*/)?(lib[\w+]+|ld-linux)\S*\.so", output_of("ldd", executable), re.MULTILINE):
        if not re.search(rf"\b{re.escape(name)}(?!\w)", named):
            yield f"{name}: linked, not in {licences.name}"


def main():
    if not shutil.which("readelf") or not shutil.which("ldd"):
        sys.exit(77)
    executable = sys.argv[1]
    missing = [*missing_hardening(executable, sys.argv[2]), *missing_licences(executable, pathlib.Path(sys.argv[3]))]
    print("\n".join(missing) or "hardened; every linked library is named")
    sys.exit(1 if missing else 0)


main()
