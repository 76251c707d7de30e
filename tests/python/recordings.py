"""Every recording beside the checkout, with what is said of it: path, arguments of `read_recording`, and whether it is quick to fit."""

import csv
import pathlib
import re
from typing import Any, Dict, Iterator, NamedTuple

from conftest import SHARED

SIMULATED = SHARED / "data" / "synthetic"
MEASURED = SHARED / "data" / "real"
LARGEST_QUICK = 120_000  # bytes


class Said(NamedTuple):
    """A recording, and its arguments in Python; those of the command line have the same names."""

    file: pathlib.Path
    arguments: Dict[str, Any]

    @property
    def id(self) -> str:
        part = "-part" if {"window", "step"} & set(self.arguments) else ""
        return f"{self.file.parent.name}/{self.file.stem}{part}"

    @property
    def words(self):
        """As options."""
        words = []
        for name, value in self.arguments.items():
            text = f"{value[0]}:{value[1]}" if isinstance(value, tuple) else str(value)
            words += ["--" + name.replace("_", "-"), text]
        return words

    @property
    def is_quick(self) -> bool:
        return self.file.stat().st_size < LARGEST_QUICK


# Name of the file, and what its name and ../shared/data/README.md say of it; {0}, {1} stand for groups of the pattern.
SAID = [
    (r"fdm_(\d+)g_(\d+)mm_min", dict(speed="{1} mm/min", normal_force="{0} gf")),
    (r"raw_layout_(\d+)g_(\d+)mm_min", dict(speed="{1} mm/min", normal_force="{0} gf")),
    (r"colas_k\d+_v(\d+)", dict(speed="{0} um/s", normal_force=0.3012)),
    (r"clutch_", dict(speed="0.5 mm/s")),
    (r"clutch_", dict(speed="0.5 mm/s", window=(0.9, 2.95))),
    (r"(?:BeigeCotton|Board10mm)_F\d+_V-?(\d+)mmps", dict(speed="{0} mm/s", force_column="channel1")),
    (r"giacomel_", dict(speed="10 um/s")),
    (r"Force7_OG", dict(speed="1.198 mm/s", sample_rate=4)),
    (r"umt_014_FX2", dict(speed_column="Rotary.Velocity", radius="15 mm")),
    (r"umt_014_FX2", dict(speed_column="Rotary.Velocity", radius="15 mm", step=7)),
    (r"umt_HT", dict(speed="1 mm/s")),
    (r"damper_p0_", dict(speed=0.01147)),
    (r"damper_p5_", dict(speed=0.0225)),
    (r"damper_p9_", dict(speed=0.03371)),
    (r"damper_d1_", dict(speed=0.07)),
]
# A test of many strokes, and controls whose columns their README does not name: tests/real reads them.
NO_RECORDING = {"published_spacing.csv", "damper_whole_d1.csv"}
CONTROLS = {"oil", "pin", "robot"}

_OF_MANIFEST = {"speed_m_per_s": "speed", "normal_force_N": "normal_force", "force_view": "force_view", "sample_rate_Hz": "sample_rate"}


def simulated() -> Iterator[Said]:
    manifest = SIMULATED / "manifest.csv"
    if not manifest.exists():
        return
    with manifest.open() as stream:
        for row in csv.DictReader(stream):
            yield Said(SIMULATED / row["file"], {name: row[column] for column, name in _OF_MANIFEST.items() if row.get(column)})


def measured_files():
    return sorted(file for file in MEASURED.rglob("*") if file.is_file() and file.name not in NO_RECORDING and file.parent.name not in CONTROLS) if MEASURED.exists() else []


def said_of(file: pathlib.Path) -> Iterator[Said]:
    for pattern, arguments in SAID:
        match = re.match(pattern, file.name)
        if match:
            yield Said(file, {name: value.format(*match.groups()) if isinstance(value, str) else value for name, value in arguments.items()})


ALL = [*simulated(), *(said for file in measured_files() for said in said_of(file))]
