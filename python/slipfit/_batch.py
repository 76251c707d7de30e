"""Batches, and the manifests that they are made of."""

from __future__ import annotations

import importlib.util
import json
import os
import sys
import warnings
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterator, List, Optional, Sequence, Tuple, Union

from . import _slipfit
from ._cells import Quantity, fixed_of, quantity_of
from ._documents import Path, frame_of_csv
from ._errors import Error, in_words_of_python
from ._fit import Fit
from ._saved import result_of
from ._sweep import Fix
from ._values import Notice

if TYPE_CHECKING:
    import pandas as pd


def manifest(paths: Union[Path, Sequence[Path]], *, out: Optional[Path] = None) -> "pd.DataFrame":
    """Draft a manifest of files and folders, to look at, to fill in and to fit with `batch`.

    Parameters
    ----------
    paths : path or sequence of paths
        Folders (with what lies below) and files. Speed and load come from columns, else from the file's name.
    out : path, optional
        Write it to this file, too; paths in it are relative to its folder.

    Returns
    -------
    DataFrame
        One row a recording; what could not be told is empty. ``attrs["left_out"]`` lists the files that hold no
        recording, and why.
    """
    given = [paths] if isinstance(paths, (str, os.PathLike)) else list(paths)
    folder = "" if out is None else os.path.dirname(os.fspath(out))
    text, left_out = _slipfit.manifest([os.fspath(path) for path in given], folder)
    if out is not None:
        with open(out, "w", encoding="utf-8") as file:
            file.write(text)
    frame = frame_of_csv(text)
    frame.attrs["left_out"] = [Notice(code, in_words_of_python(message)) for code, message in left_out]
    return frame


# Columns of summary.csv that hold text.
_TEXTS = {"id", "group", "file", "status", "input_digest", "regime", "surface_verdict", "tier", "warnings", "error"}


def _can_write_parquet() -> bool:
    return all(importlib.util.find_spec(name) is not None for name in ("pandas", "pyarrow"))


def _add_parquet(result: "BatchResult") -> None:
    """A copy of the table: without it the batch is as complete."""
    if not _can_write_parquet():
        return
    try:
        result.to_parquet()
    except Exception as error:  # of pyarrow, or of the disk
        warnings.warn(f"{result.folder}: summary.parquet was not written ({error}); summary.csv holds the same", stacklevel=3)


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
        self._places: Optional[Dict[str, Tuple[int, int]]] = None

    def __iter__(self) -> Iterator[Dict[str, Any]]:
        """The documents in the manifest's order."""
        for line in self._lines():
            yield json.loads(line)

    def _lines(self) -> Iterator[str]:
        with open(self._written("results.jsonl"), encoding="utf-8") as stream:
            yield from stream

    def fits(self) -> Iterator[Fit]:
        """The results in the manifest's order, read one by one."""
        for line in self._lines():
            yield result_of(line, self._path("results.jsonl"))

    @property
    def ids(self) -> List[str]:
        """Of the results, in the manifest's order; failures have none."""
        return list(self._index())

    def _index(self) -> Dict[str, Tuple[int, int]]:
        """Where the line of each id stands: (begin, length) in bytes."""
        if self._places is None:
            places: Dict[str, Tuple[int, int]] = {}
            begin = 0
            with open(self._written("results.jsonl"), "rb") as stream:
                for line in stream:
                    places[str(json.loads(line)["id"])] = (begin, len(line))
                    begin += len(line)
            self._places = places
        return self._places

    def __getitem__(self, id: str) -> Fit:
        places = self._index()
        if id not in places:
            raise KeyError(f"{self.folder} has no result {id!r}: see .ids and .failures")
        begin, length = places[id]
        with open(self._written("results.jsonl"), "rb") as stream:
            stream.seek(begin)
            return result_of(stream.read(length).decode("utf-8"), self._path("results.jsonl"))

    def __len__(self) -> int:
        return len(self._index())

    def to_frame(self, *, typed: bool = False) -> "pd.DataFrame":
        """summary.csv: one row a recording.

        Parameters
        ----------
        typed : bool
            Types that do not depend on what the cells hold: ``string`` for text, ``float64`` for numbers, ``int64`` for ``row``.
        """
        if not typed:
            return self._table("summary.csv")
        frame = self._table("summary.csv", dtype="string", keep_default_na=False)
        for name in frame.columns:
            if name == "row":
                frame[name] = frame[name].astype("int64")
            elif name not in _TEXTS and not name.endswith("_status"):
                frame[name] = frame[name].replace("", None).astype("float64")
        return frame

    def to_parquet(self, path: Optional[Path] = None) -> str:
        """Write the table as summary.parquet, or to `path`, and return where; needs pandas and pyarrow.

        Columns of numbers are doubles and columns of text strings in every batch, also where all cells are empty.
        """
        target = self._path("summary.parquet") if path is None else os.fspath(path)
        table = self.to_frame(typed=True)
        table.to_parquet(target, engine="pyarrow", index=False)
        return target

    @property
    def failures(self) -> "pd.DataFrame":
        """failures.csv: id, code and message of each recording that failed."""
        return self._table("failures.csv")

    def _path(self, name: str) -> str:
        return os.path.join(self.folder, name)

    def _written(self, name: str) -> str:
        """The path of a file that a batch writes at its end."""
        if not os.path.exists(self._path(name)):
            raise Error("not_finished", f"{self.folder}: has no {name}, which a batch writes at its end; finish it with resume=True")
        return self._path(name)

    def _table(self, name: str, **reading: Any) -> "pd.DataFrame":
        import pandas

        return pandas.read_csv(self._written(name), float_precision="round_trip", **reading)

    def __repr__(self) -> str:
        counts = self.counts
        done = counts["before"] + counts["fitted"]
        return f"<slipfit.BatchResult {self.folder!r}: {done} of {counts['total']} fitted, {counts['failed']} failed>"

    def _repr_html_(self) -> str:
        from . import _html

        return _html.of_batch(self)


