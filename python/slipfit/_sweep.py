"""What several recordings tell together; and the functions that fit or analyse one or several."""

from __future__ import annotations

import functools
import json
import os
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple, Union, overload

from . import _slipfit
from ._cells import Quantity, fixed_of
from ._documents import Path, write_page
from ._errors import Error, in_words_of_python
from ._fit import Curve, Fit, Options, _check_recording
from ._recording import Recording
from ._values import Estimate

if TYPE_CHECKING:
    import pandas as pd

Fix = Optional[Mapping[str, Quantity]]


class Sweep(Fit):
    """What several recordings tell together: one set of parameters, friction that depends on the speed included.

    As `Fit`; `recordings` holds each on its own. Frequency, spacing, cycles and curve belong to one recording.
    """

    def __init__(
        self, recordings: Mapping[str, Recording], name: str, options: Options, native: Optional[_slipfit.Sweep] = None
    ) -> None:
        super().__init__(None, options, name=name)
        self._all = dict(recordings)  # empty: of a saved sweep
        self._sweep = native
        self._members: Optional[Dict[str, Fit]] = None

    def _swept(self) -> _slipfit.Sweep:
        if self._sweep is None:
            if not self._all:
                raise Error("no_recording", f"{self.id}: a saved result holds no samples; attach them with sweep.with_recording(recordings)")
            named = [(name, one._native) for name, one in self._all.items()]
            if self._options.kind == "fit":
                made = _slipfit.fit_sweep(named, self._options.tier, list(self._options.fixed))
            else:
                made = _slipfit.analyze_sweep(named)
            self._check_same(made.json(self._id))
            self._sweep = made
        return self._sweep

    def with_recording(self, recording: Any = None) -> "Sweep":
        """The same result with its recordings, a mapping by the names in the document; as `Fit.with_recording`."""
        taken = self._all if recording is None else {str(name): one for name, one in recording.items()}
        stated = {one["id"]: one["recording"] for one in self._document()["recordings"]}
        if set(taken) != set(stated):
            raise Error("another_recording", f"{self.id}: the document has the recordings {', '.join(stated)}, not {', '.join(taken) or 'none'}")
        for name, one in taken.items():
            _check_recording(name, stated[name], one)
        made = Sweep({name: taken[name] for name in stated}, self._id, self._options, self._sweep)
        made._content, made._keeps_recording = self.to_json(), True
        return made

    def to_json(self) -> str:
        """The document of the schema slipfit.fit/1 with ``recordings``, as ``slipfit fit --joint --json`` writes it."""
        if self._content is None:
            self._content = self._swept().json(self._id)
        return self._content

    @property
    def recordings(self) -> Dict[str, Fit]:
        """Each recording's own result, by its name."""
        if self._members is None:
            if self._all:
                natives = zip(self._all.items(), self._swept().members)
                self._members = {name: Fit(one, self._options, native, name) for (name, one), native in natives}
            else:
                self._members = {one["id"]: self._saved_member(one) for one in self._document()["recordings"]}
        return self._members

    def _saved_member(self, content: Dict[str, Any]) -> Fit:
        """What the document of the sweep holds of a recording: no model of its own."""
        member = Fit(None, Options("analyze"), name=content["id"])
        member._content = json.dumps({"schema": "slipfit.fit/1", "version": self._document()["version"], **content})
        return member

    def __getitem__(self, name: str) -> Fit:
        return self.recordings[name]

    def __len__(self) -> int:
        return len(self._document()["recordings"])

    @property
    def recording(self) -> Recording:
        raise AttributeError("a sweep has several recordings: see .recordings")

    @property
    def pattern_spacing(self) -> Estimate:
        """Of one recording: ``sweep.recordings[NAME].pattern_spacing``."""
        return Estimate._of("pattern_spacing_m", None, "of one recording: see .recordings")

    @property
    def cycles(self) -> "pd.DataFrame":
        """Of all recordings, with the column ``recording``."""
        import pandas

        frames = [one.cycles.assign(recording=name) for name, one in self.recordings.items()]
        return pandas.concat(frames, ignore_index=True)

    @property
    def curve(self) -> Curve:
        raise AttributeError("a curve is of one recording: sweep.recordings[NAME].curve")

    def _quantities(self) -> List[Estimate]:
        return [*self.parameters.values(), self.critical_speed]

    def recordings_frame(self) -> "pd.DataFrame":
        """One row a recording: speed, status, role, frequency, spacing as measured, predicted, and predicted by the others."""
        import pandas

        rows = {}
        for one in self.to_dict()["recordings"]:
            values = {**one["derived"], **(one.get("joint") or {})}
            rows[one["id"]] = {
                "speed_m_per_s": one["recording"]["speed_m_per_s"],
                "normal_force_N": one["recording"]["normal_force_N"],
                "status": one["status"],
                "role": one.get("role"),
                "frequency_Hz": one["frequency"]["value_Hz"],
                **{key: (values.get(key) or {}).get("value") for key in ("pattern_spacing_m", "spacing_m", "spacing_left_out_m")},
            }
        return pandas.DataFrame.from_dict(rows, orient="index")

    def report(self, path: Path) -> None:
        """Write a page to look at, to print and to send (one HTML file, no network)."""
        write_page(path, self._swept().page(self._id, f"slipfit.{self._options.kind}([...])  # Python"))

    def plot(self, kind: str = "speed", ax: Any = None) -> Any:
        """Draw with matplotlib: axes in, axes out.

        Parameters
        ----------
        kind : str
            ``"speed"``: spacing over speed, measured and predicted; ``"friction"``: over speed; ``"trace"``: the traces
            one above the other; ``"cycles"``: the cycles of all recordings; ``"spectrum"``; ``"map"``: of the regimes.
        ax : matplotlib axes, optional
        """
        from . import _plot

        return _plot.sweep(self, kind, ax)

    def details(self) -> str:
        """All results as text, as ``slipfit fit --joint --details`` prints them."""
        return self._swept().text(self._id)

    def __repr__(self) -> str:
        known = f", stiffness {self.stiffness}" if self.parameters else ""
        return f"<slipfit.Sweep {self.id!r} of {len(self)}: {self.status.replace('_', ' ')}{known}>"

    def _state(self) -> Tuple[Any, ...]:
        return (self._all if self._keeps_recording else {}, self._options, self.to_json(), self._id)

    @classmethod
    def _from_state(cls, recording: Any, options: Options, content: str, name: str) -> "Sweep":
        made = cls(recording, name, options)
        made._content = content
        made._keeps_recording = bool(recording)
        return made


