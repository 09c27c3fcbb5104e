import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROWS = [
    [cell.strip() for cell in line.strip("|\n").split("|")]
    for line in (ROOT / "docs" / "paper_map.md").read_text().splitlines()
    if line.startswith("| ") and "src/pyrofit" in line
]
MUST_BE_THERE = {f"Eq. {n}" for n in range(1, 6)} | {f"Table {n}" for n in range(1, 7)}
MUST_BE_THERE |= {f"Fig. {n}" for n in range(1, 6)}


def test_every_equation_table_and_figure_of_the_campaign_is_mapped():
    assert {row[0] for row in ROWS} >= MUST_BE_THERE


@pytest.mark.parametrize("row", ROWS, ids=[f"{row[0]} {row[3]}" for row in ROWS])
def test_the_mapped_function_exists_and_names_its_equation(row):
    label, _, file, name = row
    tree = ast.parse((ROOT / file).read_text())
    found = {
        node.name: ast.get_docstring(node) or ""
        for node in tree.body
        if isinstance(node, ast.FunctionDef | ast.ClassDef)
    }
    assert name in found, f"{file} has no {name}"
    number = re.escape(label)
    assert re.search(rf"{number}\b", found[name]), f"the docstring of {name} does not name {label}"
