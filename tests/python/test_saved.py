"""What was saved is opened again, and says the same."""

import concurrent.futures
import importlib.util
import io
import json
import pickle
import sys
import types
import warnings

import numpy as np
import pandas as pd
import pytest
from conftest import MODEL, PROJECT, TESTDATA, WEAKENING, error_of

import slipfit as sf


@pytest.fixture(scope="module")
def folder(runs, tmp_path_factory):
    """A batch of three recordings and one that is missing."""
    here = tmp_path_factory.mktemp("batch")
    lines = ["id,file,speed_m_per_s,group"]
    for name, recording in runs.items():
        recording.to_frame().to_csv(here / f"{name}.csv", index=False)
        lines.append(f"{name},{name}.csv,{recording.speed!r},dry")
    (here / "runs.csv").write_text("\n".join([*lines, "absent,absent.csv,0.01,"]) + "\n")
    sf.batch(here / "runs.csv", out=here / "out", jobs=2, joint_groups=True)
    return here


def test_a_fit_is_read_again(saved, demo_fit):
    for source in (saved, str(saved), saved.open("rb"), io.StringIO(demo_fit.to_json()), demo_fit.to_dict()):
        fit = sf.read_fit(source)
        assert fit.to_dict() == demo_fit.to_dict() and fit.stiffness == demo_fit.stiffness
    assert sf.read_fit(saved).to_json() == demo_fit.to_json()
    assert fit.to_frame().equals(demo_fit.to_frame()) and fit.row() == demo_fit.row()
    assert fit.predict([0.01, 0.02]).to_json() == demo_fit.predict([0.01, 0.02]).to_json()
    assert fit.plan().to_json() == demo_fit.plan().to_json()
    assert repr(fit) == repr(demo_fit) and str(fit) == str(demo_fit) and "tangential stiffness" in fit._repr_html_()
    assert sf.compare(fit, demo_fit).to_dict() == sf.compare(demo_fit, demo_fit).to_dict()


def test_a_document_holds_no_samples(saved, demo, demo_fit):
    fit = sf.read_fit(saved)
    for call in (lambda: fit.curve, lambda: fit.cycles, lambda: fit.plot(), lambda: fit.report("page.html"), lambda: fit.recording):
        error = error_of(call)
        assert error.code == "no_recording" and "with_recording" in error.remedy
    whole = sf.read_fit(saved, recording=demo)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        np.testing.assert_array_equal(whole.curve.fitted, demo_fit.curve.fitted)
    other = sf.Recording(demo.time[:-1], demo.force[:-1], speed=0.01)
    assert error_of(lambda: fit.with_recording(other)).code == "another_recording"


def test_a_fit_that_is_made_again_otherwise_is_warned_of(demo, demo_fit):
    document = demo_fit.to_dict()
    document["parameters"]["stiffness_N_per_m"]["value"] += 1.0
    with pytest.warns(UserWarning, match="other parameters than the saved one"):
        sf.read_fit(document, recording=demo).curve  # noqa: B018


def test_held_parameters_are_held_again(demo):
    fit = sf.fit(demo, fix={"damping_ratio": 0.05})
    again = sf.read_fit(fit.to_dict(), recording=demo)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        np.testing.assert_array_equal(again.curve.fitted, fit.curve.fitted)


def test_one_of_several_documents(folder, demo_fit, tmp_path):
    lines = folder / "out" / "results.jsonl"
    assert sf.read_fit(lines, id="v0.04").id == "v0.04"
    assert "holds 4 documents" in error_of(lambda: sf.read_fit(lines)).message
    assert "v0.02" in error_of(lambda: sf.read_fit(lines, id="v3")).message
    (tmp_path / "two.json").write_text(json.dumps([demo_fit.to_dict(), {**demo_fit.to_dict(), "id": "other"}]))
    assert sf.read_fit(tmp_path / "two.json", id="other").stiffness == demo_fit.stiffness


