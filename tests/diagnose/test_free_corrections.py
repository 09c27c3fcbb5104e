"""Free corrections find the kind of term that a twin's truth has and its model lacks."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from free_twins import MLR, SLABS, STEP, Change, nothing, substance, twin

from pyrofit.diagnose.advise.free_corrections import Probe, probes
from pyrofit.diagnose.base.descent import descend_chi_square
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import model_of
from pyrofit.diagnose.corrections.fit import with_coefficients
from pyrofit.diagnose.corrections.forms import fitted_corrections
from pyrofit.diagnose.search.refit import look_at, with_effect
from pyrofit.effects.base import changed
from pyrofit.estimate.problem import Problem
from pyrofit.experiments import Gasification
from pyrofit.model.time_table import TimeTable


def slabs(change_slab: Callable[[Any], Any]) -> Change:
    """Change all gasification experiments."""

    def change(problem: Problem) -> Problem:
        runs = {
            name: replace(run, experiment=change_slab(run.experiment))
            if isinstance(run.experiment, Gasification)
            else run
            for name, run in problem.runs.items()
        }
        return replace(problem, runs=runs)

    return change


def backs(**update: Any) -> Change:
    """Change all backs."""
    return slabs(lambda slab: changed(slab, back=changed(slab.back, **update)))


def foils(**update: Any) -> Change:
    """Change all foils."""

    def change(slab: Any) -> Any:
        foil = changed(slab.sample.foil, **update)
        return changed(slab, sample=changed(slab.sample, foil=foil))

    return slabs(change)


def fronts(**update: Any) -> Change:
    """Change all fronts; a function of a front's flux gives the new one."""

    def change(slab: Any) -> Any:
        flux = slab.front.flux_W_m2
        own = {key: value(flux) if callable(value) else value for key, value in update.items()}
        return changed(slab, front=changed(slab.front, **own))

    return slabs(change)


def fading(flux: float) -> TimeTable:
    """A tenth less flux within 300 s."""
    return TimeTable(time_s=(0.0, 300.0), value=(flux, 0.9 * flux))


MELTING = substance("specific_heat_J_kgK", peak_area=6e4, peak_temperature_K=450.0)


@pytest.fixture(scope="module")
def faded() -> list[Probe]:
    return probes(twin(fronts(flux_W_m2=fading)))


@pytest.fixture(scope="module")
def stepped() -> list[Probe]:
    return probes(twin(STEP))


@pytest.fixture(scope="module")
def molten() -> list[Probe]:
    return probes(twin(MELTING))


@pytest.fixture(scope="module")
def convected() -> list[Probe]:
    return probes(twin(fronts(h_cube_root_W_m2K43=0.8)))


@pytest.fixture(scope="module")
def cooled() -> list[Probe]:
    return probes(twin(backs(h_W_m2K=14.0)))


@pytest.fixture(scope="module")
def heavy() -> list[Probe]:
    return probes(twin(foils(mass_factor=6.0)))


@pytest.mark.parametrize(
    ("found", "expected"),
    [
        ("faded", "flux"),
        ("stepped", "conductivity"),
        ("molten", "heat_capacity"),
        ("convected", "front_heat_loss"),
        ("cooled", "back_heat_loss"),
        ("heavy", "foil_heat_capacity"),
    ],
)
def test_probe_of_the_hidden_kind_absorbs_most(
    found: str, expected: str, request: pytest.FixtureRequest
) -> None:
    first, *rest = request.getfixturevalue(found)
    assert first.probe == expected
    assert first.absorbed > 0.9
    assert all(other.absorbed < first.absorbed for other in rest)
    assert {p.probe for p in rest} | {expected} == {
        "flux",
        "conductivity",
        "heat_capacity",
        "front_heat_loss",
        "back_heat_loss",
        "foil_heat_capacity",
    }


def shape_at(probe: Probe, *where: float) -> list[float]:
    at, value = np.array(probe.shape).T
    return [float(v) for v in np.interp(where, at, value)]


def test_shape_of_the_flux_fades_as_hidden(faded: list[Probe]) -> None:
    early, later, end = shape_at(faded[0], 72.0, 300.0, 1200.0)
    # Only ratios are determined, a constant factor may be emissivity.
    assert early / later == pytest.approx(0.976 / 0.9, abs=0.02)
    assert end / later == pytest.approx(1.0, abs=0.03)
    assert faded[0].unit == "-"


