"""Unusual values and names are told; files that are no study are refused at once."""

import copy
import os
from pathlib import Path
from typing import Any

import pytest
import yaml

from pyrofit.config import as_study, read_mapping
from pyrofit.config.check.unusual import COUNTS, USUAL, unusual_values
from pyrofit.errors import StudyError

ROOT = Path(__file__).parents[2]
SMOKE = yaml.safe_load((ROOT / "config" / "smoke.yaml").read_text(encoding="utf-8"))


SECOND = {
    "material.components.ash": SMOKE["material"]["components"]["residue"],
    "material.reactions.second": {
        "reactant": "residue",
        "products": {"ash": 0.5},
        "reference_temperature_K": 700,
        "reference_rate_1_s": 0.001,
        "E_J_mol": 2e5,
        "heat_of_reaction_J_kg": 5e5,
    },
}
"""A reaction without parameters."""
SLAB = "experiments.slab_25"
PLACES = {
    "E_J_mol": "material.reactions.second.E_J_mol",
    "conductivity_W_mK": "material.components.residue.conductivity_W_mK",
    "density_kg_m3": "material.components.residue.density_kg_m3",
    "duration_s": f"{SLAB}.duration_s",
    "emissivity": "material.components.residue.emissivity",
    "flux_W_m2": f"{SLAB}.front.flux_W_m2",
    "foil.thickness_m": f"{SLAB}.sample.foil.thickness_m",
    "gas_temperature_K": f"{SLAB}.front.gas_temperature_K",
    "h_W_m2K": f"{SLAB}.back.h_W_m2K",
    "heat_of_combustion_J_kg": "material.reactions.second.heat_of_combustion_J_kg",
    "heat_of_reaction_J_kg": "material.reactions.second.heat_of_reaction_J_kg",
    "heating_rate_K_min": "experiments.tga_5K.heating_rate_K_min",
    "reference_temperature_K": "material.reactions.second.reference_temperature_K",
    "specific_heat_J_kgK": "material.components.residue.specific_heat_J_kgK",
    "thickness_m": f"{SLAB}.sample.layers.0.thickness_m",
    "wall_temperature_K": f"{SLAB}.back.wall_temperature_K",
}
"""A place in the study `smoke` with `SECOND` for each key that has a usual range."""


def told(change: dict[str, Any]) -> list[str]:
    """Return what is told of the study `smoke` with keys replaced, by dotted place."""
    given = copy.deepcopy(SMOKE)
    for place, value in change.items():
        *folders, last = place.split(".")
        part = given
        for key in folders:
            part = part[int(key)] if isinstance(part, list) else part[key]
        part[last] = value
    return unusual_values(as_study(given, "smoke.json"))


@pytest.mark.parametrize("name", ["hotplate", "paper", "pine", "pmma", "smoke", "twin"])
def test_nothing_is_unusual_in_the_shipped_studies(name: str) -> None:
    path = ROOT / "config" / f"{name}.yaml"
    assert unusual_values(as_study(read_mapping(path), str(path))) == []


def told_or_refused(place: str, value: float) -> str:
    """Return 'told' or 'refused' for one value, or an empty text for silence."""
    try:
        said = told(SECOND | {place: value})
    except StudyError:
        return "refused"
    return "told" if any(f"{place}: " in one for one in said) else ""


@pytest.mark.parametrize("key", USUAL)
def test_value_beyond_each_end_of_a_usual_range_is_told_or_refused(key: str) -> None:
    low, high, _ = USUAL[key]
    ends = [told_or_refused(PLACES[key], value) for value in (0.8 * low, 1.25 * high)]
    assert all(ends)
    assert "told" in ends
    within = told(SECOND | {PLACES[key]: (low * high) ** 0.5})
    assert within == []


