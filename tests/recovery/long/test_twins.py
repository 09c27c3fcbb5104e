"""Twenty twins: synthetic measurements of drawn truths, and intervals that cover them.

A twin is a polymer like PMMA under 25 kW/m2 whose mass loss rate and back temperature the reference
solver computes, with noise as it is measured: 2.9e-4 kg/(m2 s), correlated -0.25 and -0.20 like the
differenced readings of a balance, and 1.1 K that lasts (0.9^k). Material, apparatus and noise are
those of `config/twin.yaml`. The analysis knows the kinetics, and of the noise what the series tell:
its correlation is estimated.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from pyrofit.config import Study, TermSpec, as_study
from pyrofit.estimate.identify import Identification, identify
from pyrofit.estimate.likelihood import Likelihood, likelihood_of
from pyrofit.estimate.noise_of_curves import with_noise_of_curves
from pyrofit.estimate.posterior import UNIFORM
from pyrofit.estimate.problem import make_problem
from pyrofit.estimate.uncertain_apparatus import Moves, moves
from pyrofit.experiments.slab.uncertain import PLACES, with_value
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.measurements import computed

TWIN = Path(__file__).parents[3] / "config" / "twin.yaml"
ESTIMATED = ("rho_a", "k_a", "cp_a", "eps_a", "dh")

# Fixed beforehand, from the sensitivities in the middle of the limits: there the 95 % intervals of
# these are 1.5, 1.9, 2.8 and 2.6 % wide. That of dh is the widest, 3.6 %: what the sample gives off
# late makes up for it, so it is not claimed.
DETERMINED = ("rho_a", "k_a", "cp_a", "eps_a")

# A black polymer: with less than half of the flux absorbed it would not burn out in the record, and
# the released mass would not tell the density.
EMISSIVITY = {"lower": 0.5, "upper": 1.0}
NUMBER = 20
STARTS = 30
CHANNELS = ("mlr", "back_temperature")


@dataclass(frozen=True, eq=False)
class Twin:
    """A truth in units of the search range, its likelihood, and what was found."""

    truth: FloatArray
    likelihood: Likelihood
    found: Identification


def given(number: int) -> tuple[dict[str, Any], FloatArray]:
    """Return the study of a twin, and its truth in units of the search range."""
    study: dict[str, Any] = yaml.safe_load(TWIN.read_text(encoding="utf-8"))
    truth = study["synthetic"]["truth"]
    for name, parameter in study["parameters"].items():
        if name not in ESTIMATED:
            parameter.update(value=truth.get(name, parameter.get("value")))
            parameter.pop("lower", None), parameter.pop("upper", None)
    study["parameters"]["eps_a"].update(EMISSIVITY)
    # The middle 60 % of the search range.
    x = np.random.default_rng([2026, number]).uniform(0.2, 0.8, len(ESTIMATED))
    limits = [study["parameters"][name] for name in ESTIMATED]
    drawn = [p["lower"] + u * (p["upper"] - p["lower"]) for p, u in zip(limits, x, strict=True)]
    study["seed"] = number
    study["synthetic"] = {
        "truth": {**truth, **dict(zip(ESTIMATED, map(float, drawn), strict=True))},
        # A quarter of the default elements: off the default by 2e-5 of the highest rate at most.
        "accuracy": {"elements": 100, "tolerance": 1e-6},
    }
    study["kinetics"] = None
    study["experiments"] = {"capa_25": study["experiments"]["capa_25"]}
    study["imp"] = {
        "estimate": list(ESTIMATED),
        "costs": {"RMSE": [{"experiment": "capa_25", "signal": "mlr", "kind": "RMSE"}]},
        "identification": {"capa_25": list(CHANNELS)},
    }
    study["validation"] = {"experiments": ["capa_25"]}
    return study, x


def posed(study: Study) -> Likelihood:
    terms: tuple[TermSpec, ...] = study.imp.channels
    measured = computed(study)
    return likelihood_of(
        make_problem(study, ESTIMATED, terms, measured, study.material, study.fixed_values())
    )


def made(number: int) -> Twin:
    described, truth = given(number)
    likelihood = posed(as_study(described, "twin.yaml"))
    rng = np.random.default_rng([7, number])
    starts = list(rng.uniform(0.05, 0.95, (STARTS, len(ESTIMATED))))
    first = identify(likelihood, starts, profiles=False).optimum.x
    about = with_noise_of_curves(likelihood, [first])
    return Twin(truth, about, identify(about, [first]))


@pytest.fixture(scope="module")
def twins() -> list[Twin]:
    return [made(number) for number in range(NUMBER)]


def test_claimed_parameters_are_determined_in_the_middle_of_the_limits() -> None:
    described, _ = given(0)
    likelihood = posed(as_study(described, "twin.yaml"))
    jacobian = likelihood.with_known(likelihood.slopes(np.full(len(ESTIMATED), 0.5)))
    sd = np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian)))
    widths = dict(zip(ESTIMATED, 2.0 * 1.96 * sd, strict=True))
    assert max(widths[name] for name in DETERMINED) < 0.03, widths
    assert widths["dh"] > max(widths[name] for name in DETERMINED), widths


# Measured: rho_a 20 of 20 covered, widths 1.6 % in the median and 3.7 % at most; k_a 19, 2.1 and
# 3.3 %; cp_a 20, 3.1 and 4.5 %; eps_a 19, 2.8 and 4.0 %. (dh: 19, 4.8 and 7.3 %.)
@pytest.mark.parametrize("name", DETERMINED)
def test_intervals_cover_the_truth_and_are_narrow(twins: list[Twin], name: str) -> None:
    i = ESTIMATED.index(name)
    intervals = [twin.found.estimates[i].noise for twin in twins]
    covered = [
        interval.low <= twin.truth[i] <= interval.high
        for twin, interval in zip(twins, intervals, strict=True)
    ]
    assert 0.85 <= np.mean(covered) <= 1.0
    assert max(interval.width for interval in intervals) <= 0.20
    # With usual errors of the apparatus only the density is determined by one test.
    sure = {"determined"} if name == "rho_a" else {"determined as described"}
    assert {twin.found.estimates[i].verdict for twin in twins} == sure


def test_intervals_of_all_parameters_together_cover_as_often_as_they_say(
    twins: list[Twin],
) -> None:
    covered = [
        estimate.noise.low <= x <= estimate.noise.high
        for twin in twins
        for x, estimate in zip(twin.truth, twin.found.estimates, strict=True)
    ]
    assert 0.90 <= np.mean(covered) <= 0.99  # measured 0.97


def test_optimum_is_no_worse_than_a_descent_from_the_truth(twins: list[Twin]) -> None:
    for twin in twins:
        oracle = twin.likelihood.descend(twin.truth).chi2
        assert twin.found.optimum.chi2 < oracle + 1e-3  # measured 2e-8


def test_chi_square_is_that_of_noise(twins: list[Twin]) -> None:
    # Measured 0.96 on average: the floors make the noise a little larger than it is.
    ratios = [t.found.posterior.chi2 / t.found.posterior.freedom for t in twins]
    assert 0.93 < np.mean(ratios) < 1.0
    assert max(ratios) < 1.1


def test_no_right_model_is_refused(twins: list[Twin]) -> None:
    assert all(twin.found.goodness.describes for twin in twins)  # measured p from 0.07


def test_noise_is_estimated_as_it_was_drawn(twins: list[Twin]) -> None:
    rate, temperature = (
        np.array([twin.likelihood.noise[k].correlation.sequence(3)[1:] for twin in twins])
        for k in range(2)
    )
    assert rate.mean(axis=0) == pytest.approx((-0.25, -0.20), abs=0.05)
    assert temperature.mean(axis=0) == pytest.approx((0.90, 0.81), abs=0.02)


def test_wrong_description_moves_estimates_as_far_as_told(twins: list[Twin]) -> None:
    likelihood, x = twins[0].likelihood, twins[0].found.optimum.x
    problem, place = likelihood.problem, PLACES["flux"]
    (name,) = problem.runs
    run, value = problem.runs[name], 1.0 + 0.1 * place.sd
    wrong = replace(run, experiment=with_value(run.experiment, place, value))
    described = replace(likelihood, problem=replace(problem, runs={name: wrong}))
    moved = described.descend(x).x - x

    J = likelihood.with_known(likelihood.slopes(x))
    C = np.linalg.inv(J.T @ J + UNIFORM * np.eye(x.size))
    every = moves(likelihood, x)
    points = sum(likelihood.points)
    assert every.names[0] == "flux"
    flux = Moves(("flux",), 0.1 * every.u[:, :1])
    told = C @ J[:points].T @ likelihood.whiten(flux.u[:, 0])
    assert moved == pytest.approx(-told, abs=0.1 * float(np.max(np.abs(told))))
    sds, most = flux.of_parameters(likelihood, C, J[:points])
    assert sds == pytest.approx(np.abs(told))
    assert set(most) == {"flux"}


def test_interval_of_a_right_model_leaves_the_apparatus_aside(twins: list[Twin]) -> None:
    # A flux that is wrong by 3 % moves the emissivity by about as much.
    i = ESTIMATED.index("eps_a")
    for estimate in (twin.found.estimates[i] for twin in twins):
        assert estimate.apparatus > 0.02
        assert estimate.interval.width < 2.0 * 1.96 * estimate.apparatus
