"""Request for a submission."""

from typing import NamedTuple


class Submission(NamedTuple):
    """A request for a submission.

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