@pytest.mark.parametrize("content", ["", "{}", "[]", "3", "not JSON", '{"schema": "slipfit.fit/1", "id": "a", "status": "new"}'])
def test_what_is_no_document_is_refused(content, tmp_path):
    (tmp_path / "bad.json").write_text(content)
    assert error_of(lambda: sf.read_fit(tmp_path / "bad.json")).code == "bad_document"


def test_a_sweep_is_read_again(sweep, runs, tmp_path):
    (tmp_path / "dry.json").write_text(sweep.to_json())
    again = sf.read_fit(tmp_path / "dry.json")
    assert isinstance(again, sf.Sweep) and len(again) == 3 and again.parameters == sweep.parameters
    assert again["v0.04"].frequency == sweep["v0.04"].frequency and again["v0.04"].pattern_spacing.value
    assert again.recordings_frame().equals(sweep.recordings_frame())
    assert again.predict([0.03]).to_json() == sweep.predict([0.03]).to_json()
    assert error_of(lambda: again.plot()).code == "no_recording"
    whole = again.with_recording(runs)
    np.testing.assert_array_equal(whole["v0.04"].curve.fitted, sweep["v0.04"].curve.fitted)
    assert error_of(lambda: again.with_recording({"v0.02": runs["v0.02"]})).code == "another_recording"
    assert "tangential stiffness" in again._repr_html_() and str(again) == str(sweep)


def test_a_pickle_has_no_samples_unless_asked(demo, demo_fit, sweep, runs):
    small, whole = pickle.dumps(demo_fit), pickle.dumps(demo_fit.with_recording())
    assert len(small) < 20_000 < 160_000 < len(whole)
    assert pickle.loads(small).to_json() == demo_fit.to_json()
    assert error_of(lambda: pickle.loads(small).cycles).code == "no_recording"
    assert pickle.loads(whole).cycles.equals(demo_fit.cycles)
    assert pickle.loads(small).with_recording(demo).cycles.equals(demo_fit.cycles)
    assert len(pickle.loads(pickle.dumps(sweep))) == 3
    assert len(pickle.dumps(sweep)) < 40_000 < len(pickle.dumps(sweep.with_recording()))


def test_a_batch_is_opened(folder, runs):
    batch = sf.open_batch(folder / "out")
    assert batch.counts["total"] == 5 and batch.counts["failed"] == 1 and repr(batch).endswith("4 of 5 fitted, 1 failed>")
    assert batch.ids == ["v0.02", "v0.04", "v0.08", "group:dry"] and len(batch) == 4
    assert batch["v0.04"].stiffness == sf.fit(runs["v0.04"]).stiffness and isinstance(batch["group:dry"], sf.Sweep)
    assert [fit.id for fit in batch.fits()] == batch.ids == [document["id"] for document in batch]
    assert len(batch.to_frame()) == 5 and list(batch.failures.id) == ["absent"] and "absent.csv" in batch._repr_html_()
    with pytest.raises(KeyError, match="absent"):
        batch["absent"]
    assert error_of(lambda: sf.open_batch(folder)).code == "not_a_batch"
    assert sf.compare(batch, batch["v0.02"]).to_frame().size


def test_an_unfinished_batch_has_no_results(folder, tmp_path):
    (tmp_path / "run.json").write_text((folder / "out" / "run.json").read_text().replace('"finished": true', '"finished": false'))
    batch = sf.open_batch(tmp_path)
    for read in (lambda: list(batch), lambda: batch.ids, lambda: batch["v0.02"], batch.to_frame, lambda: batch.failures):
        assert error_of(read).code == "not_finished"


def test_rows_are_those_of_the_summary(folder):
    batch = sf.open_batch(folder / "out")
    written = batch.to_frame().set_index("id").drop(columns="row")
    for fit in batch.fits():
        row = pd.Series(fit.row(), dtype=object)
        assert list(row.index.drop("id")) == list(written.columns)
        for name, value in written.loc[fit.id].items():
            if name == "file":
                continue  # the manifest's folder stands in front of it
            if name == "group" and fit.id == "group:dry":
                continue  # of the manifest
            assert (row[name] is None and pd.isna(value)) or row[name] == value, (fit.id, name)


