"""Recordings: from arrays, or from files as testers export them."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Dict, List, Literal, Optional, Tuple, Union, overload

import numpy as np

from . import _slipfit
from ._arrays import column_of
from ._cells import Quantity, cells_of
from ._errors import in_words_of_python
from ._sources import Source, local_file
from ._values import Notice

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    Array = npt.NDArray[np.float64]

Range = Union[str, Tuple[Quantity, Quantity]]


class Recording:
    """Force over time of one run, and how it was made.

    Parameters
    ----------
    time : array of shape (n,), or None
        Seconds (or `time_unit`). Lists, pandas Series and any array of numbers will do; contiguous doubles are read
        where they lie. Dates (`DatetimeIndex`, ``datetime64``, ``datetime``) and durations (``timedelta64``) become
        seconds, dates since the first. None: `sample_rate` is the clock.
    force : array of shape (n,)
        Newtons (or `force_unit`; ``"1"`` for a coefficient of friction, ``"N m"`` for a torque, with `radius`). Values that
        are masked, missing or not finite are left out and counted, as are samples whose time runs backwards: the result says so.
    speed : float or str
        Driving speed in m/s, or text with a unit: ``"10 mm/s"``, ``"600 mm/min"``; ``"60 rpm"`` with `radius`.
    normal_force : float or str, optional
        Newtons, or text: ``"41 gf"``. Coefficients of friction need it.
    zero : float or str, optional
        Reading of the sensor at no force. Absolute forces are `conditional` without it.
    name : str
        What results and messages call the recording.
    sample_rate, time_unit, force_unit, window, rows
        As for `read_recording`.
    speed_uncertainty, radius, mass, mass_uncertainty, force_view, drift, sensor_bandwidth, sensor_filter, sensor_average,
    sensor_resonance,
    drive_period, drive_path, measured_spacing, measured_spacing_uncertainty, surface, group, sample, material, operator
        As for `read_recording`.

    Raises
    ------
    Error
        Where the arrays are no recording (``length_mismatch``, ``too_few_samples``, ``time_runs_backwards``,
        ``reciprocating``, ...) or a text is no value of its argument (``bad_number``, ``unknown_unit``,
        ``out_of_range``).

    Notes
    -----
    The recording keeps a copy of its own of the samples: changing the array afterwards changes no recording.
    Recordings cannot be changed; they can be pickled and copied.
    """

    __slots__ = ("_native", "__weakref__")
    _native: _slipfit.Recording

    def __init__(
        self,
        time: Any,
        force: Any,
        *,
        speed: Optional[Quantity] = None,
        normal_force: Optional[Quantity] = None,
        zero: Optional[Quantity] = None,
        name: str = "recording",
        sample_rate: Optional[Quantity] = None,
        time_unit: Optional[str] = None,
        force_unit: Optional[str] = None,
        window: Optional[Range] = None,
        rows: Optional[Range] = None,
        speed_uncertainty: Optional[Quantity] = None,
        radius: Optional[Quantity] = None,
        mass: Optional[Quantity] = None,
        mass_uncertainty: Optional[Quantity] = None,
        force_view: Optional[str] = None,
        drift: Optional[str] = None,
        sensor_bandwidth: Optional[Quantity] = None,
        sensor_filter: Optional[str] = None,
        sensor_average: Optional[Quantity] = None,
        sensor_resonance: Optional[Quantity] = None,
        drive_period: Optional[Quantity] = None,
        drive_path: Optional[Quantity] = None,
        measured_spacing: Optional[Quantity] = None,
        measured_spacing_uncertainty: Optional[Quantity] = None,
        surface: Union[str, "os.PathLike[str]", None] = None,
        group: Optional[str] = None,
        sample: Optional[str] = None,
        material: Optional[str] = None,
        operator: Optional[str] = None,
    ) -> None:
        said = dict(locals())
        for own in ("self", "time", "force", "name", "__class__"):
            said.pop(own, None)
        clock = None if time is None else column_of(time, "time", unit=time_unit)
        self._native = _slipfit.take_arrays(str(name), clock, column_of(force, "force"), cells_of(said))[0][1]

    @classmethod
    def _of(cls, native: _slipfit.Recording) -> "Recording":
        made = cls.__new__(cls)
        made._native = native
        return made

    @property
    def time(self) -> "Array":
        """Seconds on the recording's own clock, shape (n,), read-only, without a copy."""
        return self._native.time_s

    @property
    def force(self) -> "Array":
        """Newtons, or coefficients of friction, the zero subtracted; shape (n,), read-only, without a copy."""
        return self._native.force

    @property
    def name(self) -> str:
        """The file, or the name that was given."""
        return self._native.file

    @property
    def speed(self) -> float:
        """Driving speed in m/s."""
        return self._native.speed_m_per_s

    @property
    def normal_force(self) -> Optional[float]:
        """Newtons; None where it is not known."""
        return self._native.normal_force_N

    @property
    def group(self) -> str:
        """Label of the recordings that belong together; empty without one."""
        return self._native.group

    @property
    def sample_rate(self) -> float:
        """Samples a second (Hz), from the median step of the clock."""
        return 1.0 / self._native.sample_interval_s

    @property
    def duration(self) -> float:
        """Seconds from the first sample to the last."""
        return float(self.time[-1] - self.time[0])

    @property
    def force_unit(self) -> str:
        """``"N"``, or ``"1"`` for a coefficient of friction whose normal force is not known."""
        return "1" if self._native.is_coefficient else "N"

    @property
    def assumed(self) -> List[str]:
        """What reading had to assume, sentence by sentence."""
        return [in_words_of_python(one) for one in self._native.assumed]

    @property
    def warnings(self) -> List[Notice]:
        """What was found while reading."""
        return [Notice(code, in_words_of_python(message)) for code, message in self._native.warnings]

    def to_frame(self) -> "pd.DataFrame":
        """Columns ``time_s`` and ``force_N`` (``force_1`` for coefficients)."""
        import pandas

        return pandas.DataFrame({"time_s": self.time, f"force_{self.force_unit}": self.force})

    def plot(self, ax: Any = None) -> Any:
        """The trace; matplotlib axes in, axes out."""
        from . import _plot

        return _plot.trace(self, ax)

    def __len__(self) -> int:
        return len(self._native)

    def __repr__(self) -> str:
        load = "" if self.normal_force is None else f", {self.normal_force:g} N load"
        return f"<slipfit.Recording {self.name!r}: {len(self)} samples, {self.duration:.4g} s, {self.speed:g} m/s{load}>"

    def _repr_html_(self) -> str:
        from . import _html

        return _html.of_recording(self)

    def __reduce__(self) -> Tuple[Any, ...]:
        return (Recording._of, (self._native,))

    def __copy__(self) -> "Recording":
        return self

    def __deepcopy__(self, memo: Dict[int, Any]) -> "Recording":
        return self


