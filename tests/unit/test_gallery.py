"""The gallery of the documentation: its pictures are there, small, and have a command."""

import re
from pathlib import Path

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "gallery.md").read_text(encoding="utf-8")
MOST_BYTES = 60_000


def test_gallery_shows_all_its_pictures_and_no_others() -> None:
    shown = re.findall(r"!\[[^\]]*\]\(([^)]*)\)", PAGE)
    there = sorted(p.relative_to(DOCS).as_posix() for p in DOCS.glob("figures/gallery/*"))
    assert sorted(shown) == there


def test_pictures_of_the_gallery_are_small() -> None:
    large = [p.name for p in DOCS.glob("figures/gallery/*") if p.stat().st_size > MOST_BYTES]
    assert large == []


def test_each_section_of_the_gallery_begins_with_its_command() -> None:
    _, *sections = re.split(r"^## ", PAGE, flags=re.M)
    assert sections
    assert all(re.match(r".*\n\n    (pyrofit|snakemake|python) ", text) for text in sections)
