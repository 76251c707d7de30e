"""Errors, threads, memory, pickles, what notebooks show, and what is imported when."""

import ast
import concurrent.futures
import copy
import gc
import io
import os
import pickle
import resource
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from conftest import MODEL, PROJECT, TESTDATA, error_of

import slipfit as sf
from slipfit import _slipfit


DEMO = TESTDATA / "demo.csv"


def steady():
    return sf.Recording(np.arange(2000) / 100.0, 5 + 0.01 * np.random.default_rng(1).standard_normal(2000), speed=0.01)


REFUSALS = {
    "no_speed": lambda demo: sf.Recording(demo.time, demo.force),
    "file_not_found": lambda demo: sf.read_recording("absent.csv", speed=1),
    "unknown_unit": lambda demo: sf.read_recording(DEMO, speed="10 parsec"),
    "bad_number": lambda demo: sf.read_recording(DEMO, speed="fast"),
    "out_of_range": lambda demo: sf.read_recording(DEMO, speed=-1),
    "unknown_column": lambda demo: sf.read_recording(DEMO, speed=1, force_column="Fz"),
    "window_empty": lambda demo: sf.read_recording(DEMO, speed=1, window=(50, 60)),
    "bad_window": lambda demo: sf.read_recording(DEMO, speed=1, window=(2, 1)),
    "bad_rows": lambda demo: sf.read_recording(DEMO, speed=1, rows=3),
    "bad_where": lambda demo: sf.read_recording(DEMO, speed=1, where={}),
    "unknown_force_view": lambda demo: sf.read_recording(DEMO, speed=1, force_view="side"),
    "length_mismatch": lambda demo: sf.Recording(demo.time, demo.force[1:], speed=1),
    "too_few_samples": lambda demo: sf.Recording([0], [1], speed=1),
    "time_runs_backwards": lambda demo: sf.Recording(demo.time[::-1], demo.force, speed=1),
    "no_time_column": lambda demo: sf.Recording(None, demo.force, speed=1),
    "unknown_tier": lambda demo: sf.fit(demo, tier="velocity"),
    "unknown_fix": lambda demo: sf.fit(demo, fix={"mass_kg": 1}),
    "bad_speeds": lambda demo: sf.fit(demo).predict("3:1:4"),
    "bad_target": lambda demo: sf.fit(demo).plan("colour"),
    "no_normal_force": lambda demo: sf.fit(demo).predict([0.01], normal_force=3),
    "cannot_predict": lambda demo: sf.analyze(demo).predict([0.01]),
    "is_directory": lambda demo: sf.batch(TESTDATA, out="results"),
    "unknown_plot": lambda demo: sf.fit(demo).plot("pie"),
    "parameter_out_of_range": lambda demo: sf.simulate(**{**MODEL, "kinetic_friction": 7}, speed=1, duration=1, sample_rate=100),
    "bad_document": lambda demo: sf.compare(DEMO, DEMO),
}


@pytest.mark.parametrize("code", REFUSALS)
def test_errors_have_code_message_and_remedy(code, demo):
    error = error_of(lambda: REFUSALS[code](demo))
    assert error.code == code
    assert error.message and error.remedy and "\n" not in error.message
    assert "--" not in error.message + error.remedy, "options of the command line have other names here"


def test_a_remedy_is_what_to_do():
    error = error_of(lambda: sf.read_recording(DEMO))
    assert error.remedy.startswith("give the driving speed")
    assert "expected" in error_of(lambda: sf.read_recording(DEMO, speed="10 parsec")).remedy


