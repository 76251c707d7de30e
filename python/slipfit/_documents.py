"""Results that are a document of the library: the same JSON as the command line writes."""

from __future__ import annotations

import csv
import io
import json
import os
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Tuple, Union, cast

from ._errors import in_words_of_python
from ._values import Estimate, Notice, notices_of

if TYPE_CHECKING:
    import pandas as pd

Path = Union[str, "os.PathLike[str]"]


def frame_of_csv(text: str) -> "pd.DataFrame":
    """A table of the library, digit for digit."""
    import pandas

    return pandas.read_csv(io.StringIO(text), float_precision="round_trip")


def row_of(lines: Tuple[str, str], text: bool) -> Dict[str, Union[str, int, float, None]]:
    """A line of names and a line of cells: numbers as numbers, names as text, an empty cell is None; or all cells as text."""
    names, cells = csv.reader(line.rstrip("\n") for line in lines)
    if text:
        return dict(zip(names, cells))
    return {name: _cell(text, name in ("id", "group", "file")) for name, text in zip(names, cells)}


def _cell(text: str, is_name: bool) -> Union[str, int, float, None]:
    if is_name or not text:
        return text or None
    try:
        return int(text)
    except ValueError:
        pass
    try:
        return float(text)
    except ValueError:
        return text


def write_page(path: Path, page: str) -> None:
    with open(path, "w", encoding="utf-8") as file:
        file.write(page)


def _with_ends(name: str, content: Dict[str, Any]) -> Dict[str, Any]:
    """Value and ends of the interval of an estimate, as cells of a table."""
    estimate = content.get(name) or {}
    low, high = estimate.get("ci95") or (None, None)
    return {name: estimate.get("value"), name + "_low": low, name + "_high": high}


class Document:
    """A JSON document of the library, and the same for people."""

    def __init__(self, content: str, text: str) -> None:
        self._content = content
        self._text = text

    def to_json(self) -> str:
        """The document, as the command line writes it with ``--json``."""
        return self._content

    def to_dict(self) -> Dict[str, Any]:
        """The document as Python's own types; a new one at each call."""
        return cast(Dict[str, Any], json.loads(self._content))

    @property
    def warnings(self) -> List[Notice]:
        """What to know before trusting the numbers."""
        return notices_of(self.to_dict().get("warnings", []))

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        """The first line of the text."""
        return f"<slipfit.{type(self).__name__} {self._summary()}>"

    def _summary(self) -> str:
        return next((line.strip() for line in self._text.splitlines() if line.strip()), "")

    def _repr_html_(self) -> str:
        from . import _html

        return _html.of_document(self)

    def __reduce__(self) -> Tuple[Any, ...]:
        return (type(self), (self._content, self._text))


class Prediction(Document):
    """What the fitted model says at other speeds (`Fit.predict`)."""

    def __init__(self, content: str, text: str, table: str) -> None:
        super().__init__(content, text)
        self._table = table

    @property
    def critical_speed(self) -> Estimate:
        """Where stick-slip ends (m/s)."""
        return Estimate._of("critical_speed_m_per_s", self.to_dict()["critical_speed_m_per_s"])

    def to_frame(self) -> "pd.DataFrame":
        """One row a speed: value, low and high of each quantity, in SI; the columns of ``predict --csv``."""
        return frame_of_csv(self._table)

    def plot(self, ax: Any = None) -> Any:
        """Spacing over speed with its 95 % band; matplotlib axes in, axes out."""
        from . import _plot

        return _plot.prediction(self.to_dict(), ax)

    def __reduce__(self) -> Tuple[Any, ...]:
        return (Prediction, (self._content, self._text, self._table))


class Plan(Document):
    """Which recording to make next (`Fit.plan`)."""

    def to_frame(self) -> "pd.DataFrame":
        """One row an option, best first: speed, sampling rate, duration, and the standard error with it."""
        import pandas

        return pandas.json_normalize(self.to_dict()["options"])


class Comparison(Document):
    """Do two sides differ (`compare`)?"""

    def __init__(self, content: str, text: str, page: Optional[Any] = None) -> None:
        super().__init__(content, text)
        self._page = page

    def _summary(self) -> str:
        found = next((line for line in self._text.splitlines() if line.startswith(("A and B ", "No "))), None)
        return super()._summary() if found is None else found.partition(":")[0].rstrip(".")

    def to_frame(self) -> "pd.DataFrame":
        """One row a quantity: difference and ratio with interval, p value, adjusted for all quantities (Holm)."""
        import pandas

        rows = {}
        for name, content in self.to_dict()["quantities"].items():
            rows[name] = {
                **_with_ends("difference", content),
                **_with_ends("ratio", content),
                "p_value": content.get("p_value"),
                "p_adjusted": content.get("p_adjusted"),
            }
        return pandas.DataFrame.from_dict(rows, orient="index")

    def report(self, path: Path) -> None:
        """Write the page of the comparison (one HTML file)."""
        if self._page is None:
            raise RuntimeError("an unpickled comparison has no page: compare again")
        write_page(path, self._page())


class Info(Document):
    """What a file holds, and what `read_recording` would take of it (`info`)."""

    @property
    def refusal(self) -> Optional[str]:
        """Why the file would be refused as it is; None where it is a recording."""
        refusal = self.to_dict()["refusal"]
        return None if refusal is None else in_words_of_python(refusal)

    @property
    def sheets(self) -> List[str]:
        """What `sheet` can name: sheets of a workbook, files of an archive."""
        return cast(List[str], self.to_dict()["sheets"])

    @property
    def variables(self) -> List[str]:
        """What `variable` can name: groups and tables of HDF5, TDMS and MATLAB files."""
        return cast(List[str], self.to_dict()["variables"])

    @property
    def columns(self) -> "pd.DataFrame":
        """One row a column: index (from 1), name, unit, quantity."""
        return self._frame("columns")

    @property
    def steps(self) -> "pd.DataFrame":
        """One row a step: number, rows, times (s), speed (m/s), normal force (N)."""
        return self._frame("steps")

    def _frame(self, key: str) -> "pd.DataFrame":
        import pandas

        return pandas.DataFrame(self.to_dict()[key])


class Surface(Document):
    """The pattern on a worn surface (`surface`)."""

    def __init__(self, content: str, text: str, native: Optional[Any] = None) -> None:
        super().__init__(content, text)
        self._native = native

    @property
    def status(self) -> str:
        """``periodic``, ``irregular``, ``none`` or ``undetermined``."""
        return cast(str, self.to_dict()["status"])

    @property
    def spacing(self) -> Estimate:
        """Mean distance of the ridges (m)."""
        return Estimate._of("spacing_m", self.to_dict()["spacing_m"])

    def report(self, path: Path) -> None:
        """Write the page of the surface (one HTML file)."""
        if self._native is None:
            raise RuntimeError("an unpickled surface has no page: measure it again")
        write_page(path, self._native.page("slipfit.surface(...)"))
