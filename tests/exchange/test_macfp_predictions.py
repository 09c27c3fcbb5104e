"""What parameter sets of the data base predict, against exact and published curves."""

import os
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from macfp_sets import OLD, ZERO_BASED, write
from scipy.integrate import cumulative_trapezoid

from pyrofit.cli import main
from pyrofit.constants import GAS_CONSTANT
from pyrofit_exchange.macfp.compare import CASES
from pyrofit_exchange.macfp.predict import (
    PMMA_CASES,
    material,
    metrics,
    simulate_case,
    simulate_program,
)
from pyrofit_exchange.macfp.read import read_set

ROOT = Path(os.environ.get("PYROFIT_DATA_DIR", ""))
FIRST_ORDER = ("Aalto_I", "BUW-FZJ_A", "GIDAZE+", "NIST", "UCLAN", "UMET")
"""Sets whose FDS deck has the same kinetics as their JSON."""


def data_base(*parts: str) -> list[Path]:
    found = sorted(ROOT.glob("/".join(parts)))
    if not found:
        pytest.skip("the data folder holds the files of the studies alone")
    return found


def test_heated_sample_of_two_parallel_reactions_is_exact(tmp_path: Path) -> None:
    of = material(read_set(write(tmp_path / "set.json", ZERO_BASED)).strict)
    T = np.arange(300.0, 900.0, 0.25)
    t = (T - 300.0) * 6.0
    exact = np.zeros_like(T)
    for share, A, E, n, nu in ((0.7, 1e12, 1.5e5, 1.0, 0.2), (0.3, 1e13, 1.9e5, 2.0, 0.3)):
        damage = cumulative_trapezoid(A * np.exp(-E / (GAS_CONSTANT * T)), t, initial=0.0)
        left = np.exp(-damage) if n == 1.0 else 1.0 / (1.0 + damage)
        exact += share * (nu + (1.0 - nu) * left)
    got = simulate_program(of, 10.0, t, T)
    assert np.abs(got - exact).max() < 2e-4


def test_ideal_slab_loses_what_its_rate_says(tmp_path: Path) -> None:
    of = material(
        read_set(write(tmp_path / "set.json", ZERO_BASED | {"Transport": OLD["Transport"]})).strict
    )
    case = PMMA_CASES[2]
    curves = simulate_case(of, case)
    lost = np.cumsum(curves.mlr_kg_m2_s)
    assert np.abs(curves.mass_kg_m2[0] - lost - curves.mass_kg_m2).max() < 1e-3
    assert curves.front_K[60] > curves.back_K[60] + 50.0
    assert metrics(curves).left == pytest.approx(0.7 * 0.2 + 0.3 * 0.3, abs=2e-3)


def test_predictions_stand_beside_each_other_and_in_files(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = [str(write(tmp_path / f"{n}.json", given)) for n, given in (("a", OLD), ("b", OLD))]
    out = tmp_path / "out"
    assert main(["macfp", "predict", *paths, "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert said.count("\na ") == said.count("\nb ") == len(CASES["pmma"])
    table = pd.read_csv(out / "a_Gasification_25kW_6mm.csv")
    assert list(table.columns)[:3] == ["Time (s)", "Mass (g)", "MLR (g/m2/s)"]
    assert len(table) == 2001


@pytest.mark.measured
@pytest.mark.parametrize("name", FIRST_ORDER)
def test_tga_of_a_set_follows_the_fds_curve_of_the_data_base(name: str) -> None:
    (path,) = data_base(f"PMMA/Material_Properties/*/MaCFP_PMMA_{name}.json")
    curve = data_base("Verification/Model_predictions", f"MaCFP_PMMA_{name}_dynamic_*.csv")[0]
    fds = pd.read_csv(curve, skiprows=[1])
    mass = fds["m"].to_numpy() / fds["m"].iloc[0]
    live = mass > 0.012  # FDS deletes the layer
    of = material(read_set(path).strict)
    got = simulate_program(of, 10.0, fds["t"].to_numpy()[live], fds["T"].to_numpy()[live])
    assert np.abs(got - mass[live]).max() < 1.1e-3


@pytest.mark.measured
@pytest.mark.parametrize("case", PMMA_CASES, ids=lambda case: case.name)
def test_ideal_slab_of_a_set_follows_the_prediction_of_its_laboratory(case: object) -> None:
    (path,) = data_base("PMMA/Material_Properties/2021/MaCFP_PMMA_NIST.json")
    folder = "PMMA/Computational_Results/Gasification_Predictions"
    (curve,) = data_base(folder, f"NIST_Gasification_{case.name}.csv")  # type: ignore[attr-defined]
    published = pd.read_csv(curve, skiprows=[0]).to_numpy()
    got = simulate_case(material(read_set(path).strict), case)  # type: ignore[arg-type]
    for lost in (0.1, 0.5, 0.9):
        times = [
            t[np.argmax(m <= (1.0 - lost) * m[0])]
            for t, m in ((got.time_s, got.mass_kg_m2), (published[:, 0], published[:, 1]))
        ]
        assert times[0] == pytest.approx(times[1], rel=0.012, abs=2.0)
