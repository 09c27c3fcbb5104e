"""The stages of a study: fits, prediction, and the comparison of costs on twins."""

from typing import Annotated

from pydantic import Field

from pyrofit.config.keys.terms import Terms, TermSpec, channels_of
from pyrofit.model.base import Part

Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]


MOST = 1_000_000
"""Largest count of starts."""
MOST_REPETITIONS = 100_000
"""Largest count of repetitions: each is a job of its own for each cost, to be planned first."""


class Sceua(Part):
    """Budget of SPOTPY's SCE-UA."""

    complexes: int | None = Field(
        None, ge=1, description="number of complexes; none = number of parameters, as PROPTI"
    )
    generations: int = Field(
        20, ge=3, description="generations, the burn-in counted as the first, as PROPTI counts"
    )


class LeastSquares(Part):
    """Multistart bounded least squares beside it."""

    starts: int = Field(8, ge=1, le=MOST, description="random starts within the limits")


class Cmaes(Part):
    """CMA-ES beside it."""

    starts: int = Field(2, ge=1, le=MOST, description="random starts within the limits")
    calls: int = Field(
        3000, ge=10, description="model calls after which a start begins no further generation"
    )


class KineticValues(Part):
    """Published kinetics of one reaction."""

    A_1_s: float = Field(gt=0.0, description="pre-exponential factor A [1/s]")
    E_J_mol: float = Field(ge=0.0, description="activation energy E [J/mol]")
    order: float = Field(1.0, ge=0.0, description="reaction order n [-]")


class KineticSet(Part):
    """Kinetics to compare with, or to use instead of fitted ones."""

    reactions: dict[str, KineticValues] = Field(description="by reaction of the material")
    composition: dict[str, float | str] = Field(description="mass fractions of the virgin material")


class Kinetics(Part):
    """Stage 1: fit of the kinetics to TGA."""

    estimate: tuple[str, ...] = Field(min_length=1, description="parameters to estimate")
    cost: Terms = Field(description="terms of the cost, a weighted sum, Eq. 5 of Lauer et al.")
    sceua: Sceua = Field(default_factory=Sceua, description="budget of SCE-UA")
    least_squares: LeastSquares = Field(
        default_factory=LeastSquares, description="least squares, in addition to SCE-UA"
    )
    compare: tuple[str, ...] = Field((), description="further experiments to draw and score")
    sets: dict[str, KineticSet] = Field(
        default_factory=dict, description="published kinetics, drawn and scored beside the fit"
    )

    @property
    def channels(self) -> tuple[TermSpec, ...]:
        """Signals of the analysis of identifiability, each once, all measured points."""
        return channels_of(self.cost)


class Imp(Part):
    """Stage 2: inverse modelling, repeated for every cost."""

    estimate: tuple[str, ...] = Field(min_length=1, description="parameters to estimate")
    kinetics: str = Field("described", description="'described', 'fitted', or one of kinetics.sets")
    costs: dict[Name, Terms] = Field(min_length=1, description="cost functions by name")
    repetitions: int = Field(25, ge=1, le=MOST_REPETITIONS, description="repetitions per cost")
    sceua: Sceua = Field(default_factory=Sceua, description="budget of SCE-UA")
    least_squares: LeastSquares = Field(
        default_factory=LeastSquares, description="least squares, in addition to SCE-UA"
    )
    cmaes: Cmaes = Field(default_factory=Cmaes, description="CMA-ES, in addition to both")
    identification: dict[str, tuple[str, ...]] = Field(
        default_factory=dict,
        description="signals by experiment for the analysis of identifiability; "
        "none = those that the costs compare",
    )

    @property
    def channels(self) -> tuple[TermSpec, ...]:
        """Signals of the analysis of identifiability, each once, all measured points.

        Signals of costs are taken from the first to the last time that any cost compares.
        """
        if self.identification:
            pairs = [(e, s) for e, signals in self.identification.items() for s in signals]
            return tuple(TermSpec(experiment=e, signal=s, kind="RMSE") for e, s in pairs)
        return channels_of([term for terms in self.costs.values() for term in terms])


class Validation(Part):
    """Stage 3: prediction of experiments that were not fitted."""

    experiments: tuple[str, ...] = Field(
        min_length=1,
        description="experiments to predict: slabs or external ones; TGA, DSC or MCC in a study "
        "without slabs",
    )
