"""One version in all files that state it."""

import re
import tomllib
from pathlib import Path

import yaml

import pyrofit

ROOT = Path(__file__).parents[2]
_HEADING = re.compile(r"^## (\d+\.\d+\.\d+)(?:, \d{4}-\d\d-\d\d)?$", re.M)
"""A version of the changelog, with its date once it is released."""


def test_all_files_state_the_same_version() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    newest = _HEADING.search((ROOT / "CHANGELOG.md").read_text(encoding="utf-8"))
    assert newest is not None
    stated = {pyrofit.__version__, project["version"], citation["version"], newest[1]}
    assert stated == {project["version"]}


def test_changelog_begins_with_changes_of_no_version() -> None:
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    first, *others = re.findall(r"^## (.*)$", text, re.M)
    assert first == "Unreleased"
    assert all(_HEADING.fullmatch(f"## {heading}") for heading in others)
