"""Simulation, comparison, worn surfaces, and what a file holds."""

from __future__ import annotations

import json
import math
import os
from typing import Any, List, Mapping, Optional, Sequence, Tuple, Union, cast

from . import _slipfit
from ._batch import BatchResult
from ._cells import Quantity, cells_of, quantity_of, text_of
from ._documents import Comparison, Info, Path, Prediction, Surface
from ._errors import Error
from ._fit import Fit, Speeds, speeds_of
from ._recording import Recording
from ._saved import read_fit
from ._sweep import Sweep
from ._sweep import fit as fit_recordings


def _friction(static: float, kinetic: Optional[Quantity], law: Sequence[Optional[Quantity]]) -> List[float]:
    """Static friction and the constant kinetic friction, or f0, f1 and alpha."""
    given = [one is not None for one in law]
    if any(given) == (kinetic is not None) or any(given) != all(given):
        raise Error("unknown_option", "kinetic_friction: give either kinetic_friction, or f0, f1 and alpha")
    if kinetic is not None:
        return [static, quantity_of("kinetic_friction", kinetic, "force")]
    f0, f1, alpha = (cast(Quantity, one) for one in law)
    return [static, quantity_of("f0", f0, "force"), quantity_of("f1", f1, "force"), float(alpha)]


def _natural_frequency(stiffness: float, mass: Optional[float], natural_frequency: Optional[Quantity]) -> float:
    """sqrt(k/m) in rad/s."""
    if (mass is None) == (natural_frequency is None):
        raise Error("unknown_option", "natural_frequency: give either mass (kg) or natural_frequency (rad/s)")
    if mass is None:
        return quantity_of("natural_frequency", cast(Quantity, natural_frequency), "angular_speed", above=0.0)
    if not (stiffness > 0.0 and mass > 0.0):
        raise Error("out_of_range", "mass: stiffness or mass is not above zero, expected both above it")
    return math.sqrt(stiffness / mass)


def simulate(
    *,
    stiffness: float,
    mass: Optional[float] = None,
    natural_frequency: Optional[Quantity] = None,
    damping_ratio: float = 0.0,
    static_friction: Quantity,
    kinetic_friction: Optional[Quantity] = None,
    f0: Optional[Quantity] = None,
    f1: Optional[Quantity] = None,
    alpha: Optional[float] = None,
    speed: Quantity,
    duration: Quantity,
    sample_rate: Quantity,
    noise: Quantity = 0.0,
    jitter: Quantity = 0.0,
    offset: Quantity = 0.0,
    drift: float = 0.0,
    hum: Quantity = 0.0,
    hum_frequency: Quantity = 50.0,
    force_view: str = "spring",
    seed: int = 1,
    name: str = "simulation",
    **said: Any,
) -> Recording:
    """A recording of the model, with noise: the samples that ``slipfit simulate`` writes.

    Parameters
    ----------
    stiffness : float
        Tangential stiffness (N/m).
    mass, natural_frequency : float
        One of them: kg, or sqrt(k/m) in rad/s.
    damping_ratio : float
        c / (2 sqrt(k m)), at least 0.
    static_friction, kinetic_friction : float or str
        F_s and F_k (N).
    f0, f1, alpha : float
        Friction that depends on the sliding speed v, f0 + f1 exp(alpha v), in place of `kinetic_friction` (N, N, s/m).
    speed, duration, sample_rate : float or str
        m/s, s, Hz; or text with a unit.
    noise, jitter, offset, hum : float or str
        White noise (N rms), standard deviation of F_s from slip to slip (N), what is added (N), amplitude of hum (N).
    drift : float
        N/s.
    force_view : "spring", "transmitted" or "contact"
    seed : int
        The same seed gives the same numbers on every machine.
    name, **said
        As for `Recording`: ``normal_force``, ``zero``, ``group``, ...

    Returns
    -------
    Recording

    Raises
    ------
    Error
        ``parameter_out_of_range`` for a body or friction that cannot be, ``out_of_range``, ``bad_number``,
        ``unknown_unit``.
    """
    omega = _natural_frequency(stiffness, mass, natural_frequency)
    added = [
        quantity_of("jitter", jitter, "force"),
        quantity_of("noise", noise, "force"),
        quantity_of("offset", offset, "force"),
        float(drift),
        quantity_of("hum", hum, "force"),
        quantity_of("hum_frequency", hum_frequency, "frequency", above=0.0),
    ]
    if min(added[0], added[1], added[4]) < 0.0:
        raise Error("out_of_range", "noise, jitter and hum: a value is below zero, expected zero or more")
    friction = _friction(quantity_of("static_friction", static_friction, "force"), kinetic_friction, (f0, f1, alpha))
    time, force = _slipfit.simulate(
        [float(stiffness), omega, float(damping_ratio)],
        friction,
        quantity_of("speed", speed, "speed", above=0.0),
        quantity_of("duration", duration, "time", above=0.0),
        quantity_of("sample_rate", sample_rate, "frequency", above=0.0),
        added,
        force_view,
        int(seed),
    )
    return Recording(time, force, speed=speed, force_view=force_view, name=name, **said)


