"""The slab against FDS 6.7.4

FDS on 33 to 625 cells with steps of 0.05 s; its output is an average over the second before the
time it writes. *Burn-out* is the last time at which the mass loss rate falls through 1 g/(m² s);
back temperatures are compared until 10 s before. At 60 kW/m² the last 30 s are given by burn-out
alone.
"""

from typing import Any, NamedTuple

import numpy as np
import pytest
from cases import (
    BEST,
    NAMES,
    TABLE_4,
    burn_out,
    inert_material,
    paper_experiment,
    paper_material,
    reference,
    run,
    slab_experiment,
)
from evidence import (
    LARGEST_K,
    MLR,
    RMS_K,
    RMS_OVER_MEAN,
    TEMPERATURE,
    TIME,
    Evidence,
    Line,
)

from pyrofit.experiments import Gasification
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.material import Material
from pyrofit.solver.curves import Request

FDS = "FDS 6.7.4"
NODES_K = (293.15, 393.15, 673.15)
RAMPS: dict[str, Any] = {
    "conductivity_W_mK": {"temperature_K": NODES_K, "value": [0.2, 0.18, 0.12]},
    "specific_heat_J_kgK": {"temperature_K": NODES_K, "value": [1400.0, 1900.0, 2600.0]},
}
CHAR = BEST | {"rho_r": 300.0, "k_r": 0.12, "cp_r": 1500.0, "eps_r": 0.85}


class Limits(NamedTuple):
    rms: float
    """rms difference over mean of the mass loss rate."""
    late_s: float
    """Difference of burn-out [s]."""
    back_K: float
    """rms difference of the back temperature [K]."""
    until_s: float = np.inf
    """Time until which the mass loss rate is compared [s]."""


class Pair(NamedTuple):
    mlr: Line
    back: Line
    """Back temperature [K], until 10 s before burn-out."""
    energy: float
    """Our energy error."""

    @property
    def late(self) -> float:
        time, ours, fds = self.mlr
        return burn_out(time, ours) - burn_out(time, fds)


def compare(
    case: str,
    experiment: Gasification,
    material: Material | None = None,
    values: dict[str, float] = BEST,
    accuracy: Accuracy | None = None,
) -> Pair:
    curve = reference("fds", case)[1:]
    time = curve["time_s"].to_numpy() - 0.5
    requests = {"mlr": Request(time, 1.0), "back_temperature": Request(time)}
    curves = run(experiment, material or paper_material(), requests, accuracy, values)
    mlr = curve["mlr_kg_m2_s"].to_numpy()
    live = time < burn_out(time, mlr) - 10.0
    back = Line(time, curves.signals["back_temperature"], curve["T_back_C"].to_numpy() + 273.15)
    return Pair(
        Line(time, curves.signals["mlr"], mlr),
        Line(*(part[live] for part in back)),
        curves.energy_error,
    )


def state(evidence: Evidence, title: str, pair: Pair, limits: Limits) -> None:
    early = Line(*(part[pair.mlr.x < limits.until_s] for part in pair.mlr))
    words = f", until {limits.until_s:.0f} s" if np.isfinite(limits.until_s) else ""
    evidence.curve(title + words, TIME, MLR, early, FDS, limits.rms, RMS_OVER_MEAN)
    evidence.number(f"{title}: burn-out", abs(pair.late), limits.late_s, "difference", FDS, "s")
    gap = RMS_K.of(pair.back.ours, pair.back.other)
    evidence.number(f"{title}: back temperature", gap, limits.back_K, RMS_K.name, FDS, "K")
    heat = "imbalance / heat exchanged"
    evidence.number(f"{title}: energy", pair.energy, 1e-4, heat, "balance")


PAPER: list[tuple[str, str, float, dict[str, Any], Limits]] = [
    ("capa25_RMSE_S2", "RMSE set", 25.0, {}, Limits(0.003, 1.5, 0.2)),
    ("capa25_RANGE_S2", "RANGE set", 25.0, {}, Limits(0.003, 1.5, 0.2)),
    ("capa25_BANDS_S2", "BANDS set", 25.0, {}, Limits(0.003, 1.5, 0.2)),
    (
        "capa25_RMSE_S2_cu025",
        "RMSE set, 25 µm copper",
        25.0,
        {"foil_m": 2.5e-5},
        Limits(0.003, 1.5, 0.2),
    ),
    (
        # 3.0 s late, and 2.7 s with 400 cells: the mixing rule, not the grid.
        "capa25_RMSE_S2_csf0p2",
        "RMSE set, CELL_SIZE_FACTOR 0.2",
        25.0,
        {"cell_size_factor": 0.2},
        Limits(0.005, 3.1, 0.5),
    ),
    (
        "capa25_RMSE_S2_insulated",
        "RMSE set, insulated back",
        25.0,
        {"insulated": True},
        Limits(0.005, 1.5, 0.2),
    ),
    ("m_flux40", "RMSE set", 40.0, {}, Limits(0.006, 2.5, 1.5, 500.0)),
    ("capa60_RMSE_S2", "RMSE set", 60.0, {}, Limits(0.015, 3.0, 4.0, 280.0)),
    (
        "capa60_RMSE_S2_cu025",
        "RMSE set, 25 µm copper",
        60.0,
        {"foil_m": 2.5e-5},
        Limits(0.015, 3.0, 4.0, 280.0),
    ),
]


