"""The metadata of an archive keep the rules of a Workflow Run RO-Crate, as its validator sees them.

The validator would fetch the context of JSON-LD. It gets the one that comes with rocrate instead.
"""

import json
import warnings
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest

from pyrofit.archive_crate import FOLDERS, LISTED, REPORT, WORKFLOW, metadata
from pyrofit.config import Study, read_study
from pyrofit.errors import DataError

ROOT = Path(__file__).parents[3]
ORIGIN = {"packages": {"snakemake": "9.27.1"}}
NAMES = [*LISTED, REPORT, WORKFLOW, "as_given/smoke.yaml", "data/my file.csv", "SHA256SUMS"]
NAMESPACE = "https://bioschemas.org/"
"""Where RO-Crate 1.1 has the terms that later versions have elsewhere."""


@pytest.fixture(scope="module")
def smoke() -> Study:
    return read_study(ROOT / "config" / "smoke.yaml")


@pytest.fixture
def crate(smoke: Study) -> dict[str, Any]:
    content: dict[str, Any] = json.loads(metadata(smoke, ORIGIN, NAMES))
    return content


def faults(crate: dict[str, Any], folder: Path) -> list[str]:
    """Return the violations of a MUST of the profile or of those it builds on."""
    for name in NAMES:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).touch()
    text = files("rocrate").joinpath("data", "ro-crate.jsonld").read_text(encoding="utf-8")
    context = json.loads(text)["@context"]
    for term in ("ComputationalWorkflow", "FormalParameter"):
        context[term] = NAMESPACE + term
    (folder / "ro-crate-metadata.json").write_text(json.dumps({**crate, "@context": context}))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        from rocrate_validator import models, services

        settings = services.ValidationSettings(
            rocrate_uri=str(folder),
            profile_identifier="workflow-run-crate-0.5",
            requirement_severity=models.Severity.REQUIRED,
        )
        found = services.validate(settings)
    assert found.passed() == (not found.get_issues())
    return [str(issue.message) for issue in found.get_issues()]


def entity(crate: dict[str, Any], name: str) -> dict[str, Any]:
    (found,) = [e for e in crate["@graph"] if e["@id"] == name]
    return dict(found)


def test_validator_finds_no_fault(crate: dict[str, Any], tmp_path: Path) -> None:
    assert faults(crate, tmp_path) == []


def test_validator_finds_a_run_without_its_workflow(crate: dict[str, Any], tmp_path: Path) -> None:
    (run,) = [e for e in crate["@graph"] if e["@id"] == "#run"]
    del run["instrument"]
    assert "The Action MUST have an instrument" in " ".join(faults(crate, tmp_path))


def test_run_joins_workflow_study_and_results(crate: dict[str, Any]) -> None:
    assert entity(crate, "./")["mainEntity"] == {"@id": WORKFLOW}
    run = entity(crate, "#run")
    assert run["instrument"] == {"@id": WORKFLOW}
    assert run["object"] == [{"@id": "data/my%20file.csv"}, {"@id": "study.yaml"}]
    assert run["result"] == [{"@id": "results/"}, {"@id": REPORT}]
    language = entity(crate, WORKFLOW)["programmingLanguage"]["@id"]
    assert entity(crate, language)["version"] == "9.27.1"


def test_folders_and_files_that_the_archive_lacks_are_not_named(smoke: Study) -> None:
    lean = json.loads(metadata(smoke, {}, [WORKFLOW, "study.yaml", "results/study.json"]))
    named = {e["@id"] for e in lean["@graph"]}
    assert {"software/", "results/", "study.yaml", "results/study.json"} <= named
    assert not {"data/", "plugins/", REPORT, "README.txt"} & named
    assert set(FOLDERS) & named == {"software/", "results/"}


def test_date_is_that_of_the_entries_or_the_given_one(
    smoke: Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    first = metadata(smoke, ORIGIN, NAMES)
    assert first == metadata(smoke, ORIGIN, reversed(NAMES))
    assert entity(json.loads(first), "./")["datePublished"] == "1980-01-01"
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1790000000")
    assert entity(json.loads(metadata(smoke, ORIGIN, NAMES)), "./")["datePublished"] == "2026-09-21"


@pytest.mark.parametrize("given", ["today", "1.5", "9" * 30])
def test_date_that_is_no_number_of_seconds_is_refused(
    smoke: Study, monkeypatch: pytest.MonkeyPatch, given: str
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", given)
    with pytest.raises(DataError, match="SOURCE_DATE_EPOCH is '"):
        metadata(smoke, ORIGIN, NAMES)