WORDS = {
    "give the driving speed, for example --speed 10mm/s (no column contains it)": 'give the driving speed, for example speed="10mm/s" (no column contains it)',
    "suggests another unit; give --speed 0.01, or correct": "suggests another unit; give speed=0.01, or correct",
    "(--drift sensor or --drift friction states which)": '(drift="sensor" or drift="friction" states which)',
    "state its reading with --zero": "state its reading with zero=",
    "--tier velocity needs a speed sweep (--joint): one": 'tier="velocity" needs a speed sweep (several recordings): one',
    "--tier: unknown tier 'x'": "tier: unknown tier 'x'",
    "take one with --step N, --rows A:B or --where COLUMN=VALUE.": 'take one with step=N, rows="A:B" or where="COLUMN=VALUE".',
    "--window T0:T1 chooses another": 'window="T0:T1" chooses another',
    "--force-unit, such as --force-unit N, or": 'force_unit=, such as force_unit="N", or',
    "is it in ms (--time-unit ms)?": 'is it in ms (time_unit="ms")?',
    "--force-scale '5 N/V' (newtons)": 'force_scale="5 N/V" (newtons)',
    "(k is off; --speed-uncertainty widens their intervals)": "(k is off; speed_uncertainty= widens their intervals)",
    "finish it with slipfit batch --resume, then merge": "finish it with batch(..., resume=True), then merge",
    "expected what slipfit fit --json --out FIT.json writes": "expected what Fit.to_json() returns",
    "a long--dashed word, 10 -- 20": "a long--dashed word, 10 -- 20",
}


@pytest.mark.parametrize("said", WORDS)
def test_options_of_the_command_line_become_arguments(said):
    from slipfit._errors import in_words_of_python

    assert in_words_of_python(said) == WORDS[said]


def test_warnings_and_notes_speak_python(demo, demo_fit, sweep):
    text = "\n".join([*(str(one) for one in demo_fit.warnings), *(one.note for one in demo_fit.parameters.values()), *demo.assumed,
                      *(str(one) for one in sweep.warnings), demo_fit.reason])
    assert "--" not in text and 'drift="sensor"' in text and "zero=" in text
    assert "--drift sensor" in demo_fit.to_dict()["warnings"][0]["message"]  # the document stays as it is


def test_errors_can_be_pickled():
    error = error_of(lambda: sf.read_recording(DEMO))
    again = pickle.loads(pickle.dumps(error))
    assert (again.code, again.message, again.remedy) == (error.code, error.message, error.remedy)


def test_values_that_are_no_text_or_number():
    with pytest.raises(TypeError):
        sf.read_recording(DEMO, speed=[1])
    with pytest.raises(TypeError):
        sf.fit(["run7.csv"])
    with pytest.raises(KeyError, match="stiffness_N_per_m"):
        sf.fit(sf.read_recording(DEMO, speed=0.01)).parameters["colour"]


def test_recordings_keep_their_samples(demo):
    force = demo.force.copy()
    recording = sf.Recording(demo.time, force, speed=0.01)
    force[:] = 0.0
    np.testing.assert_array_equal(recording.force, demo.force)
    with pytest.raises(ValueError):
        recording.force[0] = 1.0
    view = recording.force
    del recording
    gc.collect()
    assert view[0] == demo.force[0]


def test_zero_and_load(demo):
    recording = sf.Recording(demo.time, demo.force + 0.5, speed=0.01, zero=0.5, normal_force="10 N")
    np.testing.assert_allclose(recording.force, demo.force, rtol=0, atol=1e-12)
    fit = sf.fit(recording)
    assert fit.parameters["static_friction_N"].status == "conditional"  # the level of the demo rises
    assert fit.to_dict()["level_trend"]["reading"] == "open"
    assert recording.normal_force == 10.0


def test_a_torque_over_the_radius_is_the_force(demo):
    torque = demo.force * 0.012
    recording = sf.Recording(demo.time, torque, speed=0.01, force_unit="N m", radius="12mm")
    np.testing.assert_allclose(recording.force, demo.force, rtol=1e-14)
    error = error_of(lambda: sf.Recording(demo.time, torque, speed=0.01, force_unit="N m"))
    assert error.code == "no_radius" and "radius" in error.remedy


