"""The parts of every effect: its parameters, and the change it makes to the description."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, TypeVar

from pyrofit.model.base import Part
from pyrofit.model.experiment import Experiment
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.material import Material
from pyrofit.model.slab import SlabExperiment

Numbers = Mapping[str, float | str]
"""A number in SI units, or the name of a parameter, by the effect's own names."""
Chosen = Mapping[str, float | str | tuple[str, ...]]
"""Numbers of an effect as a study gives them, with ``of``: the components that change, and
``laboratories``: those that have the effect."""
MaterialChange = Callable[[Material, Numbers], Material]
ComponentsChange = Callable[[Material, Numbers, Collection[str]], Material]
ExperimentChange = Callable[[Experiment, Numbers], Experiment]
Family = Literal["apparatus", "environment", "material"]
FAMILIES: dict[Family, str] = {
    "material": "the material; all experiments on it share it, in every laboratory",
    "apparatus": "the apparatus or the record; each laboratory has its own",
    "environment": "the surroundings of the sample; each laboratory has its own",
}
"""Families that effects belong to, in words."""
Made = TypeVar("Made", bound=Part)

ASSUMED = "assumed range"
ADDED = "extra_"
"""Beginning of the names of components and reactions that effects add."""


@dataclass(frozen=True)
class Quantity:
    """A parameter of an effect, SI units."""

    symbol: str
    """As in the effect's equation."""
    label: str
    unit: str
    lower: float
    upper: float
    value: float
    """Where the effect vanishes; of a form parameter, its default."""
    typical: float
    """A value often met; of a form parameter, another than the default."""
    source: str = ASSUMED
    plausible: tuple[float, float] | None = None
    """Strengths that a careful description leaves open, two standard deviations to either side."""


@dataclass(frozen=True)
class Need:
    """Condition on the experiments that can have an effect, and the same in words."""

    words: str
    holds: Callable[[Experiment], bool]

    def __call__(self, experiment: Experiment) -> bool:
        """Tell whether an experiment meets it."""
        return self.holds(experiment)


def need(words: str) -> Callable[[Callable[[Experiment], bool]], Need]:
    """Make a `Need` of the function that follows."""
    return lambda holds: Need(words, holds)


@need("a slab under radiant heat")
def has_slab(experiment: Experiment) -> bool:
    """Tell whether the sample of an experiment is a slab."""
    return isinstance(experiment, SlabExperiment)


@need("an experiment with a temperature programme")
def has_programme(experiment: Experiment) -> bool:
    """Tell whether the sample of an experiment follows a temperature programme."""
    return isinstance(experiment, HeatedExperiment)


@need("a slab or a heat flow")
def takes_up_heat(experiment: Experiment) -> bool:
    """Tell whether an experiment shows the heat that its sample takes up."""
    quantities = map(experiment.quantity, experiment.signals)
    return has_slab(experiment) or any("specific_heat_J_kgK" in q.rests_on for q in quantities)


@need("any experiment")
def reacts(experiment: Experiment) -> bool:
    """Tell whether the sample of an experiment reacts: always."""
    return True


@need("oxygen in the gas")
def has_oxygen(experiment: Experiment) -> bool:
    """Tell whether the gas of an experiment holds oxygen."""
    return getattr(experiment, "oxygen", 0.0) != 0.0


@need("a foil on the back")
def has_foil(experiment: Experiment) -> bool:
    """Tell whether an experiment has a foil."""
    return isinstance(experiment, SlabExperiment) and experiment.sample.foil is not None


@need("a slab without a board or plate behind it")
def has_no_backing(experiment: Experiment) -> bool:
    """Tell whether nothing opaque but a foil stands behind the sample."""
    return isinstance(experiment, SlabExperiment) and not experiment.sample.backing


@need("a back that exchanges heat")
def has_open_back(experiment: Experiment) -> bool:
    """Tell whether the back of an experiment exchanges heat."""
    if not isinstance(experiment, SlabExperiment):
        return False
    back = experiment.back
    return any(x != 0.0 for x in (back.h_W_m2K, back.h_cube_root_W_m2K43, back.emissivity))


@dataclass(frozen=True)
class Effect:
    """A physical effect.

    At its null value the strength leaves the base model exactly; ``form`` says how the effect looks
    (where a step lies, how fast it comes). ``material`` and ``experiment`` make the change; names
    of parameters may stand for numbers.
    """

    title: str
    family: Family
    """Family that it belongs to, see `FAMILIES`."""
    group: str
    """The missing phenomenon; effects of one group are forms of one another."""
    equation: str
    strength: dict[str, Quantity]
    """The one parameter that measures it."""
    form: dict[str, Quantity] = field(default_factory=dict)
    material: MaterialChange = lambda material, at: material
    components: ComponentsChange | None = None
    """Change of the named components; by default those of the material, no boards and plates."""
    experiment: ExperimentChange = lambda experiment, at: experiment
    needs: Need = has_slab
    """Condition on an experiment; those that do not meet it are not changed."""
    of_sample: bool = False
    """Whether it changes the sample: experiments on inert bodies are left as they are."""
    keeps: tuple[str, ...] = ()
    """Keys of the main reaction that it sets, and that published kinetics do not replace."""
    same_as: str = ""
    """An effect that these data cannot tell from this one."""
    distinct_in: Need | None = None
    """Condition on an experiment for it to be another model than a form of its group; where none
    meets it, the effect is no candidate. None = it is always a model of its own."""
    check: str = ""
    """The measurement that decides where its strength is not plausible, in words."""
    name: str = ""

    @property
    def is_shared(self) -> bool:
        """Whether all laboratories share it: it belongs to the material."""
        return self.family == "material"

    @property
    def quantities(self) -> dict[str, Quantity]:
        """All its parameters, the strength first."""
        return self.strength | self.form


def changed(part: Made, **update: Any) -> Made:
    """Return a part with some values changed, checked like a new one."""
    return type(part)(**{**dict(part), **update})


def on(place: str, takes: Mapping[str, str], **constant: Any) -> ExperimentChange:
    """Return a change that sets keys of a part (dotted path; "" = the experiment itself).

    ``takes`` maps a key of the part to the parameter of the effect that it takes, ``constant`` to
    a value. The change raises ``ValueError`` where the description has set such a key already.
    """
    path = place.split(".") if place else []

    def change(experiment: Experiment, at: Numbers) -> Experiment:
        update = {key: at[own] for key, own in takes.items()} | constant
        made: Experiment = _set(experiment, path, update)
        return made

    return change


def _set(part: Any, path: list[str], update: dict[str, Any]) -> Any:
    if path and isinstance(part, Mapping):
        return {**part, path[0]: _set(part[path[0]], path[1:], update)}
    if path:
        return changed(part, **{path[0]: _set(getattr(part, path[0]), path[1:], update)})
    for key in update:
        present = getattr(part, key)
        if present != type(part).model_fields[key].default:
            how = "estimates" if isinstance(present, str) else "sets"
            raise ValueError(
                f"the study or another effect already {how} {key} ({present}); leave out one of "
                "the two"
            )
    return changed(part, **update)
