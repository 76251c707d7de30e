"""Documents that were saved, as results."""

from __future__ import annotations

import json
import os
from typing import Any, List, Mapping, Optional, Union

from . import _slipfit
from ._documents import Path
from ._errors import Error
from ._fit import Fit, Options
from ._recording import Recording
from ._sweep import Sweep

_HELD = ("stiffness_N_per_m", "natural_frequency_rad_per_s", "damping_ratio")  # what --fix takes


def _options_of(document: Mapping[str, Any]) -> Options:
    """The options of a fit. Older documents do not hold them; their statuses show what was fixed."""
    asked = document.get("options")
    if asked is not None:
        return Options("fit", asked["tier"], tuple(f"{name}={value!r}" for name, value in asked["fix"].items()))
    if "model" not in document:
        return Options("analyze")
    parameters = document.get("parameters") or {}
    held = [name for name in _HELD if parameters.get(name, {}).get("status") == "fixed"]
    return Options("fit", "auto", tuple(f"{name}={parameters[name]['value']!r}" for name in held))


def result_of(content: str, name: str) -> Fit:
    """A checked document as a result; its bytes stay as they are."""
    _slipfit.check_document(content, name)
    document = json.loads(content)
    options = _options_of(document)
    made: Fit = Sweep({}, document["id"], options) if "recordings" in document else Fit(None, options, name=document["id"])
    made._content = content
    return made


def _text_of(source: Any) -> str:
    if isinstance(source, Mapping):
        return json.dumps(source)
    if hasattr(source, "read"):
        text = source.read()
        return text.decode("utf-8") if isinstance(text, bytes) else str(text)
    with open(source, encoding="utf-8") as stream:
        return stream.read()


def _documents_of(text: str, name: str) -> List[str]:
    """One document, an array of them, or one a line."""
    stripped = text.strip()
    try:
        content = json.loads(stripped)
    except ValueError:
        return [line for line in stripped.splitlines() if line.strip()]
    return [json.dumps(one) for one in content] if isinstance(content, list) else [stripped]


def _selected(documents: List[str], id: str, name: str) -> str:
    names = []
    for one in documents:
        try:
            names.append(str(json.loads(one).get("id")))
        except (ValueError, AttributeError):
            raise Error("bad_document", f"'{name}': holds a line that is no fit document") from None
        if names[-1] == id:
            return one
    raise Error("bad_document", f"'{name}': no document with the id {id!r}, expected one of {', '.join(names[:8]) or 'none'}")


def read_fit(
    source: Union[Path, Mapping[str, Any], Any],
    *,
    id: Optional[str] = None,
    recording: Union[Recording, Mapping[str, Recording], None] = None,
) -> Fit:
    """A result that was saved: what `Fit.to_json` or ``slipfit fit --json`` wrote.

    Parameters
    ----------
    source : path, file object or dict
        A document; or several (a results.jsonl, an array of ``slipfit fit a.csv b.csv --json``), of which `id` names one.
    id : str, optional
    recording : Recording, or mapping of str to Recording, optional
        What it was made of: for curve, cycles, charts and the page, which a document does not hold.

    Returns
    -------
    Fit or Sweep
        Its bytes are those of the document; predictions, plans, comparisons and draws need no recording.

    Raises
    ------
    Error
        ``bad_document``, ``another_recording``.
    """
    name = os.fspath(source) if isinstance(source, (str, os.PathLike)) else str(getattr(source, "name", "document"))
    documents = _documents_of(_text_of(source), name)
    if id is None and len(documents) != 1:
        raise Error("bad_document", f"'{name}': holds {len(documents)} documents, expected one; name it by id=, or open the folder with open_batch")
    fit = result_of(documents[0] if id is None else _selected(documents, id, name), name)
    return fit if recording is None else fit.with_recording(recording)  # type: ignore[arg-type]