def test_shortcuts(demo_fit):
    assert demo_fit.stiffness.value == demo_fit.parameters["stiffness_N_per_m"].value
    assert demo_fit.stiffness.unit == "N/m" and demo_fit.damping_ratio.unit == ""
    assert demo_fit.stiffness.ci95[0] < float(demo_fit.stiffness) < demo_fit.stiffness.ci95[1]
    assert demo_fit.friction_difference.status == "conditional" and demo_fit.friction_difference.note
    assert demo_fit.natural_frequency.se > 0 and demo_fit.frequency.unit == "Hz"
    assert demo_fit.pattern_spacing.value == pytest.approx(0.01 / demo_fit.frequency.value, rel=1e-12)
    assert [warning.code for warning in demo_fit.warnings] == ["level_trend", "hum_fitted"] and demo_fit.status == "stick_slip"
    frame = demo_fit.to_frame()
    assert frame.loc["stiffness_N_per_m", "value"] == demo_fit.stiffness.value
    assert frame.loc["damping_ratio", "status"] == "conditional"


def test_a_changed_dictionary_changes_no_result(demo_fit):
    demo_fit.to_dict()["parameters"].clear()
    assert demo_fit.parameters and demo_fit.to_dict()["parameters"]


@pytest.mark.parametrize("again", [lambda one: pickle.loads(pickle.dumps(one)), copy.copy, copy.deepcopy], ids=["pickle", "copy", "deepcopy"])
def test_pickles_and_copies(again, demo, demo_fit, sweep, tmp_path):
    recording = again(demo)
    np.testing.assert_array_equal(recording.force, demo.force)
    assert sf.fit(recording).to_json() == demo_fit.to_json()
    fit = again(demo_fit.with_recording())
    assert fit.to_json() == demo_fit.to_json() and fit.cycles.equals(demo_fit.cycles)
    np.testing.assert_array_equal(fit.curve.fitted, demo_fit.curve.fitted)
    fit.report(tmp_path / "again.html")
    demo_fit.report(tmp_path / "first.html")
    assert (tmp_path / "again.html").read_bytes() == (tmp_path / "first.html").read_bytes()
    assert again(sweep.with_recording()).recordings["v0.04"].to_json() == sweep.recordings["v0.04"].to_json()
    prediction = demo_fit.predict([0.01])
    assert again(prediction).to_frame().equals(prediction.to_frame())
    assert str(again(demo_fit.plan())) == str(demo_fit.plan())


def test_a_recording_with_a_worn_track_survives_a_pickle(demo, tmp_path):
    heights = [(i % 40) / 20 + 0.01 * (i * 7919 % 13) for i in range(2000)]
    file = tmp_path / "profile.csv"
    file.write_text("x [um],z [um]\n" + "".join(f"{10 * i},{h:.3f}\n" for i, h in enumerate(heights)))
    recording = sf.read_recording(DEMO, speed=0.01, surface=file, measured_spacing="0.4 mm", sample="A", material="PP", operator="x")
    again = pickle.loads(pickle.dumps(recording))
    fit = sf.fit(recording)
    assert fit.to_dict()["derived"]["surface_En"]
    assert sf.fit(again).to_json() == fit.to_json()


def test_notebooks_show_results(demo_fit, sweep):
    shown = demo_fit._repr_html_()
    for expected in ("stick-slip", "tangential stiffness", "conditional", "nterference at 49.99 Hz", "<svg", "95 % interval"):
        assert expected in shown
    assert "<script" not in shown and len(shown) < 60_000
    assert "tangential stiffness" in sweep._repr_html_()
    still = sf.fit(steady())
    assert still.frequency.value is None and "<svg" in still._repr_html_()


def test_what_a_fit_says_of_slips_is_not_said_of_steady_sliding():
    time_s = np.arange(20_000) / 1000
    force = 4 + 0.05 * np.sin(2 * np.pi * 50 * time_s) + 0.03 * np.random.default_rng(3).standard_normal(time_s.size)
    hum = sf.fit(sf.Recording(time_s, force, speed="10 mm/s"))
    assert hum.status == "steady_sliding" and [notice.code for notice in hum.warnings] == ["suspicious_line"]
    assert "fit in red" not in hum._repr_html_()


