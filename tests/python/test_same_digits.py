"""The module says what the command line says, byte for byte."""

import json
import subprocess

import numpy as np
import pytest
from conftest import PROGRAM, TESTDATA, WEAKENING
from recordings import Said

import slipfit as sf


def printed(*words):
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=False)


def said_by_program(*words):
    run = printed(*words, "--json")
    assert run.returncode == 0, run.stderr
    return run.stdout


def test_demo(demo_fit):
    assert demo_fit.to_json() + "\n" == said_by_program("fit", TESTDATA / "demo.csv", "--speed", "10mm/s")


@pytest.mark.parametrize("options", [
    dict(zero=0.5, normal_force="10 N", mass="6 g"),
    dict(speed_uncertainty="1 %", window=(0.2, 1.8)),
    dict(force_column=2, time_column="time_s", rows=(1, 9000)),
    dict(sensor_average="0.2 ms", sensor_bandwidth="2 kHz", sensor_resonance=4000, drive_period="20 ms"),
    dict(force_view="transmitted"),
    dict(force_unit="mN", time_unit="s"),
], ids=lambda options: ",".join(options))
def test_options(options):
    file = TESTDATA / "demo.csv"
    fit = sf.fit(sf.read_recording(file, speed="600 mm/min", **options))
    assert fit.to_json() + "\n" == said_by_program("fit", file, "--speed", "600 mm/min", *Said(file, options).words)


def test_tier_and_fix(demo):
    fit = sf.fit(demo, tier="damped", fix={"damping_ratio": 0.05})
    words = ("fit", TESTDATA / "demo.csv", "--speed", "10mm/s", "--tier", "damped", "--fix", "damping_ratio=0.05")
    assert fit.to_json() + "\n" == said_by_program(*words)
    assert fit.damping_ratio.status == "fixed"


def test_analyze(demo):
    result = sf.analyze(demo)
    assert result.to_json() + "\n" == said_by_program("analyze", TESTDATA / "demo.csv", "--speed", "10mm/s")
    assert not result.parameters and result.stiffness.value is None and "analyze" in result.stiffness.note


def test_text(demo_fit):
    words = ("fit", TESTDATA / "demo.csv", "--speed", "10mm/s")
    assert demo_fit.details() == printed(*words, "--details").stdout
    ours, theirs = str(demo_fit).splitlines(), printed(*words).stdout.splitlines()
    assert ours[2:9] == theirs[2:9] and len(ours) == len(theirs) <= 25
    assert ".details()" in ours[-1] and "--details" in theirs[-1]
    assert "--" not in str(demo_fit) and 'drift="sensor"' in str(demo_fit)


def test_cycles_and_curve(demo_fit, tmp_path):
    printed("fit", TESTDATA / "demo.csv", "--speed", "10mm/s", "--cycles", tmp_path / "cycles.csv", "--curve", tmp_path / "curve.csv")
    table = np.genfromtxt(tmp_path / "curve.csv", delimiter=",", names=True)
    curve = demo_fit.curve
    for ours, theirs in zip(curve, ("time_s", "force_N", "fitted_N", "residual_N")):
        np.testing.assert_array_equal(ours, table[theirs])
    import pandas

    written = pandas.read_csv(tmp_path / "cycles.csv", float_precision="round_trip")
    pandas.testing.assert_frame_equal(demo_fit.cycles.astype({"used": int}), written)
    assert demo_fit.cycles[demo_fit.cycles.used].onset_s.notna().all()


@pytest.mark.parametrize("speeds", ["1mm/s:0.5m/s:20", "5mm/s,10mm/s", "0.01"])
def test_predictions(demo_fit, saved, speeds):
    ours, theirs = demo_fit.predict(speeds).to_dict(), json.loads(said_by_program("predict", saved, "--speeds", speeds))
    assert ours.pop("source") == "demo" and theirs.pop("source") == str(saved)
    assert ours == theirs


def test_predictions_at_arrays_are_those_at_texts(demo_fit):
    assert demo_fit.predict(np.array([0.005, 0.01])).to_dict() == demo_fit.predict("0.005,0.01").to_dict()
    assert demo_fit.predict(["5 mm/s", "10 mm/s"]).to_dict()["rows"] == demo_fit.predict([0.005, 0.01]).to_dict()["rows"]


@pytest.mark.parametrize("name", [None, "damping_ratio", "stiffness_N_per_m"])
def test_plans(demo_fit, saved, name):
    ours = demo_fit.plan(name).to_dict()
    theirs = json.loads(said_by_program("plan", saved, *(["--for", name] if name else [])))
    ours.pop("source"), theirs.pop("source")
    assert ours == theirs


def test_plan_takes_a_name_without_its_unit(demo_fit):
    assert demo_fit.plan("stiffness").to_dict() == demo_fit.plan("stiffness_N_per_m").to_dict()


def test_simulations_are_those_of_the_program(tmp_path):
    file = tmp_path / "sim.csv"
    words = ["--stiffness", 1000, "--natural-frequency", 200, "--damping-ratio", 0.05, "--static-friction", 6, "--noise", 0.01,
             "--f0", 3, "--f1", 1, "--alpha=-10", "--speed", "20mm/s", "--duration", 2, "--sample-rate", 1000, "--seed", 7]
    assert printed("simulate", *words, "--out", file).returncode == 0
    ours = sf.simulate(**WEAKENING, speed="20 mm/s", duration=2, sample_rate=1000, seed=7)
    theirs = sf.read_recording(file, speed="20 mm/s")
    np.testing.assert_array_equal(ours.time, theirs.time)
    np.testing.assert_array_equal(ours.force, theirs.force)


