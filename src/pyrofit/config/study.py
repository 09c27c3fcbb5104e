"""What a study is made of: every key with its description and unit."""

from typing import Annotated, Any, Self

from pydantic import Field, model_validator

from pyrofit.config.checks import check_study
from pyrofit.config.diagnosis import Diagnosis
from pyrofit.config.diagnosis_checks import check_diagnosis
from pyrofit.config.terms import Terms, TermSpec, channels_of
from pyrofit.effects.base import ADDED
from pyrofit.effects.substance import main_reaction
from pyrofit.model.base import Number, Part
from pyrofit.model.experiment import AnyExperiment, Gasification, Tga
from pyrofit.model.material import Material
from pyrofit.model.parameters import Parameter
from pyrofit.simulate import Accuracy
from pyrofit.solver.reference.resolution import Resolution

Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]


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

    starts: int = Field(8, ge=1, description="random starts within the limits")


class Cmaes(Part):
    """CMA-ES beside it."""

    starts: int = Field(2, ge=1, description="random starts within the limits")
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
    cost: Terms = Field(description="terms of the fitness, Eq. 5")
    sceua: Sceua = Field(default_factory=Sceua, description="budget of SCE-UA")
    least_squares: LeastSquares = Field(default_factory=LeastSquares, description="beside it")
    compare: tuple[str, ...] = Field((), description="further experiments to draw and score")
    sets: dict[str, KineticSet] = Field(
        default_factory=dict, description="published kinetics, drawn and scored beside the fit"
    )

    @property
    def channels(self) -> tuple[TermSpec, ...]:
        """Signals from which is found what the data determine, each once, all measured points."""
        return channels_of(self.cost)


class Imp(Part):
    """Stage 2: inverse modelling, repeated for every cost."""

    estimate: tuple[str, ...] = Field(min_length=1, description="parameters to estimate")
    kinetics: str = Field("described", description="'described', 'fitted', or one of kinetics.sets")
    costs: dict[Name, Terms] = Field(min_length=1, description="cost functions by name")
    repetitions: int = Field(25, ge=1, description="repetitions per cost")
    sceua: Sceua = Field(default_factory=Sceua, description="budget of SCE-UA")
    least_squares: LeastSquares = Field(default_factory=LeastSquares, description="beside it")
    cmaes: Cmaes = Field(default_factory=Cmaes, description="beside both")
    identification: dict[str, tuple[str, ...]] = Field(
        default_factory=dict,
        description="signals by gasification experiment from which is found what the data "
        "determine; none = those that the costs compare",
    )

    @property
    def channels(self) -> tuple[TermSpec, ...]:
        """Signals from which is found what the data determine, each once, all measured points.

        Signals of costs are taken from the first to the last time that any cost compares.
        """
        if self.identification:
            pairs = [(e, s) for e, signals in self.identification.items() for s in signals]
            return tuple(TermSpec(experiment=e, signal=s, kind="RMSE") for e, s in pairs)
        return channels_of([term for terms in self.costs.values() for term in terms])


class Robustness(Part):
    """Twins of known truth on which the cost functions are compared, `snakemake robustness`."""

    noise: tuple[Annotated[float, Field(gt=0.0)], ...] = Field(
        (1.0, 3.0, 10.0), min_length=1, description="noise, multiples of the measurement's"
    )
    outliers: tuple[Annotated[float, Field(gt=0.0, lt=1.0)], ...] = Field(
        (0.02, 0.1), min_length=1, description="outliers, shares of the points"
    )
    outlier_size: float = Field(
        0.5, gt=0.0, description="size of an outlier, share of the signal's range"
    )
    draws: int = Field(10, ge=1, description="twins of each level")
    starts: int = Field(3, ge=1, description="random starts of least squares for each")


class Validation(Part):
    """Stage 3: prediction of experiments that were not fitted."""

    experiments: tuple[str, ...] = Field(min_length=1, description="gasification experiments")


class Synthetic(Part):
    """How synthetic measurements are made."""

    truth: dict[str, float] = Field(description="parameter values, in the units of `parameters`")
    accuracy: Resolution = Field(
        default_factory=Resolution,
        description="numerical settings of the reference solver, which computes them",
    )
    effects: dict[str, dict[str, float]] = Field(
        default_factory=dict,
        description="effects of the catalogue that the truth has besides those of the model, with "
        "their parameters in SI units",
    )


class Published(Part):
    """Published results shown beside ours."""

    source: str = Field(description="reference")
    costs: dict[str, dict[str, tuple[float, float, float]]] = Field(
        default_factory=dict,
        description="by cost: best, mean and sigma of 'fit' and of each parameter, in its unit",
    )
    limits: dict[str, tuple[float, float]] = Field(
        default_factory=dict,
        description="lower and upper sampling limit of each parameter, in its unit",
    )