def test_names_from_outside_stay_text(demo):
    shown = sf.fit(sf.Recording(demo.time, demo.force, speed=0.01, name="<script>alert(1)</script>"))._repr_html_()
    assert "<script" not in shown


@pytest.mark.parametrize("kind", ["trace", "spectrum", "cycles", "speed", "map"])
def test_plots(kind, demo_fit, sweep):
    from matplotlib import pyplot

    axes = pyplot.figure().add_subplot()
    assert demo_fit.plot(kind, ax=axes) is axes and axes.lines
    assert sweep.plot(kind).lines
    pyplot.close("all")


def test_every_chart_of_the_page_is_drawn_from_its_data(demo_fit, tmp_path):
    from matplotlib import pyplot

    axes = {kind: demo_fit.plot(kind) for kind in ("trace", "spectrum", "cycles", "residuals", "evolution", "pairs", "map", "speed", "pattern")}
    trace = axes["trace"]
    assert np.array_equal(trace.lines[0].get_xdata(), demo_fit.recording.time)
    assert np.array_equal(trace.lines[0].get_ydata(), demo_fit.recording.force)
    low, high = axes["map"].get_xlim()
    assert low < demo_fit.damping_ratio.value < high and axes["map"].get_xscale() == "log"
    pyplot.close("all")


@pytest.mark.parametrize("kind, code", [("speed", "cannot_predict"), ("cycles", "no_cycles"), ("residuals", "no_cycles")])
def test_plots_of_what_is_not_there(kind, code):
    error = error_of(lambda: sf.fit(steady()).plot(kind))
    assert error.code == code and error.remedy.startswith("use plot('trace')")


def test_pandas_and_matplotlib_are_imported_when_used():
    script = ("import sys, slipfit as sf; fit = sf.fit(sf.read_recording(sys.argv[1], speed=0.01)); fit._repr_html_(); fit.predict([0.01]);"
              "assert not {'pandas', 'matplotlib'} & set(sys.modules); fit.to_frame(); assert 'pandas' in sys.modules")
    subprocess.run([sys.executable, "-c", script, str(DEMO)], check=True, env=os.environ)


def test_threads_give_the_same_results(demo, demo_fit):
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        documents = list(pool.map(lambda _: sf.fit(demo).to_json(), range(32)))
    assert set(documents) == {demo_fit.to_json()}


def test_other_threads_run_while_one_fits(runs):
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    begin = time.monotonic()
    sf.fit(runs)
    end = time.monotonic()
    done.set()
    thread.join()
    # The sweep takes tenths of a second: with the lock held there would be none but at its ends.
    assert sum(begin < at < end for at in ticks) > 5


def peak_MB():
    with open("/proc/self/statm") as stream:
        return int(stream.read().split()[1]) * resource.getpagesize() / 1e6


@pytest.mark.parametrize("fits", [pytest.param(150, id="short"), pytest.param(10_000, id="long", marks=pytest.mark.long)])
def test_memory_does_not_grow(fits, demo):
    recording = sf.Recording(demo.time[:3000], demo.force[:3000], speed=0.01)

    def work(count):
        for _ in range(count):
            fit = sf.fit(recording)
            fit.to_json(), fit.curve, fit.stiffness

    work(50)
    gc.collect()
    before = peak_MB()
    work(fits)
    gc.collect()
    assert peak_MB() - before < 5.0  # a leak of a recording alone would be 48 kB a fit, 7 MB in the short test


@pytest.fixture
def long_manifest(runs, tmp_path):
    runs["v0.02"].to_frame().to_csv(tmp_path / "run.csv", index=False)
    file = tmp_path / "runs.csv"
    file.write_text("id,file,speed_m_per_s\n" + "".join(f"r{i},run.csv,0.02\n" for i in range(400)))
    return file


