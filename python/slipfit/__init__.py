"""Fits a stick-slip friction model to tribometer recordings and says how far each number can be trusted.

    import slipfit as sf

    rec = sf.read_recording("run7.csv", speed="10 mm/s", normal_force="10 N")
    fit = sf.fit(rec)
    fit.stiffness.value, fit.stiffness.ci95, fit.stiffness.status

Numbers are in SI. What is not known is None, and the note says why. Errors are `slipfit.Error` with `code` and `remedy`.
pandas and matplotlib are imported only by what needs them.
"""

from ._batch import BatchResult, batch, manifest, merge, open_batch
from ._documents import Comparison, Info, Plan, Prediction, Surface
from ._errors import Error
from ._fit import Curve, Fit
from ._functions import compare, figures, info, predict, simulate, surface
from ._recording import Recording, read_recording
from ._slipfit import __version__
from ._saved import read_fit
from ._sweep import Sweep, analyze, fit, fit_many
from ._values import Estimate, Notice, Parameters

__all__ = [
    "BatchResult",
    "Comparison",
    "Curve",
    "Error",
    "Estimate",
    "Fit",
    "Info",
    "Notice",
    "Parameters",
    "Plan",
    "Prediction",
    "Recording",
    "Surface",
    "Sweep",
    "__version__",
    "analyze",
    "batch",
    "compare",
    "figures",
    "fit",
    "fit_many",
    "info",
    "manifest",
    "merge",
    "open_batch",
    "predict",
    "read_fit",
    "read_recording",
    "simulate",
    "surface",
]
