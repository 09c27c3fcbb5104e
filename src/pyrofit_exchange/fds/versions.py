"""Differences between versions of FDS: names of keys, and defaults that change a curve."""

import re
from typing import NamedTuple

from pyrofit.errors import ProgramError


class FdsError(ProgramError):
    """FDS, or a file of it, cannot be used."""


class Version(NamedTuple):
    """Versions of FDS that read the same input.

    Parameters
    ----------
    name
        Its name on the command line.
    back_gas
        Key of the temperature behind the sample. From 6.8 on TMP_BACK fixes the back surface.
    adjusts_heat
        Whether heats of reaction follow the component enthalpies unless ADJUST_H forbids it.
    locks_step
        Whether the time step is held by LOCK_TIME_STEP.
    cube_root
        Whether the coefficient of natural convection can be given.
    layer_order
        Whether A of an order other than 1 counts densities over that of the layer.
    range_of_gas
        Whether the rate that follows from PYROLYSIS_RANGE is times the yield of gas.
    """

    name: str
    back_gas: str
    adjusts_heat: bool
    locks_step: bool
    cube_root: bool
    layer_order: bool
    range_of_gas: bool


OLD = Version("6.7", "TMP_BACK", False, False, True, True, True)
NEW = Version("6.8+", "TMP_GAS_BACK", True, True, False, False, False)
LAST_WITH_CUBE_ROOT, LAST_WITH_LAYER_ORDER = 4, 7
"""Of 6.7: C_VERTICAL was there in 6.7.4 and gone by 6.7.9; A changed its unit in 6.7.8."""


def version_of(text: str) -> Version:
    """Return the version that a number names.

    Raises
    ------
    FdsError
        The text has no version from 6.7 on.

    Examples
    --------
    >>> version_of("6.7.4").name, version_of("6.11.1").name, version_of("6.8+").name
    ('6.7', '6.8+', '6.8+')
    """
    found = re.match(r"(\d+)\.(\d+)(?:\.(\d+))?", text)
    if not found or (int(found[1]), int(found[2])) < (6, 7):
        raise FdsError(f"unknown version of FDS '{text}'; give 6.7 or 6.8+")
    if (int(found[1]), int(found[2])) > (6, 7):
        return NEW
    patch = int(found[3] or 0)
    return OLD._replace(
        cube_root=patch <= LAST_WITH_CUBE_ROOT, layer_order=patch <= LAST_WITH_LAYER_ORDER
    )
