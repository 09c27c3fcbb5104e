"""Count how often bands of the posterior hold the noiseless truth of twins.

    python benchmarks/posterior.py OUTPUT.csv --first 0 --twins 10 --kinds right wrong

A twin is fitted at 25 kW/m2 and predicted at 60 kW/m2. Its truth comes from the reference solver:
with the fitted model ('right'), or with an effect that this model lacks.
"""

import argparse
import os
import time
from pathlib import Path
from typing import Any

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np
import pandas as pd
import yaml

from pyrofit.config import Study, TermSpec, as_study
from pyrofit.estimate.bands import band, carried, measured
from pyrofit.estimate.likelihood import likelihood_of
from pyrofit.estimate.problem import Problem, make_problem
from pyrofit.estimate.sampled import Sampled, sample, spread
from pyrofit.estimate.targets import Measurements
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.measurements import computed
from pyrofit.steps.posterior.options import PosteriorOptions

TWIN = Path(__file__).parents[1] / "config" / "twin.yaml"
ESTIMATED = ("rho_a", "k_a", "cp_a", "eps_a", "dh")
SIGNALS = ("mlr", "back_temperature")
SETS = 400
LACKING: dict[str, dict[str, dict[str, float]]] = {
    "right": {},
    "k_T": {"k_T": {"slope_1_K": -1e-3}},
    "c_T": {"c_T": {"slope_1_K": 1e-3}},
    "in_depth": {"in_depth": {"length_m": 3.5e-4}},
    "back_loss": {"back_loss": {"factor": 0.5}},
    "emissivity_conversion": {"emissivity_conversion": {"change": -0.08}},
}
"""Effects that the truth has and the fitted model lacks, of typical strength by the catalogue."""


def study_of(kind: str, number: int) -> Study:
    """Return a study with the twin's measurements at 25 kW/m2 and its truth at both fluxes."""
    given: dict[str, Any] = yaml.safe_load(TWIN.read_text(encoding="utf-8"))
    truth = given["synthetic"]["truth"]
    for name, parameter in given["parameters"].items():
        if name not in ESTIMATED:
            parameter.update(value=truth.get(name, parameter.get("value")))
            parameter.pop("lower", None), parameter.pop("upper", None)
    given["parameters"]["eps_a"].update(lower=0.5, upper=1.0)
    x = np.random.default_rng([2026, number]).uniform(0.2, 0.8, len(ESTIMATED))
    for name, u in zip(ESTIMATED, x.tolist(), strict=True):
        lower, upper = (given["parameters"][name][key] for key in ("lower", "upper"))
        truth[name] = lower + u * (upper - lower)
    given["seed"] = number
    given["synthetic"] = {
        "truth": truth,
        "accuracy": {"elements": 100, "tolerance": 1e-6},
        "effects": LACKING[kind],
    }
    fitted = given["experiments"]["capa_25"]
    given["kinetics"] = None
    given["experiments"] = {
        "capa_25": fitted,
        "true_25": _noiseless(fitted),
        "true_60": _noiseless(given["experiments"]["capa_60"]),
    }
    given["imp"] = {
        "estimate": list(ESTIMATED),
        "costs": {"RMSE": [{"experiment": "capa_25", "signal": "mlr", "kind": "RMSE"}]},
        "identification": {"capa_25": list(SIGNALS)},
    }
    given["validation"] = {"experiments": ["capa_25"]}
    return as_study(given, "twin.yaml")


def _noiseless(experiment: dict[str, Any]) -> dict[str, Any]:
    signals = {
        name: {key: value for key, value in signal.items() if key != "noise"}
        for name, signal in experiment["signals"].items()
    }
    return {**experiment, "signals": signals}


def posed(study: Study, experiment: str, series: Measurements) -> Problem:
    """Return an experiment of the twin with both signals."""
    terms = [TermSpec(experiment=experiment, signal=s, kind="RMSE") for s in SIGNALS]
    return make_problem(study, ESTIMATED, terms, series, study.material, study.fixed_values())


