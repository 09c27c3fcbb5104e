"""Repeats of real laboratories, read as repeats of a study."""

import os
from pathlib import Path
from typing import Any

import pytest
from diagnosis_keys import given

from pyrofit.config import as_study
from pyrofit.estimate.likelihood import likelihood_of
from pyrofit.estimate.noise import REPEATS
from pyrofit.estimate.problem import make_problem
from pyrofit.stages.reading import read_all

pytestmark = pytest.mark.measured


def folder() -> Path:
    return Path(os.environ["PYROFIT_DATA_DIR"]).resolve() / "PMMA" / "Calibration_Data"


def tga(**sds: float) -> dict[str, Any]:
    """Return the smoke study with three TGA records of one laboratory at 20 K/min."""
    study = given()
    names = [folder() / "DBI_Lund" / f"DBI_Lund_TGA_N2_20K_{i}.csv" for i in (1, 2, 3)]
    study["experiments"]["tga_20K"]["signals"] = {"mass_fraction": {"until_K": 700}}
    study["experiments"]["tga_20K"]["repeats"] = {
        **sds,
        "tests": [{"signals": {"mass_fraction": str(name)}} for name in names],
    }
    return study


def noise(described: dict[str, Any]) -> dict[str, Any]:
    """Return the noise of the laboratory's records by experiment."""
    study = as_study(described, str(Path.cwd() / "smoke.yaml"))
    frames = {key: frame for key, (frame, _) in read_all(study).items()}
    assert study.kinetics is not None
    terms = [t for t in study.kinetics.cost if t.experiment != "tga_5K"]
    problem = make_problem(
        study, study.kinetics.estimate, terms, frames, study.material, study.fixed_values()
    )
    found = likelihood_of(problem).noise
    return {name: n for (name, _, _), n in zip(problem.picks, found, strict=True)}


@pytest.fixture(scope="module")
def plain() -> dict[str, Any]:
    return noise(tga())


def test_tga_repeats_of_a_laboratory_scatter_beyond_the_noise_of_points(
    plain: dict[str, Any],
) -> None:
    found = plain
    assert list(found) == ["tga_20K_1", "tga_20K_2", "tga_20K_3"]
    for one in found.values():
        assert one.modes is not None
        # Measured: 0.01 between the records; their points scatter by 5e-4.
        assert 0.005 < one.floors[REPEATS] < 0.02


def test_lag_of_each_tga_repeat_takes_scatter_away(plain: dict[str, Any]) -> None:
    free = noise(tga(lag_sd_s=10.0))
    size = [max(n.total_sd.max() for n in found.values()) for found in (plain, free)]
    assert size[1] < size[0]


def test_gasification_repeats_of_a_laboratory_are_read_as_repeats() -> None:
    study = given()
    slab = study["experiments"]["slab_60"]
    column = {"value": "Back Surface Temperature 1"}
    slab["signals"] = {
        "back_temperature": {"columns": column},
        "mass": {"sample_area_m2": 0.01},
    }
    names = [folder() / "Aalto" / f"Aalto_Gasification_65kW_{i}.csv" for i in (1, 2, 3)]
    slab["repeats"] = [
        {"signals": {"back_temperature": str(name), "mass": str(name)}} for name in names
    ]
    read = as_study(study, str(Path.cwd() / "smoke.yaml"))
    series = read_all(read)
    points = [len(series[f"slab_60_{i}", "back_temperature"][0]) for i in (1, 2, 3)]
    assert points == [507, 552, 554]
    masses = [series[f"slab_60_{i}", "mass"][0]["mass_kg_m2"].iloc[0] for i in (1, 2, 3)]
    assert masses == pytest.approx([6.702, 7.389, 6.976])
