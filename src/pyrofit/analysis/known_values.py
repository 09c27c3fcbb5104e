"""Known values of parameters beside their estimates."""

from collections.abc import Iterable
from dataclasses import dataclass

from pyrofit.analysis.estimates import Estimated
from pyrofit.config import Study
from pyrofit.results.identification import stages_of

FAR = 2.0
"""Standard deviations from its known value beyond which an estimate is far from it."""


@dataclass(frozen=True)
class KnownBesideEstimate:
    """A parameter's known value with standard deviation and source, and its estimate.

    Values are in the parameter's unit.
    """

    value: float
    sd: float
    source: str
    estimate: Estimated

    @property
    def away_sd(self) -> float:
        """(estimate - value) / sd."""
        return (self.estimate.value - self.value) / self.sd

    @property
    def is_far(self) -> bool:
        """Whether the estimate is more than `FAR` standard deviations from the known value."""
        return abs(self.away_sd) > FAR


def known_values(study: Study, estimates: Iterable[Estimated]) -> list[KnownBesideEstimate]:
    """Return the known values of those estimated parameters that have one."""
    found = [(study.known[e.name], e) for e in estimates if e.name in study.known]
    return [KnownBesideEstimate(known.value, known.sd, known.source, e) for known, e in found]


def has_known(study: Study) -> bool:
    """Tell whether a stage other than the diagnosis estimates a parameter with a known value."""
    return any(name in study.known for names in stages_of(study).values() for name in names)
