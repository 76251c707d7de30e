"""Charts with matplotlib, which is imported only here: those of the page, drawn from the same data."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Dict, List, Optional

import numpy as np

from ._errors import Error

if TYPE_CHECKING:
    from ._fit import Fit
    from ._recording import Recording
    from ._sweep import Sweep

_STROKES = {"solid": "-", "dashed": "--", "dotted": ":", "dashdot": "-."}
_SHAPES: Dict[str, Dict[str, Any]] = {
    "dot": {"marker": "o", "markersize": 5},
    "speck": {"marker": "o", "markersize": 2},
    "ring": {"marker": "o", "markersize": 6, "markerfacecolor": "none"},
    "triangle": {"marker": "^", "markersize": 5},
    "cross": {"marker": "x", "markersize": 5},
}
_GAP = 0.34  # between panels, in heights of the first one

_OF_ONE = ("trace", "spectrum", "cycles", "residuals", "evolution", "pairs", "map", "speed", "pattern")
_OF_SEVERAL = {"speed": "sweep-spacing", "friction": "sweep-friction", "cycles": "sweep-cycles", "trace": "sweep-traces"}
_OF_EACH = ("spectrum", "map")  # charts of the recordings, over each other
_WITHOUT_MODEL = ("map", "speed", "pattern", "friction")


def _numbers(points: List[List[Optional[float]]]) -> List["np.ndarray[Any, Any]"]:
    return [np.array(values, dtype=float) for values in points]


def _label(name: str) -> str:
    return name or "_nolegend_"


def _draw_lines(ax: Any, lines: List[Dict[str, Any]], **style: Any) -> None:
    for line in lines:
        shown = {"color": line["colour"], "label": _label(line["name"]), **style}
        ax.plot(*_numbers(line["points"]), linestyle=_STROKES[line["stroke"]], linewidth=0.6 * line["width_px"], **shown)


def _draw_markers(ax: Any, markers: List[Dict[str, Any]], **style: Any) -> None:
    for one in markers:
        shown = {"color": one["colour"], "label": _label(one["name"]), **style}
        ax.plot(*_numbers(one["points"]), linestyle="none", **_SHAPES[one["shape"]], **shown)


def _draw(ax: Any, panel: Dict[str, Any]) -> None:
    for area in panel["areas"]:
        ax.fill(*_numbers(area["points"]), color=area["colour"], alpha=0.2, linewidth=0.0, label=_label(area["name"]))
    _draw_lines(ax, panel["lines"])
    _draw_markers(ax, panel["markers"])
    for note in panel["notes"]:
        ax.annotate(note["text"], (note["x"], note["y"]), color=note["colour"], fontsize="small")
    x, y = panel["x"], panel["y"]
    ax.set(xscale=x["scale"], yscale=y["scale"], xlabel=x["label"], ylabel=y["label"])
    ax.set(xlim=(x["low"], x["high"]), ylim=(y["low"], y["high"]))


def _explain(ax: Any) -> None:
    if ax.get_legend_handles_labels()[0]:
        ax.legend(loc="best", fontsize="small")


def _axes(ax: Any, panels: List[Dict[str, Any]]) -> List[Any]:
    """New axes, one a panel; or the given ones, and others below them for the further panels."""
    shares = [panel["height_px"] / panels[0]["height_px"] for panel in panels]
    if ax is None:
        from matplotlib import pyplot

        height = sum(panel["height_px"] for panel in panels) / 80.0 + 0.5 * len(panels)
        drawn = pyplot.subplots(len(panels), figsize=(7.5, height), layout="constrained", squeeze=False, height_ratios=shares)[1]
        return list(drawn[:, 0])
    all_axes, bottom = [ax], 0.0
    for share in shares[1:]:
        bottom -= _GAP + share
        all_axes.append(ax.inset_axes([0.0, bottom, 1.0, share]))
    return all_axes


def _chart(charts: Dict[str, Any], key: str, result: Any, kind: str) -> Dict[str, Any]:
    chart: Dict[str, Any] = charts[key]
    if not chart["panels"]:
        code = "cannot_predict" if kind in _WITHOUT_MODEL else "no_cycles"
        raise Error(code, f"{result.id}: {chart['absent'].rstrip('.')}; use plot('trace') to see the recording")
    return chart


def _shown(panels: List[Dict[str, Any]], title: str, ax: Any) -> Any:
    all_axes = _axes(ax, panels)
    for one, panel in zip(all_axes, panels):
        _draw(one, panel)
        _explain(one)
    all_axes[0].set_title(title)
    return all_axes[0]


def _check(kind: str, kinds: List[str]) -> None:
    if kind not in kinds:
        raise Error("unknown_plot", f"plot: unknown kind {kind!r}, expected one of {', '.join(kinds)}")


def trace(recording: "Recording", ax: Any) -> Any:
    line = {"name": "measured", "colour": "#6F6F6F", "stroke": "solid", "width_px": 1.2, "points": [recording.time, recording.force]}
    (ax,) = _axes(ax, [{"height_px": 280.0}])
    _draw_lines(ax, [line])
    label = "force [N]" if recording.force_unit == "N" else "coefficient of friction"
    ax.set(xlabel="time [s]", ylabel=label, title=recording.name)
    return ax


def fit(result: "Fit", kind: str, ax: Any) -> Any:
    _check(kind, list(_OF_ONE))
    chart = _chart(json.loads(result._result().charts(kind)), kind, result, kind)
    return _shown(chart["panels"], f"{result.id}: {chart['title']}", ax)


def prediction(document: Dict[str, Any], ax: Any) -> Any:
    """The spacing of a document over speed, as the page's charts are described."""
    rows = [(1e3 * row["speed_m_per_s"], row["periodic_displacement_m"]) for row in document["rows"]]
    known = [(speed, 1e6 * one["value"]) for speed, one in rows if one and one["value"] is not None]
    bands = [(speed, one["ci95"]) for speed, one in rows if one and one.get("ci95")]
    outline = [(speed, 1e6 * low) for speed, (low, _) in bands] + [(speed, 1e6 * high) for speed, (_, high) in reversed(bands)]
    if not known:
        raise Error("cannot_predict", "there is no stick-slip at any of these speeds; choose others")
    heights = [y for _, y in known + outline]
    speeds = [x for x, _ in rows]
    panel = {
        "x": {"label": "driving speed [mm/s]", "low": min(speeds), "high": max(speeds), "scale": "log"},
        "y": {"label": "periodic displacement [µm]", "low": min(heights) / 1.1, "high": 1.1 * max(heights), "scale": "log"},
        "height_px": 280.0,
        "areas": [{"name": "95 % interval", "colour": "#0072B2", "points": list(zip(*outline))}] if outline else [],
        "lines": [{"name": "predicted", "colour": "#0072B2", "stroke": "solid", "width_px": 2.0, "points": list(zip(*known))}],
        "markers": [],
        "notes": [],
    }
    return _shown([panel], "Periodic displacement over speed", ax)