@pytest.fixture
def manifest(runs, tmp_path):
    lines = ["id,file,speed_m_per_s,group"]
    for name, recording in runs.items():
        recording.to_frame().to_csv(tmp_path / f"{name}.csv", index=False)
        lines.append(f"{name},{name}.csv,{recording.speed!r},dry")
    file = tmp_path / "runs.csv"
    file.write_text("\n".join(lines) + "\n")
    return file


def test_sweeps(manifest):
    said = said_by_program("fit", "--joint", manifest, "--group", "dry")
    read = {name: sf.read_recording(manifest.parent / f"{name}.csv", speed=float(name[1:]), group="dry") for name in ("v0.02", "v0.04", "v0.08")}
    assert sf.fit(read).to_json() + "\n" == said
    assert sf.fit(list(read.values())).id == "dry"


def test_members_of_a_sweep_are_fits_of_their_own(sweep, runs):
    for name, recording in runs.items():
        assert sweep.recordings[name].to_json() == sf.fit(recording, name=name).to_json()
    assert not np.isnan(sweep["v0.02"].curve.fitted).all()


def test_batches(manifest, tmp_path):
    ours = sf.batch(manifest, out=tmp_path / "ours", jobs=2, joint_groups=True)
    assert printed("batch", manifest, "--out", tmp_path / "theirs", "--joint-groups", "--quiet").returncode == 0
    for name in ("results.jsonl", "summary.csv", "failures.csv"):
        assert (tmp_path / "ours" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes()
    assert ours.counts["fitted"] == 4 and len(ours.to_frame()) == 4 and len(list(ours)) == 4


def test_comparisons(demo_fit, sweep, tmp_path):
    (tmp_path / "a.json").write_text(demo_fit.to_json())
    (tmp_path / "b.json").write_text(sweep["v0.02"].to_json())
    said = json.loads(said_by_program("compare", tmp_path / "a.json", tmp_path / "b.json"))
    assert sf.compare(demo_fit, sweep["v0.02"], names=("a", "b")).to_dict() == said
    assert sf.compare(tmp_path / "a.json", tmp_path / "b.json", names=("a", "b")).to_dict() == said


def test_what_a_file_holds():
    file = TESTDATA / "demo.csv"
    ours = sf.info(file)
    assert ours.to_json() + "\n" == said_by_program("info", file) and str(ours) == printed("info", file).stdout
    assert list(ours.columns.quantity) == ["time", "force"] and ours.refusal is None and len(ours.steps) == 1
    assert sf.info(file, rows=(1, 100), force_column=2).to_json() + "\n" == said_by_program("info", file, "--rows", "1:100", "--force-column", 2)


def test_what_a_refused_file_holds(tmp_path):
    file = tmp_path / "two.csv"
    file.write_text("time_s,channel1,channel2\n" + "".join(f"{i / 100},{i % 7},{i % 5}\n" for i in range(200)))
    assert "force_column=" in sf.info(file).refusal


def test_manifests_are_drafted(manifest, tmp_path):
    folder = manifest.parent
    manifest.unlink()
    (folder / "notes.txt").write_text("nothing but words\n")
    draft = sf.manifest(folder, out=folder / "draft.csv")
    assert (folder / "draft.csv").read_text() == printed("manifest", folder, "--out", folder / "theirs.csv", "--quiet").stdout or (
        (folder / "draft.csv").read_text() == (folder / "theirs.csv").read_text())
    assert list(draft.id) == ["v0.02", "v0.04", "v0.08"] and draft.speed_m_per_s.isna().all()
    assert [notice.code for notice in draft.attrs["left_out"]]
    draft["speed_m_per_s"] = [0.02, 0.04, 0.08]
    draft.to_csv(folder / "runs.csv", index=False)
    assert sf.batch(folder / "runs.csv", out=tmp_path / "out").counts["fitted"] == 3


def test_surfaces(tmp_path):
    heights = [(i % 40) / 20 + 0.01 * (i * 7919 % 13) for i in range(2000)]
    file = tmp_path / "heights.txt"
    file.write_text("".join(f"{height:.3f}\n" for height in heights))
    ours = sf.surface(file, pitch="0.5 um")
    assert ours.to_json() + "\n" == said_by_program("surface", file, "--pitch", "0.5um")
    assert ours.status == "periodic" and abs(ours.spacing.value - 20e-6) < 1e-6


def test_arrays_give_the_numbers_of_the_file(demo, demo_fit):
    for arrays in ((demo.time, demo.force), (list(demo.time), list(demo.force)), (np.repeat(demo.time, 2)[::2], demo.force)):
        fit = sf.fit(sf.Recording(*arrays, speed="10 mm/s"))
        assert fit.to_dict()["parameters"] == demo_fit.to_dict()["parameters"]


def test_series_of_pandas_are_arrays(demo, demo_fit):
    frame = demo.to_frame()
    fit = sf.fit(sf.Recording(frame.time_s, frame.force_N, speed=0.01, name="demo"))
    assert fit.stiffness == demo_fit.stiffness
