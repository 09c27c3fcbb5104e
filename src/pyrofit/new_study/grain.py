"""Pieces cut in different directions of the grain: each direction has a conductivity of its own."""

import re

from pyrofit.new_study.plan import PartOfPlan

_DIRECTION = re.compile(
    r"(?<![a-z])(parallel|perpendicular|perp|along|across|longitudinal|transverse|radial"
    r"|tangential)(?![a-z])",
    re.IGNORECASE,
)


def directions_of(slabs: PartOfPlan) -> dict[str, str]:
    """Return by test the direction of the grain, where its conductivity needs a factor.

    The first direction that is fitted needs none. One that no fitted test has can have none.
    """
    told = {run.name: _told(run.name) for run in slabs.runs}
    fitted = list(dict.fromkeys(told[run.name] for run in slabs.fitted if told[run.name]))
    return {name: direction for name, direction in told.items() if direction in fitted[1:]}


def _told(name: str) -> str:
    """Return the direction that the name of a test tells; nothing where it tells none.

    >>> _told("board_30kW_hor_Perpendicular"), _told("board_30kW")
    ('perpendicular', '')
    """
    match = _DIRECTION.search(name.replace("_", " "))
    return match[1].lower() if match else ""
