"""Twins of tests whose apparatus is free."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study, TermSpec, read_study
from pyrofit.diagnose.base.descent import descend_chi_square
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import Base, model_of
from pyrofit.effects.substance import properties_changed
from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.problem import Problem, make_problem
from pyrofit.quantities import known_quantities

Change = Callable[[Problem], Problem]


MLR = (("capa_25", "mlr"), ("capa_60", "mlr"))


SLABS = (*MLR, ("capa_25", "back_temperature"), ("capa_60", "back_temperature"))


SD = {"mlr": 5e-4, "back_temperature": 2.0, "mass_fraction": 5e-3}


END_S = {"capa_25": 1800.0, "capa_60": 400.0}


def posed(study: Study, channels: Sequence[tuple[str, str]], curves: Any = None) -> Problem:
    """The study's problem, measured at zero where no curves are given."""
    frames = {}
    for i, (name, signal) in enumerate(channels):
        if signal == "mass_fraction":
            T = np.arange(350.0, 720.0, 2.0)
            frame = pd.DataFrame({"time_s": (T - 350.0) * 6.0, "temperature_K": T})
        else:
            frame = pd.DataFrame({"time_s": np.arange(5.0, END_S[name], 5.0)})
        frame[known_quantities()[signal].column] = 0.0 if curves is None else curves[i]
        frames[name, signal] = frame
    known = {n: v * study.parameters[n].factor for n, v in study.synthetic.truth.items()}  # type: ignore[union-attr]
    estimated = [*study.imp.estimate, *(("T_B", "E_B") if len(channels) > len(SLABS) else ())]  # type: ignore[union-attr]
    specs = [TermSpec(experiment=e, signal=s, kind="RMSE") for e, s in channels]
    return make_problem(study, estimated, specs, frames, study.material, known)


def twin(
    hidden: Change, channels: Sequence[tuple[str, str]] = SLABS, seed: int = 1, noisy: bool = True
) -> FittedModel:
    """The fit of the study's model to a truth that hides something, with white noise."""
    study = read_study(Path(__file__).parents[2] / "config" / "twin.yaml")
    assert study.synthetic is not None
    problem = posed(study, channels)
    factors = {n: study.parameters[n].factor for n in problem.names}
    truth = np.array([study.synthetic.truth[n] * factors[n] for n in problem.names])
    _, curves = hidden(problem).simulate(truth)
    rng = np.random.default_rng(seed)
    measured = [
        curve + noisy * SD[signal] * rng.standard_normal(curve.size)
        for curve, (_, signal) in zip(curves, channels, strict=True)
    ]
    noise = tuple(
        NoiseModel(np.full(curve.size, SD[signal]), Correlation())
        for curve, (_, signal) in zip(curves, channels, strict=True)
    )
    likelihood = Likelihood(posed(study, channels, measured), noise)
    base = Base(likelihood, tuple(range(len(channels))))
    model = model_of(base, {})
    return FittedModel(model, descend_chi_square(model, likelihood.scaled(truth)))


def nothing(problem: Problem) -> Problem:
    return problem


def substance(key: str, **numbers: float) -> Change:
    put = properties_changed(key, **{name: name for name in numbers})

    def change(problem: Problem) -> Problem:
        material = put(problem.material, numbers, problem.material.own)
        return replace(problem, material=material)

    return change


STEP = substance("conductivity_W_mK", step=-0.06, step_temperature_K=450.0, step_width_K=4.0)