def open_batch(folder: Path) -> BatchResult:
    """The results of a batch, from its folder: of `batch`, `merge`, ``slipfit batch`` or ``slipfit merge``.

    Raises
    ------
    Error
        ``not_a_batch``.
    """
    name = os.fspath(folder)
    try:
        with open(os.path.join(name, "run.json"), encoding="utf-8") as stream:
            run = json.load(stream)
        counts = {key: run[key] for key in ("total", "before", "fitted", "failed", "seconds")}
    except (OSError, ValueError, KeyError, TypeError):
        raise Error("not_a_batch", f"{name}: holds no run.json of a batch, expected a folder that a batch wrote") from None
    return BatchResult(name, counts)


def merge(shards: Sequence[Path], *, out: Path) -> BatchResult:
    """Put the finished shards of one batch together, in the manifest's order: the files that one machine would have written.

    Raises
    ------
    Error
        ``not_a_batch``, ``not_finished``, ``shards_differ``, ``shards_missing``, ...
    """
    _slipfit.merge([os.fspath(one) for one in shards], os.fspath(out))
    result = open_batch(out)
    _add_parquet(result)
    return result


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
        A recording that fails is a row of ``BatchResult.failures``, and no exception. Where pandas and pyarrow are
        installed, the folder holds summary.parquet beside summary.csv.

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
    if os.path.isdir(manifest):
        raise Error("is_directory", f"{os.fspath(manifest)}: is a folder; write its manifest first with manifest(..., out='runs.csv')")

    def show(total: int, before: int, fitted: int, failed: int, seconds: float) -> None:
        told = {"total": total, "before": before, "fitted": fitted, "failed": failed, "seconds": seconds}
        (progress if callable(progress) else _line)(told)

    part, parts = shard or (1, 1)
    if not 1 <= part <= parts:
        raise Error("out_of_range", f"shard: bad {shard!r}, expected (I, N) with I from 1 to N")
    count = _slipfit.default_jobs() if jobs is None else jobs
    if not 1 <= count <= 1024:
        raise Error("out_of_range", f"jobs: {jobs} is out of range, expected 1 to 1024")
    options = {
        "manifest": os.fspath(manifest),
        "out": os.fspath(out),
        "tier": tier,
        "fixed": fixed_of(fix),
        "jobs": count,
        "timeout_s": quantity_of("timeout", timeout, "time", above=0.0),
        "resume": bool(resume),
        "shard": part,
        "shards": parts,
        "report": None if report is None else os.fspath(report),
        "command": f"slipfit.batch({os.fspath(manifest)!r}, ...)  # Python",
        "joint_groups": bool(joint_groups),
    }
    stale = os.path.join(os.fspath(out), "summary.parquet")  # of an earlier run; written again at the end
    if resume and os.path.exists(stale):
        os.unlink(stale)
    counts = _slipfit.batch(options, show if progress else None, None)
    result = BatchResult(os.fspath(out), counts)
    _add_parquet(result)
    return result
