"""Steps that a study may go without: one folder each, named as its command, target and results.

A folder defines ``STEP``; nothing else needs to know it. `docs/adding.md` says what it holds.
"""

from dataclasses import replace
from functools import cache

from pyrofit.discovery import contents
from pyrofit.steps.base import Step


@cache
def known_steps() -> dict[str, Step]:
    """Return all steps by name, in the order of the report."""
    found = contents(__name__, __path__, "STEP")
    steps = [replace(step, name=name) for name, step in found.items()]
    return {step.name: step for step in sorted(steps, key=lambda step: step.place)}
