"""Step 4: curves of the best sets at every predicted experiment, scored."""

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.data.quantities import VALUE_COLUMN
from pyrofit.errors import DataError
from pyrofit.files import Results, write_csv
from pyrofit.model.experiment import Gasification
from pyrofit.simulate import simulate_gasifications, solver_errors
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Request
from pyrofit.stages import outcomes
from pyrofit.stages.fit import best_sets, fixed_for_imp
from pyrofit.stages.measurements import load

LEAST_SQUARES, CMAES = "least squares", "CMA-ES"
"""Suffixes of the sets that these optimisers found on a cost."""


def sets_of(study: Study, results: Results) -> dict[str, dict[str, float]]:
    """Return the sets to predict: the best of each cost and optimiser, and published ones."""
    sets = dict(best_sets(study, results))
    for cost in study.imp.costs:
        start = outcomes.starts(study, results, cost)[0]
        sets[f"{cost} {LEAST_SQUARES}"] = start["parameters"]
    for cost in study.imp.costs:
        sets[f"{cost} {CMAES}"] = outcomes.cmaes(study, results, cost)[0]["parameters"]
    for cost, values in published_sets(study).items():
        sets[f"{cost} published"] = values
    return sets


def published_sets(study: Study) -> dict[str, dict[str, float]]:
    """Return the published best set of every cost that has a complete one, SI units."""
    costs = study.published.costs if study.published else {}
    return {
        cost: {n: table[n][0] * study.parameters[n].factor for n in study.imp.estimate}
        for cost, table in costs.items()
        if set(study.imp.estimate) <= set(table)
    }


def predict(study: Study, results: Results) -> None:
    """Simulate every set at every experiment to predict; write ``curves.csv``, ``scores.csv``.

    Curves are given at the measured times, as averages over the bins of the measurement; the score
    is the CV(RMSE) of mass loss rates, and the RMSE in K of temperatures. Beside it stands the
    solver's own error, estimated by refinement.
    """
    fixed = fixed_for_imp(study, results)
    material = study.material_with(study.imp.kinetics)
    measurements = load(study, results)
    chosen = sets_of(study, results)
    columns = {n: np.array([values[n] for values in chosen.values()]) for n in study.imp.estimate}
    curves = []
    scores = []
    for name in study.validation.experiments:
        experiment = study.experiments[name]
        assert isinstance(experiment, Gasification)
        requests = {
            q: Request(measurements[name, q]["time_s"].to_numpy(float), s.average_s)
            for q, s in experiment.signals.items()
        }
        runs, finer = (
            simulate_gasifications(
                experiment, material, {**fixed, **columns}, requests, accuracy, sets=len(chosen)
            )
            for accuracy in (study.accuracy, study.accuracy.refined())
        )
        for label, run, fine in zip(chosen, runs, finer, strict=True):
            if not run.status.finished:
                raise DataError(
                    f"{name}: the best set of {label} cannot be predicted: "
                    f"{run.status.explanation}; check the limits of the parameters"
                )
            errors = solver_errors(run, fine, requests)
            for quantity, request in requests.items():
                measured = measurements[name, quantity][VALUE_COLUMN[quantity]].to_numpy(float)
                simulated = run.signals[quantity]
                curves.append(_curve(name, quantity, label, request.time_s, simulated, measured))
                score = _score(quantity, simulated, measured, errors[quantity])
                about = {"experiment": name, "signal": quantity, "set": label}
                scores.append({**about, **score})
    write_csv(results.validation("curves.csv"), pd.concat(curves, ignore_index=True))
    write_csv(results.validation("scores.csv"), pd.DataFrame(scores))


def _curve(
    name: str, quantity: str, label: str, time: FloatArray, value: FloatArray, measured: FloatArray
) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "experiment": name,
            "signal": quantity,
            "set": label,
            "time_s": time,
            "simulated": value,
            "measured": measured,
        }
    )


def _score(
    quantity: str, value: FloatArray, measured: FloatArray, solver_rmse: float
) -> dict[str, object]:
    rmse = float(np.sqrt(np.mean((value - measured) ** 2)))
    mean = abs(float(np.mean(measured))) if quantity == "mlr" else np.nan
    return {
        "points": measured.size,
        "rmse_si": rmse,
        "cv_rmse": rmse / mean,
        "solver_rmse_si": solver_rmse,
        "solver_cv_rmse": solver_rmse / mean,
        "largest_simulated_si": float(np.max(value)),
    }