def test_ctrl_c_stops_a_batch_and_loses_nothing(long_manifest, tmp_path):
    out = tmp_path / "out"
    script = ("import sys, slipfit as sf\ntry:\n    sf.batch(sys.argv[1], out=sys.argv[2], jobs=1)\n"
              "except KeyboardInterrupt:\n    print('interrupted')\n")
    process = subprocess.Popen([sys.executable, "-c", script, str(long_manifest), str(out)], stdout=subprocess.PIPE, text=True)
    results, journal = out / "results.jsonl", out / "journal"
    for _ in range(1000):
        if journal.exists() and b" fit " in journal.read_bytes():
            break
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=20)[0] == "interrupted\n" and process.returncode == 0
    kept = sum(line.split()[1] == "fit" for line in journal.read_text().splitlines())
    assert 0 < kept < 400
    told = []
    rest = sf.batch(long_manifest, out=out, jobs=2, resume=True, progress=told.append)
    assert rest.counts["before"] >= kept - 1 and rest.counts["before"] + rest.counts["fitted"] == 400
    assert told and told[-1]["total"] == 400
    whole = sf.batch(long_manifest, out=tmp_path / "whole", jobs=2)
    assert len(whole.to_frame()) == 400
    assert (tmp_path / "whole" / "results.jsonl").read_bytes() == results.read_bytes()


def test_an_exception_in_the_progress_stops_the_batch(long_manifest, tmp_path):
    def fail(counts):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        sf.batch(long_manifest, out=tmp_path / "out", jobs=1, progress=fail)


def test_a_batch_beside_other_threads(long_manifest, tmp_path, demo):
    stop = threading.Event()

    def busy():
        while not stop.is_set():
            sf.fit(demo)

    thread = threading.Thread(target=busy)
    thread.start()
    try:
        assert sf.batch(long_manifest, out=tmp_path / "out", jobs=2).counts["fitted"] == 400
    finally:
        stop.set()
        thread.join()


def test_a_batch_takes_the_processors_that_it_may_use():
    script = "import os; os.sched_setaffinity(0, {min(os.sched_getaffinity(0))}); from slipfit import _slipfit; print(_slipfit.default_jobs())"
    assert subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout == "1\n"


def test_batches_refuse_and_report(long_manifest, tmp_path):
    sf.batch(long_manifest, out=tmp_path / "out", jobs=2)
    assert error_of(lambda: sf.batch(long_manifest, out=tmp_path / "out")).code == "results_present"
    bad = tmp_path / "bad.csv"
    bad.write_text("id,file,speed_m_per_s\na,absent.csv,0.01\n")
    result = sf.batch(bad, out=tmp_path / "bad")
    assert result.counts["failed"] == 1 and list(result.failures.id) == ["a"]


def test_types():
    mypy = pytest.importorskip("mypy.api")
    text, errors, code = mypy.run(["--config-file", str(PROJECT / "python" / "mypy.ini"), "--cache-dir", os.devnull,
                                   str(PROJECT / "python" / "slipfit"), str(PROJECT / "tests" / "python" / "typed.py")])
    assert code == 0, text + errors


def test_the_stub_names_what_the_extension_has():
    text = (PROJECT / "python" / "slipfit" / "_slipfit.pyi").read_text()
    for part in ast.parse(text).body:
        if isinstance(part, (ast.ClassDef, ast.FunctionDef)):
            assert hasattr(_slipfit, part.name), part.name
        for member in part.body if isinstance(part, ast.ClassDef) else []:
            assert hasattr(getattr(_slipfit, part.name), member.name), f"{part.name}.{member.name}"
    for name in dir(_slipfit):
        assert name.startswith("__") or f"def {name}(" in text or f"class {name}:" in text, name


@pytest.mark.long
def test_the_stub_is_the_extension():
    pytest.importorskip("mypy.stubtest")
    run = subprocess.run([sys.executable, "-m", "mypy.stubtest", "slipfit._slipfit", "--ignore-missing-stub", "--mypy-config-file",
                          str(PROJECT / "python" / "mypy.ini"), "--allowlist", str(PROJECT / "tests" / "python" / "stub_allowlist.txt"),
                          "--ignore-unused-allowlist"],
                         capture_output=True, text=True, env={**os.environ, "MYPYPATH": str(PROJECT / "python")}, check=False)
    assert run.returncode == 0, run.stdout + run.stderr