@pytest.mark.parametrize("key", COUNTS)
def test_count_beyond_each_usual_one_is_told(key: str) -> None:
    places = {
        "generations": ("imp.sceua.generations", "kinetics.sceua.generations"),
        "repetitions": ("imp.repetitions",),
        "starts": ("imp.least_squares.starts", "imp.cmaes.starts"),
    }[key]
    for place in places:
        (said,) = told({place: 10**5})
        assert said == f"{place}: 100,000 {key} are unusual; {COUNTS[key][1]} are usual"


@pytest.mark.parametrize(
    ("place", "value", "said"),
    [
        ("experiments.tga_5K.heating_rate_K_min", 50000, "50000 K/min is outside the usual range"),
        (f"{SLAB}.duration_s", 1e9, "1e+09 s is outside the usual range of 10 to 100000 s"),
        (f"{SLAB}.sample.foil.thickness_m", 0.025, "0.025 m is outside the usual range of 1e-06"),
        (
            f"{SLAB}.front.flux_W_m2",
            {"time_s": [0, 60], "value": [0, 25]},
            "largest value, 25 W/m2 is outside the usual range of 1000 to 200000 W/m2",
        ),
        (
            "material.components.residue.conductivity_W_mK",
            {"temperature_K": [300, 600], "value": [0.2, 0.3], "factor": 1e-3},
            "largest value, 0.0003 W/(m K) is outside the usual range",
        ),
        (
            "parameters.dh",
            {"unit": "J/kg", "lower": 250, "upper": 1500},
            "heat_of_reaction_J_kg: upper limit of parameter 'dh', 1500 J/kg is outside",
        ),
        (
            "parameters.eps",
            {"unit": "-", "lower": 0.0001, "upper": 0.002},
            "emissivity: upper limit of parameter 'eps', 0.002 - is outside",
        ),
    ],
)
def test_value_of_a_wrong_unit_is_told(place: str, value: Any, said: str) -> None:
    truth = SMOKE["synthetic"]["truth"] | ({"eps": 0.001} if place == "parameters.eps" else {})
    assert any(said in one for one in told({"synthetic.truth": truth} | {place: value}))


def test_small_values_at_the_start_of_a_table_are_usual() -> None:
    table = {"time_s": [0, 5, 60], "value": [0, 200, 25000]}
    assert told({f"{SLAB}.front.flux_W_m2": table}) == []


@pytest.mark.parametrize("flux", [25, 2.5e7])
def test_flux_in_another_unit_is_told_with_the_usual_range(flux: float) -> None:
    (said,) = told({"experiments.slab_25.front.flux_W_m2": flux})
    assert said == (
        f"experiments.slab_25.front.flux_W_m2: {flux:g} W/m2 is outside the usual range of 1000 to "
        "200000 W/m2; check the unit"
    )
    assert told({"experiments.slab_25.front.flux_W_m2": 0}) == []


def test_limits_of_a_parameter_count_where_it_stands_for_a_number() -> None:
    reaction = SMOKE["material"]["reactions"]
    name = next(r["E_J_mol"] for r in reaction.values() if isinstance(r["E_J_mol"], str))
    said = told({f"parameters.{name}": {"unit": "J/mol", "lower": 100, "upper": 300}})
    assert any(f"lower limit of parameter '{name}', 100 J/mol is outside" in one for one in said)
    assert any(f"upper limit of parameter '{name}', 300 J/mol is outside" in one for one in said)


def test_repetitions_and_names_are_told() -> None:
    (said,) = told({"imp.repetitions": 10**5})
    assert "100,000 repetitions" in said
    (said,) = told({"imp.least_squares.starts": 10**5})
    assert "100,000 starts" in said
    (said,) = told({"name": "n" * 100})
    assert said.startswith("name: a name of 100 characters does not fit into tables")
    (said,) = told({"name": "nan"})
    assert "the name 'nan' is easily mistaken" in said