@overload
def read_recording(
    file: Source,
    *,
    speed: Optional[Quantity] = ...,
    normal_force: Optional[Quantity] = ...,
    zero: Optional[Quantity] = ...,
    window: Optional[Range] = ...,
    step: Optional[int] = ...,
    rows: Optional[Range] = ...,
    where: Any = ...,
    strokes: Literal[False, None] = ...,
    segments: Literal[False, None] = ...,
    time_column: Union[str, int, None] = ...,
    force_column: Union[str, int, None] = ...,
    normal_force_column: Union[str, int, None] = ...,
    speed_column: Union[str, int, None] = ...,
    time_unit: Optional[str] = ...,
    force_unit: Optional[str] = ...,
    force_scale: Optional[str] = ...,
    sample_rate: Optional[Quantity] = ...,
    sheet: Union[str, int, None] = ...,
    variable: Optional[str] = ...,
    speed_uncertainty: Optional[Quantity] = ...,
    radius: Optional[Quantity] = ...,
    mass: Optional[Quantity] = ...,
    mass_uncertainty: Optional[Quantity] = ...,
    force_view: Optional[str] = ...,
    drift: Optional[str] = ...,
    sensor_bandwidth: Optional[Quantity] = ...,
    sensor_filter: Optional[str] = ...,
    sensor_average: Optional[Quantity] = ...,
    sensor_resonance: Optional[Quantity] = ...,
    drive_period: Optional[Quantity] = ...,
    drive_path: Optional[Quantity] = ...,
    measured_spacing: Optional[Quantity] = ...,
    measured_spacing_uncertainty: Optional[Quantity] = ...,
    surface: Union[str, "os.PathLike[str]", None] = ...,
    group: Optional[str] = ...,
    sample: Optional[str] = ...,
    material: Optional[str] = ...,
    operator: Optional[str] = ...,
) -> Recording: ...
@overload
def read_recording(file: Source, *, strokes: Union[Literal[True], str], **said: Any) -> Dict[str, Recording]: ...
@overload
def read_recording(file: Source, *, segments: Literal[True], **said: Any) -> Dict[str, Recording]: ...
def read_recording(  # type: ignore[misc]  # arguments of the other two are those of the first
    file: Source,
    *,
    speed: Optional[Quantity] = None,
    normal_force: Optional[Quantity] = None,
    zero: Optional[Quantity] = None,
    window: Optional[Range] = None,
    step: Optional[int] = None,
    rows: Optional[Range] = None,
    where: Any = None,
    strokes: Union[bool, str, None] = None,
    segments: Optional[bool] = None,
    time_column: Union[str, int, None] = None,
    force_column: Union[str, int, None] = None,
    normal_force_column: Union[str, int, None] = None,
    speed_column: Union[str, int, None] = None,
    time_unit: Optional[str] = None,
    force_unit: Optional[str] = None,
    force_scale: Optional[str] = None,
    sample_rate: Optional[Quantity] = None,
    sheet: Union[str, int, None] = None,
    variable: Optional[str] = None,
    speed_uncertainty: Optional[Quantity] = None,
    radius: Optional[Quantity] = None,
    mass: Optional[Quantity] = None,
    mass_uncertainty: Optional[Quantity] = None,
    force_view: Optional[str] = None,
    drift: Optional[str] = None,
    sensor_bandwidth: Optional[Quantity] = None,
    sensor_filter: Optional[str] = None,
    sensor_average: Optional[Quantity] = None,
    sensor_resonance: Optional[Quantity] = None,
    drive_period: Optional[Quantity] = None,
    drive_path: Optional[Quantity] = None,
    measured_spacing: Optional[Quantity] = None,
    measured_spacing_uncertainty: Optional[Quantity] = None,
    surface: Union[str, "os.PathLike[str]", None] = None,
    group: Optional[str] = None,
    sample: Optional[str] = None,
    material: Optional[str] = None,
    operator: Optional[str] = None,
) -> Any:
    """Read a recording as a tester exports it: text of any layout, .xlsx, .mat, HDF5, TDMS, packed or not.

    What is not said is found out; `Recording.assumed` tells what was assumed. Every argument is an option of
    ``slipfit fit`` of the same name, with the same meaning.

    Parameters
    ----------
    file : path, file object or address
        Open files and what fsspec opens (``"s3://..."``) are copied first.
    speed : float or str
        Driving speed: 0.01 (m/s), ``"10 mm/s"``, ``"600 mm/min"``; ``"60 rpm"`` with `radius`. A column may tell it.
    normal_force : float or str
        5 (N), ``"41 gf"``. A column may tell it.
    zero : float or str
        Reading of the sensor at no force (N).
    window : (float, float) or "T0:T1"
        Part to read, in seconds on the recording's own clock.
    step : int
        Step of a file that holds several.
    rows : (int, int) or "A:B"
        Rows of numbers, counted from 1, both included.
    where : {column: value}, (column, value) or "COLUMN=VALUE"
        Rows whose cell in this column says this.
    strokes : True, "both", "positive" or "negative"
        Reciprocating test: each stroke is a recording.
    segments : bool
        Each stretch of one speed is a recording.
    time_column, force_column, normal_force_column, speed_column : str or int
        Name, or number counted from 1.
    time_unit, force_unit : str
        ``"ms"``, ``"mN"``; ``"1"`` for a coefficient.
    force_scale : str
        ``"5 N/V"``: the force for a unit of what the column holds.
    sample_rate : float or str
        Hz, for a recording without a clock.
    sheet : str or int
        Of a workbook or a zip archive.
    variable : str
        Of a .mat file, dataset or group of HDF5, group of TDMS.
    speed_uncertainty : float or str
        Standard error of the speed: ``"0.1 mm/s"``, ``"1 %"``.
    radius : float or str
        Distance of the contact from the axis (m): for a torque, or a speed of rotation.
    mass : float or str
        Moving mass (kg); gives w_n where averaging hides it, else held against k / w_n**2.
    mass_uncertainty : float or str
        Standard error of the mass: ``"5 g"``, ``"1 %"``; 2 % of it by default.
    force_view : "spring", "transmitted" or "contact"
        Which force the sensor sees.
    drift : "sensor", "friction" or "none"
        How a trend of the force level is read; without it intervals include both readings where the data do not decide.
    sensor_bandwidth, sensor_resonance : float or str
        Of the sensor (Hz).
    sensor_filter : str
        Low-pass filter of the instrument (Butterworth), order and corner: ``"4, 200 Hz"``.
    sensor_average : float or str
        Time over which each sample is averaged (s); 0 for an instant.
    drive_period : float or str
        Period of what may set the rhythm (s): a motor's step.
    drive_path : float or str
        Path over which the drive's force repeats (m): a tooth, a turn.
    measured_spacing, measured_spacing_uncertainty : float or str
        Of the pattern on the worn surface (m), to hold the prediction against.
    surface : path
        Profile or image of the worn track.
    group, sample, material, operator : str
        Labels that results carry.

    Returns
    -------
    Recording, or dict of str to Recording
        With `strokes` or `segments` a dict, which `fit` takes as it is.

    Raises
    ------
    Error
        See docs/formats.md for the codes.
    """
    said = dict(locals())
    said.pop("file")
    with local_file(file) as (path, name):
        pieces = _slipfit.read_file(path, cells_of(said), name)
    if strokes or segments:
        return {name: Recording._of(native) for name, native in pieces}
    return Recording._of(pieces[0][1])
