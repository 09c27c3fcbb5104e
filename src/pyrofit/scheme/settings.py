"""All numbers that steer the choice of a reaction scheme, in one record that is written out."""

from dataclasses import dataclass


@dataclass(frozen=True)
class SchemeSettings:
    """Noise of a record, its discrepancy, the search, and the rule of the choice.

    Mass is counted as a fraction of the initial mass.
    """

    # Noise of one record, as repeats of one laboratory show it
    scatter: float = 5e-4
    """Standard deviation of a point about a smooth curve."""
    drift: float = 2e-3
    """Standard deviation of the balance's drift, which lasts over `drift_length_K`."""
    drift_length_K: float = 200.0
    """Distance in temperature over which the drift loses its memory."""
    repeat_shift_K: float = 0.5
    """Standard deviation of the temperature between repeats in one laboratory."""
    laboratory_shift_K: float = 5.0
    """Standard deviation of the temperature between laboratories."""

    # Discrepancy: the misfit of a scheme beyond the noise
    discrepancy_length_K: float = 15.0
    """Distance in temperature over which the misfit of a scheme lasts."""
    discrepancies: tuple[float, ...] = (
        0.0,
        1e-4,
        3e-4,
        1e-3,
        2e-3,
        3e-3,
        5e-3,
        7e-3,
        0.01,
        0.014,
        0.02,
        0.028,
        0.04,
        0.056,
        0.08,
        0.11,
        0.16,
    )
    """Sizes among which the likelihood chooses; the last is that of a first fit."""
    points: int = 120
    """Points to which a record is interpolated, even in time."""

    # Search
    most_reactions: int = 4
    """Reactions beside the early volatile at most."""
    branches: int = 3
    """Schemes that a round extends."""
    branch_bic: float = 150.0
    """A scheme this far above the least BIC is not extended."""
    random_starts: int = 4
    """Random starts of a fit beside those made from the scheme that it extends."""
    rounds: int = 3
    """Times that the discrepancy is estimated and the scheme fitted again."""
    worth_bic: float = 0.0
    """Gain in BIC that a round must bring for another to follow."""

    # Choice
    hopeless_bic: float = 500.0
    """A scheme this far above the least BIC is not used for predictions."""
    largest_margin: float = 6.0
    """Largest margin: few rates tell their own standard error badly."""
    as_good: float = 3.0
    """Log score that a scheme may lose to the best and still predict as well."""
