"""Unusual values and names are told; files that are no study are refused at once."""

import copy
import os
from pathlib import Path
from typing import Any

import pytest
import yaml

from pyrofit.config import as_study, read_mapping
from pyrofit.config.unusual import unusual
from pyrofit.errors import StudyError

ROOT = Path(__file__).parents[2]
SMOKE = yaml.safe_load((ROOT / "config" / "smoke.yaml").read_text(encoding="utf-8"))


def told(change: dict[str, Any]) -> list[str]:
    """Return what is told of the study `smoke` with keys replaced, by dotted place."""
    given = copy.deepcopy(SMOKE)
    for place, value in change.items():
        *folders, last = place.split(".")
        part = given
        for key in folders:
            part = part[int(key)] if isinstance(part, list) else part[key]
        part[last] = value
    return unusual(as_study(given, "smoke.json"))


@pytest.mark.parametrize("name", ["hotplate", "paper", "pine", "pmma", "smoke", "twin"])
def test_nothing_is_unusual_in_the_shipped_studies(name: str) -> None:
    path = ROOT / "config" / f"{name}.yaml"
    assert unusual(as_study(read_mapping(path), str(path))) == []


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
    (said,) = told({"imp.repetitions": 10**9})
    assert "1,000,000,000 repetitions" in said
    (said,) = told({"name": "n" * 300})
    assert "a name of 300 characters" in said
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
