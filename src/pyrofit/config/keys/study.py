"""Parts of a study: every key with its description and unit."""

from html import escape
from typing import Any, TypeVar

from pydantic import Field

from pyrofit.config.keys.diagnosis import Diagnosis
from pyrofit.config.keys.known import Known
from pyrofit.config.keys.stages import Imp, Kinetics, Name, Validation
from pyrofit.config.keys.steps import Steps
from pyrofit.effects import known_effects
from pyrofit.effects.base import ADDED
from pyrofit.effects.substance import main_reaction
from pyrofit.experiments import AnyExperiment, kind_of
from pyrofit.experiments.base import Stage
from pyrofit.model.accuracy import Accuracy, Resolution
from pyrofit.model.base import Number, Part
from pyrofit.model.material import Material
from pyrofit.model.parameters import Parameter

Options = TypeVar("Options", bound=Part)


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
    description: str = Field("", description="the study in a sentence or two")
    seed: int = Field(1, ge=0, description="seed of everything random")
    plugins: tuple[str, ...] = Field(
        (),
        description="folders with effects, quantities and costs of your own, relative to the "
        "study file: effects/*.py, quantities/*.py and costs/*.py",
    )
    parameters: dict[Name, Parameter] = Field(description="named numbers")
    known: dict[str, Known] = Field(
        default_factory=dict,
        description="measured values of estimated parameters, with standard deviations, by "
        "parameter",
    )
    material: Material = Field(
        Material(components={}, composition={}),
        description="components, reactions, composition; required but where external programs "
        "simulate all experiments",
    )
    experiments: dict[Name, AnyExperiment] = Field(min_length=1, description="experiments by name")
    effects: dict[str, dict[str, Number | tuple[str, ...]] | None] = Field(
        default_factory=dict,
        description="effects of the catalogue that material and experiments have, with their "
        "parameters. Each is a number in SI units or the name of a parameter. A strength "
        "left out is a parameter <effect>_<strength> to be estimated. `of` lists the "
        "components whose property changes, by default those of the material, no boards "
        "and plates. `laboratories` lists the laboratories whose experiments have an "
        "effect of apparatus or surroundings, by default all",
    )
    with_effects: dict[str, dict[str, Number | tuple[str, ...]]] = Field(
        default_factory=dict,
        description="effects that material and experiments already have, as the workflow notes "
        "them; list yours under `effects`",
    )
    accuracy: Accuracy = Field(default_factory=Accuracy, description="numerical settings")
    synthetic: Synthetic | None = Field(None, description="for signals with file: synthetic")
    kinetics: Kinetics | None = Field(None, description="stage 1, TGA")
    imp: Imp = Field(description="stage 2, inverse modelling")
    validation: Validation = Field(description="stage 3, prediction")
    diagnosis: Diagnosis = Field(
        default_factory=Diagnosis, description="stage 4, which effect the model lacks"
    )
    steps: Steps = Field(
        default_factory=Steps, description="options of the steps that run when asked for"
    )
    published: Published | None = Field(None, description="published results")

    def options(self, kind: type[Options]) -> Options:
        """Return the options of the step that declares them as ``kind``."""
        return next(part for _, part in self.steps if isinstance(part, kind))

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

    def __repr__(self) -> str:
        """List parameters and experiments; the keys of the file are in ``model_dump()``."""
        lines = [f"study '{self.name}'"]
        lines += [f"  parameter {n}: {p.words}" for n, p in self.parameters.items()]
        lines += [
            f"  experiment {n}: {kind_of(e).words}; {', '.join(e.signals)}"
            for n, e in self.experiments.items()
        ]
        return "\n".join(lines)

    __str__ = __repr__

    def _repr_html_(self) -> str:
        return f"<pre>{escape(repr(self))}</pre>"

    def of_stage(self, stage: Stage) -> dict[str, Any]:
        """Return the experiments that a stage can fit, by name."""
        return {n: e for n, e in self.experiments.items() if self.serves(n, stage)}

    def serves(self, name: str, stage: Stage) -> bool:
        """Tell whether a stage can fit an experiment.

        Where all experiments are of heated samples and there is no stage for them, as in a study of
        kinetics alone, the inverse modelling fits them.
        """
        own = kind_of(self.experiments[name]).stage
        if self.kinetics is None and stage == "imp" and own != stage:
            return all(kind_of(e).stage == own for e in self.experiments.values())
        return own == stage

    def fixed_values(self) -> dict[str, float]:
        """Return the given parameter values in SI units."""
        return {
            name: p.value * p.factor for name, p in self.parameters.items() if p.value is not None
        }

    def search_limits(self, name: str) -> tuple[float, float]:
        """Return the limits within which a parameter is estimated, in its unit.

        Its own limits, and by default value -+ 3 sd where a value is known.
        """
        p, known = self.parameters[name], self.known.get(name)
        if p.lower is None or p.upper is None:
            raise ValueError("the parameter has no limits")
        if known is None:
            return p.lower, p.upper
        reach = known.within_sds * known.sd
        return max(p.lower, known.value - reach), min(p.upper, known.value + reach)

    def true_values(self) -> dict[str, float]:
        """Return the parameter values of computed measurements in SI units."""
        truth = self.synthetic.truth if self.synthetic else {}
        return self.fixed_values() | {n: v * self.parameters[n].factor for n, v in truth.items()}

    def kept_of_kinetics(self) -> dict[str, tuple[str, ...]]:
        """Return by effect of the model the keys of the main reaction that are its own."""
        effects = known_effects()
        return {name: effects[name].keeps for name in self.with_effects if effects[name].keeps}

    def material_with(self, kinetics: str) -> Material:
        """Return the material with the kinetics 'described', 'fitted' or of a published set."""
        if kinetics in ("described", "fitted"):
            return self.material
        assert self.kinetics is not None
        chosen = self.kinetics.sets[kinetics]
        # Values that effects have set stay, too.
        kept = {key for keys in self.kept_of_kinetics().values() for key in keys}
        main = main_reaction(self.material)[0] if kept else ""
        reactions = {
            name: reaction.model_copy(
                update={
                    "reference_temperature_K": None,
                    "reference_rate_1_s": None,
                    **chosen.reactions[name].model_dump(exclude=kept if name == main else None),
                }
            )
            for name, reaction in self.material.reactions.items()
            if name in chosen.reactions
        }
        # Reactions and components that effects have added stay.
        added = {n: r for n, r in self.material.reactions.items() if n not in reactions}
        shares = {n: s for n, s in self.material.composition.items() if n.startswith(ADDED)}
        return self.material.model_copy(
            update={
                "reactions": reactions | added,
                "composition": {**chosen.composition, **shares},
            }
        )


IN_MEMORY = "memory"
"""In the place of a file: the series is given in Python."""


def is_own(file: str) -> bool:
    """Tell whether a signal's file is the user's own."""
    return file not in ("synthetic", IN_MEMORY) and not file.startswith("macfp:")
