"""What a submission is asked for."""

from typing import NamedTuple


class Asked(NamedTuple):
    """What is asked for.

    Parameters
    ----------
    institute, material
        Names of the laboratory and of the material, as they stand in names of files.
    forms
        Workshops: 3, 4 or both.
    like
        Experiment whose apparatus the slabs of the third workshop have; nothing = ideal.
    """

    institute: str
    material: str
    forms: tuple[int, ...]
    like: str
