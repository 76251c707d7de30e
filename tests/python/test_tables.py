"""Files of many recordings: every sheet and every group."""

import subprocess
import zipfile

import numpy as np
import pytest
from conftest import MODEL, PROGRAM

import slipfit as sf


def run(speed, seed=1):
    return sf.simulate(**MODEL, kinetic_friction=4, speed=speed, duration=2, sample_rate=500, seed=seed)


@pytest.fixture
def workbook(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.active.title = "notes"
    book.active.append(["nothing but words"])
    for speed in (20, 40, 80):
        sheet = book.create_sheet(f"wet_{speed}mm_s")
        sheet.append(["time_s", "force_N"])
        for pair in zip(run(speed / 1000).time, run(speed / 1000).force):
            sheet.append([float(value) for value in pair])
    book.save(tmp_path / "book.xlsx")
    return tmp_path / "book.xlsx"


@pytest.fixture
def many(tmp_path):
    """40 groups, and a calibration of three rows."""
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "many.h5", "w") as file:
        for i in range(40):
            recording = run(0.02 + 0.001 * i, seed=i + 1)
            group = file.create_group(f"runs/{i:03}")
            group["time_s"], group["force_N"] = recording.time, recording.force
        file["calibration"] = np.eye(3)
    return tmp_path / "many.h5"


def test_every_sheet_is_a_recording(workbook, tmp_path):
    draft = sf.manifest(workbook, out=tmp_path / "runs.csv")
    assert list(draft.id) == ["book-wet_20mm_s", "book-wet_40mm_s", "book-wet_80mm_s"]
    assert list(draft.sheet) == ["wet_20mm_s", "wet_40mm_s", "wet_80mm_s"] and list(draft.speed_m_per_s) == [0.02, 0.04, 0.08]
    assert ["notes" in notice.message for notice in draft.attrs["left_out"]] == [True]
    assert sf.info(workbook).sheets == ["notes", "wet_20mm_s", "wet_40mm_s", "wet_80mm_s"] and "wet_40mm_s" in str(sf.info(workbook))
    batch = sf.batch(tmp_path / "runs.csv", out=tmp_path / "out")
    single = sf.fit(sf.read_recording(workbook, speed=0.04, sheet="wet_40mm_s"))
    assert batch.counts["fitted"] == 3 and batch["book-wet_40mm_s"].stiffness == single.stiffness


def test_every_group_is_a_recording(many, tmp_path):
    draft = sf.manifest(many, out=tmp_path / "runs.csv")
    assert len(draft) == 40 and list(draft.variable) == [f"/runs/{i:03}" for i in range(40)] == sf.info(many).variables
    assert list(draft.id[:2]) == ["many-runs-000", "many-runs-001"] and not draft.attrs["left_out"]
    draft.assign(speed_m_per_s=[0.02 + 0.001 * i for i in range(40)]).to_csv(tmp_path / "runs.csv", index=False)
    batch = sf.batch(tmp_path / "runs.csv", out=tmp_path / "out")
    single = sf.fit(sf.read_recording(many, speed=0.027, variable="/runs/007"))
    assert batch.counts["fitted"] == 40 and batch["many-runs-007"].parameters == single.parameters


def test_a_file_is_opened_once_for_all_its_groups(many, tmp_path):
    strace = subprocess.run(["strace", "-f", "-e", "trace=execve,openat", "-o", str(tmp_path / "trace"), PROGRAM, "manifest", str(many)],
                            capture_output=True, text=True, check=False) if _has_strace() else None
    if strace is None:
        pytest.skip("strace is not installed")
    assert len(strace.stdout.splitlines()) == 41
    trace = (tmp_path / "trace").read_text()
    assert trace.count(f'openat(AT_FDCWD, "{many}"') == 1
    assert trace.count('slipfit-hdf5", [') == 1


def _has_strace():
    try:
        return subprocess.run(["strace", "-V"], capture_output=True, check=False).returncode == 0
    except FileNotFoundError:
        return False


def test_every_file_of_an_archive_is_a_recording(tmp_path):
    with zipfile.ZipFile(tmp_path / "runs.zip", "w") as archive:
        for speed in (20, 40):
            archive.writestr(f"{speed}mm_s.csv", run(speed / 1000).to_frame().to_csv(index=False))
    draft = sf.manifest(tmp_path / "runs.zip")
    assert list(draft.sheet) == ["20mm_s.csv", "40mm_s.csv"] and list(draft.speed_m_per_s) == [0.02, 0.04]


def test_one_sheet_or_group_needs_no_name(tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "one.h5", "w") as file:
        file["time_s"], file["force_N"] = run(0.02).time, run(0.02).force
    draft = sf.manifest(tmp_path / "one.h5")
    assert list(draft.id) == ["one"] and "variable" not in draft.columns


def test_what_slipfit_wrote_is_not_drafted(tmp_path):
    run(0.02).to_frame().to_csv(tmp_path / "a.csv", index=False)
    (tmp_path / "runs.csv").write_text("id,file,speed_m_per_s\na,a.csv,0.02\n")
    sf.batch(tmp_path / "runs.csv", out=tmp_path / "out")
    fit = sf.fit(sf.read_recording(tmp_path / "a.csv", speed=0.02))
    subprocess.run([PROGRAM, "fit", tmp_path / "a.csv", "--speed", "0.02", "--cycles", tmp_path / "cycles.csv", "--curve", tmp_path / "curve.csv"],
                   check=True, capture_output=True)
    fit.predict("1mm/s:0.5m/s:20").to_frame().to_csv(tmp_path / "prediction.csv", index=False)
    draft = sf.manifest(tmp_path)
    assert list(draft.id) == ["a"] and not draft.attrs["left_out"]
    assert list(sf.manifest(tmp_path / "curve.csv").id) == ["curve"]  # named by the user
