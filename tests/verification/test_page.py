"""The committed page against the cases of this session."""

import re

import pytest
import verification_page as page
from verification_page import Collected

WAY_OUT = "the page is not that of the tests: run 'make verification'"


@pytest.fixture(scope="module")
def committed() -> str:
    return (page.HOME / "README.md").read_text(encoding="utf-8")


def test_page_lists_every_case_with_its_tolerance(collected: Collected, committed: str) -> None:
    stated = {page.key(case, collected.texts) for case in collected.cases}
    assert stated <= page.listed(committed), WAY_OUT


def test_page_lists_nothing_that_no_test_states(collected: Collected, committed: str) -> None:
    """Only of modules that were run whole, without skips and failures."""
    whole = set(collected.texts) - collected.partial - collected.skipped
    stated = {page.key(case, collected.texts) for case in collected.cases if case.section in whole}
    titles = {title for title, *_ in stated}
    assert {row for row in page.listed(committed) if row[0] in titles} == stated, WAY_OUT


def test_page_shows_every_figure_of_its_folder(committed: str) -> None:
    shown = set(re.findall(r"\]\(([^)#]+\.png)\)", committed))
    assert shown == {path.name for path in page.HOME.glob("*.png")}, WAY_OUT


def test_page_and_figures_stay_small() -> None:
    sizes = [path.stat().st_size for path in page.HOME.iterdir()]
    assert max(path.stat().st_size for path in page.HOME.glob("*.png")) <= 60e3
    assert sum(sizes) <= 2.5e6
