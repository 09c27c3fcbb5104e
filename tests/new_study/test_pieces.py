"""Pieces that weigh differently have a factor each in a new study."""

import re
from pathlib import Path

import numpy as np
import pytest

from pyrofit.analysis.differing_repeats import notes_on_repeats
from pyrofit.config import Study, read_study
from pyrofit.new_study.write import init
from pyrofit.stages.reading import read_all

SECONDS = np.arange(0.0, 900.0, 5.0)
LEFT = 0.2 + 0.8 / (1.0 + np.exp((SECONDS - 500.0) / 60.0))
KELVIN = np.arange(300.0, 900.0, 2.0)


def slabs(folder: Path, masses_g: dict[str, float]) -> list[Path]:
    """Write the masses of slabs of 0.01 m2."""
    files = []
    for name, grams in masses_g.items():
        files.append(folder / f"{name}.csv")
        table = np.c_[SECONDS, grams * LEFT]
        np.savetxt(files[-1], table, "%.6g", ",", header="Time (s),Mass (g)", comments="")
    return files


def made(folder: Path, masses_g: dict[str, float], residue: float = 0.2) -> tuple[Study, list[str]]:
    fraction = residue + (1.0 - residue) / (1.0 + np.exp((KELVIN - 640.0) / 12.0))
    tga, header = folder / "a_10K.csv", "time_s,temperature_K,mass_fraction"
    columns = np.c_[6.0 * (KELVIN - 300.0), KELVIN, fraction]
    np.savetxt(tga, columns, "%.6g", ",", header=header, comments="")
    files = {"tga": [tga], "gasification": slabs(folder, masses_g)}
    study, said = init("x", files, folder)
    return read_study(study), said


UNEQUAL = {"a_25kW_R1": 90.0, "a_25kW_R2": 110.0, "a_50kW": 100.0}


@pytest.mark.parametrize(
    ("residue", "key"), [(0.2, "density_factor"), (0.02, "thickness_factor")], ids=["wood", "sheet"]
)
def test_each_piece_has_its_mass_over_the_mean(tmp_path: Path, residue: float, key: str) -> None:
    study, said = made(tmp_path, UNEQUAL, residue)
    for name, grams in UNEQUAL.items():
        sample = study.experiments[name].sample
        assert getattr(sample, key) == pytest.approx(grams / 100.0)
        assert sample.density_factor * sample.thickness_factor == getattr(sample, key)
    assert any("weigh 9 to 11 kg/m²" in line for line in said)
    text = (tmp_path / "x" / "x.yaml").read_text("utf-8")
    assert len(re.findall(f"{key}.*CHANGE", text)) == 1


@pytest.mark.parametrize(
    "masses",
    [
        {"a_25kW_R1": 99.0, "a_25kW_R2": 101.0},
        {"a_25kW": 60.0, "a_50kW": 120.0},
        {"a_25kW_R1": 100.0},
        {"a_25kW_R1": 0.0, "a_25kW_R2": 100.0},
    ],
    ids=["nearly equal", "two thicknesses", "one", "tared"],
)
def test_other_pieces_have_none(tmp_path: Path, masses: dict[str, float]) -> None:
    study, said = made(tmp_path, masses)
    assert all(e.sample.density_factor == 1.0 for n, e in study.experiments.items() if n in masses)
    assert not any("weigh" in line for line in said)


def test_pieces_of_two_thicknesses_have_two_means(tmp_path: Path) -> None:
    thick, thin = {"a_25kW_R1": 90.0, "a_25kW_R2": 110.0}, {"a_50kW_R1": 27.0, "a_50kW_R2": 33.0}
    study, said = made(tmp_path, thick | thin)
    factors = [study.experiments[name].sample.density_factor for name in (*thick, *thin)]
    assert factors == pytest.approx([0.9, 1.1, 0.9, 1.1])
    assert sum("weigh" in line for line in said) == 2


def test_value_that_jumps_is_no_initial_mass(tmp_path: Path) -> None:
    files = slabs(tmp_path, {"a_25kW_R1": 90.0, "a_25kW_R2": 110.0})
    shaken = np.c_[SECONDS, np.where(np.arange(SECONDS.size) == 1, 160.0, 110.0 * LEFT)]
    np.savetxt(files[1], shaken, "%.6g", ",", header="Time (s),Mass (g)", comments="")
    study, _ = init("y", {"gasification": files}, tmp_path)
    assert "thickness_factor: 1.100" in study.read_text("utf-8")


def test_record_that_starts_before_its_sample_lies_there_tells_no_mass(tmp_path: Path) -> None:
    files = slabs(tmp_path, {"a_25kW_R1": 90.0, "a_25kW_R2": 110.0})
    late = np.c_[SECONDS, np.where(SECONDS < 60.0, 50.0, 110.0 * LEFT)]
    np.savetxt(files[1], late, "%.6g", ",", header="Time (s),Mass (g)", comments="")
    study, _ = init("y", {"gasification": files}, tmp_path)
    assert "_factor" not in study.read_text("utf-8")


GRAIN = ["a_25kW_parallel", "a_25kW_perpendicular_R1", "a_25kW_perpendicular_R2"]


def test_each_further_direction_of_the_grain_has_its_conductivity(tmp_path: Path) -> None:
    masses = dict.fromkeys([*GRAIN, "a_50kW_parallel", "a_50kW_perpendicular"], 100.0)
    study, _ = made(tmp_path, {name: grams + i for i, (name, grams) in enumerate(masses.items())})
    for name in masses:
        factor = study.experiments[name].sample.conductivity_factor
        assert factor == ("a_perpendicular" if "perpendicular" in name else 1.0)
    assert "a_perpendicular" in study.imp.estimate


@pytest.mark.parametrize(
    ("names", "residue"),
    [
        (GRAIN[:1], 0.2),
        (["a_25kW_parallel", "a_50kW_perpendicular"], 0.2),
        (["a_25kW_parallelogram", "a_25kW_perp"], 0.2),
        (GRAIN, 0.02),
    ],
    ids=["one", "the other held out", "one of two", "no char"],
)
def test_no_direction_without_a_fitted_test_of_another(
    tmp_path: Path, names: list[str], residue: float
) -> None:
    masses = {name: 100.0 + 0.5 * i for i, name in enumerate(names)}
    study, _ = made(tmp_path, masses, residue)
    assert all(study.experiments[name].sample.conductivity_factor == 1.0 for name in names)
    assert not any(name.startswith("a_") for name in study.parameters)


def test_records_of_unequal_pieces_are_told_with_their_masses(tmp_path: Path) -> None:
    study, _ = made(tmp_path, {"a_25kW_R1": 90.0, "a_25kW_R2": 110.0, "a_25kW_R3": 110.5})
    frames = {record: frame for record, (frame, _) in read_all(study).items()}
    notes = [note for _, note in notes_on_repeats(study, frames)]
    assert any(note.endswith("weighs 18 % less, and the study describes it so") for note in notes)
    assert not any("Leave it out" in note for note in notes)