def held(study: Study, series: Measurements, found: Sampled, number: int) -> dict[str, float]:
    """Return the share of the noiseless points in the bands, without and with discrepancy."""
    rng = np.random.default_rng([5, number])
    X = spread(found.drawn, SETS)
    shares: dict[str, float] = {}
    for flux in ("25", "60"):
        truth = posed(study, f"true_{flux}", series)
        models = [m for _, m in truth.simulate_all(found.likelihood.values(X))]
        for k, signal in enumerate(SIGNALS):
            target = truth.cost.terms[k][1].target
            curves = np.array([m[k] for m in models])
            wide = curves + _lacking(found, k, flux, target.time_s, curves, rng)
            key = f"{signal}_{flux}"
            quantity = study.experiments[f"true_{flux}"].quantity(signal)
            for kind, of in (("parameters", curves), ("both", wide)):
                low, _, high = band(of)
                error = quantity.solver_error * np.ptp(high)
                inside = (low - error <= target.value) & (target.value <= high + error)
                shares[f"{key}_{kind}"] = float(np.mean(inside))
                shares[f"{key}_{kind}_width"] = float(np.mean(high - low) / np.ptp(target.value))
    return shares


def _lacking(
    found: Sampled,
    k: int,
    flux: str,
    time_s: FloatArray,
    curves: FloatArray,
    rng: np.random.Generator,
) -> FloatArray:
    if flux == "60":
        return carried([found.discrepancies[k]]).carried_to(time_s, curves, rng) - curves
    target = found.likelihood.problem.cost.terms[k][1].target
    best = found.likelihood.split(found.curves)[k]
    covariance = found.discrepancies[k].covariance(time_s, best)
    return measured(covariance, found.noise_alone.noise[k], target.value - curves, rng)


def judged(kind: str, number: int) -> dict[str, object]:
    """Return the results of a twin."""
    begun = time.process_time()
    study = study_of(kind, number)
    series = computed(study)
    likelihood = likelihood_of(posed(study, "capa_25", series))
    truth = np.array([study.true_values()[name] for name in ESTIMATED])
    x = likelihood.scaled(truth)
    sampling = time.process_time()
    found = sample(likelihood, x, number, 1, PosteriorOptions().steps)
    spent = time.process_time() - sampling
    low, high = np.quantile(found.drawn.flat, (0.025, 0.975), axis=0)
    return {
        "kind": kind,
        "number": number,
        "probability": found.probability,
        "chi2_per_freedom": found.chi2 / found.freedom,
        "discrepancies": str(found.discrepancies),
        "converged": found.drawn.converged,
        "rhat": float(np.max(found.drawn.rhat)),
        "ess": float(np.min(found.drawn.ess)),
        "time": float(np.max(found.drawn.times)),
        "accepted": found.drawn.accepted,
        "steps": found.drawn.steps,
        "calls": found.drawn.calls,
        "parameters_held": float(np.mean((low <= x) & (x <= high))),
        **held(study, series, found, number),
        "twin_s": sampling - begun,
        "sampling_s": spent,
    }


def main() -> None:
    """Run the twins and append a row for each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", type=Path)
    parser.add_argument("--twins", type=int, default=10, help="of each kind")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument(
        "--kinds", nargs="+", default=["right", "wrong"], choices=[*LACKING, "wrong"]
    )
    given = parser.parse_args()
    rows: list[dict[str, object]] = []
    for number in range(given.first, given.first + given.twins):
        for kind in given.kinds:
            wrong = list(LACKING)[1 + number % (len(LACKING) - 1)]
            rows.append(judged(wrong if kind == "wrong" else kind, number))
            print(rows[-1], flush=True)
            pd.DataFrame(rows).to_csv(given.output, index=False)


if __name__ == "__main__":
    main()
