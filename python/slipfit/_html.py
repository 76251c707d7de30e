"""What a notebook shows of a result."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any, Iterable, List, Sequence, Tuple, Union

import numpy as np

from . import _slipfit

if TYPE_CHECKING:
    from ._batch import BatchResult
    from ._documents import Document
    from ._fit import Fit
    from ._recording import Recording
    from ._values import Estimate

_WIDTH, _HEIGHT, _COLUMNS = 560, 90, 280
_STYLE = "font-variant-numeric:tabular-nums;margin:.5em 0"


def _path(times: "np.ndarray[Any, Any]", values: "np.ndarray[Any, Any]", low: float, high: float) -> str:
    """Lowest and highest value of each column of pixels."""
    step = max(1, len(values) // _COLUMNS)
    pieces: List[str] = []
    span = float(times[-1] - times[0]) or 1.0
    scale = _HEIGHT / ((high - low) or 1.0)
    pen = "M"
    for begin in range(0, len(values), step):
        part = values[begin : begin + step]
        if np.isnan(part).all():
            pen = "M"
            continue
        x = _WIDTH * float(times[begin] - times[0]) / span
        for y in (np.nanmin(part), np.nanmax(part)):
            pieces.append(f"{pen}{x:.1f} {_HEIGHT - scale * (float(y) - low):.1f}")
            pen = "L"
    return "".join(pieces)


def _picture(recording: "Recording", lines: Sequence[Tuple[Any, str]], about_lines: str) -> str:
    """Values over time, each in its colour."""
    low, high = float(np.min(recording.force)), float(np.max(recording.force))
    time = recording.time
    paths = "".join(f'<path d="{_path(time, values, low, high)}" stroke="{color}" stroke-width="1"/>' for values, color in lines)
    about = f"{recording.duration:.4g} s, {low:.4g} to {high:.4g} {recording.force_unit}"
    return (
        f'<svg viewBox="0 -2 {_WIDTH} {_HEIGHT + 4}" style="width:100%;max-width:{_WIDTH}px" fill="none" role="img" '
        f'aria-label="force over time, {escape(about)}">{paths}</svg>'
        f'<div style="font-size:85%">force over {escape(about)}{about_lines}</div>'
    )


def chart(recording: "Recording", fit: "Fit") -> str:
    """The trace, and the fit on it, as a small picture."""
    curve = fit.curve
    lines = [(curve.force, "#8a8a8a")]
    is_fitted = fit.status != "steady_sliding" and not np.isnan(curve.fitted).all()
    if is_fitted:
        lines.append((curve.fitted, "#c0392b"))
    return _picture(recording, lines, "; fit in red" if is_fitted else "")


def _row(one: "Estimate") -> str:
    note = f' title="{escape(one.note)}"' if one.note else ""
    cells = (*_slipfit.estimate_row(one.value, one.se, one.ci95, one.unit), one.status or "")
    return f"<tr{note}><th style='text-align:left'>{escape(one.words)}</th>" + "".join(f"<td>{escape(c)}</td>" for c in cells) + "</tr>"


_HEAD = "<tr><th></th><th>value</th><th>unit</th><th>95 % interval</th><th>status</th></tr>"


def of_estimate(one: "Estimate") -> str:
    return of_parameters([one])


def of_parameters(estimates: Iterable["Estimate"]) -> str:
    """A table, a row each."""
    return f'<table style="{_STYLE}">{_HEAD}{"".join(_row(one) for one in estimates)}</table>'


def of_document(document: "Union[Document, Fit]") -> str:
    """The text as it is printed."""
    return f'<pre style="{_STYLE}">{escape(str(document))}</pre>'


def of_recording(recording: "Recording") -> str:
    """What it is, the trace, and what was assumed."""
    notes = [*recording.assumed, *(notice.message for notice in recording.warnings)]
    listed = "".join(f"<li>{escape(one)}</li>" for one in notes)
    return (
        f'<div style="{_STYLE}"><b>{escape(repr(recording)[len("<slipfit.") : -1])}</b>'
        + _picture(recording, [(recording.force, "#8a8a8a")], "")
        + (f"<ul>{listed}</ul>" if listed else "")
        + "</div>"
    )


def of_batch(result: "BatchResult") -> str:
    """Counts, the first failures and where the table is."""
    failed = result.failures if result.counts["failed"] else None
    rows = [] if failed is None else failed.head(5).itertuples(index=False)
    listed = "".join(f"<li><code>{escape(str(one.id))}</code>: {escape(str(one.message))}</li>" for one in rows)
    return f'<div style="{_STYLE}"><b>{escape(repr(result)[len("<slipfit.") : -1])}</b>' + (f"<ul>{listed}</ul>" if listed else "") + "</div>"


def of_fit(fit: "Fit") -> str:
    """The summary as it is printed, and the trace."""
    return of_document(fit) + ("" if fit._recording is None else chart(fit.recording, fit))