class Study(Part):
    """Everything that defines a study."""

    name: Name = Field(description="name of the results folder")
    title: str = Field("", description="title of the report")
    description: str = Field("", description="what the study is, in a sentence or two")
    seed: int = Field(1, ge=0, description="seed of everything random")
    parameters: dict[Name, Parameter] = Field(description="named numbers")
    material: Material = Field(description="components, reactions, composition")
    experiments: dict[Name, AnyExperiment] = Field(min_length=1, description="experiments by name")
    effects: dict[str, dict[str, Number] | None] = Field(
        default_factory=dict,
        description="effects of the catalogue that material and experiments have, with their "
        "parameters: a number in SI units or the name of a parameter; a strength left out is "
        "a parameter <effect>_<strength> to be estimated",
    )
    with_effects: dict[str, dict[str, Number]] = Field(
        default_factory=dict,
        description="effects that material and experiments already have, as the workflow notes "
        "them; list yours under `effects`",
    )
    accuracy: Accuracy = Field(default_factory=Accuracy, description="numerical settings")
    synthetic: Synthetic | None = Field(None, description="for signals with file: synthetic")
    kinetics: Kinetics | None = Field(None, description="stage 1, TGA")
    imp: Imp = Field(description="stage 2, inverse modelling")
    validation: Validation = Field(description="stage 3, prediction")
    robustness: Robustness = Field(
        default_factory=Robustness, description="cost functions on twins of known truth"
    )
    diagnosis: Diagnosis = Field(
        default_factory=Diagnosis, description="stage 4, which effect the model lacks"
    )
    published: Published | None = Field(None, description="published results")

    @model_validator(mode="after")
    def _check(self) -> Self:
        check_study(self)
        check_diagnosis(self)
        return self

    @property
    def is_synthetic(self) -> bool:
        """Whether any measurement is computed."""
        return any(self.is_computed(n, s) for n, e in self.experiments.items() for s in e.signals)

    def is_computed(self, experiment: str, signal: str) -> bool:
        """Whether the measurement of a signal is computed."""
        return self.experiments[experiment].signals[signal].file == "synthetic"

    @property
    def needs_macfp(self) -> tuple[str, ...]:
        """Files of the MaCFP data base that the study reads, relative to its root."""
        files = [s.file for e in self.experiments.values() for s in e.signals.values()]
        return tuple(f.removeprefix("macfp:") for f in files if f.startswith("macfp:"))

    @property
    def own_files(self) -> tuple[str, ...]:
        """Measured files of the user that the study reads."""
        files = [s.file for e in self.experiments.values() for s in e.signals.values()]
        return tuple(dict.fromkeys(f for f in files if is_own(f)))

    def kinds(self, kind: type[Tga] | type[Gasification]) -> dict[str, Any]:
        """Return the experiments of one kind by name."""
        return {n: e for n, e in self.experiments.items() if isinstance(e, kind)}

    def fixed_values(self) -> dict[str, float]:
        """Return the given parameter values in SI units."""
        return {
            name: p.value * p.factor for name, p in self.parameters.items() if p.value is not None
        }

    def true_values(self) -> dict[str, float]:
        """Return the parameter values of computed measurements in SI units."""
        truth = self.synthetic.truth if self.synthetic else {}
        return self.fixed_values() | {n: v * self.parameters[n].factor for n, v in truth.items()}

    def material_with(self, kinetics: str) -> Material:
        """Return the material with the kinetics 'described', 'fitted' or of a published set."""
        if kinetics in ("described", "fitted"):
            return self.material
        assert self.kinetics is not None
        chosen = self.kinetics.sets[kinetics]
        # What effects have set stays, too.
        ordered = main_reaction(self.material)[0] if "reaction_order" in self.with_effects else ""
        reactions = {
            name: reaction.model_copy(
                update={
                    "A_1_s": chosen.reactions[name].A_1_s,
                    "E_J_mol": chosen.reactions[name].E_J_mol,
                    "order": reaction.order if name == ordered else chosen.reactions[name].order,
                    "reference_temperature_K": None,
                    "reference_rate_1_s": None,
                }
            )
            for name, reaction in self.material.reactions.items()
            if name in chosen.reactions
        }
        # What effects have added stays.
        added = {n: r for n, r in self.material.reactions.items() if n not in reactions}
        shares = {n: s for n, s in self.material.composition.items() if n.startswith(ADDED)}
        return self.material.model_copy(
            update={
                "reactions": reactions | added,
                "composition": {**chosen.composition, **shares},
            }
        )


def is_own(file: str) -> bool:
    """Tell whether a signal's file is the user's own."""
    return file != "synthetic" and not file.startswith("macfp:")
