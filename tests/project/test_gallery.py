"""The gallery of the documentation: its pictures are there, small, and have a command."""

import re
from importlib import import_module
from pathlib import Path

import pytest

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
    assert all(re.search(r"\n\nDrawn at commit [0-9a-f]{8}\.\n\n", text) for text in sections)


def test_sections_that_are_not_drawn_anew_keep_their_captions(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.syspath_prepend(DOCS.parent / "tools")
    gallery = import_module("gallery")
    whole = gallery.with_captions(gallery.sections(PAGE))
    parts = [gallery.HEAD]
    for text in whole.values():
        parts.append(gallery.without_captions(text, "".join(parts)))
    assert "\n".join(parts) == PAGE
    # The caption of a section above that has changed since stands in the first of these sections.
    first, *others = whole.values()
    (caption,) = re.findall(r"twin_figures_profiles\.png\)\n\n(.*)\n", first)
    changed = first.replace(caption, "Another caption.")
    old = next(text for text in others if f"profiles.png)\n\n{caption}" in text)
    assert caption in gallery.without_captions(old, changed)
    assert caption not in gallery.without_captions(old, first)