def test_everything_public_says_what_it_is():
    for name in sf.__all__:
        one = getattr(sf, name)
        if callable(one):
            assert one.__doc__, name
    for function in (sf.fit, sf.read_recording, sf.simulate, sf.compare, sf.batch, sf.surface):
        assert "Raises" in function.__doc__


def test_containers_are_read_by_the_programs_beside_the_module(demo, demo_fit, tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "run.h5", "w") as file:
        file["time_s"], file["force_N"] = demo.time, demo.force
    fit = sf.fit(sf.read_recording(tmp_path / "run.h5", speed="10 mm/s"))
    assert fit.stiffness == demo_fit.stiffness


def test_files_from_elsewhere(demo_fit, tmp_path):
    fsspec = pytest.importorskip("fsspec")
    content = DEMO.read_bytes()
    fsspec.filesystem("memory").pipe_file("/bucket/demo.csv", content)
    sources = [DEMO.open("rb"), DEMO.open(), io.BytesIO(content), "memory://bucket/demo.csv", fsspec.open("memory://bucket/demo.csv")]
    for source, name in zip(sources, (str(DEMO), str(DEMO), "recording", "memory://bucket/demo.csv", "memory://bucket/demo.csv")):
        recording = sf.read_recording(source, speed=0.01)
        fit = sf.fit(recording)
        assert recording.name.replace(":///", "://") == name and fit.parameters == demo_fit.parameters
        assert fit.to_dict()["recording"]["input_digest"] == demo_fit.to_dict()["recording"]["input_digest"]
    error = error_of(lambda: sf.read_recording(io.BytesIO(b"nothing but words\n"), speed=1))
    assert error.message.startswith("recording") and "slipfit-" not in error.message
    with pytest.raises(FileNotFoundError):
        sf.read_recording("memory://bucket/absent.csv", speed=1)


def test_a_pickle_keeps_an_assumed_unit_of_time(tmp_path):
    recording = sf.simulate(**MODEL, kinetic_friction=4, speed=0.02, duration=2, sample_rate=1000)
    rows = zip(1e3 * recording.time, recording.force)
    (tmp_path / "ms.csv").write_text("time,force_N\n" + "".join(f"{float(t)!r},{float(f)!r}\n" for t, f in rows))  # seconds are assumed
    read = sf.read_recording(tmp_path / "ms.csv", speed=0.02)
    again = pickle.loads(pickle.dumps(read))
    assert sf.fit(again).to_json() == sf.fit(read).to_json()


def test_the_residual_has_a_panel_of_its_own(demo_fit):
    axes = demo_fit.plot("trace")
    panel = axes.figure.axes[-1]
    assert [line.get_label() for line in axes.lines] == ["measured", "fit"] and panel.get_ylabel() == "residual [N]"
    low, high = panel.get_ylim()
    assert high - low < 0.2 < np.ptp(demo_fit.recording.force)


def test_ctrl_c_ends_a_fit_within_a_second():
    """Judged by processor time, which other programs do not change: the whole fit takes 10 s of it."""
    script = """
import slipfit as sf, time
model = dict(stiffness=1000, natural_frequency=200, damping_ratio=0.05, static_friction=6, f0=3, f1=1, alpha=-10, noise=0.05)
runs = {str(i): sf.simulate(**model, speed=0.01 * 1.2 ** i, duration=60, sample_rate=1000, seed=i + 1) for i in range(12)}
begin = time.process_time()
print("begins", flush=True)
try:
    sf.fit(runs)
except KeyboardInterrupt:
    print(time.process_time() - begin, flush=True)
"""
    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "begins\n"
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    printed = process.communicate(timeout=120)[0]
    assert process.returncode == 0
    assert float(printed) < 0.3 * 2 + 2.0  # until the signal, and a second, on two processors
