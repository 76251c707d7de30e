"""Where the recordings and the program are; SLIPFIT_EXECUTABLE and SLIPFIT_SHARED_DIR say otherwise."""

import os
import pathlib

import pytest

import slipfit as sf

PROJECT = pathlib.Path(__file__).resolve().parents[2]
TESTDATA = PROJECT / "testdata"
SHARED = pathlib.Path(os.environ.get("SLIPFIT_SHARED_DIR", PROJECT.parent / "shared"))
PROGRAM = os.environ.get("SLIPFIT_EXECUTABLE", str(PROJECT / "build" / "release" / "apps" / "slipfit"))

MODEL = dict(stiffness=1000.0, natural_frequency=200.0, damping_ratio=0.05, static_friction=6.0, noise=0.01)
WEAKENING = dict(MODEL, f0=3.0, f1=1.0, alpha=-10.0)

os.environ["MPLBACKEND"] = "Agg"


def error_of(call):
    with pytest.raises(sf.Error) as caught:
        call()
    return caught.value


@pytest.fixture(scope="session")
def demo():
    return sf.read_recording(TESTDATA / "demo.csv", speed="10 mm/s")


@pytest.fixture(scope="session")
def demo_fit(demo):
    return sf.fit(demo)


@pytest.fixture
def saved(demo_fit, tmp_path):
    """The document of the demo's fit."""
    file = tmp_path / "demo.json"
    file.write_text(demo_fit.to_json())
    return file


@pytest.fixture(scope="session")
def runs():
    """A sweep of three speeds with friction that falls with the speed."""
    return {
        f"v{speed:g}": sf.simulate(**WEAKENING, speed=speed, duration=3, sample_rate=1000, name=f"v{speed:g}")
        for speed in (0.02, 0.04, 0.08)
    }


@pytest.fixture(scope="session")
def sweep(runs):
    return sf.fit(runs, name="dry")
