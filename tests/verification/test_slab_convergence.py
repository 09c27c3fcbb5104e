"""Convergence and the default settings

With cells of half the size, or steps of half the length, a second-order method has a quarter of
the error. The order is observed without reactions (a slab on copper, temperature) and with them
(the paper's case, Table 4's RMSE set, mass loss rate in bins of 5 s at 25 and 60 kW/m²; in time at
25 only). The default settings are compared with a solution on 1600 cells.
"""

import functools

import numpy as np
import pytest
from cases import (
    FAINT,
    Curve,
    inert_material,
    paper_experiment,
    paper_material,
    reference,
    rms_over_mean,
    run,
    slab_experiment,
)
from evidence import MLR, RMS_K, RMS_OVER_MEAN, TIME, Axis, Evidence, Line
from exact import slab_with_foil
from terms import charring, specimen

from pyrofit.model.accuracy import Accuracy
from pyrofit.solver.curves import Request

ON = {25: 1200.0, 60: 280.0}
"""Time [s] until which cells burn out one after another from the front, by flux [kW/m2]."""
TIGHT = {"tolerance": 1e-5, "longest_step_s": 1.0}
CELL = Axis("cell size", "mm", 1e3)
STEP = Axis("time step", "s")
TOLERANCE = Axis("tolerance", "-")
KELVIN = Axis("error of the temperature", "K")
SHARE = Axis("rms error / mean", "%", 100.0)
THICKNESS = 5.8e-3
BINS = np.arange(2.5, 900.0, 5.0)
LATE = np.arange(20.0, 401.0, 20.0)
"""Times [s] at which temperatures without reactions are compared."""
FOIL = {"thickness_m": 2e-4, "density_kg_m3": 8940.0, "specific_heat_J_kgK": 380.0}


def fine(flux: int) -> tuple[Curve, Curve]:
    curve = reference("own", f"capa{flux}_RMSE_S2")
    return curve["time_s"].to_numpy(), curve["mlr_kg_m2_s"].to_numpy()


@functools.cache
def bins(flux: int, accuracy: Accuracy) -> Curve:
    """Mass loss rate in the bins."""
    request = Request(fine(flux)[0], 5.0)
    curves = run(paper_experiment(flux), paper_material(), {"mlr": request}, accuracy)
    return curves.signals["mlr"]


@functools.cache
def front(flux: int, accuracy: Accuracy) -> Curve:
    """Front temperature [K] from 20 s, when equal steps resolve it, until burn-out begins."""
    time = fine(flux)[0]
    request = Request(time[(time > 20.0) & (time < ON[flux])])
    name = "front_temperature"
    return run(paper_experiment(flux), paper_material(), {name: request}, accuracy).signals[name]


def ripple(flux: int, accuracy: Accuracy) -> float:
    """Rms over mean of what a running mean of 45 s takes out of the error, after 100 s."""
    time, mlr = fine(flux)
    error = (bins(flux, accuracy) - mlr) / mlr.mean()
    rough = error[4:-4] - np.convolve(error, np.ones(9) / 9.0, "valid")
    live = (time[4:-4] > 100.0) & (time[4:-4] < ON[flux])
    return float(np.sqrt(np.mean(rough[live] ** 2)))


def equal(step: float) -> dict[str, float]:
    """Settings for steps of one length."""
    return {"first_step_s": step, "longest_step_s": step, "tolerance": 0.1, "most_steps": 10**5}


def inert(flux: float | dict[str, list[float]], accuracy: Accuracy) -> Curve:
    """Front, then back temperature of a slab on copper that absorbs a millionth of the flux."""
    requests = {f"{side}_temperature": Request(LATE) for side in ("front", "back")}
    experiment = slab_experiment(THICKNESS, {"flux_W_m2": flux}, foil=FOIL)
    curves = run(experiment, inert_material(emissivity=FAINT), requests, accuracy, {})
    return np.concatenate([curves.signals[name] for name in requests])


@pytest.mark.parametrize(("flux", "limit"), [(25, 1e-3), (60, 1e-3)])
def test_default_settings_are_converged(evidence: Evidence, flux: int, limit: float) -> None:
    time, mlr = fine(flux)
    line = Line(time, bins(flux, Accuracy()), mlr)
    title, source = f"{flux} kW/m², default settings", "pyrofit on 1600 cells, tolerance 1e-5"
    evidence.curve(title, TIME, MLR, line, source, limit, RMS_OVER_MEAN)


