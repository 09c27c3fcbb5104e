"""What differs between versions of FDS: names of keys, and defaults that change a curve."""

import re
from typing import NamedTuple

from pyrofit.errors import PyrofitError


class FdsError(PyrofitError):
    """FDS, or a file of it, cannot be used."""


class Version(NamedTuple):
    """Versions of FDS that read the same input.

    Parameters
    ----------
    name
        What it is called on the command line.
    back_gas
        Key of the temperature behind the sample. From 6.8 on TMP_BACK fixes the back surface.
    adjusts_heat
        Whether heats of reaction follow the component enthalpies unless ADJUST_H forbids it.
    locks_step
        Whether the time step is held by LOCK_TIME_STEP.
    cube_root
        Whether the coefficient of natural convection can be given.
    furnace
        Whether `Temp` of a TGA is the furnace, and `T_surf` the sample.
    """

    name: str
    back_gas: str
    adjusts_heat: bool
    locks_step: bool
    cube_root: bool
    furnace: bool


OLD = Version("6.7", "TMP_BACK", False, False, True, False)
NEW = Version("6.8+", "TMP_GAS_BACK", True, True, False, True)


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
    found = re.match(r"(\d+)\.(\d+)", text)
    if not found or (int(found[1]), int(found[2])) < (6, 7):
        raise FdsError(f"unknown version of FDS '{text}'; give 6.7 or 6.8+")
    return OLD if (int(found[1]), int(found[2])) == (6, 7) else NEW
