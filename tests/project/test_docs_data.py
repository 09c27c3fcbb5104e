"""The tables beside the pages of the documentation: each is linked, with a head and full rows."""

import csv
import re
from importlib import import_module
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
TABLES = sorted((DOCS / "data").glob("*/*.csv"))


@pytest.mark.parametrize("page", sorted({path.parent.name for path in TABLES}))
def test_page_links_all_its_tables_and_no_others(page: str) -> None:
    linked = re.findall(r"\]\((data/[^)]*)\)", (DOCS / f"{page}.md").read_text(encoding="utf-8"))
    there = [p.relative_to(DOCS).as_posix() for p in TABLES if p.parent.name == page]
    assert sorted(set(linked)) == there


@pytest.mark.parametrize("path", TABLES, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_table_has_a_head_of_different_names_and_full_rows(path: Path) -> None:
    with path.open(encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    assert rows
    assert len({*head}) == len(head)
    assert all(head)
    assert {len(row) for row in rows} == {len(head)}


def test_benchmark_files_a_table_without_the_marks_of_a_page(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(DOCS.parent / "benchmarks")
    page = import_module("page")
    monkeypatch.setattr(page, "TABLES", tmp_path)
    link = page.filed("rates", "Rates", ("sets", "rate 1/s"), [("**all**", "1,599"), (2, "0.1, 3")])
    assert link == "[Rates](data/benchmarks/rates.csv)"
    assert (tmp_path / "rates.csv").read_text(encoding="utf-8") == (
        'sets,rate 1/s\nall,1599\n2,"0.1, 3"\n'
    )