@pytest.mark.parametrize("flux", [25, 60])
def test_400_cells_reproduce_the_stored_solution_of_1600(evidence: Evidence, flux: int) -> None:
    time, mlr = fine(flux)
    accuracy = Accuracy(cells=400, tolerance=1e-4, longest_step_s=1.0)
    line = Line(time, bins(flux, accuracy), mlr)
    title, source = f"{flux} kW/m², 400 cells", "pyrofit on 1600 cells, tolerance 1e-5"
    evidence.curve(title, TIME, MLR, line, source, 5e-5, RMS_OVER_MEAN)


def test_mlr_error_falls_with_the_square_of_the_cell_size(evidence: Evidence) -> None:
    cells = np.array([50, 100, 200, 400])

    def errors(flux: int) -> tuple[Curve, Curve]:
        right = bins(flux, Accuracy(cells=1600, **TIGHT))
        found = [rms_over_mean(bins(flux, Accuracy(cells=n, **TIGHT)), right) for n in cells]
        return THICKNESS / cells, np.array(found)

    lines = {f"{flux} kW/m²": errors(flux) for flux in (25, 60)}
    title = "mass loss rate, order in space"
    evidence.order(title, CELL, SHARE, lines, "pyrofit on 1600 cells: same tolerance")


def darkening(accuracy: Accuracy) -> Curve:
    """Mass loss rate in bins of a wood whose char absorbs better."""
    wood = {"density_kg_m3": 600.0, "emissivity": 0.7}
    material = charring(virgin=wood, char={"density_kg_m3": 150.0, "emissivity": 0.95})
    return run(specimen(30.0), material, {"mlr": Request(BINS, 5.0)}, accuracy, {}).signals["mlr"]


def test_mlr_error_with_a_changing_emissivity_is_of_second_order(evidence: Evidence) -> None:
    cells = np.array([50, 100, 200, 400])
    right = darkening(Accuracy(cells=1600, **TIGHT))
    found = [rms_over_mean(darkening(Accuracy(cells=n, **TIGHT)), right) for n in cells]
    lines = {"emissivity 0.7 to 0.95, 30 kW/m²": (5e-3 / cells, np.array(found))}
    title = "mass loss rate of a darkening char, order in space"
    evidence.order(title, CELL, SHARE, lines, "pyrofit on 1600 cells: same tolerance", 0.5)
    title, source = "darkening char, default settings", "pyrofit on 1600 cells"
    error = rms_over_mean(darkening(Accuracy()), right)
    evidence.number(title, error, 3e-3, "rms error / mean", source, "%")


def test_temperature_error_of_a_reacting_slab_is_of_second_order(evidence: Evidence) -> None:
    cells, steps = np.array([50, 100, 200, 400]), np.array([2.0, 1.0, 0.5, 0.25])

    def in_space(flux: int) -> tuple[Curve, Curve]:
        right = front(flux, Accuracy(cells=1600, **TIGHT))
        found = [RMS_K.of(front(flux, Accuracy(cells=n, **TIGHT)), right) for n in cells]
        return THICKNESS / cells, np.array(found)

    def in_time(flux: int) -> tuple[Curve, Curve]:
        right = front(flux, Accuracy(cells=100, **equal(0.05)))
        found = [RMS_K.of(front(flux, Accuracy(cells=100, **equal(h))), right) for h in steps]
        return steps, np.array(found)

    title = "front temperature of a reacting slab from 20 s on, order in"
    lines = {f"{flux} kW/m²": in_space(flux) for flux in (25, 60)}
    source = "pyrofit on 1600 cells: same tolerance"
    evidence.order(f"{title} space", CELL, KELVIN, lines, source)
    lines = {f"{flux} kW/m²": in_time(flux) for flux in (25, 60)}
    source = "pyrofit with steps of 0.05 s: same cells"
    evidence.order(f"{title} time", STEP, KELVIN, lines, source, 0.3)


