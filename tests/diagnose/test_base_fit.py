"""What a diagnosis starts from: points to start at, knowledge, noise, and the fit of the base."""

from dataclasses import replace

import numpy as np
import pytest
from hidden_effects import HIDDEN, SEED
from small import CHANNELS, LIMITS, SD, measured, study

from pyrofit.config import candidate_effects
from pyrofit.diagnose.base.descent import descend_chi_square
from pyrofit.diagnose.base.fit import set_up, start_points
from pyrofit.diagnose.base.model import model_of
from pyrofit.diagnose.settings import Settings
from pyrofit.effects import known_effects
from pyrofit.errors import DataError
from pyrofit.estimate.likelihood import FAILED, Likelihood
from pyrofit.estimate.targets import Measurements
from pyrofit.quantities import known_quantities
from pyrofit.solver.arrays import FloatArray

KNOWN = {"cp": {"value": 2.3, "sd": 0.02}, "k": {"value": 0.21, "sd": 0.01}}


@pytest.fixture(scope="module")
def series() -> Measurements:
    return measured(HIDDEN["nothing"], SEED)


def test_starts_are_spread_within_the_limits_by_the_seed(series: Measurements) -> None:
    base = set_up(study(), series).base.model.base
    first, again, other = start_points(base, 5), start_points(base, 5), start_points(base, 6)
    points = np.array(first)
    assert points.shape == (1 + Settings().base_starts, len(LIMITS))
    assert first[0].tolist() == [0.5] * len(LIMITS)
    assert points.min() >= 0.05
    assert points.max() <= 0.95
    # Latin: of each parameter one value in each of as many bins as there are points.
    bins = np.sort(((points[1:] - 0.05) / 0.9 * Settings().base_starts).astype(int), axis=0)
    assert np.array_equal(bins, np.tile(np.arange(Settings().base_starts)[:, None], len(LIMITS)))
    assert np.array_equal(points, again)
    assert not np.array_equal(points, other)


def test_known_parameters_start_at_what_is_known(series: Measurements) -> None:
    base = set_up(study(known=KNOWN), series).base.model.base
    points = np.array(start_points(base, 5))
    names = base.likelihood.problem.names
    problem = base.likelihood.problem
    for name, known in KNOWN.items():
        i = names.index(name)
        factor = study().parameters[name].factor
        assert problem.span[i] == pytest.approx(6.0 * known["sd"] * factor)
        assert points[:, i] == pytest.approx(np.full(1 + Settings().base_starts, 0.5))


def test_knowledge_is_in_si_units_and_pulls_its_parameter(series: Measurements) -> None:
    free, bound = set_up(study(), series).base, set_up(study(known=KNOWN), series).base
    known = bound.model.likelihood.prior
    names = bound.model.names
    assert [names[i] for i in known.index] == ["cp", "k"]
    assert known.mean.tolist() == [2300.0, 0.21]
    # These values disagree with the data: the misfit makes them weigh more.
    assert (known.sd * known.weight).tolist() == pytest.approx([20.0, 0.01])
    assert np.all(known.weight >= 1.0)
    plausible = bound.model.base.plausible
    assert bound.fit.residuals.size == bound.model.points + 2 + len(plausible)
    at = names.index("cp")
    before, after = (t.model.likelihood.values(t.fit.x)[at] for t in (free, bound))
    assert abs(after - 2300.0) < abs(before - 2300.0)
    pull = (bound.model.likelihood.values(bound.fit.x)[list(known.index)] - known.mean) / known.sd
    of_known = slice(bound.model.points, bound.model.points + 2)
    assert bound.fit.residuals[of_known] == pytest.approx(pull)


def test_fit_of_the_base_is_the_lowest_of_all_its_starts(series: Measurements) -> None:
    trial = set_up(study(), series).base
    for x in start_points(trial.model.base, 11)[:6]:
        assert trial.fit.chi2 < descend_chi_square(trial.model, x).chi2 + 0.1