def test_shards_are_merged(folder, tmp_path):
    shards = [tmp_path / f"part{i}" for i in (1, 2)]
    for i, out in enumerate(shards, 1):
        sf.batch(folder / "runs.csv", out=out, shard=(i, 2), joint_groups=True)
    merged = sf.merge(shards, out=tmp_path / "whole")
    assert merged.ids == sf.open_batch(folder / "out").ids
    for name in ("results.jsonl", "summary.csv", "failures.csv"):
        assert (tmp_path / "whole" / name).read_bytes() == (folder / "out" / name).read_bytes()
    assert error_of(lambda: sf.merge(shards[:1], out=tmp_path / "half")).code == "shards_missing"


@pytest.mark.parametrize("pool", [None, concurrent.futures.ThreadPoolExecutor, concurrent.futures.ProcessPoolExecutor])
def test_any_pool_fits_many(pool, runs):
    if pool is None:
        fits = sf.fit_many(runs)
    else:
        with pool(2) as workers:
            fits = sf.fit_many(runs, map=workers.map)
    assert {name: one.to_json() for name, one in fits.items()} == {name: sf.fit(one, name=name).to_json() for name, one in runs.items()}
    assert not np.isnan(fits["v0.04"].curve.fitted).all()
    assert [one.to_json() for one in sf.fit_many(runs.values())] == [sf.fit(one).to_json() for one in runs.values()]


def test_predictions_from_documents_and_parameters(saved, demo_fit):
    expected = demo_fit.predict("5mm/s,10mm/s").to_json()
    assert sf.predict("5mm/s,10mm/s", fit=saved).to_json() == expected == sf.predict("5mm/s,10mm/s", fit=demo_fit).to_json()
    model = {key: value for key, value in MODEL.items() if key != "noise"}
    stated = sf.predict([0.02], **model, kinetic_friction=4)
    assert stated.to_frame().periodic_displacement_m[0] > 0 and stated.to_dict()["source"] == "parameters"
    law = {key: value for key, value in WEAKENING.items() if key != "noise"}
    assert sf.predict([0.02], **law).to_frame().periodic_displacement_m[0] > 0
    assert error_of(lambda: sf.predict([0.02])).code == "unknown_option"
    assert error_of(lambda: sf.predict([0.02], fit=demo_fit, stiffness=3)).code == "unknown_option"
    assert error_of(lambda: sf.predict([0.02], **{**model, "kinetic_friction": 7})).code == "parameter_out_of_range"


def test_the_figures_of_the_paper(tmp_path):
    paths = sf.figures(tmp_path / "figures")
    assert {"figure_7.csv", "figure_7.svg"} <= {path.rpartition("/")[2] for path in paths}
    assert all((tmp_path / "figures" / path).exists() for path in paths)


def test_covariance_and_aicc(demo_fit, demo):
    covariance = demo_fit.covariance
    names = ["stiffness_N_per_m", "natural_frequency_rad_per_s", "damping_ratio", "friction_difference_N"]
    assert list(covariance.columns) == names == list(covariance.index)
    for name in names:  # intervals hold more than the covariance: both readings of the trend of the level
        assert 0.7 < covariance.loc[name, name] ** 0.5 / demo_fit.parameters[name].se < 1.01, name
    assert demo_fit.aicc == demo_fit.to_dict()["model"]["candidates"][2]["aicc"]
    assert sf.analyze(demo).aicc is None
    assert error_of(lambda: sf.analyze(demo).covariance).code == "no_covariance"


