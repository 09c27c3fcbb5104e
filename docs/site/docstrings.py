"""Docstrings as Sphinx reads them."""

import re
from typing import Any


def literal_formulas(
    app: Any, kind: str, name: str, thing: Any, options: Any, lines: list[str]
) -> None:
    """Mark indented paragraphs of the text as literal: they are formulas, not quotations.

    Sections with underlined headings (Parameters, Returns, Examples ...) are left to napoleon.
    """
    end = next((i for i, line in enumerate(lines) if re.fullmatch(r"-{3,}", line)), len(lines) + 1)
    made: list[str] = []
    literal = False
    for i, line in enumerate(lines):
        indented = line.startswith("    ")
        if i < end - 1 and indented and not literal and (not made or not made[-1]):
            made += ["::", ""]
        literal = indented or (literal and not line)
        # Bars are absolute values, not substitutions.
        made.append(line if literal or "`" in line else line.replace("|", "\\|"))
    lines[:] = made
