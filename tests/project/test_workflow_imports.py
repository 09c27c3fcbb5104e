"""Rules import names that exist: only runs of minutes would tell otherwise."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
RULES = [
    path
    for part in ("workflow", "src", "tests")
    for path in sorted((ROOT / part).rglob("*"))
    if path.suffix == ".smk" or path.name == "Snakefile"
]
IMPORT = re.compile(r"^from pyrofit[\w.]* import (?:[\w, ]+|\([^)]*\))$", re.M)


@pytest.mark.parametrize("path", RULES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_names_that_rules_import_exist(path: Path) -> None:
    for statement in IMPORT.findall(path.read_text("utf-8")):
        exec(statement, {})


def test_rules_are_found() -> None:
    assert any(IMPORT.search(path.read_text("utf-8")) for path in RULES)
