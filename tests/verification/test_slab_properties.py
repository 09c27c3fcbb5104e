"""Conductivity and specific heat that depend on temperature

With k = k₀ f(T) and c = c₀ f(T) the heat equation becomes linear in Θ = ∫ f dT (Kirchhoff's
transformation): ρ c₀ ∂Θ/∂t = k₀ ∂²Θ/∂x², and a flux at the surface is -k₀ ∂Θ/∂x. Θ under a
constant flux is therefore the classical solution, and T follows by solving Θ(T) = Θ. This is
exact for every form of f that pyrofit has: linear, a power, a table. One flux of 5 kW/m² into a
deep body, front and 2 mm depth (k₀ = 0.2 W/(m K), c₀ = 1500 J/(kg K), ρ = 1200 kg/m³).
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from cases import FAINT, Curve, inert_material, run, slab_experiment
from evidence import LARGEST_K, TEMPERATURE, TIME, Evidence, Line
from exact import deep_body, slab_with_foil
from scipy.optimize import brentq

from pyrofit.model.accuracy import Accuracy
from pyrofit.solver.curves import Request

RHO, K0, C0, T0, FLUX = 1200.0, 0.2, 1500.0, 293.15, 5e3
NODES = (293.15, 340.0, 400.0, 470.0, 600.0)
SHARES = (1.0, 1.4, 1.1, 1.9, 1.5)
"""A table of f, neither monotonic nor smooth; its nodes are such of the solver too, but one."""


def linear(slope: float) -> Callable[[float], float]:
    """Integral of 1 + slope (T - 300 K) from T0."""
    return lambda T: (T - T0) * (1.0 + slope * (0.5 * (T + T0) - 300.0))


def power(n: float) -> Callable[[float], float]:
    """Integral of (T/300 K)^n from T0."""
    return lambda T: 300.0 / (n + 1.0) * ((T / 300.0) ** (n + 1.0) - (T0 / 300.0) ** (n + 1.0))


def table(T: float) -> float:
    """Integral of the table from T0, its first node."""
    inside = [x for x in NODES if x < T]
    nodes = np.array([*inside, T])
    return float(np.trapezoid(np.interp(nodes, NODES, SHARES), nodes))


FORMS: dict[str, tuple[Callable[[float], dict[str, Any]], Callable[[float], float]]] = {
    "linear, +0.2 % per K": (lambda p: {"value": p, "slope_1_K": 2e-3}, linear(2e-3)),
    "linear, -0.1 % per K": (lambda p: {"value": p, "slope_1_K": -1e-3}, linear(-1e-3)),
    "power 0.7": (lambda p: {"value": p, "exponent": 0.7}, power(0.7)),
    "power -0.5": (lambda p: {"value": p, "exponent": -0.5}, power(-0.5)),
    "table": (lambda p: {"temperature_K": NODES, "value": [p * s for s in SHARES]}, table),
}


def temperature(theta: Curve, integral: Callable[[float], float]) -> Curve:
    """T of which the integral of f is theta."""

    def one(x: float) -> float:
        return float(brentq(lambda T: integral(T) - x, T0, 1000.0, xtol=1e-10))

    return np.array([one(x) for x in theta])


@pytest.mark.parametrize(
    ("grid", "accuracy", "limit"),
    [
        ("50 cells", Accuracy(cells=50, tolerance=2e-3), 1.0),
        ("200 cells", Accuracy(cells=200, tolerance=1e-5), 0.06),
    ],
)
@pytest.mark.parametrize("name", FORMS)
def test_properties_of_temperature_follow_kirchhoff(
    evidence: Evidence, name: str, grid: str, accuracy: Accuracy, limit: float
) -> None:
    form, integral = FORMS[name]
    time = np.arange(2.0, 200.5, 3.0)
    material = inert_material(RHO, form(K0), form(C0), emissivity=FAINT)
    curves = run(
        slab_experiment(0.02, {"flux_W_m2": FLUX / FAINT}),
        material,
        dict.fromkeys(("front_temperature", "probe_0"), Request(time)),
        accuracy,
        {},
        probes_m=(2e-3,),
    )
    lines = {
        place: Line(
            time,
            curves.signals[signal],
            temperature(deep_body(FLUX, K0, RHO * C0, depth, time), integral),
        )
        for place, signal, depth in (
            ("front", "front_temperature", 0.0),
            ("2 mm", "probe_0", 2e-3),
        )
    }
    title = f"k and c of temperature: {name}, {grid}"
    source = "exact: Kirchhoff's transformation, C&J ch. I"
    evidence.curve(title, TIME, TEMPERATURE, lines, source, limit, LARGEST_K)


def test_insulated_slab_with_properties_of_temperature_keeps_its_heat(evidence: Evidence) -> None:
    form, integral = FORMS["table"]
    time = np.geomspace(5.0, 400.0, 60)
    curves = run(
        slab_experiment(5.8e-3, {"flux_W_m2": FLUX / FAINT}),
        inert_material(RHO, form(K0), form(C0), emissivity=FAINT),
        dict.fromkeys(("front_temperature", "back_temperature"), Request(time)),
        Accuracy(cells=200, tolerance=1e-5),
        {},
    )
    lines = {
        side: Line(
            time,
            curves.signals[f"{side}_temperature"],
            temperature(slab_with_foil(FLUX, K0, RHO * C0, 5.8e-3, 0.0, x, time), integral),
        )
        for side, x in (("front", 0.0), ("back", 5.8e-3))
    }
    title = "k and c of temperature: table, insulated slab, 200 cells"
    source = "exact: Kirchhoff's transformation of the series, C&J ch. III"
    evidence.curve(title, TIME, TEMPERATURE, lines, source, 0.015, LARGEST_K)
    evidence.number(
        f"{title}: energy",
        curves.energy_error,
        1e-4,
        "imbalance / heat absorbed",
        "balance",
    )
