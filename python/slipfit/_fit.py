"""What one recording tells: a view on the library's document, and arrays."""

from __future__ import annotations

import json
import warnings
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union, cast

import numpy as np

from . import _slipfit
from ._cells import Quantity, text_of
from ._documents import Path, Plan, Prediction, frame_of_csv, row_of, write_page
from ._errors import Error, in_words_of_python
from ._recording import Recording
from ._values import Estimate, Notice, Parameters, notices_of

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    Array = npt.NDArray[np.float64]

Speeds = Union[str, Sequence[Quantity], "Array"]

_NOT_FITTED = "not in this result: analyze() fits no model, or the model that fits does not have it"


class Curve(NamedTuple):
    """The trace and the fit on it: arrays of shape (n,), NaN where the fit does not reach."""

    time: "Array"
    """Seconds."""
    force: "Array"
    """As measured, in the unit of `Recording.force_unit`."""
    fitted: "Array"
    residual: "Array"
    """`force` less `fitted`."""


class Options(NamedTuple):
    """How a result was made."""

    kind: str  # "fit" or "analyze"
    tier: str = "auto"
    fixed: Tuple[str, ...] = ()


class Fit:
    """What one recording tells, as `fit` or `analyze` find it.

    Numbers are `Estimate`: `.value`, `.se`, `.ci95`, `.status`, `.note`, in SI. What is not known is None and the note
    says why. ``identified``: to be trusted; ``weak``: read its interval; ``bounded``: only the interval is known;
    ``conditional``: known if what the note names holds; ``unidentified``: the recording cannot tell; ``fixed``: held.
    """

    def __init__(
        self, recording: Optional[Recording], options: Options, native: Optional[_slipfit.Analysis] = None, name: str = ""
    ) -> None:
        self._recording = recording
        self._options = options
        self._native = native
        self._content: Optional[str] = None
        self._parsed: Optional[Dict[str, Any]] = None
        self._id = name
        self._keeps_recording = False  # in a pickle

    # The document

    def _result(self) -> _slipfit.Analysis:
        """Made again after unpickling: the same input gives the same bytes."""
        if self._native is None:
            native = self.recording._native
            fitted = self._options.kind == "fit"
            made = _slipfit.fit(native, self._options.tier, list(self._options.fixed)) if fitted else _slipfit.analyze(native)
            self._check_same(made.json(self._id))
            self._native = made
        return self._native

    def _check_same(self, made: str) -> None:
        """Warns where what is made again differs from what was saved: other options, or another version."""
        if self._content is None or self._content == made:
            return
        if json.loads(made).get("parameters") != self._document().get("parameters"):
            warnings.warn(
                f"{self.id}: made again, the fit has other parameters than the saved one "
                f"(saved by version {self._document()['version']}, this is {_slipfit.__version__})",
                stacklevel=4,
            )

    def to_json(self) -> str:
        """The document of the schema slipfit.fit/1, byte for byte that of ``slipfit fit --json``."""
        if self._content is None:
            self._content = self._result().json(self._id)
        return self._content

    def to_dict(self) -> Dict[str, Any]:
        """The document as Python's own types; a new one at each call."""
        return cast(Dict[str, Any], json.loads(self.to_json()))

    def _document(self) -> Dict[str, Any]:
        if self._parsed is None:
            self._parsed = self.to_dict()
        return self._parsed

    # Numbers

    @property
    def id(self) -> str:
        """The name in the document."""
        return cast(str, self._document()["id"])

    @property
    def recording(self) -> Recording:
        """What was analysed. A document holds no samples: see `with_recording`."""
        if self._recording is None:
            raise Error("no_recording", f"{self.id}: a saved result holds no samples; attach them with fit.with_recording(recording)")
        return self._recording

    def with_recording(self, recording: Optional[Recording] = None) -> "Fit":
        """The same result with its recording, which a pickle of it carries, too.

        Parameters
        ----------
        recording : Recording, optional
            What a saved result was made of: curve, cycles, charts and page are made again from it. Without it the
            recording that the result has.

        Raises
        ------
        Error
            ``another_recording`` where number of samples, duration or speed differ from those in the document.
        """
        taken = self.recording if recording is None else recording
        _check_recording(self.id, self._document()["recording"], taken)
        made = Fit(taken, self._options, self._native, self._id)
        made._content, made._keeps_recording = self.to_json(), True
        return made

    @property
    def status(self) -> str:
        """``stick_slip``, ``steady_sliding``, ``oscillatory_slip`` or ``undetermined``."""
        return cast(str, self._document()["status"])

    @property
    def reason(self) -> str:
        """Why that status, in a sentence."""
        return in_words_of_python(self._document().get("status_reason") or "")

    @property
    def warnings(self) -> List[Notice]:
        """What to know before trusting the numbers."""
        return notices_of(self._document()["warnings"])

    @property
    def parameters(self) -> Parameters:
        """The parameters of the model by their keys: ``fit.parameters["stiffness_N_per_m"]``; empty without a fit."""
        content = self._document().get("parameters") or {}
        return Parameters({name: Estimate._of(name, one) for name, one in content.items()})

    def _parameter(self, name: str) -> Estimate:
        content = self._document().get("parameters") or {}
        return Estimate._of(name, content.get(name), _NOT_FITTED)

    @property
    def stiffness(self) -> Estimate:
        """Tangential stiffness k (N/m)."""
        return self._parameter("stiffness_N_per_m")

    @property
    def friction_difference(self) -> Estimate:
        """F_s - F_k at v = 0+ (N)."""
        return self._parameter("friction_difference_N")

    @property
    def natural_frequency(self) -> Estimate:
        """w_n = sqrt(k/m) (rad/s)."""
        return self._parameter("natural_frequency_rad_per_s")

    @property
    def damping_ratio(self) -> Estimate:
        """zeta = c / (2 sqrt(k m))."""
        return self._parameter("damping_ratio")

    @property
    def frequency(self) -> Estimate:
        """Slips a second (Hz); None in steady sliding."""
        content = self._document().get("frequency")
        return Estimate._of("frequency_Hz", content, "of one recording: see .recordings", "_Hz")

    def _derived(self, name: str) -> Estimate:
        return Estimate._of(name, self._document().get("derived", {}).get(name), "not in this result")

    @property
    def pattern_spacing(self) -> Estimate:
        """Distance of the abrasion pattern's ridges, V / f (m): a measurement, no prediction."""
        return self._derived("pattern_spacing_m")

    @property
    def periodic_displacement(self) -> Estimate:
        """Distance of the slips by the fitted model at this speed (m)."""
        return self._derived("periodic_displacement_m")

    @property
    def critical_speed(self) -> Estimate:
        """Speed at which stick-slip ends, by the fitted model (m/s)."""
        return self._derived("critical_speed_m_per_s")

    @property
    def aicc(self) -> Optional[float]:
        """AICc of the chosen model, up to a constant of the recording; None without a fit."""
        candidates = (self._document().get("model") or {}).get("candidates") or []
        return next((one["aicc"] for one in candidates if one["chosen"]), None)

    @property
    def covariance(self) -> "pd.DataFrame":
        """Covariance of the parameters in SI, names on both axes: by the delta method where the fit is in logarithms.

        It describes the model that was fitted. Intervals (`Estimate.ci95`) include more: trends of the level, bounds,
        the doubts that the notes name. `sample` draws from these.
        """
        from . import _uncertainty

        return _uncertainty.covariance(self.id, self._document())

    def sample(self, n: int, *, seed: int = 1) -> "pd.DataFrame":
        """Draws of the parameters from their stated uncertainty: one row a draw, in SI.

        Parameters
        ----------
        n : int
            Number of draws.
        seed : int
            The same seed gives the same draws.

        Returns
        -------
        DataFrame
            The parameters of `covariance` with ``mass_kg`` and ``damping_coefficient_N_s_per_m`` that follow from them. Medians are
            the values, the central 95 % of each column is its interval ``ci95``, with its skew; ranks depend on
            each other as in the fit.

        Raises
        ------
        Error
            ``no_covariance``.
        """
        from . import _uncertainty

        return _uncertainty.sample(self.id, self._document(), n, seed)

    def to_xarray(self, n: int = 1000, *, seed: int = 1) -> Any:
        """`sample` as an xarray.Dataset with the dimensions ``chain`` and ``draw``, units as attributes."""
        from . import _uncertainty

        return _uncertainty.dataset(self.sample(n, seed=seed))

    def to_inference_data(self, n: int = 1000, *, seed: int = 1) -> Any:
        """`sample` as the posterior of an arviz.InferenceData."""
        import arviz

        return arviz.InferenceData(posterior=self.to_xarray(n, seed=seed))

    def row(self, *, text: bool = False) -> Dict[str, Union[str, int, float, None]]:
        """The row of summary.csv, without the manifest's ``row``: None where a cell is empty.

        Parameters
        ----------
        text : bool
            The cells as summary.csv has them, digit for digit.
        """
        return row_of(_slipfit.summary_row(self.to_json(), self.id), text)

    def _quantities(self) -> List[Estimate]:
        """What tables and texts show, in their order."""
        return [*self.parameters.values(), self.frequency, self.pattern_spacing, self.periodic_displacement, self.critical_speed]

    # Tables and arrays

    def to_frame(self) -> "pd.DataFrame":
        """One row a quantity, by its key: value, se, low, high (95 %), unit, status, note."""
        import pandas

        rows = {
            one.name: {
                "value": float(one),
                "se": float("nan") if one.se is None else one.se,
                "low": float("nan") if one.ci95 is None else one.ci95[0],
                "high": float("nan") if one.ci95 is None else one.ci95[1],
                "unit": one.unit,
                "status": one.status or "",
                "note": one.note,
            }
            for one in self._quantities()
        }
        return pandas.DataFrame.from_dict(rows, orient="index")

    @property
    def cycles(self) -> "pd.DataFrame":
        """One row a cycle, as ``--cycles`` writes them: times (s), forces, and what the fit says of each."""
        return frame_of_csv(self._result().cycles_csv()).astype({"used": bool})

    @property
    def curve(self) -> Curve:
        """Time, force, fitted force and residual, each of shape (n,)."""
        fitted = self._result().fitted()
        recording = self.recording
        return Curve(recording.time, recording.force, fitted, recording.force - fitted)

    # What follows from it

    def predict(self, speeds: Speeds, *, normal_force: Optional[Quantity] = None) -> Prediction:
        """What the fitted model says at other speeds, with 95 % bands, and where stick-slip ends.

        Parameters
        ----------
        speeds : array of shape (n,) or sequence in m/s, sequence of texts, or text
            ``[0.01, 0.02]``, ``["1 mm/s", "5 mm/s"]``, ``"5mm/s,10mm/s"``, or ``"A:B:N"``: N speeds from A to B in
            equal ratios.
        normal_force : float or str, optional
            Predict under this load (N); needs a fit whose recordings state theirs.

        Raises
        ------
        Error
            ``cannot_predict`` where the fit leaves a parameter open that the motion depends on (the message names it
            and why), ``bad_speeds``, ``out_of_range``, ``no_normal_force``.
        """
        load = None if normal_force is None else _slipfit.quantity(text_of(normal_force), "force")
        if load is not None and not load > 0.0:
            raise Error("out_of_range", f"normal_force: {normal_force!r} is not above zero, expected a load in N")
        return Prediction(*_slipfit.predict(self.to_json(), self.id, speeds_of(speeds), load))

    def plan(self, name: Optional[str] = None, *, speed: Optional[Quantity] = None) -> Plan:
        """Which recording to make next, so that one number becomes better known.

        Parameters
        ----------
        name : str, optional
            Key of a parameter, or its beginning without the unit: ``"damping_ratio"``, ``"stiffness"``; or
            ``"periodic_displacement_m"`` with `speed`. Without it the one that is known worst.
        speed : float or str, optional
            Speed of the predicted spacing to narrow (m/s).

        Raises
        ------
        Error
            ``bad_target``, ``cannot_predict``, ``no_covariance``.
        """
        at = None if speed is None else _slipfit.quantity(text_of(speed), "speed")
        if name is None and at is not None:
            name = "periodic_displacement_m"
        return Plan(*_slipfit.plan(self.to_json(), self.id, self._key_of(name), at))

    def _key_of(self, name: Optional[str]) -> Optional[str]:
        if name is None or name in self.parameters:
            return name
        meant = [key for key in (*self.parameters, "periodic_displacement_m") if key.startswith(name + "_")]
        return meant[0] if len(meant) == 1 else name

    def details(self) -> str:
        """All results as text, as ``slipfit fit --details`` prints them."""
        return self._result().text()

    def report(self, path: Path) -> None:
        """Write a page to look at, to print and to send (one HTML file, no network)."""
        write_page(path, self._result().page(f"slipfit.{self._options.kind}(...)  # Python"))

    def plot(self, kind: str = "trace", ax: Any = None) -> Any:
        """Draw with matplotlib: axes in, axes out.

        Parameters
        ----------
        kind : str
            A chart of the page: ``"trace"``: force, fit and residual; ``"spectrum"``; ``"cycles"``: all cycles over each
            other; ``"residuals"``: over the cycle; ``"evolution"``: over the slips; ``"pairs"``: peaks and troughs;
            ``"map"``: of the regimes; ``"speed"``: spacing and frequency over speed; ``"pattern"``.
        ax : matplotlib axes, optional
            To draw into; else new ones.
        """
        from . import _plot

        return _plot.fit(self, kind, ax)

    # Python

    def __str__(self) -> str:
        """The summary that ``slipfit fit`` prints, in words of Python."""
        return in_words_of_python(_slipfit.summary(self.to_json(), self.id))

    def __repr__(self) -> str:
        known = f", stiffness {self.stiffness}" if self.parameters else ""
        return f"<slipfit.{type(self).__name__} {self.id!r}: {self.status.replace('_', ' ')}, {self.frequency}{known}>"

    def _repr_html_(self) -> str:
        from . import _html

        return _html.of_fit(self)

    def __reduce__(self) -> Tuple[Any, ...]:
        return (_remade, (type(self), self._state()))

    def _state(self) -> Tuple[Any, ...]:
        return (self._recording if self._keeps_recording else None, self._options, self.to_json(), self._id)

    @classmethod
    def _from_state(cls, recording: Any, options: Options, content: str, name: str) -> "Fit":
        made = cls(recording, options, name=name)
        made._content = content
        made._keeps_recording = recording is not None
        return made

    def __copy__(self) -> "Fit":
        return self

    def __deepcopy__(self, memo: Dict[int, Any]) -> "Fit":
        return self


def _check_recording(name: str, stated: Mapping[str, Any], recording: Recording) -> None:
    """Raises where the document is of another recording."""
    for word, expected, found in (
        ("samples", stated["samples"], len(recording)),
        ("s", stated["duration_s"], recording.duration),
        ("m/s", stated["speed_m_per_s"], recording.speed),
    ):
        if expected is not None and abs(found - expected) > 1e-9 * abs(expected):
            raise Error("another_recording", f"{name}: the document is of {expected:.9g} {word}, this recording has {found:.9g}")


def _remade(kind: Any, state: Tuple[Any, ...]) -> Any:
    return kind._from_state(*state)


def speeds_of(speeds: Speeds) -> Union[str, List[float]]:
    if isinstance(speeds, str):
        return speeds
    if isinstance(speeds, (int, float)):
        return [float(speeds)]
    listed = list(speeds)
    if any(isinstance(one, str) for one in listed):
        return ",".join(text_of(one) for one in listed)
    return [float(one) for one in listed]
