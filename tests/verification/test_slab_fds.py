"""The slab against FDS 6.7.4 on 156 to 625 cells.

FDS device output is an average over the 1 s that ends at ``time_s``. Burn-out is the last time at
which the mass loss rate falls through 1 g/(m2 s); the curves end 60 s after it falls through
0.1 g/(m2 s), and rms and mean are taken until there.
"""

from typing import Any, NamedTuple

import numpy as np
import pytest
from cases import (
    BEST,
    NAMES,
    TABLE_4,
    Curve,
    burn_out,
    paper_experiment,
    paper_material,
    reference,
    rms_over_mean,
    run,
)

from pyrofit.model.experiment import Gasification
from pyrofit.model.material import Material
from pyrofit.simulate import Accuracy
from pyrofit.solver.curves import Request


class Pair(NamedTuple):
    time: Curve
    ours: Curve
    fds: Curve
    back: Curve
    """Our back temperature less FDS's [K], until 10 s before burn-out."""

    @property
    def late(self) -> float:
        return burn_out(self.time, self.ours) - burn_out(self.time, self.fds)

    def rms(self, until: float = np.inf) -> float:
        early = self.time < until
        return rms_over_mean(self.ours[early], self.fds[early])


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
    back = curves.signals["back_temperature"] - curve["T_back_C"].to_numpy() - 273.15
    live = time < burn_out(time, mlr) - 10.0
    return Pair(time, curves.signals["mlr"], mlr, back[live])


def rms(x: Curve) -> float:
    return float(np.sqrt(np.mean(x**2)))


@pytest.mark.parametrize(
    ("case", "change", "late_s"),
    [
        # measured: rms over mean, burn-out, rms of the back temperature
        ("capa25_RMSE_S2", {}, 3.0),  # 0.18 %, -1.0 s, 0.14 K
        ("capa25_RANGE_S2", {}, 3.0),  # 0.15 %, +0.2 s, 0.08 K
        ("capa25_BANDS_S2", {}, 3.0),  # 0.15 %, -0.0 s, 0.07 K
        ("capa25_RMSE_S2_cu025", {"foil_m": 2.5e-5}, 3.0),  # 0.19 %, -1.1 s, 0.14 K
        # 0.33 %, +3.04 s, 0.35 K; +2.7 s with 400 cells: the mixing rule, not the grid
        ("capa25_RMSE_S2_csf0p2", {"cell_size_factor": 0.2}, 3.1),
        # 0.40 %, +0.4 s, 0.11 K; 0.53 % when 750 s without any gas are counted in
        ("capa25_RMSE_S2_insulated", {"insulated": True}, 3.0),
    ],
)
def test_25_kW_m2_follows_fds(case: str, change: dict[str, Any], late_s: float) -> None:
    values = dict(zip(NAMES, TABLE_4[case.split("_")[1]], strict=True))
    pair = compare(case, paper_experiment(25.0, **change), values=values)
    assert pair.rms() <= 0.005
    assert abs(pair.late) <= late_s
    assert rms(pair.back) <= 0.5


@pytest.mark.parametrize(
    ("case", "foil_m"),
    [
        ("capa60_RMSE_S2", 2e-4),  # measured: 1.18 % before 280 s, +2.3 s, 3.0 K
        ("capa60_RMSE_S2_cu025", 2.5e-5),  # measured: 1.31 % before 280 s, +2.3 s, 2.9 K
    ],
)
def test_60_kW_m2_follows_fds_until_burn_out(case: str, foil_m: float) -> None:
    pair = compare(case, paper_experiment(60.0, foil_m=foil_m))
    assert pair.rms(until=280.0) <= 0.015
    assert abs(pair.late) <= 4.0
    assert rms(pair.back) <= 4.0


def test_temperature_dependent_properties_follow_fds() -> None:
    # Measured: 0.15 %, burn-out +0.9 s, back temperature 0.12 K.
    nodes = [293.15, 393.15, 673.15]
    material = paper_material(
        conductivity_W_mK={"temperature_K": nodes, "value": [0.2, 0.18, 0.12]},
        specific_heat_J_kgK={"temperature_K": nodes, "value": [1400.0, 1900.0, 2600.0]},
    )
    pair = compare("m_ramps_react", paper_experiment(25.0), material)
    assert pair.rms() <= 0.005
    assert abs(pair.late) <= 3.0
    assert rms(pair.back) <= 0.5


def test_char_that_stays_in_place_follows_fds() -> None:
    # Measured on 200 cells: 0.16 %, burn-out -0.1 s, back temperature 0.02 K. The default 50 cells
    # give 0.92 %, most of it in the first 100 s: the emissivity is mixed over 9 um, a cell has
    # 116 um.
    values = BEST | {"rho_r": 300.0, "k_r": 0.12, "cp_r": 1500.0, "eps_r": 0.85}
    material = paper_material(residue_yield=0.2, share=1e-4)
    fine = Accuracy(cells=200, tolerance=1e-3)
    pair = compare("m_char20", paper_experiment(40.0, foil_m=None), material, values, fine)
    assert pair.rms() <= 0.005
    assert abs(pair.late) <= 3.0
    assert rms(pair.back) <= 0.5
