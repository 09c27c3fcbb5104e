"""The targets of the workflow, as its rules describe them."""

import re
from collections.abc import Iterator
from pathlib import Path

from pyrofit.discovery import added, loaded
from pyrofit.steps import known_steps

WORKFLOW = Path(__file__).parents[1] / "workflow"
"""Folder of the workflow in the installed package."""
_RULE = re.compile(r'^ *rule (\w+):\n\s+"""(.+?)"""$', re.M | re.S)


def targets() -> dict[str, str]:
    """Return the description of each target by its name: of steps, and rules with a docstring."""
    found = dict(pair for text in _texts() for pair in _RULE.findall(text))
    found |= {n: f"{s.words[0].upper()}{s.words[1:]}." for n, s in known_steps().items()}
    return {name: " ".join(found[name].split()) for name in sorted(found)}


def _texts() -> Iterator[str]:
    others = [Path(loaded(point)) for point in added("rules").values()]
    for path in [*sorted(WORKFLOW.rglob("*.smk")), *others]:
        yield path.read_text(encoding="utf-8")
