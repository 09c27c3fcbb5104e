"""Steps that a study may go without: one folder each, named as its command, target and results.

A folder defines ``STEP``; nothing else needs to know it. `docs/adding.md` says what it holds. Other
packages add steps by entry points of the group ``pyrofit.steps``.
"""

from dataclasses import replace
from functools import cache

from pyrofit.discovery import added, contents, loaded
from pyrofit.errors import PyrofitError
from pyrofit.steps.base import Step


@cache
def known_steps() -> dict[str, Step]:
    """Return all steps by name, in the order of the report.

    Raises
    ------
    PyrofitError
        Another package adds a step of a name that exists.
    """
    found = contents(__name__, __path__, "STEP")
    steps = [replace(step, name=name, package=f"{__name__}.{name}") for name, step in found.items()]
    for name, point in added("steps").items():
        if name in found:
            raise PyrofitError(
                f"{point.value}: pyrofit has a step '{name}' already; give it another name"
            )
        steps.append(replace(loaded(point), name=name, package=point.module))
    return {step.name: step for step in sorted(steps, key=lambda step: step.place)}
