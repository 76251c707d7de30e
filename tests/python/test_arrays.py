"""What arrays of other kinds than doubles become: never wrong numbers without a word."""

import datetime

import numpy as np
import pandas as pd
import pytest

import slipfit as sf


def of_time(demo, time):
    return sf.Recording(time, demo.force, speed=0.01)


def nanoseconds(demo):
    return np.round(demo.time * 1e9).astype("int64")


BEGIN = np.datetime64("2024-05-12T13:02:03", "ns")
TIMES = {
    "timedelta64[ns]": lambda demo: nanoseconds(demo).astype("timedelta64[ns]"),
    "timedelta64[us]": lambda demo: np.round(demo.time * 1e6).astype("timedelta64[us]"),
    "timedelta64[100us]": lambda demo: np.round(demo.time * 1e4).astype("int64").astype("timedelta64[100us]"),
    "datetime64[ns]": lambda demo: BEGIN + nanoseconds(demo).astype("timedelta64[ns]"),
    "TimedeltaIndex": lambda demo: pd.to_timedelta(demo.time, unit="s"),
    "DatetimeIndex": lambda demo: pd.DatetimeIndex(BEGIN + nanoseconds(demo).astype("timedelta64[ns]")),
    "DatetimeIndex with a zone": lambda demo: pd.DatetimeIndex(BEGIN + nanoseconds(demo).astype("timedelta64[ns]")).tz_localize("Europe/Berlin"),
    "Series of dates with a zone": lambda demo: pd.Series(BEGIN + nanoseconds(demo).astype("timedelta64[ns]")).dt.tz_localize("UTC"),
    "datetime": lambda demo: [datetime.datetime(2024, 5, 12) + datetime.timedelta(microseconds=round(1e6 * t)) for t in demo.time],
    "timedelta": lambda demo: [datetime.timedelta(microseconds=round(1e6 * t)) for t in demo.time],
    "masked dates": lambda demo: np.ma.array(BEGIN + nanoseconds(demo).astype("timedelta64[ns]"), mask=False),
}


@pytest.mark.parametrize("kind", TIMES)
def test_dates_and_durations_are_seconds(kind, demo, demo_fit):
    recording = of_time(demo, TIMES[kind](demo))
    np.testing.assert_allclose(recording.time, demo.time, rtol=0, atol=1.5e-9)  # a tick of nanoseconds, rounded down
    assert sf.fit(recording).stiffness.value == pytest.approx(demo_fit.stiffness.value, rel=1e-6)


def test_a_missing_date_is_left_out_and_counted(demo):
    dates = TIMES["datetime64[ns]"](demo)
    dates[[0, 7]] = np.datetime64("NaT")
    recording = of_time(demo, dates)
    assert len(recording) == len(demo) - 2 and [notice.code for notice in recording.warnings] == ["rows_without_number"]
    assert recording.time[0] == 0.0


def test_dates_have_their_unit_and_are_no_force(demo):
    with pytest.raises(TypeError, match="time_unit"):
        sf.Recording(TIMES["datetime64[ns]"](demo), demo.force, speed=0.01, time_unit="ms")
    with pytest.raises(TypeError, match="force: expected numbers, got dates"):
        sf.Recording(demo.time, TIMES["timedelta64[ns]"](demo), speed=0.01)
    with pytest.raises(TypeError, match="no fixed length"):
        of_time(demo, np.arange(len(demo)).astype("timedelta64[M]"))


def test_masked_samples_are_left_out(demo):
    masked = np.ma.array(demo.force.copy(), mask=False)
    masked[100:103] = np.ma.masked
    masked.data[100:103] = 1e6
    recording = sf.Recording(demo.time, masked, speed=0.01)
    assert len(recording) == len(demo) - 3 and recording.force.max() < 10
    assert [notice.code for notice in recording.warnings] == ["rows_without_number"]


@pytest.mark.parametrize("missing", [None, pd.NA], ids=["None", "NA"])
def test_missing_numbers_are_left_out(missing, demo):
    force = pd.array([missing, *demo.force[1:]], dtype="Float64")
    assert len(sf.Recording(demo.time, pd.Series(force), speed=0.01)) == len(demo) - 1
    assert len(sf.Recording(demo.time, [missing, *demo.force[1:]], speed=0.01)) == len(demo) - 1


def test_complex_numbers_and_texts_are_refused(demo):
    with pytest.raises(TypeError, match="complex"):
        sf.Recording(demo.time, demo.force + 0j, speed=0.01)
    with pytest.raises(TypeError, match="expected numbers, got str"):
        sf.Recording(demo.time, np.array(["fast"] * len(demo), dtype=object), speed=0.01)


def test_quantities_with_units_are_refused(demo):
    class Quantity:  # as pint's, which numpy would take for plain numbers
        magnitude = demo.force

        def __array__(self, dtype=None):
            return self.magnitude

    with pytest.raises(TypeError, match="force_unit"):
        sf.Recording(demo.time, Quantity(), speed=0.01)


def test_estimates_have_no_arithmetic(demo_fit):
    for call in (lambda: demo_fit.stiffness * 2, lambda: demo_fit.stiffness + (1,), lambda: len(demo_fit.stiffness)):
        with pytest.raises(TypeError):
            call()
    with pytest.raises(AttributeError):
        demo_fit.stiffness.value = 3.0
    assert f"{demo_fit.stiffness:.1f}" == "5000.4" and f"{demo_fit.stiffness}" == str(demo_fit.stiffness)


@pytest.mark.parametrize("wrap", [lambda one: [one], lambda one: (one,), lambda one: {"demo": one}], ids=["list", "tuple", "mapping"])
def test_one_recording_in_a_list_is_one_recording(wrap, demo, demo_fit):
    assert sf.fit(wrap(demo)).to_json() == demo_fit.to_json()
    assert sf.analyze(wrap(demo)).to_json() == sf.analyze(demo).to_json()