@pytest.mark.parametrize(("case", "words", "flux", "change", "limits"), PAPER)
def test_paper_case_follows_fds(
    evidence: Evidence, case: str, words: str, flux: float, change: dict[str, Any], limits: Limits
) -> None:
    values = BEST
    if case.startswith("capa"):
        values = dict(zip(NAMES, TABLE_4[case.split("_")[1]], strict=True))
    pair = compare(case, paper_experiment(flux, **change), values=values)
    state(evidence, f"{flux:.0f} kW/m², {words}", pair, limits)


def test_temperature_dependent_properties_follow_fds(evidence: Evidence) -> None:
    pair = compare("m_ramps_react", paper_experiment(25.0), paper_material(**RAMPS))
    state(evidence, "25 kW/m², k and c by tables", pair, Limits(0.003, 1.5, 0.2))


def test_char_that_stays_in_place_follows_fds(evidence: Evidence) -> None:
    material = paper_material(residue_yield=0.2, share=1e-4)
    pair = compare("m_char20", paper_experiment(40.0, foil_m=None), material, CHAR)
    state(evidence, "40 kW/m², char 0.2, no foil", pair, Limits(0.004, 1.0, 0.1))


def sides(
    case: str, experiment: Gasification, material: Material, accuracy: Accuracy | None = None
) -> dict[str, Line]:
    """Front and back temperature [K] at the middle of FDS's averages."""
    curve = reference("fds", case)[1:]
    time = curve["time_s"].to_numpy() - 0.5
    names = {"front": "T_front_C", "back": "T_back_C"}
    requests = {f"{side}_temperature": Request(time) for side in names}
    curves = run(experiment, material, requests, accuracy)
    return {
        side: Line(
            time,
            curves.signals[f"{side}_temperature"],
            curve[column].to_numpy() + 273.15,
        )
        for side, column in names.items()
    }


INERT: dict[str, tuple[str, Gasification, Material, str, tuple[float, float]]] = {
    "m_conduction_const": (
        "convective heating by 200 K, no radiation",
        slab_experiment(5.8e-3, {"h_W_m2K": 100.0, "gas_temperature_K": 493.15}),
        inert_material(emissivity=0.0),
        "",
        (0.2, 0.05),
    ),
    "m_flux_semiinf_eps1": (
        "25 kW/m² on emissivity 1, no convection",
        slab_experiment(5.8e-3, {"flux_W_m2": 25e3}),
        inert_material(),
        "The lasting 0.8 K are as if FDS's closed box returned 0.1 kW/m² of what the sample emits; "
        "the largest difference is that of the first second.",
        (2.0, 1.6),
    ),
    "m_ramps_inert": (
        "25 kW/m², k and c by tables, copper",
        paper_experiment(25.0),
        inert_material(
            1201.3,
            RAMPS["conductivity_W_mK"],
            RAMPS["specific_heat_J_kgK"],
            emissivity=BEST["eps_a"],
        ),
        "The largest difference is that of the first second.",
        (2.0, 1.5),
    ),
}


@pytest.mark.parametrize("case", INERT)
def test_slab_without_reactions_follows_fds(evidence: Evidence, case: str) -> None:
    words, experiment, material, note, limits = INERT[case]
    for grid, accuracy, limit in (
        ("50 cells", Accuracy(cells=50, tolerance=2e-3), limits[0]),
        ("200 cells", Accuracy(cells=200, tolerance=1e-4), limits[1]),
    ):
        lines = sides(case, experiment, material, accuracy)
        title = f"no reactions: {words}, {grid}"
        evidence.curve(title, TIME, TEMPERATURE, lines, FDS, limit, LARGEST_K, note)


def test_a_coarse_surface_cell_of_fds_is_followed_in_its_emissivity_alone(
    evidence: Evidence,
) -> None:
    pair = compare("capa25_RMSE_S2_csf1p0", paper_experiment(25.0, cell_size_factor=1.0))
    evidence.difference(
        "25 kW/m², RMSE set, CELL_SIZE_FACTOR 1",
        TIME,
        MLR,
        pair.mlr,
        FDS,
        (0.006, 0.01),
        "FDS has 33 cells here: its rate rises and falls as each of them burns out. pyrofit takes "
        "the emissivity of FDS's surface cell of 0.19 mm, which is most of the effect (with the "
        "cell of CELL_SIZE_FACTOR 0.05 the difference is 5.2 %), but not the ripple.",
    )
    evidence.number(
        "25 kW/m², RMSE set, CELL_SIZE_FACTOR 1: burn-out",
        abs(pair.late),
        5.0,
        "difference",
        FDS,
        "s",
    )