Recordings = Union[Recording, Sequence[Recording], Mapping[str, Recording]]


def _named(recordings: Iterable[Recording]) -> Dict[str, Recording]:
    """By their files' names without endings; what is called alike is numbered."""
    named: Dict[str, Recording] = {}
    for one in recordings:
        stem = os.path.splitext(os.path.basename(one.name))[0] or "recording"
        name, number = stem, 2
        while name in named:
            name, number = f"{stem} {number}", number + 1
        named[name] = one
    return named


def _check(recordings: Iterable[Any]) -> None:
    for one in recordings:
        if not isinstance(one, Recording):
            raise TypeError(f"expected recordings, not {type(one).__name__}: see Recording and read_recording")


def _group_name(named: Mapping[str, Recording]) -> str:
    """The group that all recordings share, else the first name and how many more there are."""
    groups = {value.group for value in named.values()}
    first = next(iter(named))
    return groups.pop() if len(groups) == 1 and "" not in groups else f"{first} and {len(named) - 1} more"


def _analysed(recordings: Recordings, name: Optional[str], options: Options) -> Any:
    if isinstance(recordings, Recording):
        named = {name or "": recordings}
    elif isinstance(recordings, Mapping):
        named = {str(key): value for key, value in recordings.items()}
    else:
        listed = list(recordings)
        _check(listed)
        named = {name or "": listed[0]} if len(listed) == 1 else _named(listed)
    _check(named.values())
    if not named:
        raise ValueError("expected at least one recording")
    if len(named) == 1:
        own_name, recording = next(iter(named.items()))
        one = Fit(recording, options, name=name or own_name)
        one._result()
        return one
    sweep = Sweep(named, _group_name(named) if name is None else name, options)
    sweep._swept()
    return sweep


