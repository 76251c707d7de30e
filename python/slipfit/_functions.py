"""Simulation, comparison, worn surfaces and batches."""

from __future__ import annotations

import json
import math
import os
import sys
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union, cast

from . import _slipfit
from ._cells import Quantity, fixed_of, text_of
from ._documents import Comparison, Path, Surface
from ._errors import Error
from ._fit import Fit, Fix, Sweep, fit
from ._recording import Recording

if TYPE_CHECKING:
    import pandas as pd


def _si(name: str, value: Quantity, dimension: str, *, above: Optional[float] = None) -> float:
    number = _slipfit.quantity(text_of(value), dimension)
    if above is not None and not number > above:
        raise Error("out_of_range", f"{name}: {value!r} is not above {above:g}, expected more")
    return number


def _friction(static: float, kinetic: Optional[Quantity], law: Sequence[Optional[Quantity]]) -> List[float]:
    """Static friction and the constant kinetic friction, or f0, f1 and alpha."""
    given = [one is not None for one in law]
    if any(given) == (kinetic is not None) or any(given) != all(given):
        raise Error("unknown_option", "kinetic_friction: give either kinetic_friction, or f0, f1 and alpha")
    if kinetic is not None:
        return [static, _si("kinetic_friction", kinetic, "force")]
    f0, f1, alpha = (cast(Quantity, one) for one in law)
    return [static, _si("f0", f0, "force"), _si("f1", f1, "force"), float(alpha)]


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
    if (mass is None) == (natural_frequency is None):
        raise Error("unknown_option", "natural_frequency: give either mass (kg) or natural_frequency (rad/s)")
    if mass is not None:
        if not (stiffness > 0.0 and mass > 0.0):
            raise Error("out_of_range", "mass: stiffness and mass are above zero, expected so")
        omega = math.sqrt(stiffness / mass)
    else:
        omega = _si("natural_frequency", cast(Quantity, natural_frequency), "angular_speed", above=0.0)
    added = [
        _si("jitter", jitter, "force"),
        _si("noise", noise, "force"),
        _si("offset", offset, "force"),
        float(drift),
        _si("hum", hum, "force"),
        _si("hum_frequency", hum_frequency, "frequency", above=0.0),
    ]
    if min(added[0], added[1], added[4]) < 0.0:
        raise Error("out_of_range", "noise, jitter and hum: a value is below zero, expected zero or more")
    friction = _friction(_si("static_friction", static_friction, "force"), kinetic_friction, (f0, f1, alpha))
    time, force = _slipfit.simulate(
        [float(stiffness), omega, float(damping_ratio)],
        friction,
        _si("speed", speed, "speed", above=0.0),
        _si("duration", duration, "time", above=0.0),
        _si("sample_rate", sample_rate, "frequency", above=0.0),
        added,
        force_view,
        int(seed),
    )
    return Recording(time, force, speed=speed, force_view=force_view, name=name, **said)


Side = Union[Fit, Recording, Path, Sequence[Union[Fit, Recording, Path]], Mapping[str, Union[Fit, Recording]]]


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
        side = fit(side)
    if isinstance(side, Fit):
        return [side.to_json()], [side]
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
    a, b : Fit, Recording (fitted first), path, or several of them
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
        None if pitch is None else _si("pitch", pitch, "length", above=0.0),
        None if pixel is None else _si("pixel", pixel, "length", above=0.0),
        radians,
        None if x_column is None else text_of(x_column),
        None if z_column is None else text_of(z_column),
    )
    return Surface(native.json(), native.text(), native)


