"""The verification page: rows of cases, their figures, and what a written page lists."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from drawing import png
from evidence import Case

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
HEAD = "| case | compared with | error measure | tolerance | measured | figure |"
ROW = re.compile(
    r"^\| (?P<case>[^|]+) \| (?P<source>[^|]+) \| [^|]+ \| (?P<tolerance>[^|]+) \| [^|]+ \|"
)
INTRODUCTION = """# Verification

Does pyrofit solve the equations it says it solves? This page answers case by case. Every row is
one comparison: with an exact solution, with an independent program (FDS 6.7.4, Gpyro 0.82), with
pyrofit's own solution on a much finer grid, or of a balance that has to close. *Measured* is how
far apart the two are, *tolerance* what the tests allow; a test fails when the measured value is
above it. Rows that say *different by* are not agreements: there the other program solves another
equation, the text says which, and the test holds the size of the difference.

What is verified here is the solution of the equations. Whether they describe a material is
another question, which measurements answer.

The page is written by the tests themselves (`tests/verification`), so that its numbers are those
the tests measured. To write it again:

    make verification

Of the published FDS curves and the measured files it needs the MaCFP data base, in the folder
that `PYROFIT_DATA_DIR` names; without it those sections are left out.
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
        assert "|" not in case.title + case.source, f"'{case.title}' breaks the table"
        self.cases.append(case)


def rank(section: str) -> tuple[int, str]:
    """Sort key of a module."""
    return (ORDER.index(section) if section in ORDER else len(ORDER), section)


def write(folder: Path, cases: list[Case], texts: Mapping[str, str], left_out: list[str]) -> None:
    """Write README.md and the figures of the cases, and delete figures of no case."""
    folder.mkdir(parents=True, exist_ok=True)
    drawn = {f"{case.slug}.png": case for case in cases if case.picture}
    for old in folder.glob("*.png"):
        if old.name not in drawn:
            old.unlink()
    for name, case in drawn.items():
        (folder / name).write_bytes(png(case))
    (folder / "README.md").write_text(text(cases, texts, left_out), encoding="utf-8")


def text(cases: list[Case], texts: Mapping[str, str], left_out: list[str]) -> str:
    """The page; ``texts`` holds the docstring of each module: its title, then its prose."""
    order = sorted({case.section for case in cases}, key=rank)
    counted = sum(not case.known_difference for case in cases)
    parts = [INTRODUCTION, f"{counted} comparisons, {len(cases) - counted} known differences.\n"]
    if left_out:
        names = ", ".join(_title(texts[name]) for name in left_out)
        parts.append(f"Left out, because their files were not here: {names}.\n")
    for section in order:
        parts.append(f"## {_title(texts[section])}\n")
        parts.extend(f"{prose}\n" for prose in texts[section].split("\n\n")[1:])
        rows = [_row(case) for case in cases if case.section == section]
        parts.append("\n".join([HEAD, "|---" * 6 + "|", *rows]) + "\n")
    parts.append("## Figures\n")
    parts.append(
        "Above, pyrofit (thin, dashed) over the other curve (thick grey, or points); below, "
        "pyrofit less the other.\n"
    )
    for section in order:
        drawn = [case for case in cases if case.section == section and case.picture]
        if drawn:
            parts.append(f"### {_title(texts[section])}\n")
            parts.extend(_figure(case) for case in drawn)
    return "\n".join(parts)


def listed(page: str) -> set[tuple[str, str, str, str]]:
    """Section, case, source and tolerance of every row of a page."""
    rows, section = set(), ""
    for line in page.splitlines():
        if line.startswith("## "):
            section = line[3:]
        found = ROW.match(line)
        if found and found["case"] not in ("case", "---"):
            rows.add((section, found["case"], found["source"], found["tolerance"]))
    return rows


def key(case: Case, texts: Mapping[str, str]) -> tuple[str, str, str, str]:
    """The same of a case."""
    return _title(texts[case.section]), case.title, case.source, case.tolerance


def _title(docstring: str) -> str:
    return " ".join(docstring.split("\n\n")[0].split()).rstrip(".")


def _row(case: Case) -> str:
    link = f"[figure](#{case.slug})" if case.picture else ""
    cells = (case.title, case.source, case.measure, case.tolerance, case.measured, link)
    return "| " + " | ".join(cells) + " |"


def _figure(case: Case) -> str:
    note = f" {case.note}" if case.note else ""
    allowed = "expected to be" if case.known_difference else "tolerance"
    return (
        f'<a id="{case.slug}"></a>\n\n![{case.title}]({case.slug}.png)\n\n'
        f"**{case.title}.** {case.source}. {case.measure[0].upper()}{case.measure[1:]} "
        f"{case.measured}, {allowed} {case.tolerance}.{note}\n"
    )
