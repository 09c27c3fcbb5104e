"""docs/benchmarks.md, section by section, and the tables beside it."""

import csv
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

PAGE = Path(__file__).parents[1] / "docs" / "benchmarks.md"
TABLES = PAGE.parent / "data" / "benchmarks"
TITLE = "# Benchmarks\n\nWritten by `make bench` and `benchmarks/robustness.py`.\n"


def put_section(title: str, text: str) -> None:
    """Put a section into the page, in place of the one of this title."""
    present = PAGE.read_text(encoding="utf-8") if PAGE.exists() else TITLE
    section = f"## {title}\n\n{text.strip()}\n"
    pattern = re.compile(rf"^## {re.escape(title)}\n.*?(?=^## |\Z)", re.MULTILINE | re.DOTALL)
    if pattern.search(present):
        present = pattern.sub(lambda _: section + "\n", present)
    else:
        present = present.rstrip() + "\n\n" + section
    PAGE.write_text(present.rstrip() + "\n", encoding="utf-8")


def table(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """Return a Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def filed(name: str, words: str, head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """Write a table as a CSV file beside the page; return a link to it."""
    TABLES.mkdir(parents=True, exist_ok=True)
    with (TABLES / f"{name}.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(head)
        writer.writerows([plain(str(cell)) for cell in row] for row in rows)
    return f"[{words}](data/benchmarks/{name}.csv)"


def plain(cell: str) -> str:
    """Return a cell of a page as one of a file.

    >>> plain("**1,599**")
    '1599'
    """
    return re.sub(r"(?<=\d),(?=\d{3}(?!\d))", "", cell.replace("**", ""))
