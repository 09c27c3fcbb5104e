"""The tutorial of the diagnosis, as a stranger follows it."""

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from pages import copy_project, follow, shown
from tiny import ROOT

TUTORIAL = ROOT / "docs" / "tutorial_diagnosis.md"
TRUE_SLOPE_1_K = 5e-4


@dataclass(frozen=True)
class Followed:
    """What the tutorial left behind."""

    root: Path
    said: str

    def found(self, study: str) -> dict[str, Any]:
        """Return the result of a diagnosis."""
        path = self.root / "results" / study / "diagnosis" / "diagnosis.json"
        result: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        return result


@pytest.fixture(scope="module")
def followed(tmp_path_factory: pytest.TempPathFactory) -> Followed:
    """Return a copy of the project in which all framed blocks were run, one after the other."""
    root = tmp_path_factory.mktemp("tutorial_diagnosis")
    copy_project(root)
    ran = follow(root, TUTORIAL)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    return Followed(root, ran.stdout + ran.stderr)


def test_verdicts_are_those_that_the_page_tells(followed: Followed) -> None:
    kinds = {
        "hidden": ("ambiguous", {"k_T", "c_T", "heater_ramp"}),
        "hidden_thick": ("named", {"k_T"}),
        "hidden_thick_extended": ("none", set()),
    }
    for study, (kind, effects) in kinds.items():
        verdict = followed.found(study)["verdict"]
        assert verdict["kind"] == kind, study
        assert {one for alike in verdict["sets"] for one in alike} == effects, study


def test_sentences_and_file_names_that_the_page_shows_are_said(followed: Followed) -> None:
    page = TUTORIAL.read_text(encoding="utf-8")
    starts = ("The model lacks", "Model and measurements", "These data show", "Diagnosis:")
    sentences = [line for line in shown(TUTORIAL) if line.startswith(starts)]
    assert len(sentences) >= 5
    for line in sentences:
        assert line in followed.said
    for name in re.findall(r"results/[\w/.]+\.(?:md|html|yaml)", page):
        assert (followed.root / name).is_file(), name


def test_numbers_that_the_page_shows_are_found(followed: Followed) -> None:
    # Other machines change the last digits.
    number = re.compile(r"^base model: chi-square ([\d.]+) of (\d+) points$", re.M)
    told, said = number.findall("\n".join(shown(TUTORIAL))), number.findall(followed.said)
    assert len(told) == 3
    assert [points for _, points in said] == [points for _, points in told]
    for (there, _), (here, _) in zip(told, said, strict=True):
        assert float(here) == pytest.approx(float(there), abs=1.0)
    row = re.compile(r"^\| (gasification at [^|]+?) +\| +([\d.]+) +\|$", re.M)
    told, said = row.findall("\n".join(shown(TUTORIAL))), row.findall(followed.said)[:3]
    assert len(told) == 3
    assert [name for name, _ in said] == [name for name, _ in told]
    for (_, there), (_, here) in zip(told, said, strict=True):
        assert float(here) == pytest.approx(float(there), rel=0.03)


def test_gap_shrinks_and_the_truth_is_found(followed: Followed) -> None:
    ratios = re.findall(r"chi-square per degree of freedom ([\d.]+)", followed.said)
    before, after = (float(ratio) for ratio in ratios)
    assert before > 1.1
    assert after < 1.0
    off = [float(x) for x in re.findall(r"back_temperature +([\d.]+) +K$", followed.said, re.M)]
    assert off[1] < 0.5 * off[0]
    extended = followed.root / "results/hidden_thick/diagnosis/extended.yaml"
    slope = re.search(r"slope_1_K: ([\d.e-]+)", extended.read_text(encoding="utf-8"))
    assert slope is not None
    assert float(slope[1]) == pytest.approx(TRUE_SLOPE_1_K, abs=5e-5)
