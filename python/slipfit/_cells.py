"""What a user says about a recording, as the cells of a manifest: the library reads the texts."""

from __future__ import annotations

import numbers
import os
from typing import Any, List, Mapping, Optional, Sequence, Tuple, Union

from . import _slipfit
from ._errors import COLUMNS, Error

Quantity = Union[float, int, str]
"""A number in SI, or text with a unit: ``0.01``, ``"10 mm/s"``, ``"41 gf"``."""

_RANGES = {"window", "rows"}


def text_of(value: Any) -> str:
    """A number so that it reads back bit for bit; text as it is."""
    if isinstance(value, bool):
        raise TypeError("expected a number or text, not a truth value")
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return repr(float(value))
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    raise TypeError(f"expected a number or text, not {type(value).__name__}")


def _range_text(name: str, value: Any) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, slice) or not isinstance(value, Sequence) or len(value) != 2:
        raise Error(f"bad_{name}", f"{name}: bad value {value!r}, expected a pair (first, last) or text 'A:B'")
    return f"{text_of(value[0])}:{text_of(value[1])}"


def _where_text(value: Any) -> str:
    if isinstance(value, str):
        return value
    pairs: List[Any] = list(value.items()) if isinstance(value, Mapping) else [tuple(value)]
    if len(pairs) != 1 or len(pairs[0]) != 2:
        raise Error("bad_where", f"where: bad value {value!r}, expected one column and its value, such as {{'Step': 3}}")
    column, wanted = pairs[0]
    return f"{column}={text_of(wanted)}"


def _flag_text(name: str, value: Any) -> Optional[str]:
    if value is False:
        return None
    if value is True:
        return {"strokes": "both", "segments": "yes"}[name]
    return text_of(value)


def cells_of(arguments: Mapping[str, Any]) -> List[Tuple[str, str]]:
    """(column, text) of each argument that is given."""
    cells = []
    for name, value in arguments.items():
        if value is None:
            continue
        if name in _RANGES:
            text: Optional[str] = _range_text(name, value)
        elif name == "where":
            text = _where_text(value)
        elif name in ("strokes", "segments"):
            text = _flag_text(name, value)
        else:
            text = text_of(value)
        if text is not None:
            cells.append((COLUMNS.get(name, name), text))
    return cells


def fixed_of(fix: Optional[Mapping[str, Quantity]]) -> List[str]:
    """NAME=VALUE of each parameter to hold."""
    return [f"{name}={text_of(value)}" for name, value in (fix or {}).items()]


def quantity_of(name: str, value: Quantity, dimension: str, *, above: Optional[float] = None) -> float:
    """The number in SI."""
    number = _slipfit.quantity(text_of(value), dimension)
    if above is not None and not number > above:
        raise Error("out_of_range", f"{name}: {value!r} is not above {above:g}, expected more")
    return number
