"""The recipe of the conda package says what `pyproject.toml` says."""

import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).parents[2]
OTHER_NAMES = {"matplotlib": "matplotlib-base", "snakemake": "snakemake-minimal"}
"""Packages of conda without parts that pyrofit does not use."""


def spaced(requirement: str) -> str:
    """Return a requirement as conda writes it."""
    found = re.fullmatch(r"([\w-]+)(.*)", requirement)
    assert found is not None, requirement
    return f"{OTHER_NAMES.get(found[1], found[1]).replace('_', '-')} {found[2]}".strip()


@pytest.fixture(scope="module")
def project() -> dict[str, Any]:
    found: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    return found


@pytest.fixture(scope="module")
def recipe() -> dict[str, Any]:
    found: dict[str, Any] = yaml.safe_load((ROOT / "conda" / "recipe.yaml").read_text("utf-8"))
    return found


def test_version_license_and_command_are_those_of_the_package(
    project: dict[str, Any], recipe: dict[str, Any]
) -> None:
    about = project["project"]
    assert recipe["context"]["version"] == about["version"]
    assert recipe["about"]["summary"] == about["description"]
    assert recipe["about"]["license"] == about["license"]
    commands = [f"{name} = {place}" for name, place in about["scripts"].items()]
    assert recipe["build"]["python"]["entry_points"] == commands


def test_requirements_are_those_of_the_package(
    project: dict[str, Any], recipe: dict[str, Any]
) -> None:
    about = project["project"]
    python = f"python {about['requires-python']}"
    needed = recipe["requirements"]
    assert needed["run"] == [python, *map(spaced, about["dependencies"])]
    built_by = [spaced(line) for line in project["build-system"]["requires"]]
    assert needed["host"] == [python, *built_by, "pip"]