def predict(
    speeds: Speeds,
    *,
    fit: Union[Fit, Path, Mapping[str, Any], None] = None,
    normal_force: Optional[Quantity] = None,
    stiffness: Optional[float] = None,
    mass: Optional[float] = None,
    natural_frequency: Optional[Quantity] = None,
    damping_ratio: float = 0.0,
    static_friction: Optional[Quantity] = None,
    kinetic_friction: Optional[Quantity] = None,
    f0: Optional[Quantity] = None,
    f1: Optional[Quantity] = None,
    alpha: Optional[float] = None,
) -> Prediction:
    """What a model says at these speeds: that of a result, or one of stated parameters.

    Parameters
    ----------
    speeds
        As for `Fit.predict`.
    fit : Fit, path or dict, optional
        A result or its document: the intervals come from its covariance, under `normal_force` where that is given.
    stiffness, mass, natural_frequency, damping_ratio, static_friction, kinetic_friction, f0, f1, alpha
        As for `simulate`, in place of `fit`: a prediction without intervals.

    Raises
    ------
    Error
        ``cannot_predict``, ``bad_speeds``, ``parameter_out_of_range``, ``unknown_option``, ...
    """
    stated = (stiffness, mass, natural_frequency, static_friction, kinetic_friction, f0, f1, alpha)
    if fit is not None:
        if any(one is not None for one in stated) or damping_ratio != 0.0:
            raise Error("unknown_option", "fit: give either a result, or the parameters of a model")
        result = fit if isinstance(fit, Fit) else read_fit(fit)
        return result.predict(speeds, normal_force=normal_force)
    if stiffness is None or static_friction is None or normal_force is not None:
        raise Error("unknown_option", "stiffness: give a result as fit, or stiffness, mass or natural_frequency, and friction")
    slider = [float(stiffness), _natural_frequency(stiffness, mass, natural_frequency), float(damping_ratio)]
    friction = _friction(quantity_of("static_friction", static_friction, "force"), kinetic_friction, (f0, f1, alpha))
    return Prediction(*_slipfit.predict_stated(slider, friction, speeds_of(speeds)))


def figures(out: Path) -> List[str]:
    """Write figures 2 to 8 of the paper and the map of regimes (CSV and SVG) into a folder, and return their paths."""
    os.makedirs(out, exist_ok=True)
    paths = []
    for name, content in _slipfit.figures():
        paths.append(os.path.join(out, name))
        with open(paths[-1], "w", encoding="utf-8", newline="") as file:
            file.write(content)
    return paths


Side = Union[Fit, Recording, BatchResult, Path, Sequence[Union[Fit, Recording, Path]], Mapping[str, Union[Fit, Recording]]]


def _documents_in(path: Path) -> List[str]:
    """Of a document, a results.jsonl, or the folder of a batch; the joint fits of a batch are left out."""
    file = os.path.join(path, "results.jsonl") if os.path.isdir(path) else os.fspath(path)
    with open(file, encoding="utf-8") as stream:
        text = stream.read()
    documents = text.splitlines() if file.endswith(".jsonl") else [text]
    return [one for one in documents if one.strip() and not _is_joint(one)]