def test_held_out_channels_are_not_fitted(series: Measurements) -> None:
    partly = study(
        calibrate={"slab_25": list(SD)},
        hold_out={"slab_60": ["mlr"]},
    )
    base = set_up(partly, series).base.model.base
    assert [base.channels[i] for i in base.calibrated] == list(CHANNELS[:2])
    assert [base.channels[i] for i in base.held_out] == [("slab_60", "mlr")]
    wrong = {**series, CHANNELS[2]: series[CHANNELS[2]].copy()}
    wrong[CHANNELS[2]]["mlr_kg_m2_s"] *= 3.0
    again = set_up(partly, wrong).base
    assert np.array_equal(again.fit.x, set_up(partly, series).base.fit.x)


def test_candidates_are_those_of_the_study(series: Measurements) -> None:
    assert set_up(study(effects=["k_T", "c_T"]), series).candidates == ("k_T", "c_T")
    all_of_them = set_up(study(), series).candidates
    assert all_of_them == candidate_effects(study())
    left_out = {"tga_lag", "tga_offset", "char_oxidation"}  # no TGA, no oxygen
    assert set(known_effects()) - set(all_of_them) == left_out


def test_stated_noise_is_found_as_stated(series: Measurements) -> None:
    for (_, quantity), noise in zip(
        CHANNELS, set_up(study(), series).base.model.base.likelihood.noise, strict=True
    ):
        assert "stated" in noise.describe()
        # With floors: the clock's error where it is steep, and the solver's.
        assert SD[quantity] <= np.median(noise.sd) < 1.6 * SD[quantity]


def test_noise_that_is_not_stated_is_found_from_the_scatter(series: Measurements) -> None:
    bare = {
        key: frame.drop(columns=known_quantities()[key[1]].uncertainty_column)
        for key, frame in series.items()
    }
    base = set_up(study(), bare).base.model.base
    for (_, quantity), noise in zip(CHANNELS, base.likelihood.noise, strict=True):
        assert "from the scatter" in noise.describe()
        assert 0.6 * SD[quantity] < np.median(noise.sd) < 1.6 * SD[quantity]


def test_model_that_never_finishes_is_a_clear_error(
    series: Measurements, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        Likelihood,
        "residuals_all",
        lambda self, X, led=False: [np.full(sum(self.points), FAILED) for _ in X],
    )
    with pytest.raises(DataError, match="no run within the limits of the parameters finishes"):
        set_up(study(), series)


def test_held_out_run_that_does_not_finish_is_named_before_anything_is_searched(
    series: Measurements, monkeypatch: pytest.MonkeyPatch
) -> None:
    usual = Likelihood.curves

    def failing(self: Likelihood, x: FloatArray) -> FloatArray | None:
        held_out = [name for name, _, _ in self.problem.picks] == ["slab_60"]
        return None if held_out else usual(self, x)

    monkeypatch.setattr(Likelihood, "curves", failing)
    described = study(calibrate={"slab_25": list(SD)}, hold_out={"slab_60": ["mlr"]})
    with pytest.raises(DataError, match="hold_out: slab_60 does not finish with the parameters"):
        set_up(described, series)


def test_channels_and_effects_keep_their_order(series: Measurements) -> None:
    described = study()
    base = set_up(described, series).base.model.base
    problem = base.likelihood.problem
    assert [(name, signal) for name, signal, _ in problem.picks] == list(CHANNELS)
    assert problem.names == tuple(LIMITS)
    model = model_of(base, {"k_T": ("slope_1_K",), "c_T": ("slope_1_K",)}, (1, 3))
    assert model.names[len(LIMITS) :] == ("k_T_slope_1_K", "c_T_slope_1_K")
    assert model.position("c_T") == len(LIMITS) + 1
    x = np.full(len(model.names), 0.5)
    whole = model_of(base, model.effects)
    parts = whole.by_channel(whole.residuals(x))
    chosen = model.by_channel(model.residuals(x))
    for part, same in zip(chosen, (parts[1], parts[3]), strict=True):
        # Where the rate is not asked for, the solver steps to other times.
        assert part == pytest.approx(same, abs=1e-3)  # measured 1.5e-5
    assert replace(base, calibrated=(2,)).held_out == (0, 1, 3)
