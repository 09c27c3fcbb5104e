"""Files of predictions in the forms that the workshops of MaCFP ask for."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from pyrofit.model.material import Material
from pyrofit.solver import outputs
from pyrofit_exchange.macfp.compare import write_slab_curves
from pyrofit_exchange.macfp.predict import (
    AREA_M2,
    WOOD_CASES,
    WOOD_RATES_K_MIN,
    IdealSlab,
    SlabCurves,
    simulate_case,
    simulate_program,
)

_STA_MG = 5.0
_STA_K = 300.0 + 0.5 * np.arange(1561, dtype=np.float64)
"""Temperatures of the predicted STA [K], as many rows as the template has."""
VALIDATION_CASES = IdealSlab(25e3, 6e-3, 2000.0, 293.15), IdealSlab(50e3, 6e-3, 1000.0, 293.15)
"""Slabs of the third workshop, without an apparatus."""


def form_4(of: Material, folder: Path, institute: str, name: str) -> Iterator[str]:
    """Write the eight files of the workshop of 2026: STA at two rates, six ideal slabs."""
    folder.mkdir(parents=True, exist_ok=True)
    for rate in WOOD_RATES_K_MIN:
        t = np.asarray((_STA_K - _STA_K[0]) * 60.0 / rate, np.float64)
        mass = simulate_program(of, rate, t, _STA_K)
        flow = simulate_program(of, rate, t, _STA_K, outputs.HEAT_FLOW)
        head = "Time (s),Temperature (K),Mass (mg),Heat Flow Rate (W/g)"
        lines = [
            f"{a:g},{T:g},{_STA_MG * m:.6g},{q / 1e3:.6g}"
            for a, T, m, q in zip(t, _STA_K, mass, flow, strict=True)
        ]
        path = folder / f"{institute}_{name}_STA_N2_{rate:g}K.csv"
        path.write_text("\n".join([head, *lines]) + "\n", encoding="utf-8")
        yield path.name
    for case in WOOD_CASES:
        q, d = 1e-3 * case.flux_W_m2, 1e3 * case.thickness_m
        path = folder / f"{institute}_{name}_GASIFICATION_q{q:g}_{d:g}mm.csv"
        write_slab_curves(path, simulate_case(of, case))
        yield path.name


def form_3(
    simulate: Callable[[IdealSlab], SlabCurves], folder: Path, institute: str
) -> Iterator[str]:
    """Write mass, mass loss rate and back temperature at 25 and 50 kW/m2, as asked for in 2023."""
    folder.mkdir(parents=True, exist_ok=True)
    for case in VALIDATION_CASES:
        curves = simulate(case)
        stem = f"{institute}_Gasification_q{1e-3 * case.flux_W_m2:g}"
        for word, units, values in (
            ("Mass", "[g]", 1e3 * AREA_M2 * curves.mass_kg_m2),
            ("MLR", "[g/m2/s]", 1e3 * curves.mlr_kg_m2_s),
            ("Temp", "[K]", curves.back_K),
        ):
            name = "T_back_1" if word == "Temp" else word
            path = folder / f"{stem}_{word}.csv"
            lines = [f"{t:g},{x:.6g}" for t, x in zip(curves.time_s, values, strict=True)]
            text = [f"Time,{name}", f"[s],{units}", *lines]
            path.write_text("\n".join(text) + "\n", encoding="utf-8")
            yield path.name


def like_experiment(
    of: Material, experiment: Any, values: dict[str, float]
) -> Callable[[IdealSlab], SlabCurves]:
    """Return a simulation in the apparatus of an experiment, at the flux and time of a case."""
    from pyrofit.simulate import simulate_gasification
    from pyrofit.solver.curves import Request

    def run(case: IdealSlab) -> SlabCurves:
        front = experiment.front.model_copy(update={"flux_W_m2": case.flux_W_m2})
        changed = experiment.model_copy(update={"front": front, "signals": {}})
        t = np.arange(1.0, case.duration_s + 0.5)
        asked = {
            outputs.RATE: Request(t - 0.5, 1.0),
            outputs.MASS: Request(t),
            outputs.BACK: Request(t),
            outputs.FRONT: Request(t),
        }
        curves = simulate_gasification(changed, of, values, asked).signals
        rate, mass = curves[outputs.RATE], curves[outputs.MASS]
        back, front_T = curves[outputs.BACK], curves[outputs.FRONT]
        return SlabCurves(
            np.append(0.0, t),
            np.append(0.0, rate),
            np.append(mass[0] + rate[0], mass),
            np.append(back[0], back),
            np.append(front_T[0], front_T),
        )

    return run
