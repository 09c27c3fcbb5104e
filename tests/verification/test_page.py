"""The committed table against the cases of this session."""

import pytest
import verification_page as page
from verification_page import Collected

WAY_OUT = "the table is not that of the tests: run 'make verification'"


@pytest.fixture(scope="module")
def listed() -> set[tuple[str, ...]]:
    return page.listed((page.HOME / "cases.csv").read_text(encoding="utf-8"))


def test_table_lists_every_case_with_its_tolerance(
    collected: Collected, listed: set[tuple[str, ...]]
) -> None:
    stated = {page.key(case, collected.texts) for case in collected.cases}
    assert stated <= listed, WAY_OUT


def test_table_lists_nothing_that_no_test_states(
    collected: Collected, listed: set[tuple[str, ...]]
) -> None:
    """Only of modules that were run whole, without skips and failures."""
    whole = set(collected.texts) - collected.partial - collected.skipped
    stated = {page.key(case, collected.texts) for case in collected.cases if case.section in whole}
    titles = {title for title, *_ in stated}
    assert {row for row in listed if row[0] in titles} == stated, WAY_OUT


def test_page_has_a_heading_for_every_section(listed: set[tuple[str, ...]]) -> None:
    lines = (page.HOME / "README.md").read_text(encoding="utf-8").splitlines()
    headings = {line[3:] for line in lines if line.startswith("## ")}
    assert headings == {section for section, *_ in listed}, WAY_OUT