class BatchResult:
    """What a batch wrote into its folder.

    Attributes
    ----------
    folder : str
    counts : dict
        ``total``, ``before`` (done by the run that was resumed), ``fitted``, ``failed``, ``seconds``.
    """

    def __init__(self, folder: str, counts: Dict[str, Any]) -> None:
        self.folder = folder
        self.counts = counts

    def __iter__(self) -> Iterator[Dict[str, Any]]:
        """The documents in the manifest's order."""
        with open(os.path.join(self.folder, "results.jsonl"), encoding="utf-8") as stream:
            for line in stream:
                yield json.loads(line)

    def to_frame(self) -> "pd.DataFrame":
        """summary.csv: one row a recording."""
        return self._table("summary.csv")

    @property
    def failures(self) -> "pd.DataFrame":
        """failures.csv: id, code and message of each recording that failed."""
        return self._table("failures.csv")

    def _table(self, name: str) -> "pd.DataFrame":
        import pandas

        return pandas.read_csv(os.path.join(self.folder, name), float_precision="round_trip")

    def __repr__(self) -> str:
        counts = self.counts
        done = counts["before"] + counts["fitted"]
        return f"<slipfit.BatchResult {self.folder!r}: {done} of {counts['total']} fitted, {counts['failed']} failed>"


Progress = Union[bool, Callable[[Dict[str, Any]], None]]


def _line(counts: Dict[str, Any]) -> None:
    done = counts["before"] + counts["fitted"] + counts["failed"]
    end = "\n" if done == counts["total"] else ""
    print(f"\r{done} of {counts['total']}, {counts['failed']} failed", end=end, file=sys.stderr, flush=True)


def batch(
    manifest: Path,
    *,
    out: Path,
    jobs: Optional[int] = None,
    progress: Progress = False,
    resume: bool = False,
    tier: str = "auto",
    fix: Fix = None,
    joint_groups: bool = False,
    timeout: Quantity = 600.0,
    shard: Optional[Tuple[int, int]] = None,
    report: Optional[Path] = None,
) -> BatchResult:
    """Fit every recording of a manifest into a folder, on all cores.

    Parameters
    ----------
    manifest : path
        CSV: ``id,file,speed_m_per_s``, one row a recording (docs/formats.md lists the other columns).
    out : path
        Folder of the results; made where it is missing.
    jobs : int, optional
        Recordings at a time; without it one a core that this process may use.
    progress : bool or callable
        True: a line on standard error; a callable gets a dict of `BatchResult.counts` now and then.
    resume : bool
        Go on with what the folder holds: after Ctrl-C, a kill or a crash.
    tier, fix
        As for `fit`.
    joint_groups : bool
        Fit the recordings of each group together, too.
    timeout : float or str
        Longest time for a recording (s); then it counts as failed.
    shard : (int, int), optional
        (I, N): the I-th of N parts, I from 1.
    report : path, optional
        Page of the batch, such as ``out/index.html``.

    Returns
    -------
    BatchResult
        A recording that fails is a row of ``BatchResult.failures``, and no exception.

    Raises
    ------
    KeyboardInterrupt
        Ctrl-C ends the batch within a second or two; nothing is lost, and ``resume=True`` goes on.
    Error
        Of the manifest and the folder: ``results_present``, ``missing_column``, ...

    Notes
    -----
    Recordings are fitted in child processes, so that one that crashes fails alone.
    """
    def show(total: int, before: int, fitted: int, failed: int, seconds: float) -> None:
        told = {"total": total, "before": before, "fitted": fitted, "failed": failed, "seconds": seconds}
        (progress if callable(progress) else _line)(told)

    part, parts = shard or (1, 1)
    if not 1 <= part <= parts:
        raise Error("out_of_range", f"shard: bad {shard!r}, expected (I, N) with I from 1 to N")
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    count = cores if jobs is None else jobs
    if not 1 <= count <= 1024:
        raise Error("out_of_range", f"jobs: {jobs} is out of range, expected 1 to 1024")
    options = {
        "manifest": os.fspath(manifest),
        "out": os.fspath(out),
        "tier": tier,
        "fixed": fixed_of(fix),
        "jobs": count,
        "timeout_s": _si("timeout", timeout, "time", above=0.0),
        "resume": bool(resume),
        "shard": part,
        "shards": parts,
        "report": None if report is None else os.fspath(report),
        "command": f"slipfit.batch({os.fspath(manifest)!r}, ...)  # Python",
        "joint_groups": bool(joint_groups),
    }
    counts = _slipfit.batch(options, show if progress else None, None)
    return BatchResult(os.fspath(out), counts)
