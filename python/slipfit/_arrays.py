"""Numbers of a recording from the arrays that people have: numpy, pandas, dates, masks."""

from __future__ import annotations

import datetime
import numbers
from typing import TYPE_CHECKING, Any, Optional, cast

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]


def _is_missing(value: Any) -> bool:
    """None, pandas.NA and pandas.NaT."""
    return value is None or type(value).__name__ in ("NAType", "NaTType")


def _seconds_since_first(dates: Any) -> "Array":
    """Dates count from the first that is not missing: a double resolves 0.2 us of the seconds since 1970."""
    known = dates[~np.isnat(dates)]
    return _seconds(dates - known[0]) if known.size else np.full(dates.shape, np.nan)


def _seconds(durations: Any) -> "Array":
    """NaN where a duration is missing."""
    unit = np.datetime_data(durations.dtype)[0]
    if unit in ("Y", "M", "generic"):
        raise TypeError(f"time: durations of the type {durations.dtype} have no fixed length in seconds")
    ticks_per_s = np.timedelta64(1, "s") / np.ones(1, dtype=durations.dtype)[0]  # one tick
    ticks = durations.astype("int64").astype(np.float64)
    # Dividing by a whole number of ticks rounds once: 0.1 s in nanoseconds is 0.1.
    seconds = ticks / ticks_per_s if ticks_per_s >= 1 else ticks * (1.0 / ticks_per_s)
    return cast("Array", np.where(np.isnat(durations), np.nan, seconds))


def _of_objects(values: Any, name: str) -> "Array":
    """Of an array of Python's own objects: numbers, dates and durations, None and NA."""
    known = [one for one in values.ravel() if not _is_missing(one)]
    first = known[0] if known else 0.0
    if isinstance(first, datetime.datetime):
        return np.array([np.nan if _is_missing(one) else (one - first).total_seconds() for one in values.ravel()])
    if isinstance(first, datetime.timedelta):
        return np.array([np.nan if _is_missing(one) else one.total_seconds() for one in values.ravel()])
    if not all(isinstance(one, (numbers.Real, np.bool_)) or hasattr(one, "__float__") for one in known):
        raise TypeError(f"{name}: expected numbers, got {type(first).__name__}")
    return np.array([np.nan if _is_missing(one) else float(one) for one in values.ravel()]).reshape(values.shape)


def _is_time(array: Any) -> bool:
    kinds = (datetime.datetime, datetime.timedelta)
    return array.dtype.kind in "mM" or (array.dtype == object and any(isinstance(one, kinds) for one in array.flat))


def column_of(values: Any, name: str, *, unit: Optional[str] = None) -> "Array":
    """Doubles, contiguous; read where they lie if they are so already. What is masked or missing is NaN.

    `name` is ``"time"`` or ``"force"``. Dates and durations of a `time` become seconds, and allow no `unit`.
    """
    if hasattr(values, "magnitude") or hasattr(values, "to_value"):
        raise TypeError(f"{name}: quantities with units are not read; pass the numbers, and their unit as {name}_unit")
    masked: Any = np.ma  # its functions are untyped
    mask = masked.getmaskarray(values) if isinstance(values, masked.MaskedArray) else None
    array = masked.getdata(values) if mask is not None else np.asarray(values)
    if array.ndim != 1:
        raise ValueError(f"{name}: expected one dimension, got shape {array.shape}")
    if array.dtype.kind == "c":
        raise TypeError(f"{name}: expected real numbers, got complex ones ({array.dtype})")
    if _is_time(array):
        if name != "time":
            raise TypeError(f"{name}: expected numbers, got dates or durations ({array.dtype})")
        if unit is not None:
            raise TypeError(f"time_unit: {unit!r} is given, but time consists of dates or durations, which have a unit")
        if mask is not None and array.dtype.kind in "mM":
            array = np.where(mask, np.array("NaT", dtype=array.dtype), array)
    if array.dtype.kind == "M":
        numbers_of_column = _seconds_since_first(array)
    elif array.dtype.kind == "m":
        numbers_of_column = _seconds(array)
    elif array.dtype == object:
        numbers_of_column = _of_objects(array, name)
    else:
        numbers_of_column = np.ascontiguousarray(array, dtype=np.float64)
    if mask is not None and mask.any():
        numbers_of_column = np.where(mask, np.nan, numbers_of_column)
    return cast("Array", np.ascontiguousarray(numbers_of_column))
