"""Predictions of held-out tests by the study of pine: the tables of docs/measured_pine.md.

    snakemake --cores 1 results/pine/kinetics/fit.json --configfile config/pine.yaml
    python benchmarks/pine.py [--thin]

Least squares of the study's cost from the known values and the middle of the limits, with the
fitted kinetics, each known value as one more residual. ``--thin`` leaves the boards out of the fit.
The set is written to ``results/pine/values.json``, or ``thin.json``, for `pyrofit macfp submit`.
"""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import OptimizeResult, least_squares

from pyrofit.config import Study, TermSpec, read_study
from pyrofit.estimate.problem import Problem, make_problem
from pyrofit.estimate.targets import Measurements
from pyrofit.results.files import read_json, write_json
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.reading import read_all

ROOT = Path(__file__).parents[1]
BOARDS = ("tifp", "aalto")
STEP = 2e-3
"""Step of differences, of the distance of the limits."""
KNOWN_WEIGHT = 0.03
"""Residual of a known value one standard deviation away: a misfit of 3 % of a signal's range."""
INDEPENDENT = 5
"""Independent deviations of a signal: a model's residuals of a record have about as many signs."""
STRONG = 0.7
CALLS = 25


@dataclass(frozen=True)
class Fitted:
    """A problem and its least squares, parameters as fractions of the limits."""

    problem: Problem
    found: OptimizeResult

    @property
    def values(self) -> FloatArray:
        """Parameters in SI units."""
        return self.problem.lower + self.found.x * (self.problem.upper - self.problem.lower)

    @property
    def covariance(self) -> FloatArray:
        """Covariance in SI units, by the misfit that is left, limits as uniform distributions."""
        jacobian, span = self.found.jac, self.problem.upper - self.problem.lower
        size = 2.0 * self.found.cost / (INDEPENDENT * len(self.problem.picks) - span.size)
        inner = np.linalg.inv(jacobian.T @ jacobian / size + 12.0 * np.eye(span.size))
        return inner * np.outer(span, span)


def posed(
    study: Study, specs: Sequence[TermSpec], names: Sequence[str], measured: Measurements
) -> Problem:
    """Return the problem of some terms, with the fitted kinetics."""
    kinetics = read_json(ROOT / "results" / "pine" / "kinetics" / "fit.json")["parameters"]
    fixed = {k: v for k, v in {**study.fixed_values(), **kinetics}.items() if k not in names}
    return make_problem(study, names, specs, measured, study.material, fixed)


def known(study: Study, problem: Problem) -> tuple[list[int], FloatArray, FloatArray]:
    """Return places, means and standard deviations of known values, SI units."""
    at = [i for i, name in enumerate(problem.names) if name in study.known]
    factors = np.array([study.parameters[problem.names[i]].factor for i in at])
    entries = [study.known[problem.names[i]] for i in at]
    return at, *(factors * np.array([getattr(k, of) for k in entries]) for of in ("value", "sd"))


def fit(study: Study, problem: Problem) -> Fitted:
    """Return the least squares of cost and known values."""
    span = problem.upper - problem.lower
    at, mean, sd = known(study, problem)

    def all_residuals(x: FloatArray) -> list[FloatArray]:
        values = problem.lower + x * span
        far = KNOWN_WEIGHT * (values[:, at] - mean) / sd
        return [np.append(r, f) for r, f in zip(problem.residuals_all(values), far, strict=True)]

    def jacobian(x: FloatArray) -> FloatArray:
        steps = np.where(x < 0.5, STEP, -STEP)
        rows = all_residuals(np.vstack([x, x + np.diag(steps)]))
        return np.array([(r - rows[0]) / h for r, h in zip(rows[1:], steps, strict=True)]).T

    start = np.full(span.size, 0.5)
    start[at] = (mean - problem.lower[at]) / span[at]
    found = least_squares(
        lambda x: all_residuals(x[None])[0], start, jacobian, bounds=(0, 1), max_nfev=CALLS
    )
    return Fitted(problem, found)


def parameters(study: Study, fitted: Fitted) -> list[str]:
    """Return a line of Markdown for each parameter."""
    sd = np.sqrt(np.diag(fitted.covariance))
    lines = ["| parameter | unit | estimate | sd |", "|---|---|---|---|"]
    for name, value, spread in zip(fitted.problem.names, fitted.values, sd, strict=True):
        p = study.parameters[name]
        lines.append(f"| {name} | {p.unit} | {value / p.factor:.3g} | {spread / p.factor:.2g} |")
    return lines


def pairs(fitted: Fitted) -> list[str]:
    """Return the strongly correlated pairs, the strongest first."""
    c, names = fitted.covariance, fitted.problem.names
    rho = c / np.sqrt(np.outer(np.diag(c), np.diag(c)))
    found = [(float(rho[i, j]), f"{names[i]}, {names[j]}") for i in range(len(c)) for j in range(i)]
    strong = sorted((p for p in found if abs(p[0]) >= STRONG), key=lambda p: -abs(p[0]))
    return [f"{words}: {size:+.2f}" for size, words in strong]


def deviations(problem: Problem, values: FloatArray) -> list[float]:
    """Return the root mean square of simulated less measured of each term."""
    _, models = problem.simulate(values)
    targets = [term.target.value for _, term in problem.cost.terms]
    return [float(np.sqrt(np.mean((m - t) ** 2))) for m, t in zip(models, targets, strict=True)]


def main(thin: bool) -> None:
    """Print parameters, strong correlations, and deviations of all signals."""
    study = read_study(ROOT / "config" / "pine.yaml")
    measured = {key: frame for key, (frame, _) in read_all(study).items()}
    specs = study.imp.costs["RMSE"]
    specs = [s for s in specs if not (thin and s.experiment.startswith(BOARDS))]
    fitted = fit(study, posed(study, specs, study.imp.estimate, measured))
    print("\n".join([*parameters(study, fitted), "", *pairs(fitted), ""]))
    file = ROOT / "results" / "pine" / ("thin.json" if thin else "values.json")
    write_json(file, fitted.problem.values(fitted.values))
    used = {(s.experiment, s.signal) for s in specs}
    slabs = [key for key in measured if key[0] in set(study.validation.experiments)]
    whole = [TermSpec(experiment=n, signal=s, kind="RMSE") for n, s in slabs]
    every = posed(study, whole, study.imp.estimate, measured)
    print("| test | signal | rms | |\n|---|---|---|---|")
    for key, size in zip(slabs, deviations(every, fitted.values), strict=True):
        print(f"| {key[0]} | {key[1]} | {size:.3g} | {'' if key in used else 'held out'} |")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--thin", action="store_true")
    main(parser.parse_args().thin)
