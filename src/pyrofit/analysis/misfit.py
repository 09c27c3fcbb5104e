"""How the optimum of the likelihood fits each signal."""

from dataclasses import dataclass

from pyrofit.results.identification import Identified


@dataclass(frozen=True)
class SignalMisfit:
    """The noise of one fitted signal, and chi-square of the optimum.

    Parameters
    ----------
    stage
        'kinetics' or 'imp'.
    experiment, signal, points
        The signal and how many points it has.
    words
        Its noise in words.
    chi2
        Chi-square of the optimum.
    """

    stage: str
    experiment: str
    signal: str
    points: int
    words: str
    chi2: float

    @property
    def per_point(self) -> float:
        """Chi-square per point, near 1 where the model fits within the noise."""
        return self.chi2 / self.points


def misfits(identified: Identified) -> list[SignalMisfit]:
    """Return the misfit of every fitted signal, by stage."""
    return [
        SignalMisfit(stage, c.experiment, c.signal, c.points, c.words, c.chi2)
        for stage, noise in identified.noise.items()
        for c in noise.channels
    ]
