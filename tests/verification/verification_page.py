"""The verification page, the table of its cases, and the page of their figures."""

import csv
import io
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from drawing import png
from evidence import Case, short

HOME = Path(__file__).parents[2] / "docs" / "verification"
ORDER = (
    "test_tga_exact",
    "test_tga_codes",
    "test_tga_macfp",
    "test_slab_exact",
    "test_slab_properties",
    "test_slab_isothermal",
    "test_slab_convergence",
    "test_promise",
    "test_random_sets",
    "test_slab_balances",
    "test_slab_fds",
    "test_slab_gpyro",
    "test_slab_indepth",
    "test_cost_fds",
)
"""Modules as the page lists them; others follow."""
COLUMNS = ("section", "case", "compared with", "error measure", "tolerance", "measured", "note")
INTRODUCTION = """# Verification

**Does pyrofit solve the equations that it states?** The tests in `tests/verification` compare it
with exact solutions, with FDS 6.7.4 and Gpyro 0.82, with its own solution on a much finer grid, and
check that balances close. Whether the equations describe a material is another question.

[cases.csv](cases.csv) holds the error and the tolerance of every comparison. Rows with the
tolerance *different by* are known differences: the other program solves another equation.

The tests write this page and the table. They draw the figures into `docs/verification/figures`:

    make verification

Published FDS curves and measured files need the MaCFP data base in the folder `PYROFIT_DATA_DIR`.
"""
FIGURES = """---
orphan: true
---

# Figures of the verification

Above, pyrofit (thin, dashed) over the other curve (thick grey, or points); below, pyrofit less the
other. [Verification](../README.md) lists the sections.
"""


@dataclass
class Collected:
    """The cases of a session and which modules were not run whole."""

    cases: list[Case] = field(default_factory=list)
    texts: dict[str, str] = field(default_factory=dict)
    skipped: set[str] = field(default_factory=set)
    partial: set[str] = field(default_factory=set)

    def keep(self, case: Case) -> None:
        slugs = {other.slug for other in self.cases}
        assert case.slug not in slugs, f"two cases are called '{case.title}'"
        self.cases.append(case)


def rank(section: str) -> tuple[int, str]:
    """Sort key of a module."""
    return (ORDER.index(section) if section in ORDER else len(ORDER), section)


def write(folder: Path, cases: list[Case], texts: Mapping[str, str], left_out: list[str]) -> None:
    """Write page and table, and anew the page of the figures in a folder of its own."""
    figures = folder / "figures"
    figures.mkdir(parents=True, exist_ok=True)
    for old in figures.glob("*.png"):
        old.unlink()
    for case in cases:
        if case.picture:
            (figures / f"{case.slug}.png").write_bytes(png(case))
    (figures / "README.md").write_text(_figures(cases, texts), encoding="utf-8")
    (folder / "README.md").write_text(text(cases, texts, left_out), encoding="utf-8")
    (folder / "cases.csv").write_text(table(cases, texts), encoding="utf-8")


def text(cases: list[Case], texts: Mapping[str, str], left_out: list[str]) -> str:
    """The page; ``texts`` holds the docstring of each module: its title, then its prose."""
    differences = sum(case.known_difference for case in cases)
    counted = len(cases) - differences
    parts = [INTRODUCTION, f"{counted} comparisons, {differences} known differences.\n"]
    if left_out:
        names = ", ".join(_title(texts[name]) for name in left_out)
        parts.append(f"Left out, because their files were not here: {names}.\n")
    for section, own in _by_section(cases).items():
        parts.append(f"## {_title(texts[section])}\n")
        parts.extend(f"{prose}\n" for prose in texts[section].split("\n\n")[1:])
        sources = dict.fromkeys(short(case.source) for case in own)
        parts.append(f"Cases: {len(own)}. Compared with: {', '.join(sources)}.\n")
    return "\n".join(parts)


def table(cases: list[Case], texts: Mapping[str, str]) -> str:
    """The table of all cases, as CSV."""
    lines = io.StringIO()
    writer = csv.writer(lines, lineterminator="\n")
    writer.writerow(COLUMNS)
    for own in _by_section(cases).values():
        writer.writerows(
            [*key(c, texts)[:3], c.measure, c.tolerance, c.measured, c.note] for c in own
        )
    return lines.getvalue()


def listed(table: str) -> set[tuple[str, ...]]:
    """Section, case, source and tolerance of every row of a table."""
    wanted = ("section", "case", "compared with", "tolerance")
    return {tuple(row[name] for name in wanted) for row in csv.DictReader(io.StringIO(table))}


def key(case: Case, texts: Mapping[str, str]) -> tuple[str, ...]:
    """The same of a case."""
    return _title(texts[case.section]), case.title, case.source, case.tolerance


def _by_section(cases: list[Case]) -> dict[str, list[Case]]:
    order = sorted({case.section for case in cases}, key=rank)
    return {section: [case for case in cases if case.section == section] for section in order}


def _title(docstring: str) -> str:
    return " ".join(docstring.split("\n\n")[0].split()).rstrip(".")


def _figures(cases: list[Case], texts: Mapping[str, str]) -> str:
    parts = [FIGURES]
    for section, own in _by_section(cases).items():
        drawn = [case for case in own if case.picture]
        if drawn:
            parts.append(f"## {_title(texts[section])}\n")
            parts.extend(_figure(case) for case in drawn)
    return "\n".join(parts)


def _figure(case: Case) -> str:
    note = f" {case.note}" if case.note else ""
    allowed = "expected to be" if case.known_difference else "tolerance"
    return (
        f"![{case.title}]({case.slug}.png)\n\n"
        f"**{case.title}.** {case.source}. {case.measure[0].upper()}{case.measure[1:]} "
        f"{case.measured}, {allowed} {case.tolerance}.{note}\n"
    )
