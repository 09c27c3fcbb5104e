"""The likely cause of records beside the limits, and the kinds of causes."""

from dataclasses import dataclass

from pyrofit.steps.preview.changes import Change

TEMPERATURE, FLUX, THICKNESS = "unit of temperature", "flux", "thickness"
CLOCK, RATE, SWAPPED = "clock", "heating rate", "swapped files"
SAMPLE, SURROUNDINGS, LIMITS = "sample area or mass", "gas or wall temperature", "limits"
BASELINE, PLACE = "baseline of the heat flow", "place of a thermocouple"
WEIGHT, ZERO = "mass of the samples", "zero of the balance"
ORDER = (
    WEIGHT,
    TEMPERATURE,
    FLUX,
    THICKNESS,
    CLOCK,
    RATE,
    SWAPPED,
    ZERO,
    SAMPLE,
    BASELINE,
    PLACE,
    SURROUNDINGS,
    LIMITS,
)
"""Causes, the more usual ones first."""


@dataclass(frozen=True, eq=False)
class LikelyCause:
    """A correction of some experiments, and what it means.

    Parameters
    ----------
    cause
        One of `ORDER`.
    places
        Names of the experiments that it changes, or the parameter whose limits it widens.
    words
        The error in words.
    change
        From the case as described to the corrected one.
    """

    cause: str
    places: tuple[str, ...]
    words: str
    change: Change
