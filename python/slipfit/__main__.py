"""``python -m slipfit`` and the command ``slipfit`` of a wheel: the program that was built with the module."""

from __future__ import annotations

import os
import pathlib
import sys
from typing import NoReturn, Optional


def program() -> Optional[pathlib.Path]:
    """Beside the module, as pip and a build have it; else in bin of the same prefix, as Debian's packages have it."""
    folder = pathlib.Path(__file__).absolute().parent
    for candidate in (folder / "slipfit", folder.parents[3] / "bin" / "slipfit"):
        # A script there may be the command that calls this function.
        if candidate.is_file() and os.access(candidate, os.X_OK) and candidate.open("rb").read(2) != b"#!":
            return candidate
    return None


def main() -> NoReturn:
    found = program()
    if found is None:
        sys.exit("slipfit: the program is not beside the Python module; install it (pip install ., or the Debian package slipfit)")
    os.execv(found, [str(found), *sys.argv[1:]])


if __name__ == "__main__":
    main()