def test_aliases_that_expand_without_end_are_refused_at_once(tmp_path: Path) -> None:
    lines = ["a: &a [x, x, x, x, x, x, x, x, x, x]"]
    for new, old in zip("bcdefgh", "abcdefg", strict=True):
        lines.append(f"{new}: &{new} [{', '.join(['*' + old] * 10)}]")
    path = tmp_path / "bomb.yaml"
    path.write_text("\n".join(lines))
    with pytest.raises(StudyError, match=r"aliases .* stand for more than 100,000 values"):
        read_mapping(path)


def test_pipe_is_refused_and_not_waited_for(tmp_path: Path) -> None:
    path = tmp_path / "study.yaml"
    os.mkfifo(path)
    with pytest.raises(StudyError, match="a pipe or a device"):
        read_mapping(path)


def test_file_too_large_for_a_study_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "study.yaml"
    with path.open("wb") as file:
        file.truncate(60_000_000)
    with pytest.raises(StudyError, match="larger than 50 MB"):
        read_mapping(path)


@pytest.mark.parametrize("place", ["name", "experiments"])
def test_name_that_no_folder_can_have_is_refused(place: str) -> None:
    keys = copy.deepcopy(SMOKE)
    if place == "name":
        keys["name"] = "n" * 300
    else:
        keys["experiments"]["n" * 300] = next(iter(keys["experiments"].values()))
    with pytest.raises(StudyError, match=rf"{place}.*: a name of 300 characters, too long"):
        as_study(keys, "study.yaml")


def test_a_reaction_that_is_fast_at_room_temperature_is_told() -> None:
    place = "material.reactions.second"
    water = SECOND[place] | {"reference_temperature_K": 239, "E_J_mol": 1.36e5}
    (line,) = [one for one in told(SECOND | {place: water}) if "reacts at room" in one]
    # k(293.15 K) = 1e-3 exp(136000/R (1/239 - 1/293.15)) = 309 1/s, at order 1 ln 2 / k.
    assert "at room temperature: half of it is gone in 0.0022 s" in line
    assert "k = 0.001 1/s at 239 K" in line
    assert not [one for one in told(SECOND) if "reacts at room" in one]


def test_limits_of_a_reaction_that_reach_room_temperature_are_no_fault() -> None:
    place = "material.reactions.second"
    T = {"unit": "K", "lower": 290, "upper": 600}
    wide = {place: SECOND[place] | {"reference_temperature_K": "T_2"}, "parameters.T_2": T}
    wide["kinetics.estimate"] = [*SMOKE["kinetics"]["estimate"], "T_2"]
    wide["synthetic.truth.T_2"] = 295
    assert not [one for one in told(SECOND | wide) if "reacts at room" in one]
    cold = {"parameters.T_2": T | {"upper": 298}}
    assert [one for one in told(SECOND | wide | cold) if "reacts at room" in one]


def test_oxygen_that_a_model_with_oxidation_does_not_know_is_told() -> None:
    name = SMOKE["kinetics"]["cost"][0]["experiment"]
    burns = SECOND["material.reactions.second"] | {"oxygen_order": 0.8}
    air = SECOND | {"material.reactions.second": burns, f"experiments.{name}.gas": "air"}
    (said,) = [one for one in told(air) if "the gas is air" in one]
    assert "its `oxygen` is 0, with which no reaction with an oxygen_order runs" in said
    assert not [o for o in told(air | {f"experiments.{name}.oxygen": 0.209}) if "gas is air" in o]


def test_a_fitted_test_in_oxygen_is_told_and_another_is_not() -> None:
    names = [term["experiment"] for term in SMOKE["kinetics"]["cost"]]
    for gas, count in (("O2-21", 1), ("N2", 0), ("synthetic air", 1)):
        said = [one for one in told({f"experiments.{names[0]}.gas": gas}) if "no oxidation" in one]
        assert [one.split(":")[0] for one in said] == [f"experiments.{names[0]}"] * count
    others = SMOKE["kinetics"]["cost"][1:]
    alone = {"kinetics.cost": others, f"experiments.{names[0]}.gas": "air"}
    assert not [one for one in told(alone) if "no oxidation" in one]
