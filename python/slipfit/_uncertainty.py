"""Covariance of the parameters, and draws from their intervals."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, Mapping

import numpy as np

from ._errors import Error
from ._values import unit_of

if TYPE_CHECKING:
    import pandas as pd

_NORMAL_QUANTILE = 1.959963984540054  # of 97.5 %
# The fit solves for their logarithms: docs/formats.md, `correlation`.
_IN_LOGARITHM = {"stiffness_N_per_m", "natural_frequency_rad_per_s", "friction_difference_N", "reload_length_m",
                 "relaxation_time_s"}


def _correlation(name: str, document: Mapping[str, Any]) -> Dict[str, Any]:
    content = document.get("correlation")
    if not content:
        raise Error("no_covariance", f"{name}: the result has no covariance, expected a fit of stick-slip that determines its parameters")
    return dict(content)


def covariance(name: str, document: Mapping[str, Any]) -> "pd.DataFrame":
    import pandas

    content = _correlation(name, document)
    names = content["names"]
    scale = [value if key in _IN_LOGARITHM else 1.0 for key, value in zip(names, content["values"])]
    errors = np.array(content["scaled_se"], dtype=float) * np.array(scale, dtype=float)
    return pandas.DataFrame(np.array(content["matrix"], dtype=float) * np.outer(errors, errors), index=names, columns=names)


def _root(matrix: Any) -> Any:
    """Symmetric root of a correlation matrix; rounding may have made eigenvalues slightly negative."""
    values, vectors = np.linalg.eigh(np.array(matrix, dtype=float))
    return (vectors * np.sqrt(np.maximum(values, 0.0))) @ vectors.T


def _stretched(normal: Any, value: float, low: float, high: float) -> Any:
    """Normal numbers as a distribution with this median and these ends of the central 95 %.

    Two halves of a normal distribution, each as wide as its side of the interval.
    """
    return value + normal / _NORMAL_QUANTILE * np.where(normal > 0.0, high - value, value - low)


def sample(name: str, document: Mapping[str, Any], n: int, seed: int) -> "pd.DataFrame":
    import pandas

    content = _correlation(name, document)
    errors = np.array(content["scaled_se"], dtype=float)
    normals = np.random.default_rng(seed).standard_normal((int(n), len(errors))) @ _root(content["matrix"])
    draws = {}
    for place, key in enumerate(content["names"]):
        middle, error = float(content["values"][place]), _NORMAL_QUANTILE * errors[place]
        is_log = key in _IN_LOGARITHM
        stated = document["parameters"].get(key) or {}
        ends = stated.get("ci95")
        if ends is None or stated.get("value") is None:  # known only together with others
            ends = (middle * np.exp(-error), middle * np.exp(error)) if is_log else (middle - error, middle + error)
        if is_log and ends[0] > 0.0:
            draws[key] = np.exp(_stretched(normals[:, place], np.log(middle), np.log(ends[0]), np.log(ends[1])))
        else:
            draws[key] = _stretched(normals[:, place], middle, float(ends[0]), float(ends[1]))
    frame = pandas.DataFrame(draws)
    known = {"stiffness_N_per_m", "natural_frequency_rad_per_s"}
    if known <= set(frame.columns):
        frame["mass_kg"] = frame["stiffness_N_per_m"] / frame["natural_frequency_rad_per_s"] ** 2
        if "damping_ratio" in frame.columns:
            frame["damping_ratio"] = frame["damping_ratio"].clip(lower=0.0)
            frame["damping_coefficient_N_s_per_m"] = (
                2.0 * frame["damping_ratio"] * frame["stiffness_N_per_m"] / frame["natural_frequency_rad_per_s"]
            )
    return frame


def dataset(draws: "pd.DataFrame") -> Any:
    """One chain."""
    import xarray

    columns = {
        name: (("chain", "draw"), draws[name].to_numpy()[np.newaxis, :], {"units": unit_of(str(name))}) for name in draws.columns
    }
    return xarray.Dataset(columns, coords={"chain": [0], "draw": np.arange(len(draws))})