def test_shape_of_the_conductivity_falls_where_the_step_is(stepped: list[Probe]) -> None:
    cold, warm, hot = shape_at(stepped[0], 370.0, 530.0, 650.0)
    assert cold - warm == pytest.approx(0.06, abs=0.02)
    assert hot - warm == pytest.approx(0.0, abs=0.02)


def test_shape_of_the_heat_capacity_peaks_at_the_melting_temperature(molten: list[Probe]) -> None:
    at, change = np.array(molten[0].shape).T
    assert at[change.argmax()] == pytest.approx(450.0, abs=25.0)


def test_shape_of_the_loss_rises_with_temperature(convected: list[Probe]) -> None:
    cool, warm = shape_at(convected[0], 400.0, 600.0)
    # 0.8 (600 - 330)^(4/3) - 0.8 (400 - 330)^(4/3), the gas at 330 K
    assert warm - cool == pytest.approx(1396.0 - 230.0, rel=0.4)


def test_heat_capacity_of_the_foil_is_found(heavy: list[Probe]) -> None:
    # five more times 2.5e-5 m of 8940 kg/m3 and 380 J/(kg K)
    assert shape_at(heavy[0], 400.0) == pytest.approx([5.0 * 84.9], rel=0.1)
    assert heavy[0].unit == "J/(m2 K)"


def test_nothing_is_absorbed_where_nothing_is_hidden() -> None:
    trial = twin(nothing)
    assert [probe.absorbed for probe in probes(trial)] == [0.0] * 6


@pytest.mark.parametrize("number", range(6))
def test_zero_coefficients_are_the_base_and_each_other_value_is_not(number: int) -> None:
    trial = twin(nothing, MLR)
    correction = fitted_corrections(trial)[number]
    model = with_coefficients(trial.model, correction)
    count = len(correction.sd)
    zero = np.append(trial.fit.x, np.full(count, 0.5))
    at_zero = model.residuals(zero)
    assert not at_zero[trial.fit.residuals.size :].any()
    # A kink of the flux is a time that the solver steps to: its own error changes.
    within = 0.1 if correction.probe == "flux" else 0.0
    assert np.abs(at_zero[: trial.fit.residuals.size] - trial.fit.residuals).max() <= within
    for i in range(count):
        moved = zero.copy()
        moved[trial.fit.x.size + i] += 0.1
        change = np.abs(model.residuals(moved) - at_zero)[: trial.model.points]
        assert change.max() > 3.0 * within, correction.sd


def test_described_flux_with_a_step_and_a_parameter_is_multiplied() -> None:
    steps = TimeTable(time_s=(0.0, 100.0, 100.0), value=("q", 2e4, 3e4))
    fitted = twin(nothing, MLR)
    problem = fronts(flux_W_m2=steps)(fitted.model.likelihood.problem)
    problem = replace(problem, fixed={**problem.fixed, "q": 1e4})
    likelihood = replace(fitted.model.likelihood, problem=problem)
    fitted = replace(fitted, model=replace(fitted.model, likelihood=likelihood))
    (correction, *_) = fitted_corrections(fitted)
    derived: Any = correction.problem
    found = derived.derive({**problem.fixed, **dict.fromkeys(correction.sd, 0.1)})
    table = derived.runs["capa_60"].experiment.front.flux_W_m2
    time, flux = np.array(table.time_s), np.array([found[name] for name in table.value])
    assert time[time == 100.0].size == 2
    before = time.searchsorted(100.0, side="left") + 1
    assert flux[:before] == pytest.approx(1.1 * (1e4 + 100.0 * time[:before]))
    assert flux[before:] == pytest.approx(3.3e4)


def test_probes_follow_an_effect_that_sets_the_same_numbers() -> None:
    trial = twin(fronts(h_cube_root_W_m2K43=0.8, gas_rise_K=40.0))
    (seen,) = look_at(trial, ["front_convection"])
    before = with_effect(trial, seen)
    found = {probe.probe: probe for probe in probes(before)}
    assert all(probe.chi2 < before.fit.chi2 + 0.1 for probe in found.values())
    assert before.effects == ("front_convection",)


def test_probe_of_a_calibration_with_tga_is_that_of_the_hidden_kind() -> None:
    trial = twin(STEP, (*SLABS, ("tga_10K", "mass_fraction")))
    assert probes(trial)[0].probe == "conductivity"


def test_tga_alone_has_no_probe() -> None:
    trial = twin(nothing, (*SLABS, ("tga_10K", "mass_fraction")))
    model = model_of(trial.model.base, {}, [len(SLABS)])
    assert probes(FittedModel(model, descend_chi_square(model, trial.fit.x))) == []
