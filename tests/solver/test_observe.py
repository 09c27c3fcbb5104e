from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from pyrofit.effects.base import changed
from pyrofit.experiments import Gasification
from pyrofit.model.slab_faces import FluxProfile
from pyrofit.solver.arrays import FloatArray, Status
from pyrofit.solver.curves import Curves, Request, Runs
from pyrofit.solver.observe import observe, observe_one, rings

TIME = np.array([0.0, 10.0, 20.0])


def experiment(spread: float | str = 0.0, **signal: Any) -> Gasification:
    return Gasification.model_validate(
        {
            "kind": "gasification",
            "sample": {"layers": [{"thickness_m": 5e-3}]},
            "front": {"flux_W_m2": 4e4, "spread": spread},
            "signals": {"mlr": {"file": "synthetic", **signal}},
        }
    )


def profiled(*relative: float, spread: float = 0.0) -> Gasification:
    radii = np.linspace(0.0, 0.035, len(relative)).tolist()
    given = experiment(spread)
    profile = FluxProfile(radius_m=tuple(radii), relative_flux=relative)
    return given.model_copy(update={"front": changed(given.front, profile=profile)})


def to_the_fourth(factor: float, asked: Mapping[str, Request]) -> Curves:
    return Curves(
        Status.OK if factor > 1.0 else Status.UNBURNT,
        {name: factor**4 * request.time_s for name, request in asked.items()},
        energy_error=factor,
    )


def seen(given: Gasification, values: Mapping[str, float] | None = None) -> Curves:
    return observe_one(
        given, values or {}, {"mlr": Request(TIME), "mass": Request(TIME)}, to_the_fourth
    )


def test_spread_averages_over_the_surface() -> None:
    # The mean of (1 + s x)^4 over |x| < 1 is 1 + 2 s^2 + s^4/5.
    curves = seen(experiment("s"), {"s": 0.5})
    assert curves.signals["mlr"] == pytest.approx(TIME * (1.0 + 0.5 + 0.0125), rel=1e-14)
    assert curves.status is Status.UNBURNT


def test_without_spread_there_is_one_run() -> None:
    curves = seen(experiment())
    assert curves.signals["mlr"].tolist() == TIME.tolist()
    assert curves.energy_error == 1.0


def test_profile_is_weighted_by_the_area() -> None:
    # f = 1 - a r/R: the mean of f^4 over u = (r/R)^2 is 1 - 8a/3 + 3 a^2 - 8 a^3/5 + a^4/3.
    a = 0.4
    exact = 1.0 - 8.0 * a / 3.0 + 3.0 * a**2 - 1.6 * a**3 + a**4 / 3.0
    assert seen(profiled(1.0, 0.8, 0.6)).signals["mlr"] == pytest.approx(TIME * exact, rel=3e-6)
    # With a spread on top the mean of (1 + s x)^4, 1.5125 for s = 0.5, is a factor.
    both = seen(profiled(1.0, 0.6, spread=0.5)).signals["mlr"]
    assert both == pytest.approx(TIME * exact * 1.5125, rel=3e-6)


def test_flat_profile_is_one_run_bit_for_bit() -> None:
    flat = seen(profiled(1.0, 1.0, 1.0))
    assert flat.signals["mlr"].tolist() == TIME.tolist()
    assert flat.energy_error == 1.0
    assert seen(profiled(0.5, 0.5)).signals["mlr"].tolist() == (0.0625 * TIME).tolist()


def test_profile_of_two_fluxes_needs_two_runs() -> None:
    profile = FluxProfile(radius_m=(0.0, 0.03, 0.0300001, 0.06), relative_flux=(1.0, 1.0, 0.5, 0.5))
    factors, weights = rings(profile)
    assert factors[weights > 1e-3] == pytest.approx([0.5, 1.0], abs=1e-3)
    assert weights[weights > 1e-3] == pytest.approx([0.75, 0.25], abs=1e-3)


@pytest.mark.parametrize(
    ("radius", "flux", "said"),
    [
        ((0.0, 0.02, 0.01), (1.0, 1.0, 1.0), "must increase; sort the points by radius"),
        ((0.0, 0.02), (1.0,), "same length, at least 2; they have 2 and 1"),
        ((0.01, 0.02), (1.0, 1.0), "must start at 0, the middle"),
        ((0.0, 0.02), (1.0, -1.0), "must not be negative"),
    ],
)
def test_bad_profile_is_told(radius: Any, flux: Any, said: str) -> None:
    with pytest.raises(ValidationError, match=said):
        FluxProfile(radius_m=radius, relative_flux=flux)


def test_delay_and_offset_belong_to_their_signal() -> None:
    curves = seen(experiment(delay_s=4.0, offset=0.5))
    assert curves.signals["mlr"].tolist() == (TIME - 4.0 + 0.5).tolist()
    assert curves.signals["mass"].tolist() == TIME.tolist()


def test_run_that_fails_under_one_flux_fails_as_a_whole() -> None:
    def failing(factor: float, asked: Mapping[str, Request]) -> Curves:
        hot = factor > 1.2
        return Curves(Status.DIVERGED, {}) if hot else to_the_fourth(factor, asked)

    requests = {"mlr": Request(TIME)}
    assert observe_one(experiment(0.1), {}, requests, failing).status is Status.UNBURNT
    failed = observe_one(experiment(0.5), {}, requests, failing)
    assert (failed.status, failed.signals) == (Status.DIVERGED, {})


def side_by_side(factor: FloatArray, asked: Mapping[str, Request]) -> Runs:
    """Run as `to_the_fourth`, every set under its factor; factors above 1.4 fail."""
    hot = factor > 1.4
    status = np.where(hot, Status.DIVERGED, np.where(factor > 1.0, Status.OK, Status.UNBURNT))
    curves = {name: factor[:, None] ** 4 * request.time_s for name, request in asked.items()}
    return Runs(
        status=status,
        signals={name: np.where(hot[:, None], np.nan, curve) for name, curve in curves.items()},
        cells=np.resize(np.arange(4), factor.size),
        steps=np.resize(np.arange(4), factor.size) + 10,
        energy_error=factor,
        mass_error=-factor,
    )


def test_every_set_has_its_own_spread_delay_and_offset() -> None:
    sets = 4
    values = {
        "s": np.array([0.0, 0.25, 0.0, 0.5]),
        "t": np.array([0.0, 4.0, -3.0, 0.0]),
        "up": np.array([0.0, 0.0, 0.5, 0.0]),
    }
    given = experiment("s", delay_s="t", offset="up")
    asked = {"mlr": Request(TIME), "mass": Request(TIME)}
    at_once = observe(given, values, asked, side_by_side, sets)
    for s in range(sets):
        one = {name: value[s : s + 1] for name, value in values.items()}
        alone = observe(given, one, asked, side_by_side)
        for name in asked:
            assert np.array_equal(at_once.signals[name][s], alone.signals[name][0], equal_nan=True)
        assert at_once.status[s] == alone.status[0]
        assert at_once.energy_error[s] == alone.energy_error[0]
        assert at_once.mass_error[s] == alone.mass_error[0]
    curves = at_once.curves()
    # Gauss's outermost point is 0.906: the last set is run under a factor of 1.45, and fails.
    assert [c.status for c in curves] == [*3 * [Status.UNBURNT], Status.DIVERGED]
    assert curves[2].signals["mlr"].tolist() == (TIME + 3.0 + 0.5).tolist()
    assert curves[2].signals["mass"].tolist() == TIME.tolist()
    assert curves[3].signals == {}
    assert [(c.cells, c.steps) for c in curves] == [(n, n + 10) for n in range(sets)]