def test_draws_have_the_stated_intervals(demo_fit):
    draws = demo_fit.sample(40_000, seed=3)
    for name in draws.columns:
        stated = demo_fit.parameters[name]
        low, middle, high = np.percentile(draws[name], [2.5, 50, 97.5])
        # The error of a percentile of 40 000 draws is 1.5 % of the half width; mass and c follow from the others.
        reach = 0.05 if name in demo_fit.covariance.columns else 0.3
        half = (stated.ci95[1] - stated.ci95[0]) / 2
        assert abs(low - stated.ci95[0]) < reach * half and abs(high - stated.ci95[1]) < reach * half, name
        assert abs(middle - stated.value) < reach * half, name
    stiffness = demo_fit.stiffness
    assert stiffness.ci95[1] - stiffness.value > 3 * (stiffness.value - stiffness.ci95[0])  # skewed, and so are the draws
    skew = np.percentile(draws.stiffness_N_per_m, 97.5) - 2 * np.median(draws.stiffness_N_per_m) + np.percentile(draws.stiffness_N_per_m, 2.5)
    assert skew > 10
    matrix = np.array(demo_fit.to_dict()["correlation"]["matrix"])
    assert draws[demo_fit.covariance.columns].corr("spearman").to_numpy() == pytest.approx(matrix, abs=0.03)
    assert demo_fit.sample(5, seed=3).equals(demo_fit.sample(5, seed=3))


def test_draws_for_xarray_and_arviz(demo_fit, monkeypatch):
    """Debian has no ArviZ: a stand-in takes what InferenceData is given."""
    pytest.importorskip("xarray")
    draws, dataset = demo_fit.sample(50, seed=3), demo_fit.to_xarray(50, seed=3)
    assert set(dataset.data_vars) == set(draws.columns) and dict(dataset.sizes) == {"chain": 1, "draw": 50}
    np.testing.assert_array_equal(dataset["mass_kg"].values[0], draws["mass_kg"])
    assert dataset["stiffness_N_per_m"].attrs["units"] == "N/m"
    if importlib.util.find_spec("arviz") is None:

        class InferenceData:
            def __init__(self, **groups):
                self.__dict__.update(groups)

        monkeypatch.setitem(sys.modules, "arviz", types.SimpleNamespace(InferenceData=InferenceData))
    assert demo_fit.to_inference_data(50, seed=3).posterior.equals(dataset)


def test_every_result_has_a_line_and_a_page_for_notebooks(demo, demo_fit, sweep, folder, tmp_path):
    (tmp_path / "heights.txt").write_text("".join(f"{(i % 40) / 20 + 0.01 * (i * 7919 % 13):.3f}\n" for i in range(2000)))
    results = [demo, demo_fit, sweep, demo_fit.predict([0.01]), demo_fit.plan(), sf.compare(demo_fit, demo_fit), sf.info(TESTDATA / "demo.csv"),
               sf.surface(tmp_path / "heights.txt", pitch="0.5 um"), sf.open_batch(folder / "out"), demo_fit.stiffness]
    for one in results:
        assert repr(one).startswith("<") and "\n" not in repr(one) and len(repr(one)) < 250, repr(one)
        assert one._repr_html_().startswith("<"), type(one)
    assert repr(sf.compare(demo_fit, demo_fit)).startswith("<slipfit.Comparison No difference is shown in any of ")
    assert "tangential stiffness" in demo_fit.parameters._repr_html_() and "stiffness_N_per_m: 5000.4" in repr(demo_fit.parameters)


def test_the_document_says_how_it_was_made(demo, demo_fit, tmp_path):
    document = demo_fit.to_dict()
    assert document["options"] == {"tier": "auto", "fix": {}} and document["recording"]["options"] == {}
    assert document["commit"] is None or len(document["commit"]) == 12
    schema = json.loads((PROJECT / "docs" / "fit.schema.json").read_text())
    assert document["$schema"] == schema["$id"]
    read = sf.read_recording(TESTDATA / "demo.csv", speed=0.01, window=(0.2, 1.8), force_column=2, time_unit="s")
    fit = sf.fit(read, tier="damped", fix={"damping_ratio": 0.05})
    document = fit.to_dict()
    assert document["options"] == {"tier": "damped", "fix": {"damping_ratio": 0.05}}
    assert document["recording"]["options"] == {"force_column": "2", "time_unit": "s", "window_s": "0.2:1.8"}
    assert pickle.loads(pickle.dumps(read))._native is not None
    assert sf.fit(pickle.loads(pickle.dumps(read)), tier="damped", fix={"damping_ratio": 0.05}).to_json() == fit.to_json()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        np.testing.assert_array_equal(sf.read_fit(document, recording=read).curve.fitted, fit.curve.fitted)
    analysed = sf.analyze(demo)
    assert "options" not in analysed.to_dict()
    assert sf.read_fit(analysed.to_dict(), recording=demo).cycles.equals(analysed.cycles)


