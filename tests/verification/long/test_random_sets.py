"""Random sets of Table 6

Sets drawn in Table 6's box widened by a fifth of its width on every side (as far as physics goes),
through the entry point of the searches, at 25 and 60 kW/m²: does every run finish, with a finite
cost, and to the last bit the same one alone and beside others? And sets in the box against the
independent reference solver.
"""

import time
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from cases import BEST, NAMES, Curve
from evidence import RMS_K, RMS_OVER_MEAN, Evidence
from sampling_limits import TABLE_6

from pyrofit.config import Study, as_study
from pyrofit.estimate.problem import FAILED_COST, Problem, make_problem
from pyrofit.model.accuracy import Resolution
from pyrofit.simulate import simulate_gasification
from pyrofit.solver.arrays import Status
from pyrofit.solver.curves import Request
from pyrofit.solver.reference.gasification import reference_gasification

PAPER = Path(__file__).parents[3] / "config" / "paper.yaml"
EXPERIMENTS = {25: ("capa_25", 1700.0), 60: ("capa_60", 420.0)}
SETS = 5000
"""At each flux."""
BATCH = 101
"""Sets side by side; not a multiple of the lanes."""
SETTINGS = Resolution(elements=200, tolerance=1e-5)
LEAST_RATE = 1e-5
"""Mean rate [kg/(m2 s)] below which differences are related to this one."""
REFERENCE = "independent solver: finite elements, BDF; 200 elements"


def paper() -> Study:
    return as_study(yaml.safe_load(PAPER.read_text(encoding="utf-8")), "paper.yaml")


def problem(flux: int) -> Problem:
    """The paper's inverse modelling with RMSE, on our curve of the published set."""
    study = paper()
    name, end = EXPERIMENTS[flux]
    material = study.material_with(study.imp.kinetics)
    at = np.arange(2.5, end, 5.0)
    fixed = study.fixed_values() | BEST
    request = {"mlr": Request(at, 5.0)}
    curve = simulate_gasification(study.experiments[name], material, fixed, request)
    measured = pd.DataFrame({"time_s": at, "mlr_kg_m2_s": curve.signals["mlr"]})
    term = study.imp.costs["RMSE"][0].model_copy(update={"experiment": name})
    return make_problem(study, NAMES, [term], {(name, "mlr"): measured}, material, fixed)


def widened(seed: int, share: float) -> Curve:
    """Draw sets from the box with ``share`` of its width added on every side; none is negative."""
    low, high = TABLE_6.T
    span = high - low
    low, high = np.maximum(low - share * span, 0.3 * low), high + share * span
    emissivities = [NAMES.index("eps_a"), NAMES.index("eps_r")]
    low[emissivities], high[emissivities] = 0.0, 1.0
    drawn: Curve = low + (high - low) * np.random.default_rng(seed).random((SETS, len(NAMES)))
    return drawn


@pytest.mark.parametrize("flux", [25, 60])
def test_random_sets_end_with_a_finite_cost(evidence: Evidence, flux: int) -> None:
    posed = problem(flux)
    drawn = widened(flux, 0.2)
    alone, longest = [], 0.0
    for values in drawn:
        start = time.perf_counter()
        alone.append(posed.evaluate(values))
        longest = max(longest, time.perf_counter() - start)
    failed = sum(not (e.status is Status.OK and 0.0 <= e.cost < FAILED_COST) for e in alone)
    title = f"{flux} kW/m²: of {SETS} sets in and around the box, not finished"
    evidence.number(title, failed / SETS, 1e-3, "share", "-", "%")
    assert longest < 5.0, "a run that hangs"
    batches = np.array_split(drawn, SETS // BATCH)
    assert [e for batch in batches for e in posed.evaluate_all(batch)] == alone


def test_fifty_sets_agree_with_the_reference(evidence: Evidence) -> None:
    study = paper()
    material = study.material_with(study.imp.kinetics)
    low, high = TABLE_6.T
    drawn = low + (high - low) * np.random.default_rng(50).random((50, len(NAMES)))
    rate, back = [], []
    for n, row in enumerate(drawn):
        name, end = EXPERIMENTS[60 if n % 2 else 25]
        at = np.arange(2.5, end, 5.0)
        requests = {"mlr": Request(at, 5.0), "back_temperature": Request(at)}
        values = study.fixed_values() | dict(zip(NAMES, row.tolist(), strict=True))
        case = study.experiments[name], material, values, requests
        ours, reference = simulate_gasification(*case), reference_gasification(*case, SETTINGS)
        assert ours.status is reference.status, values
        off = {q: ours.signals[q] - reference.signals[q] for q in requests}
        mean = max(float(reference.signals["mlr"].mean()), LEAST_RATE)
        rate.append(float(np.sqrt(np.mean(off["mlr"] ** 2))) / mean)
        back.append(float(np.sqrt(np.mean(off["back_temperature"] ** 2))))
    title = "50 sets in the box, 25 and 60 kW/m²:"
    for words, quantile, limit in (("half", 0.5, 6e-4), ("all", 1.0, 5e-3)):
        worst = float(np.quantile(rate, quantile))
        words = f"{title} mass loss rate, {words} within"
        evidence.number(words, worst, limit, RMS_OVER_MEAN.name, REFERENCE, "%")
    words = f"{title} back temperature, all within"
    evidence.number(words, max(back), 0.5, RMS_K.name, REFERENCE, "K")
