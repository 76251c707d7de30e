"""Where a file comes from: a path, an open file, or an address that fsspec knows."""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
from typing import Any, Iterator, Tuple, Union, cast

from ._errors import Error

Source = Union[str, "os.PathLike[str]", Any]
"""A path; an open file (``read``); ``"s3://bucket/run.csv"`` and what else fsspec opens."""


def _opened(source: Source) -> Any:
    """A stream where `source` is no path on this machine, else None."""
    if hasattr(source, "read"):
        return contextlib.nullcontext(source)
    if hasattr(source, "fs") and hasattr(source, "open"):  # an OpenFile of fsspec, a path of universal_pathlib
        return source if hasattr(source, "__enter__") and hasattr(source, "full_name") else source.open("rb")
    if isinstance(source, str) and "://" in source and not os.path.exists(source):
        import fsspec

        return fsspec.open(source, "rb", compression=None)
    return None


def _name_of(source: Source) -> str:
    for attribute in ("full_name", "name"):
        if isinstance(getattr(source, attribute, None), str):
            return cast(str, getattr(source, attribute))
    return str(source) if isinstance(source, (str, os.PathLike)) else "recording"


def _write(stream: Any, path: str) -> None:
    """Bytes as they are; text as UTF-8."""
    first = stream.read(1 << 20)
    with open(path, "wb") as file:
        if isinstance(first, str):
            file.write((first + stream.read()).encode("utf-8"))
        else:
            file.write(first)
            shutil.copyfileobj(stream, file)


@contextlib.contextmanager
def local_file(source: Source) -> Iterator[Tuple[str, str]]:
    """(path on this machine, name that results and messages show); a copy exists while the context is open."""
    opened = _opened(source)
    if opened is None:
        path = os.fspath(source)
        yield path, path
        return
    name = _name_of(source)
    with tempfile.TemporaryDirectory(prefix="slipfit-") as folder, opened as stream:
        path = os.path.join(folder, os.path.basename(name) or "recording")
        _write(stream, path)
        try:
            yield path, name
        except Error as error:
            raise Error(error.code, error.message.replace(path, name)) from None
