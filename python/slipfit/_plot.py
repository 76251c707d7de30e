"""Charts with matplotlib, which is imported only here."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Callable, Dict, List, Optional

import numpy as np

from ._errors import Error

if TYPE_CHECKING:
    from ._fit import Fit
    from ._recording import Recording
    from ._sweep import Sweep

_GREY, _RED, _BLUE = "#7f7f7f", "#c0392b", "#1f5fa8"


def _axes(ax: Any) -> Any:
    if ax is not None:
        return ax
    from matplotlib import pyplot

    return pyplot.subplots(figsize=(7.5, 4.0), layout="constrained")[1]


def _force_label(recording: "Recording") -> str:
    return "force (N)" if recording.force_unit == "N" else "coefficient of friction"


def trace(recording: "Recording", ax: Any) -> Any:
    ax = _axes(ax)
    ax.plot(recording.time, recording.force, color=_GREY, linewidth=0.8, label="measured")
    ax.set(xlabel="time (s)", ylabel=_force_label(recording), title=recording.name)
    return ax


def _fitted_trace(fit: "Fit", ax: Any) -> Any:
    ax = trace(fit.recording, ax)
    curve = fit.curve
    ax.set_title(f"{fit.id}: {fit.status.replace('_', ' ')}")
    if fit.status != "steady_sliding" and not np.isnan(curve.fitted).all():
        ax.plot(curve.time, curve.fitted, color=_RED, linewidth=0.8, label="fit")
        # The residual is far smaller than the force: a panel of its own below, with the same clock.
        below = ax.inset_axes([0.0, -0.42, 1.0, 0.28], sharex=ax)
        below.plot(curve.time, curve.residual, color=_BLUE, linewidth=0.5)
        below.axhline(0.0, color=_GREY, linewidth=0.5)
        below.set(xlabel=ax.get_xlabel(), ylabel="residual" if fit.recording.force_unit == "1" else "residual (N)")
        ax.set_xlabel("")
        ax.tick_params(labelbottom=False)
    ax.legend(loc="upper right")
    return ax


def _spectral_line(ax: Any, fit: "Fit", **style: Any) -> None:
    background = fit._result().background()
    frequency, power = background["frequency_Hz"], background["power"]
    shown = (frequency > 0.0) & (power > 0.0)
    ax.loglog(frequency[shown], power[shown], **style)


def _spectrum(fit: "Fit", ax: Any) -> Any:
    ax = _axes(ax)
    _spectral_line(ax, fit, color=_GREY, linewidth=0.8)
    if fit.frequency.value is not None:
        ax.axvline(fit.frequency.value, color=_RED, linewidth=0.8, label=f"slips, {fit.frequency.value:.4g} Hz")
        ax.legend(loc="upper right")
    unit = "N²" if fit.recording.force_unit == "N" else "1"
    ax.set(xlabel="frequency (Hz)", ylabel=f"power ({unit})", title=f"{fit.id}: spectrum")
    return ax


def _pieces(fit: "Fit") -> List["np.ndarray[Any, Any]"]:
    """Samples of each cycle, from peak to peak."""
    peaks = fit.cycles["peak_s"].to_numpy()
    if len(peaks) < 2:
        raise Error("no_cycles", f"{fit.id}: no cycles to draw ({fit.status.replace('_', ' ')}); use plot('trace') to see the recording")
    time = fit.recording.time
    ends = np.searchsorted(time, peaks)
    return [np.arange(a, b) for a, b in zip(ends[:-1], ends[1:]) if b - a > 1]


def _cycles(fit: "Fit", ax: Any, color: Optional[str] = None, label: str = "") -> Any:
    ax = _axes(ax)
    curve, pieces = fit.curve, _pieces(fit)
    for place, piece in enumerate(pieces):
        since = 1e3 * (curve.time[piece] - curve.time[piece[0]])
        ax.plot(since, curve.force[piece], color=color or _GREY, alpha=max(0.1, min(0.7, 10.0 / len(pieces))), linewidth=0.8,
                label=label if place == 0 and label else None)
        if color is None:
            ax.plot(since, curve.fitted[piece], color=_RED, alpha=0.25, linewidth=0.6)
    ax.set(xlabel="time since the peak (ms)", ylabel=_force_label(fit.recording), title=f"{fit.id}: {len(pieces)} cycles")
    return ax


def _stacked(fit: "Fit", ax: Any) -> Any:
    ax = _axes(ax)
    curve, pieces = fit.curve, _pieces(fit)
    shown = pieces[:: max(1, len(pieces) // 40)]
    height = 0.35 * float(np.median([np.ptp(curve.force[piece]) for piece in shown]))
    for place, piece in enumerate(shown):
        since = 1e3 * (curve.time[piece] - curve.time[piece[0]])
        ax.plot(since, curve.force[piece] - curve.force[piece[0]] + place * height, color=_GREY, linewidth=0.8)
    ax.set(xlabel="time since the peak (ms)", ylabel="force, cycles one above the other", yticks=[],
           title=f"{fit.id}: {len(shown)} of {len(pieces)} cycles")
    return ax


def _band(ax: Any, rows: List[Dict[str, Any]], name: str, scale: float) -> None:
    speeds = 1e3 * np.array([row["speed_m_per_s"] for row in rows])

    def column(read: Callable[[Dict[str, Any]], Any]) -> "np.ndarray[Any, Any]":
        return np.array([np.nan if row[name] is None or read(row[name]) is None else read(row[name]) for row in rows], dtype=float)

    ax.plot(speeds, scale * column(lambda one: one["value"]), color=_BLUE, label="predicted by the model")
    low = column(lambda one: (one.get("ci95") or [None, None])[0])
    high = column(lambda one: (one.get("ci95") or [None, None])[1])
    ax.fill_between(speeds, scale * low, scale * high, color=_BLUE, alpha=0.2, linewidth=0.0, label="95 %")


def prediction(document: Dict[str, Any], ax: Any) -> Any:
    ax = _axes(ax)
    _band(ax, document["rows"], "periodic_displacement_m", 1e6)
    critical = document["critical_speed_m_per_s"].get("ci95")
    if critical:
        ax.axvspan(1e3 * critical[0], 1e3 * critical[1], color=_RED, alpha=0.15, linewidth=0.0, label="end of stick-slip, 95 %")
    ax.set(xlabel="driving speed (mm/s)", ylabel="spacing (µm)", xscale="log")
    ax.legend(loc="best")
    return ax


def _point(ax: Any, fit: "Fit", label: str) -> None:
    spacing = fit.pattern_spacing
    if spacing.value is None:
        return
    reach = None if spacing.ci95 is None else 1e6 * np.array([[spacing.value - spacing.ci95[0]], [spacing.ci95[1] - spacing.value]])
    ax.errorbar([1e3 * fit.recording.speed], [1e6 * spacing.value], yerr=reach, fmt="o", color="black", markersize=4, label=label)


def _speed(fit: "Fit", ax: Any) -> Any:
    text = fit._result().background()["prediction"]
    if text is None:
        raise Error("cannot_predict", f"{fit.id}: the fit gives no model to predict from; use plot('trace') to see the recording, and its notes for what is missing")
    ax = _axes(ax)
    _point(ax, fit, "measured, V / f")
    ax = prediction(json.loads(text), ax)
    ax.set_title(f"{fit.id}: spacing over speed")
    return ax


def _place(ax: Any, fit: "Fit", **style: Any) -> None:
    """Where a recording stands on the map of regimes; nothing where that is not known."""
    zeta, place = fit.damping_ratio, fit._derived("lambda")
    if zeta.value and place.value:
        ax.plot([zeta.value], [place.value], "o", markersize=5, label=fit.id, **style)


def _regimes(fit: "Fit", title: str, ax: Any) -> Any:
    ax = _axes(ax)
    background = fit._result().background()
    ax.loglog(background["damping_ratio"], background["lambda"], color=_BLUE, label="limit of stick-slip from rest")
    ax.fill_between(background["damping_ratio"], background["lambda"], 1e4, color=_BLUE, alpha=0.1, linewidth=0.0)
    ax.set(xlabel="damping ratio ζ", ylabel="λ = (F_s - F_k) w_n / (k V)", ylim=(1e-2, 1e4), title=f"{title}: map of regimes")
    return ax


def _map(fit: "Fit", ax: Any) -> Any:
    ax = _regimes(fit, fit.id, ax)
    _place(ax, fit, color="black")
    ax.legend(loc="upper left")
    return ax


def _drawn(charts: Dict[str, Callable[[Any, Any], Any]], result: Any, kind: str, ax: Any) -> Any:
    if kind not in charts:
        raise Error("unknown_plot", f"plot: unknown kind {kind!r}, expected one of {', '.join(charts)}")
    return charts[kind](result, ax)


_OF_ONE: Dict[str, Callable[["Fit", Any], Any]] = {
    "trace": _fitted_trace,
    "spectrum": _spectrum,
    "cycles": _cycles,
    "stacked": _stacked,
    "speed": _speed,
    "map": _map,
}


def fit(result: "Fit", kind: str, ax: Any) -> Any:
    return _drawn(_OF_ONE, result, kind, ax)


def _swept_speed(result: "Sweep", ax: Any) -> Any:
    ax = _axes(ax)
    for place, one in enumerate(result.recordings.values()):
        _point(ax, one, "measured, V / f" if place == 0 else "_")
    text = result._swept().prediction()
    if text is not None:
        prediction(json.loads(text), ax)
    ax.set(xlabel="driving speed (mm/s)", ylabel="spacing (µm)", xscale="log", title=f"{result.id}: spacing over speed")
    ax.legend(loc="best")
    return ax


def _swept_traces(result: "Sweep", ax: Any) -> Any:
    ax = _axes(ax)
    members = sorted(result.recordings.items(), key=lambda item: item[1].recording.speed)
    step = 1.1 * max(float(np.ptp(one.recording.force)) for _, one in members)
    for place, (name, one) in enumerate(members):
        recording = one.recording
        ax.plot(recording.time - recording.time[0], recording.force - float(np.median(recording.force)) + place * step,
                linewidth=0.7, label=f"{name}, {1e3 * recording.speed:.4g} mm/s")
    ax.set(xlabel="time (s)", ylabel="force, one above the other", yticks=[], title=result.id)
    ax.legend(loc="upper right", fontsize="small")
    return ax


def _swept_cycles(result: "Sweep", ax: Any) -> Any:
    ax = _axes(ax)
    members = [one for one in result.recordings.values() if len(one.cycles) > 1]
    for place, one in enumerate(members):
        _cycles(one, ax, f"C{place % 10}", f"{one.id}, {1e3 * one.recording.speed:.4g} mm/s")
    ax.set_title(f"{result.id}: cycles")
    ax.legend(loc="upper right", fontsize="small")
    return ax


def _swept_spectra(result: "Sweep", ax: Any) -> Any:
    ax = _axes(ax)
    for name, one in result.recordings.items():
        _spectral_line(ax, one, linewidth=0.7, label=name)
    ax.set(xlabel="frequency (Hz)", ylabel="power (N²)", title=f"{result.id}: spectra")
    ax.legend(loc="upper right", fontsize="small")
    return ax


def _swept_map(result: "Sweep", ax: Any) -> Any:
    members = list(result.recordings.values())
    ax = _regimes(members[0], result.id, ax)
    _place(ax, result, color="black")
    for one in members:
        _place(ax, one)
    ax.legend(loc="upper left", fontsize="small")
    return ax


_OF_SEVERAL: Dict[str, Callable[["Sweep", Any], Any]] = {
    "speed": _swept_speed,
    "trace": _swept_traces,
    "stacked": _swept_traces,
    "cycles": _swept_cycles,
    "spectrum": _swept_spectra,
    "map": _swept_map,
}


def sweep(result: "Sweep", kind: str, ax: Any) -> Any:
    return _drawn(_OF_SEVERAL, result, kind, ax)
