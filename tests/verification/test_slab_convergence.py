"""The slab against its own fine solution: the paper's case (S2) at 25 and 60 kW/m2, 5 s bins."""

import functools

import numpy as np
import pytest
from cases import Curve, paper_experiment, paper_material, reference, rms_over_mean, run

from pyrofit.simulate import Accuracy
from pyrofit.solver.curves import Request

ON = {25: 1200.0, 60: 280.0}
"""Time [s] until which cells burn out one after another from the front, by flux [kW/m2]."""


def fine(flux: int) -> tuple[Curve, Curve]:
    curve = reference("own", f"capa{flux}_RMSE_S2")
    return curve["time_s"].to_numpy(), curve["mlr_kg_m2_s"].to_numpy()


@functools.cache
def bins(flux: int, accuracy: Accuracy) -> Curve:
    request = Request(fine(flux)[0], 5.0)
    curves = run(paper_experiment(flux), paper_material(), {"mlr": request}, accuracy)
    return curves.signals["mlr"]


def ripple(flux: int, accuracy: Accuracy) -> float:
    """Rms over mean of what a running mean of 45 s takes out of the error, after 100 s."""
    time, mlr = fine(flux)
    error = (bins(flux, accuracy) - mlr) / mlr.mean()
    rough = error[4:-4] - np.convolve(error, np.ones(9) / 9.0, "valid")
    live = (time[4:-4] > 100.0) & (time[4:-4] < ON[flux])
    return float(np.sqrt(np.mean(rough[live] ** 2)))


@pytest.mark.parametrize(("flux", "limit"), [(25, 1e-3), (60, 3e-3)])
def test_default_settings_are_converged(flux: int, limit: float) -> None:
    # Measured: 0.055 % and 0.15 %.
    assert rms_over_mean(bins(flux, Accuracy()), fine(flux)[1]) <= limit


@pytest.mark.parametrize("flux", [25, 60])
def test_400_cells_reproduce_the_stored_solution_of_1600(flux: int) -> None:
    # Measured: 0.001 % and 0.002 %.
    accuracy = Accuracy(cells=400, tolerance=1e-4, longest_step_s=1.0)
    assert rms_over_mean(bins(flux, accuracy), fine(flux)[1]) <= 5e-4


@pytest.mark.parametrize(("flux", "cells"), [(25, 50), (60, 50), (60, 100)])
def test_error_falls_with_the_square_of_the_cell_size(flux: int, cells: int) -> None:
    # Order from three grids n, 2n, 4n. Measured: 1.98 (25), 1.95 and 1.99 (60).
    tight = {"tolerance": 1e-5, "longest_step_s": 1.0}
    coarse, middle, fine_ = (bins(flux, Accuracy(cells=cells * n, **tight)) for n in (1, 2, 4))
    order = np.log2(rms_over_mean(coarse, middle) / rms_over_mean(middle, fine_))
    assert order == pytest.approx(2.0, abs=0.2)


@pytest.mark.parametrize("flux", [25, 60])
def test_error_is_proportional_to_the_tolerance(flux: int) -> None:
    # The step goes with the root of the tolerance, so this is second order in time.
    # Measured from 3e-3 to 1e-4: exponents 0.94 and 1.0.
    exact = bins(flux, Accuracy(cells=100, tolerance=1e-6, most_steps=50000))
    loose, tight = (
        rms_over_mean(bins(flux, Accuracy(cells=100, tolerance=tolerance)), exact)
        for tolerance in (3e-3, 1e-4)
    )
    assert np.log(loose / tight) / np.log(30.0) >= 0.85


@pytest.mark.parametrize(("flux", "limit"), [(25, 3e-5), (60, 1.5e-4)])
def test_cells_burn_out_without_a_ripple(flux: int, limit: float) -> None:
    # Measured: 0.002 % and 0.011 % of the mean rate.
    assert ripple(flux, Accuracy(tolerance=1e-4)) <= limit


@pytest.mark.parametrize("flux", [25, 60])
def test_default_steps_add_no_ripple_that_matters(flux: int) -> None:
    # Measured: 0.018 % (steps of 9 s sampled in bins of 5 s) and 0.011 % of the mean rate.
    assert ripple(flux, Accuracy()) <= 3e-4