@overload
def fit(recordings: Recording, *, tier: str = "auto", fix: Fix = None, name: Optional[str] = None) -> Fit: ...
@overload
def fit(
    recordings: Union[Sequence[Recording], Mapping[str, Recording]],
    *,
    tier: str = "auto",
    fix: Fix = None,
    name: Optional[str] = None,
) -> Sweep: ...
def fit(recordings: Recordings, *, tier: str = "auto", fix: Fix = None, name: Optional[str] = None) -> Any:
    """Fit the stick-slip model to a recording, or to several together.

    Parameters
    ----------
    recordings : Recording, sequence of Recording, or mapping of str to Recording
        One gives `Fit`, also in a sequence or mapping. Several are a sweep of one sliding pair at several speeds: one set of parameters, `Sweep`.
    tier : str
        ``"auto"``, ``"sawtooth"``, ``"undamped"``, ``"damped"``, ``"weakening"``; of several ``"auto"``, ``"damped"``, ``"velocity"``.
    fix : mapping of str to float, optional
        Parameters to hold, in SI: ``{"damping_ratio": 0.05}``; also ``stiffness_N_per_m`` and
        ``natural_frequency_rad_per_s``.
    name : str, optional
        The document's id; else the file's name.

    Returns
    -------
    Fit or Sweep
        A recording without stick-slip is no error: `Fit.status` says what it shows.

    Raises
    ------
    Error
        ``unknown_tier``, ``unknown_fix``, ``bad_number``, ``out_of_range``; of several ``not_a_force``,
        ``view_not_spring``.

    Notes
    -----
    Other Python threads run meanwhile: a pool of threads fits on all cores.
    """
    return _analysed(recordings, name, Options("fit", tier, tuple(fixed_of(fix))))


def _fit_one(tier: str, fix: Fix, item: Tuple[str, Recording]) -> Fit:
    """At the top of the module, so that other processes can be asked for it."""
    name, recording = item
    return fit(recording, tier=tier, fix=fix, name=name or None)


def fit_many(
    recordings: Union[Iterable[Recording], Mapping[str, Recording]],
    *,
    map: Callable[..., Iterable[Any]] = map,
    tier: str = "auto",
    fix: Fix = None,
) -> Any:
    """Fit each recording on its own, by any pool.

    Parameters
    ----------
    recordings : iterable of Recording, or mapping of str to Recording
    map : callable
        ``map(function, sequence)``: that of a ``concurrent.futures`` executor, of a ``multiprocessing`` pool, or the
        built-in one.
    tier, fix
        As for `fit`.

    Returns
    -------
    list of Fit, or dict of str to Fit

    Raises
    ------
    Error
        Of the first recording that cannot be fitted. `batch` reports failures one by one.
    """
    items = (
        [(str(name), one) for name, one in recordings.items()]
        if isinstance(recordings, Mapping)
        else [("", one) for one in recordings]
    )
    _check(one for _, one in items)
    results = list(map(functools.partial(_fit_one, tier, fix), items))
    for result, (_, recording) in zip(results, items):
        result._recording = recording  # one that comes from another process has none
    return {name: one for (name, _), one in zip(items, results)} if isinstance(recordings, Mapping) else results


@overload
def analyze(recordings: Recording, *, name: Optional[str] = None) -> Fit: ...
@overload
def analyze(
    recordings: Union[Sequence[Recording], Mapping[str, Recording]], *, name: Optional[str] = None
) -> Sweep: ...
def analyze(recordings: Recordings, *, name: Optional[str] = None) -> Any:
    """Frequency, cycles and kind of sliding; no model is fitted. Arguments and result as of `fit`."""
    return _analysed(recordings, name, Options("analyze"))
