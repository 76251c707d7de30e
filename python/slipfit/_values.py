"""Numbers with their intervals, and warnings."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Tuple

from . import _slipfit
from ._errors import in_words_of_python

@functools.lru_cache(maxsize=None)
def words_and_units() -> Dict[str, Tuple[str, str]]:
    """Words and unit of each quantity by its key in the document."""
    return _slipfit.quantity_words()


def unit_of(name: str) -> str:
    """The unit of a quantity of the document: ``"N/m"`` of ``stiffness_N_per_m``."""
    return words_and_units().get(name, ("", ""))[1]


class Notice(NamedTuple):
    """A warning: what was seen, what it means for the numbers, what to do. `code` is listed in docs/formats.md."""

    code: str
    message: str

    def __str__(self) -> str:
        return f"{self.message} [{self.code}]"


@dataclass(frozen=True)
class Estimate:
    """A number in SI with its standard error and 95 % interval; what is not known is None, and `note` says why.

    ``float(estimate)`` is its value, NaN where there is none. There is no arithmetic: ``estimate * 2`` is a TypeError,
    since the interval of a product depends on what else is in it; ``estimate.value * 2`` is a number.
    """

    name: str
    value: Optional[float]
    se: Optional[float]
    ci95: Optional[Tuple[float, float]]
    status: Optional[str]
    note: str
    unit: str

    @classmethod
    def _of(cls, name: str, content: Optional[Mapping[str, Any]], absent: str = "", suffix: str = "") -> "Estimate":
        if content is None:
            return cls(name, None, None, None, None, absent, unit_of(name))
        ends = content.get("ci95" + suffix)
        return cls(
            name,
            content.get("value" + suffix),
            content.get("se" + suffix),
            None if ends is None else (ends[0], ends[1]),
            content.get("status"),
            in_words_of_python(content.get("note") or ""),
            unit_of(name),
        )

    @property
    def words(self) -> str:
        """What it is called in reports."""
        return words_and_units().get(self.name, (self.name, ""))[0]

    def __float__(self) -> float:
        return float("nan") if self.value is None else self.value

    def __format__(self, layout: str) -> str:
        return format(float(self), layout) if layout else str(self)

    def __str__(self) -> str:
        if self.value is None:
            known = "not known" if self.ci95 is None else f"between {self.ci95[0]:.5g} and {self.ci95[1]:.5g} {self.unit}".rstrip()
        else:
            known = f"{self.value:.5g} {self.unit}".rstrip()
            known += "" if self.ci95 is None else f" [{self.ci95[0]:.5g}, {self.ci95[1]:.5g}]"
        return known + ("" if not self.status else f" ({self.status})")

    def __repr__(self) -> str:
        return f"<{self.name}: {self}>"

    def _repr_html_(self) -> str:
        from . import _html

        return _html.of_estimate(self)


class Parameters(Dict[str, Estimate]):
    """The parameters of a fit by their keys in the document."""

    def __missing__(self, key: str) -> Estimate:
        known = ", ".join(self) or "none: analyze() fits no model, and fit() found no cycles"
        raise KeyError(f"the fit has no parameter {key!r}; it has {known}")

    def __repr__(self) -> str:
        return "\n".join(repr(one) for one in self.values()) or "<no parameters>"

    def _repr_html_(self) -> str:
        from . import _html

        return _html.of_parameters(self.values())


def notices_of(content: List[Mapping[str, str]]) -> List[Notice]:
    return [Notice(one["code"], in_words_of_python(one["message"])) for one in content]
