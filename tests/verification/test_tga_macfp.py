"""TGA against the published FDS curves of the MaCFP groups

The MaCFP data base holds FDS runs of a thin layer at 10 K/min with the kinetics of each group
(`Verification/Model_predictions`). pyrofit follows the temperature that FDS wrote. FDS deletes
the layer at about 1 % of the mass; the comparison ends there.

FDS consumes component i of a layer at the rate V A ρᵢⁿ exp(-E/(R T)), with ρᵢ = mᵢ/V in the
shrinking volume V = Σ mᵢ/ρₛ. A layer of one component keeps ρᵢ = ρₛ = 1210 kg/m³, so that its
reaction is of first order with A ρₛⁿ⁻¹. Inputs whose reaction names no solid product (Sandia 3 and
4, UMD, UMET TK and GP) lose its yield: one reaction again. For two components with n ≠ 1 (Sandia 5
and 6) FDS's own law, integrated here, reproduces the curves.
"""

import os
import re
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import pytest
from cases import Curve, powder
from evidence import LARGEST, MASS, TEMPERATURE, Evidence, Line
from scipy.integrate import solve_ivp

from pyrofit.constants import GAS_CONSTANT
from pyrofit.experiments import Tga
from pyrofit.simulate import simulate_tga
from pyrofit.solver.curves import Request

ROOT = os.environ.get("PYROFIT_DATA_DIR")
FOLDER = Path(ROOT or "", "Verification", "Model_predictions")
DENSITY = 1210.0
DELETED = 0.012
"""Mass fraction at which FDS has deleted the layer."""
FIRST_ORDER = (
    "Aalto_I",
    "BUW-FZJ_A",
    "GIDAZE+",
    "NIST",
    "Sandia_3",
    "Sandia_4",
    "UCLAN",
    "UMD",
    "UMET",
    "UMET_TK",
)
ONE_COMPONENT = {
    "DBI_1": 5.4e-4,
    "DBI_calibrated": 5.4e-4,
    "Sandia_1": 1e-3,
    "Sandia_2": 1e-3,
    "UMET_GP": 1.5e-3,
}
TWO_COMPONENTS = {"Sandia_5": (0.006, 0.012), "Sandia_6": (0.016, 0.032)}

pytestmark = [
    pytest.mark.measured,
    pytest.mark.skipif(
        not FOLDER.is_dir(),
        reason="the data base in PYROFIT_DATA_DIR has no folder Verification",
    ),
]


class Run(NamedTuple):
    """An FDS run: its curve until the layer is deleted, shares and kinetics of the components."""

    time: Curve
    temperature: Curve
    mass: Curve
    shares: list[float]
    A: list[float]
    E: list[float]
    n: list[float]


def fds(name: str) -> Run:
    paths = [p for p in FOLDER.glob(f"MaCFP_PMMA_{name}_dynamic_*.csv") if "10K_FDS" in p.name]
    assert len(paths) == 1, paths
    table = pd.read_csv(paths[0], skiprows=[1])
    words = (FOLDER / f"MaCFP_PMMA_{name}_dynamic_TGA_10K_FDS.fds").read_text(encoding="utf-8")
    found = re.search(r"MATL_MASS_FRACTION\(1,1:2\) *= *([\d.]+), *([\d.]+)", words)

    def numbers(key: str) -> list[float]:
        return [float(x) for x in re.findall(rf"\b{key}\(1\) *= *([-+.\deE]+)", words)]

    mass = table["m"].to_numpy() / table["m"].iloc[0]
    live = mass > DELETED
    return Run(
        table["t"].to_numpy()[live],
        table["T"].to_numpy()[live],
        mass[live],
        [float(x) for x in found.groups()] if found else [1.0],
        numbers("A"),
        numbers("E"),
        numbers("N_S"),
    )


def described(run: Run) -> Curve:
    """pyrofit's curve: every component on its own, of first order with A rho^(n-1)."""
    names = "AB"[: len(run.shares)]
    reactions: list[dict[str, Any]] = [
        {"reactant": name, "A_1_s": A * DENSITY ** (n - 1.0), "E_J_mol": E}
        for name, A, E, n in zip(names, run.A, run.E, run.n, strict=True)
    ]
    material = powder(names, dict(zip(names, run.shares, strict=True)), *reactions)
    signals = {"mass_fraction": {"file": "synthetic"}}
    experiment = Tga.model_validate({"kind": "tga", "heating_rate_K_min": 10, "signals": signals})
    request = Request(run.time, temperature_K=run.temperature)
    return simulate_tga(experiment, material, {}, request).signals["mass_fraction"]


def law_of_fds(run: Run) -> Curve:
    """dm_i/dt = -V A_i rho_i^n_i exp(-E_i/(R T)), rho_i = m_i/V, V = sum m_i/rho_s."""
    A, E, n = np.array(run.A), np.array(run.E), np.array(run.n)

    def rates(t: float, m: Any) -> Any:
        T = np.interp(t, run.time, run.temperature)
        m = np.maximum(m, 1e-12)
        volume = m.sum() / DENSITY
        return -volume * A * (m / volume) ** n * np.exp(-E / (GAS_CONSTANT * T))

    solution = solve_ivp(
        rates,
        (run.time[0], run.time[-1]),
        run.shares,
        method="LSODA",
        t_eval=run.time,
        rtol=1e-8,
        atol=1e-11,
        max_step=30.0,
    )
    return solution.y.sum(axis=0)


def plain(name: str) -> str:
    return name.replace("_", " ")


@pytest.mark.parametrize("name", FIRST_ORDER)
def test_first_order_set_follows_fds(evidence: Evidence, name: str) -> None:
    run = fds(name)
    assert run.n[0] == 1.0
    lines = Line(run.temperature, described(run), run.mass)
    evidence.curve(f"{plain(name)}, n = 1", TEMPERATURE, MASS, lines, "FDS (MaCFP)", 5.4e-4)


@pytest.mark.parametrize("name", ONE_COMPONENT)
def test_one_component_of_order_n_is_of_first_order_in_fds(evidence: Evidence, name: str) -> None:
    run = fds(name)
    assert run.n[0] != 1.0
    title = f"{plain(name)}, n = {run.n[0]:g}, as A ρⁿ⁻¹"
    lines = Line(run.temperature, described(run), run.mass)
    evidence.curve(title, TEMPERATURE, MASS, lines, "FDS (MaCFP)", ONE_COMPONENT[name])


@pytest.mark.parametrize("name", TWO_COMPONENTS)
def test_two_components_of_order_n_follow_the_law_of_fds(evidence: Evidence, name: str) -> None:
    run = fds(name)
    law = LARGEST.of(law_of_fds(run), run.mass)
    evidence.number(
        f"{plain(name)}: FDS's law, integrated (not pyrofit)",
        law,
        1.1e-3,
        "largest difference",
        "FDS (MaCFP)",
    )
    evidence.difference(
        f"{plain(name)}, n = {run.n[1]:g}, as A ρⁿ⁻¹",
        TEMPERATURE,
        MASS,
        Line(run.temperature, described(run), run.mass),
        "FDS (MaCFP)",
        TWO_COMPONENTS[name],
        "FDS's rate follows the share of the component in the shrinking volume.",
        LARGEST,
    )
