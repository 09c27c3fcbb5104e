"""The page of all keys of a study and of the blind test."""

import re
from pathlib import Path

import pytest

from pyrofit.cli import main
from pyrofit.config import Study
from pyrofit.config.read import read_mapping
from pyrofit.config.reference import reference_page
from pyrofit_blind_test.reference import blind_test_keys
from pyrofit_blind_test.setting import Setting

ROOT = Path(__file__).parents[2]


def test_page_of_keys_is_up_to_date() -> None:
    written = (ROOT / "config" / "README.md").read_text(encoding="utf-8")
    printed = f"{reference_page()}\n{blind_test_keys()}"
    assert written == printed, "run: pyrofit reference > config/README.md"


@pytest.mark.parametrize("page", ["commands", "costs", "quantities"])
def test_generated_page_is_up_to_date(page: str, capsys: pytest.CaptureFixture[str]) -> None:
    main(["reference", "--of", page])
    written = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
    assert written == capsys.readouterr().out, (
        f"run: pyrofit reference --of {page} > docs/{page}.md"
    )


def test_page_of_commands_has_options_that_are_known_late() -> None:
    page = (ROOT / "docs" / "commands.md").read_text(encoding="utf-8")
    assert "- `--gasification` `CSV`: " in page
    assert page.count("- `--results` `RESULTS`: ") == 1
    assert "Also `--study`, `--results`, `--log`." in page
    assert "## `pyrofit data doctor`" in page
    assert "## `pyrofit data`\n" not in page


def test_every_key_of_a_study_is_described() -> None:
    rows = [line for line in reference_page().splitlines() if line.startswith("- `")]
    assert len(rows) > 120
    described = re.compile(r"- `\w+`(, required)?: \S.*\w.*\.")
    assert [row for row in rows if not described.fullmatch(row) or ": ." in row] == []


def test_keys_that_kinds_of_experiment_share_stand_once() -> None:
    page = reference_page()
    for key in ("laboratory", "heating_rate_K_min", "front", "thickness_sd"):
        assert len(re.findall(rf"^- `{key}`[,:] ", page, re.M)) == 1, key
    tga = page.split("## Tga\n")[1].split("\n## ")[0]
    heated = page.split("## HeatedExperiment\n")[1].split("\n## ")[0]
    assert "Further keys: [HeatedExperiment](#heatedexperiment)." in tga
    assert "Further keys: [Experiment](#experiment)." in heated


def test_page_has_the_keys_that_the_shipped_studies_use() -> None:
    page = reference_page()

    def keys(part: object) -> set[str]:
        if isinstance(part, dict):
            return {str(k) for k in part} | {k for v in part.values() for k in keys(v)}
        return {k for v in part for k in keys(v)} if isinstance(part, list) else set()

    known = set(re.findall(r"^- `(\w+)`", page, re.M))
    for file in ("smoke", "twin", "pmma", "paper"):
        given = read_mapping(ROOT / "config" / f"{file}.yaml")
        top = set(given) | {k for k in keys(given["experiments"]) if "_" in k and k[-1] in "sKm"}
        assert {k for k in top if k not in given["experiments"]} <= known, file


def test_page_tells_units_limits_and_usual_values() -> None:
    page = reference_page()
    row = "- `heating_rate_K_min`, required: nominal heating rate. Number [K/min]; above 0."
    assert f"{row}\n" in page
    row = "- `wall_temperature_K`: temperature of the radiating surroundings, may follow a table"
    kind = "Value or [TimeTable](#timetable) [K]; above 0, at least 150; default 293.15."
    assert f"{row} over time. {kind}\n" in page
    row = "- `repetitions`: repetitions per cost. Whole number; at least 1, at most 100000;"
    assert f"{row} default 25.\n" in page
    for name in Study.model_fields:
        assert f"- `{name}`" in page
    for name in Setting.model_fields:
        assert f"- `{name}`" in blind_test_keys()
