"""The example for Dask, on a cluster of two processes on the loopback."""

import importlib.util
import subprocess

import pytest
from conftest import PROGRAM, PROJECT

import slipfit as sf

distributed = pytest.importorskip("dask.distributed")


@pytest.fixture(scope="module")
def example():
    spec = importlib.util.spec_from_file_location("dask_batch", PROJECT / "examples" / "dask_batch.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def write_manifest(folder, count):
    """`count` recordings, of which the last but one is missing; an id of digits stays as it is."""
    model = dict(stiffness=1000.0, natural_frequency=200.0, damping_ratio=0.05, static_friction=6.0, kinetic_friction=4.0, noise=0.01)
    lines = ["id,file,speed_m_per_s,group"]
    for i in range(count):
        name = f"{i:04}"
        if i != count - 2:
            sf.simulate(**model, speed=0.02 + 0.001 * i, duration=2, sample_rate=500, seed=i + 1).to_frame().to_csv(folder / f"{name}.csv", index=False)
        lines.append(f"{name},{name}.csv,{0.02 + 0.001 * i:.3f},{'dry' if i % 2 else ''}")
    (folder / "runs.csv").write_text("\n".join(lines) + "\n")
    return folder / "runs.csv"


@pytest.mark.parametrize("count", [8, pytest.param(200, marks=pytest.mark.long)])
def test_the_table_of_dask_is_that_of_the_batch(count, example, tmp_path, monkeypatch):
    import pathlib

    import dask

    folder = pathlib.Path(sf.__file__).parent.parent
    monkeypatch.setenv("PYTHONPATH", f"{folder}:{PROJECT / 'examples'}")  # of the workers
    manifest = write_manifest(tmp_path, count)
    with dask.config.set({"distributed.admin.tick.interval": "1s"}):
        cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None)
        with cluster, distributed.Client(cluster) as client:
            rows = example.rows_of(str(manifest), client)
    example.write_table(rows, tmp_path / "table.csv")
    assert [row["id"] for row in rows] == [f"{i:04}" for i in range(count)]
    assert [row["error"] for row in rows if row["status"] == "failed"] == ["file_not_found"]
    subprocess.run([PROGRAM, "batch", manifest, "--out", tmp_path / "out", "--quiet"], check=False, capture_output=True)
    assert (tmp_path / "table.csv").read_bytes() == (tmp_path / "out" / "summary.csv").read_bytes()