def test_temperature_error_falls_with_the_square_of_the_cell_size(evidence: Evidence) -> None:
    cells = np.array([10, 20, 40, 80])
    exact = 293.15 + np.concatenate(
        [slab_with_foil(5e3, 0.2, 1.8e6, THICKNESS, 679.44, x, LATE) for x in (0.0, THICKNESS)]
    )
    accuracies = [Accuracy(cells=n, tolerance=1e-7, most_steps=10**5) for n in cells]
    errors = [np.abs(inert(5e3 / FAINT, accuracy) - exact).max() for accuracy in accuracies]
    lines = {"front and back, from 20 s on": (THICKNESS / cells, np.array(errors))}
    source = "exact: C&J ch. III, slab on copper under a constant flux"
    evidence.order("temperature without reactions, order in space", CELL, KELVIN, lines, source)


def test_temperature_error_falls_with_the_square_of_the_step(evidence: Evidence) -> None:
    rising = {"time_s": [0.0, 400.0], "value": [0.0, 1e4 / FAINT]}
    steps = np.array([4.0, 2.0, 1.0, 0.5])
    right = inert(rising, Accuracy(cells=50, **equal(0.02)))
    errors = [np.abs(inert(rising, Accuracy(cells=50, **equal(h))) - right).max() for h in steps]
    lines = {"front and back, from 20 s on": (steps, np.array(errors))}
    title, source = "temperature without reactions, order in time", "pyrofit with steps of 0.02 s"
    evidence.order(title, STEP, KELVIN, lines, source, 0.1)


def errors_of(flux: int, chosen: list[Accuracy], finest: Accuracy) -> Curve:
    """Errors of settings against the finest one."""
    right = bins(flux, finest)
    return np.array([rms_over_mean(bins(flux, accuracy), right) for accuracy in chosen])


def test_mlr_error_falls_with_the_square_of_the_step(evidence: Evidence) -> None:
    steps = np.array([2.0, 1.0, 0.5, 0.25])
    chosen = [Accuracy(cells=100, **equal(h)) for h in steps]
    finest = Accuracy(cells=100, **equal(0.05))
    title, source = "mass loss rate, order in time", "pyrofit with steps of 0.05 s: same cells"
    lines = {"25 kW/m²": (steps, errors_of(25, chosen, finest))}
    evidence.order(title, STEP, SHARE, lines, source, 0.3)
    # At 60 kW/m2 the longest steps are nearly as long as a cell burns: the error falls faster.
    found = errors_of(60, chosen, finest)
    evidence.number(
        "60 kW/m²: largest error over that of 2 s and the square of the step",
        float(np.max(found[1:] / (found[0] * (steps[1:] / steps[0]) ** 2))),
        1.0,
        "ratio",
        source,
    )
    title = "60 kW/m²: error with steps of 0.5 s"
    evidence.number(title, float(found[2]), 1.3e-4, "rms error / mean", source, "%")


def test_mlr_error_is_proportional_to_the_tolerance(evidence: Evidence) -> None:
    # The step goes with the root of the tolerance.
    tolerances = np.array([3e-3, 1e-3, 3e-4, 1e-4])
    chosen = [Accuracy(cells=100, tolerance=t) for t in tolerances.tolist()]
    finest = Accuracy(cells=100, tolerance=1e-6, most_steps=50000)
    title, source = "mass loss rate, error by tolerance", "pyrofit with tolerance 1e-6: same cells"
    lines = {"25 kW/m²": (tolerances, errors_of(25, chosen, finest))}
    evidence.order(title, TOLERANCE, SHARE, lines, source, 0.15, 1.0)
    # At 60 kW/m2 it is smaller at large tolerances; at small ones single cells' ripple is left.
    found = errors_of(60, chosen, finest)
    title = "60 kW/m²: largest error over the tolerance"
    evidence.number(title, float(np.max(found / tolerances)), 0.25, "ratio", source)


@pytest.mark.parametrize(("flux", "limit"), [(25, 3e-5), (60, 1.5e-4)])
def test_cells_burn_out_without_a_ripple(evidence: Evidence, flux: int, limit: float) -> None:
    measure = "rms of the error's rough part / mean"
    source = "pyrofit on 1600 cells"
    title = f"{flux} kW/m², ripple of cells that burn out"
    rough = ripple(flux, Accuracy(tolerance=1e-4))
    evidence.number(f"{title}, tolerance 1e-4", rough, limit, measure, source, "%")
    evidence.number(title, ripple(flux, Accuracy()), 3e-4, measure, source, "%")
