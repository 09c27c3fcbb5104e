from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from pyrofit.model.experiment import Gasification
from pyrofit.solver.arrays import Status
from pyrofit.solver.curves import Curves, Request
from pyrofit.solver.observe import observe

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


def to_the_fourth(factor: float, asked: Mapping[str, Request]) -> Curves:
    return Curves(
        Status.OK if factor > 1.0 else Status.UNBURNT,
        {name: factor**4 * request.time_s for name, request in asked.items()},
        energy_error=factor,
    )


def seen(given: Gasification, values: Mapping[str, float] | None = None) -> Curves:
    return observe(
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


def test_delay_and_offset_belong_to_their_signal() -> None:
    curves = seen(experiment(delay_s=4.0, offset=0.5))
    assert curves.signals["mlr"].tolist() == (TIME - 4.0 + 0.5).tolist()
    assert curves.signals["mass"].tolist() == TIME.tolist()


def test_run_that_fails_under_one_flux_fails_as_a_whole() -> None:
    def failing(factor: float, asked: Mapping[str, Request]) -> Curves:
        hot = factor > 1.2
        return Curves(Status.DIVERGED, {}) if hot else to_the_fourth(factor, asked)

    requests = {"mlr": Request(TIME)}
    assert observe(experiment(0.1), {}, requests, failing).status is Status.UNBURNT
    failed = observe(experiment(0.5), {}, requests, failing)
    assert (failed.status, failed.signals) == (Status.DIVERGED, {})
