"""What slipfit raises."""

from __future__ import annotations

import re
from typing import Tuple

from . import _slipfit

# Words of the command line that are something else in Python.
_PHRASES = {
    "slipfit fit --json --out FIT.json writes": "Fit.to_json() returns",
    "slipfit fit --json": "Fit.to_json()",
    "slipfit fit FILE --speed V": "fit(read_recording(FILE, speed=V))",
    "slipfit batch --resume with this folder": "batch(..., resume=True) with this folder",
    "slipfit batch --resume": "batch(..., resume=True)",
    "--resume": "resume=True",
    "--joint": "several recordings",
    "--segments": "segments=True",
    "=negative for": "'negative' for",
}
# Where an argument is called otherwise than the column of a manifest.
COLUMNS = {"zero": "zero_force", "speed_uncertainty": "speed_se", "mass_uncertainty": "mass_se",
           "measured_spacing_uncertainty": "measured_spacing_se"}
_ARGUMENTS = {column: argument for argument, column in COLUMNS.items()}


_UNIT_OPTIONS = "time-unit|force-unit|unit"
_CHOICES = "sensor|friction|both|positive|negative|spring|transmitted|contact|velocity|auto"
_OPTION = re.compile(
    r"(?<![\w-])--(?:"
    rf"(?P<of_unit>{_UNIT_OPTIONS}) (?P<unit>(?!if\b|or\b|and\b|is\b|to\b)[^\s,;:.)]+)"
    r"|(?P<name>[a-z][a-z-]*)"
    r"(?:[ =](?P<value>'[^']*'|[A-Z][A-Z0-9]*(?:[:=][A-Z0-9]+)?(?![a-z])|\d(?:[^\s,;)]*[^\s,;.)])?"
    rf"|(?:{_CHOICES})\b)|(?P<colon>: ))?"
    r")"
)


def _argument(match: "re.Match[str]") -> str:
    """``speed="10mm/s"`` of ``--speed 10mm/s``, ``zero=`` of ``--zero``, ``tier: `` of ``--tier: ``."""
    name = (match["of_unit"] or match["name"]).replace("-", "_")
    if match["colon"]:
        return f"{name}: "
    value = (match["unit"] or match["value"] or "").strip("'")
    if not value:
        return f"{name}="
    is_number = not match["unit"] and re.fullmatch(r"[A-Z]|[-+]?\d+(\.\d*)?(e[-+]?\d+)?", value)
    return f"{name}={value}" if is_number else f'{name}="{value}"'


def in_words_of_python(message: str) -> str:
    """The message with arguments instead of the options of the command line."""
    message = re.sub(r"^column '(\w+)': ", lambda match: f"{_ARGUMENTS.get(match.group(1), match.group(1))}: ", message)
    for phrase, words in _PHRASES.items():
        message = re.sub(rf"{phrase}(?![\w-])", words, message)
    return _OPTION.sub(_argument, message)


class Error(Exception):
    """An input that cannot be used.

    Attributes
    ----------
    code : str
        Which kind of error, in snake_case: stable across versions, listed in docs/formats.md.
    message : str
        One line: place, offending value, what was expected.
    remedy : str
        What to do about it.
    """

    code: str
    message: str
    remedy: str

    def __init__(self, code: str, message: str) -> None:
        self.code = code
        self.message = in_words_of_python(message)
        self.remedy = in_words_of_python(_slipfit.remedy(code, message)) or self.message
        super().__init__(self.message)

    def __str__(self) -> str:
        return f"{self.message} [{self.code}]"

    def __reduce__(self) -> Tuple[type, Tuple[str, str]]:
        return (Error, (self.code, self.message))
