"""Step 4: curves of the estimates and the best sets at every predicted experiment, scored."""

import numpy as np
import pandas as pd

from pyrofit.analysis.best_sets import published_sets
from pyrofit.analysis.uses import ESTIMATES
from pyrofit.config import Study
from pyrofit.config.check.unmeasured import unmeasured
from pyrofit.cost.distances import root_mean_square
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.experiments import kind_of
from pyrofit.quantities.base import Quantity
from pyrofit.results import identification, searches
from pyrofit.results.files import Results, write_csv
from pyrofit.results.kinetics import fixed_for_imp
from pyrofit.results.recorded import load
from pyrofit.simulate import solver_errors
from pyrofit.solver.arrays import FloatArray, Values
from pyrofit.stages.fit import best_set_of_each_cost
from pyrofit.stages.unmeasured import check_finished, predict_unmeasured


def sets_of(study: Study, results: Results) -> dict[str, dict[str, float]]:
    """Return the sets to predict: estimates, best sets of each optimiser, published ones."""
    found = identification.estimates(study, results)["estimate"]
    sets = {
        ESTIMATES: {str(n): float(v) for n, v in found.items()},
        **best_set_of_each_cost(study, results),
    }
    for key, optimiser in OPTIMISERS.items():
        for cost in study.imp.costs:
            start = searches.read_starts(study, results, cost, key)[0]
            sets[f"{cost} {optimiser.words}"] = start.parameters
    for cost, values in published_sets(study).items():
        sets[f"{cost} published"] = values
    return sets


def predict_sets(study: Study, results: Results) -> None:
    """Simulate every set at every experiment to predict; write ``curves.csv``, ``scores.csv``.

    Curves of unmeasured quantities go to ``unmeasured.csv``.

    Curves are given at the measured times, as averages over the bins of the measurement. The score
    is the CV(RMSE) of mass loss rates, and the RMSE in K of temperatures. Beside it stands the
    solver's own error, estimated by refinement.
    """
    fixed = fixed_for_imp(study, results)
    material = study.material_with(study.imp.kinetics)
    measurements = load(study, results)
    chosen = sets_of(study, results)
    columns = {n: np.array([values[n] for values in chosen.values()]) for n in study.imp.estimate}
    values: Values = {**fixed, **columns}
    if unmeasured(study):
        predicted = predict_unmeasured(study, material, values, chosen)
        write_csv(results.validation("unmeasured.csv"), predicted)
    curves = []
    scores = []
    for name in study.validation.experiments:
        experiment = study.experiments[name]
        kind = kind_of(experiment)
        requests = {}
        for signal in experiment.signals:
            frame = measurements[name, signal]
            time = frame["time_s"].to_numpy(float)
            requests[signal] = kind.request(experiment, signal, frame, time)
        runs, finer = (
            kind.simulate([experiment], material, values, [requests], accuracy, len(chosen))[0]
            for accuracy in (study.accuracy, study.accuracy.refined())
        )
        for label, run, fine in zip(chosen, runs, finer, strict=True):
            check_finished(name, label, run)
            errors = solver_errors(run, fine, requests)
            for signal, request in requests.items():
                quantity = experiment.quantity(signal)
                measured = measurements[name, signal][quantity.column].to_numpy(float)
                simulated = run.signals[signal]
                about = {"experiment": name, "signal": signal, "set": label}
                series = {"time_s": request.time_s, "simulated": simulated, "measured": measured}
                curves.append(pd.DataFrame({**about, **series}))
                scores.append({**about, **_score(quantity, simulated, measured, errors[signal])})
    write_csv(results.validation("curves.csv"), pd.concat(curves, ignore_index=True))
    write_csv(results.validation("scores.csv"), pd.DataFrame(scores))


def _score(
    quantity: Quantity, value: FloatArray, measured: FloatArray, solver_rmse: float
) -> dict[str, object]:
    rmse = root_mean_square(value - measured)
    mean = abs(float(np.mean(measured))) if quantity.relative else np.nan
    return {
        "points": measured.size,
        "rmse_si": rmse,
        "cv_rmse": rmse / mean,
        "solver_rmse_si": solver_rmse,
        "solver_cv_rmse": solver_rmse / mean,
        "largest_simulated_si": float(np.max(value)),
    }
