"""Materials of FDS as published parameter sets."""

from pathlib import Path
from typing import NamedTuple

from pyrofit.errors import DataError
from pyrofit.model.material import Material
from pyrofit_exchange.fds.imported import import_fds
from pyrofit_exchange.fds.parse import read_namelists
from pyrofit_exchange.fds.versions import NEW, FdsError
from pyrofit_exchange.macfp.material import strict_of
from pyrofit_exchange.macfp.schema import StrictSet


class SetOfFds(NamedTuple):
    """A parameter set from a file of FDS, and what is not taken over."""

    strict: StrictSet
    remarks: tuple[str, ...]


def set_of_fds(path: Path) -> SetOfFds:
    """Return the front layer of the first SURF line of a file of FDS 6.8 or newer.

    Its laboratory is the ``FYI`` of the first MATL line.

    Raises
    ------
    DataError
        The file describes no material, or the data base has no words for a part of it.
    """
    text = path.read_text(encoding="utf-8-sig", errors="replace")
    try:
        found = import_fds(text, str(path), NEW)
        first = next(keys for group, keys, _ in read_namelists(text, str(path)) if group == "MATL")
    except FdsError as error:
        raise DataError(str(error)) from None
    material = Material.model_validate(found.material)
    about = {
        "Material": str(first.get("ID", [path.stem])[0]),
        "Lab": str(first.get("FYI", ["FDS"])[0]),
        "Calibration": [],
    }
    return SetOfFds(strict_of(material, about), found.remarks)
