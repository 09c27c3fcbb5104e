"""Curves of quantities that nobody measured: predictions of new tests."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.config.check.unmeasured import unmeasured
from pyrofit.errors import DataError
from pyrofit.experiments import kind_of
from pyrofit.model.material import Material
from pyrofit.quantities import known_quantities
from pyrofit.solver.arrays import Values
from pyrofit.solver.curves import Curves, Request

POINTS = 200
"""Points of a predicted record."""


def predict_unmeasured(
    study: Study, material: Material, values: Values, labels: Mapping[str, object]
) -> pd.DataFrame:
    """Return the predicted curves, SI units; rates are averages over the spacing of the points.

    Parameters
    ----------
    study, material
        The study, and the material with the kinetics of the inverse modelling.
    values
        Parameter values by name, each a number or of shape (sets,).
    labels
        The sets by name.

    Returns
    -------
    pandas.DataFrame
        Columns ``experiment``, ``signal`` (the quantity), ``set``, ``time_s``, ``simulated``.

    Raises
    ------
    DataError
        A simulation does not finish.
    """
    parts = []
    for name, quantities in unmeasured(study).items():
        experiment = study.experiments[name]
        span, _ = experiment.synthetic_span
        bin_s = span / POINTS
        time = np.asarray(bin_s * (np.arange(POINTS) + 0.5), dtype=np.float64)
        requests = {}
        for quantity in quantities:
            known = known_quantities()[quantity]
            width = bin_s if known.sampling == "bin mean" else 0.0
            requests[quantity] = Request(time, width, output=known.curve)
        simulate = kind_of(experiment).simulate
        runs = simulate([experiment], material, values, [requests], study.accuracy, len(labels))[0]
        for label, run in zip(labels, runs, strict=True):
            check_finished(name, label, run)
            for quantity, curve in run.signals.items():
                about = {"experiment": name, "signal": quantity, "set": label}
                parts.append(pd.DataFrame({**about, "time_s": time, "simulated": curve}))
    return pd.concat(parts, ignore_index=True)


def check_finished(name: str, label: str, run: Curves) -> None:
    """Check that the run of a set can be used.

    Raises
    ------
    DataError
        It cannot.
    """
    if not run.status.finished:
        raise DataError(
            f"{name}: the set '{label}' cannot be predicted: "
            f"{run.status.explanation}; check the limits of the parameters"
        )
