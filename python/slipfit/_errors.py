"""What slipfit raises."""

from __future__ import annotations

import re
from typing import Tuple

from . import _slipfit

# Options of the command line that are no text in Python.
_FLAGS = {
    "--resume": "resume=True",
    "--joint": "several recordings",
    "--segments": "segments=True",
    "--strokes": "strokes=True",
    "--tier velocity": "tier='velocity'",
}
# Where an argument is called otherwise than the column of a manifest.
COLUMNS = {"zero": "zero_force", "speed_uncertainty": "speed_se", "mass_uncertainty": "mass_se",
           "measured_spacing_uncertainty": "measured_spacing_se"}
_ARGUMENTS = {column: argument for argument, column in COLUMNS.items()}


def _in_words_of_python(message: str) -> str:
    """The message with arguments in place of the options of the command line."""
    message = re.sub(r"^column '(\w+)': ", lambda match: f"{_ARGUMENTS.get(match.group(1), match.group(1))}: ", message)
    for flag, words in _FLAGS.items():
        message = re.sub(rf"{flag}(?![\w-])", words, message)
    message = re.sub(r"--([a-z][a-z-]*): ", lambda match: f"{match.group(1).replace('-', '_')}: ", message)
    return re.sub(
        r"--([a-z][a-z-]*)( (?=[A-Z0-9]))?",
        lambda match: f"{match.group(1).replace('-', '_')}=",
        message,
    )


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
        self.message = _in_words_of_python(message)
        self.remedy = _in_words_of_python(_slipfit.remedy(code, message)) or self.message
        super().__init__(self.message)

    def __str__(self) -> str:
        return f"{self.message} [{self.code}]"

    def __reduce__(self) -> Tuple[type, Tuple[str, str]]:
        return (Error, (self.code, self.message))
