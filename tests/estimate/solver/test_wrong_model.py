"""Intervals of kinetics that miss their tests."""

import numpy as np
import pandas as pd
import pytest

import pyrofit as pf
from pyrofit.estimate.wrong_model import least_squares, sds_of_misfit
from pyrofit.numerics import linear

E, AT = 190.0, 600.0


def table(rate: float, points: int, order: float = 1.5) -> pd.DataFrame:
    """Return a record of a reaction of an order, k(AT) = 0.001 1/s, with noise of the points."""
    T = np.linspace(AT - 150.0, AT + 150.0, points)
    fine = np.linspace(T[0], T[-1], 8000)
    k = 1e-3 * np.exp(-1e3 * E / 8.314462618 * (1.0 / fine - 1.0 / AT)) * 60.0 / rate
    x = np.concatenate([[0.0], np.cumsum(0.5 * (k[1:] + k[:-1]) * np.diff(fine))])
    left = (1.0 + (order - 1.0) * x) ** (1.0 / (1.0 - order))
    noise = 1e-3 * np.random.default_rng(int(rate)).standard_normal(points)
    columns = {"time_s": 60.0 / rate * (T - T[0]), "temperature_K": T}
    return pd.DataFrame({**columns, "mass_fraction": np.interp(T, fine, left) + noise})


def records(points: int, rates: tuple[float, ...] = (5.0, 20.0)) -> dict[str, pd.DataFrame]:
    return {f"tga_{rate:g}K": table(rate, points) for rate in rates}


def interval(points: int, rates: tuple[float, ...] = (5.0, 20.0)) -> tuple[float, float]:
    data = records(points, rates)
    fit = pf.fit(pf.new_study("x", tga=data), data, starts=4)
    assert not fit.goodness.describes
    found = fit.table.loc["E_p"]
    return float(found["low"]), float(found["high"])


def test_interval_of_a_wrong_order_holds_the_truth_and_tells_something() -> None:
    low, high = interval(120)
    assert low < E < high
    # 60 to 350 kJ/mol are the limits.
    assert high - low < 0.45 * E


def test_number_of_points_does_not_narrow_the_interval_of_a_misfit() -> None:
    few, many = interval(80), interval(240)
    assert np.diff(many) == pytest.approx(np.diff(few), rel=0.05)


def test_points_of_one_quantity_count_as_one_observation() -> None:
    data = records(100)
    study = pf.new_study("x", tga=data)
    likelihood = pf.log_likelihood(study, data).likelihood
    plain, x = least_squares(likelihood, np.array([0.5, 0.5, 0.1]))
    curves, slopes = likelihood.curves(x), likelihood.slopes(x)
    assert curves is not None
    found = sds_of_misfit(likelihood, plain, x, slopes, curves)
    sizes = np.concatenate([noise.sd for noise in plain.noise])
    H = linear.gram(slopes / sizes[:, None])
    # The prior, 12 I, is small beside 200 points, and the discrepancy is larger here.
    one = np.sqrt(200.0 * np.diag(np.linalg.inv(H)))
    assert found[:2] == pytest.approx(one[:2], rel=0.05)