def test_a_bounded_parameter_is_an_interval_without_a_value(tmp_path):
    """Slips of one sample: the drop is known, and F_s - F_k lies between half of it and all of it."""
    recording = sf.simulate(stiffness=5000, natural_frequency=900, damping_ratio=0.05, static_friction=4, kinetic_friction=3, speed=0.01,
                            duration=4, sample_rate=250, noise=0.01, jitter=0.03, seed=5)
    fit = sf.fit(recording)
    difference = fit.friction_difference
    assert difference.status == "bounded" and difference.value is None and difference.ci95[0] < difference.ci95[1]
    assert fit.to_dict()["parameters"]["friction_difference_N"]["value"] is None
    assert fit.row()["friction_difference_N"] is None and fit.row()["friction_difference_low_N"] == difference.ci95[0]
    assert str(difference).startswith("between") and np.isnan(float(difference))
    assert sf.read_fit(fit.to_dict()).friction_difference == difference
    reason = sf.compare(fit, fit).to_dict()["quantities"]["friction_difference_N"]
    assert reason["difference"] is None or reason["difference"]["value"] is None


def test_the_table_has_errors_digests_and_types(folder):
    batch = sf.open_batch(folder / "out")
    row, fit = batch["v0.04"].row(), batch["v0.04"]
    assert row["stiffness_se_N_per_m"] == fit.stiffness.se and row["frequency_se_Hz"] == fit.frequency.se
    assert row["input_digest"] == fit.to_dict()["recording"]["input_digest"] and row["normal_force_N"] is None
    typed = batch.to_frame(typed=True)
    numbers = {name for name in typed.columns if typed[name].dtype == "float64"}
    texts = {name for name in typed.columns if typed[name].dtype == "string"}
    assert numbers | texts | {"row"} == set(typed.columns) and typed.row.dtype == "int64"
    assert {"surface_spacing_m", "normal_force_N", "stiffness_N_per_m", "cycles"} <= numbers  # some are empty in every row
    assert {"id", "surface_verdict", "ageing_time_status", "input_digest", "error"} <= texts
    plain = batch.to_frame()
    for name in numbers:
        assert plain[name].astype("float64").equals(typed[name]), name


def test_a_batch_and_a_merge_write_parquet(folder, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    for i in (1, 2):
        sf.batch(folder / "runs.csv", out=tmp_path / f"part{i}", shard=(i, 2))
    merged = sf.merge([tmp_path / "part1", tmp_path / "part2"], out=tmp_path / "whole")
    table = parquet.read_table(tmp_path / "whole" / "summary.parquet")
    assert table.to_pandas()["stiffness_N_per_m"].equals(merged.to_frame()["stiffness_N_per_m"])
    assert parquet.read_schema(tmp_path / "part1" / "summary.parquet").equals(table.schema, check_metadata=False)


def test_parquet_is_written_where_it_can_be(folder, tmp_path, monkeypatch):
    from slipfit import _batch

    written = []
    monkeypatch.setattr(_batch, "_can_write_parquet", lambda: True)
    monkeypatch.setattr(pd.DataFrame, "to_parquet", lambda frame, path, **_: written.append((path, frame.dtypes.astype(str).to_dict())))
    sf.batch(folder / "runs.csv", out=tmp_path / "out")
    ((path, types),) = written
    assert path == str(tmp_path / "out" / "summary.parquet") and types["stiffness_N_per_m"] == "float64" and types["id"] == "string"

    def fail(*_, **__):
        raise OSError("disk full")

    monkeypatch.setattr(pd.DataFrame, "to_parquet", fail)
    with pytest.warns(UserWarning, match="disk full"):
        assert len(sf.batch(folder / "runs.csv", out=tmp_path / "again").to_frame()) == 4