def _is_joint(document: str) -> bool:
    """Of a group of a batch. What is no document is refused by the comparison."""
    try:
        content = json.loads(document)
    except ValueError:
        return False
    return isinstance(content, dict) and str(content.get("id", "")).startswith("group:")


def _side_of(side: Any) -> Tuple[List[str], List[Fit]]:
    """Documents, and the results that have recordings to show."""
    if isinstance(side, Sweep):
        return _side_of(list(side.recordings.values()))
    if isinstance(side, Recording):
        side = fit_recordings(side)
    if isinstance(side, Fit):
        return [side.to_json()], [side] if side._recording is not None else []
    if isinstance(side, BatchResult):
        return _documents_in(side.folder), []
    if isinstance(side, (str, os.PathLike)):
        return _documents_in(side), []
    documents: List[str] = []
    shown: List[Fit] = []
    for one in side.values() if isinstance(side, Mapping) else side:
        more, fits = _side_of(one)
        documents += more
        shown += fits
    return documents, shown


def compare(a: Side, b: Side, *, names: Tuple[str, str] = ("A", "B")) -> Comparison:
    """Do two recordings, groups of repeats or results differ?

    Parameters
    ----------
    a, b : Fit, Recording (fitted first), BatchResult, path, or several of them
        A path is a document of ``slipfit fit --json``, a results.jsonl, or the folder of a batch. Several are repeats
        of one test; of a sweep each of its recordings. A recording counts once, however many cycles it has.
    names : (str, str)
        What the result calls the sides.

    Returns
    -------
    Comparison
        Difference and ratio (B over A) of every quantity with interval, p value, and p value adjusted for all of them.

    Raises
    ------
    Error
        ``bad_document``.
    """
    (documents_a, shown_a), (documents_b, shown_b) = _side_of(a), _side_of(b)
    if not documents_a or not documents_b:
        raise ValueError("expected at least one recording or result on each side")
    native = _slipfit.Comparison(names[0], documents_a, names[1], documents_b)

    def page() -> str:
        sides = [[one._result() for one in shown] for shown in (shown_a, shown_b)]
        return native.page(sides[0], sides[1], "slipfit.compare(...)  # Python")

    return Comparison(native.json(), native.text(), page)


def surface(
    file: Path,
    *,
    unit: Optional[str] = None,
    pitch: Optional[Quantity] = None,
    pixel: Optional[Quantity] = None,
    along: Union[str, float, None] = None,
    x_column: Union[str, int, None] = None,
    z_column: Union[str, int, None] = None,
) -> Surface:
    """Spacing of the pattern on a worn surface.

    Parameters
    ----------
    file : path
        Profile (text, X3P, SDF) or image (PNG, TIFF, JPEG).
    unit : str
        Of lengths and heights of a text that names none: ``"um"``.
    pitch, pixel : float or str
        Distance of the points of a text of heights alone; size of an image's pixel on the surface (m).
    along : "x", "y" or float
        Direction of sliding on an area; a number is in degrees from x.
    x_column, z_column : str or int
        Places and heights: name, or number counted from 1.

    Raises
    ------
    Error
        See the table of errors of surfaces in docs/formats.md.
    """
    radians = None if along is None else math.radians({"x": 0.0, "y": 90.0}.get(along, along))  # type: ignore[arg-type]
    native = _slipfit.measure_surface(
        os.fspath(file),
        unit,
        None if pitch is None else quantity_of("pitch", pitch, "length", above=0.0),
        None if pixel is None else quantity_of("pixel", pixel, "length", above=0.0),
        radians,
        None if x_column is None else text_of(x_column),
        None if z_column is None else text_of(z_column),
    )
    return Surface(native.json(), native.text(), native)


def info(file: Path, **said: Any) -> Info:
    """What a file holds: columns, units, clock, steps, strokes; and what `read_recording` would take of it.

    Parameters
    ----------
    file : path
    **said
        Which part to read, and how: `step`, `rows`, `where`, `window`, columns, units, `sheet`, `variable`, `radius`,
        as for `read_recording`.

    Returns
    -------
    Info
        A file that is no recording as it is has a `refusal`.

    Raises
    ------
    Error
        ``file_not_found``, ``binary_file``, ... where there is nothing to look at.
    """
    return Info(*_slipfit.info(os.fspath(file), cells_of(said)))