def sweep(result: "Sweep", kind: str, ax: Any) -> Any:
    _check(kind, [*_OF_SEVERAL, *_OF_EACH])
    if kind in _OF_EACH:
        return _over_each_other(result, kind, ax)
    charts = json.loads(result._swept().charts(_OF_SEVERAL[kind]))
    chart = _chart(charts, _OF_SEVERAL[kind], result, kind)
    panels = [panel for one in charts.values() for panel in one["panels"]]
    return _shown(panels, f"{result.id}: {chart['title']}", ax)


def _over_each_other(result: "Sweep", kind: str, ax: Any) -> Any:
    """Draw the axes and areas of one recording's chart, and for each recording its spectrum or its point on the map."""
    is_spectrum = kind == "spectrum"
    drawn: List[Any] = []
    for place, (name, one) in enumerate(result.recordings.items()):
        panels = json.loads(one._result().charts(kind))[kind]["panels"]
        if not panels:
            continue
        lines, markers = panels[0]["lines"], panels[0]["markers"]
        if not drawn:
            drawn = _axes(ax, panels[:1])
            _draw(drawn[0], {**panels[0], "lines": [] if is_spectrum else lines, "markers": [], "notes": []})
        _draw_lines(drawn[0], lines[:1] if is_spectrum else [], color=f"C{place % 10}", label=name)
        _draw_markers(drawn[0], [] if is_spectrum else markers, color=f"C{place % 10}", label=name)
    if not drawn:
        raise Error("cannot_predict", f"{result.id}: no recording has this chart; use plot('trace') to see the recordings")
    _explain(drawn[0])
    drawn[0].set_title(f"{result.id}: {kind}")
    return drawn[0]
