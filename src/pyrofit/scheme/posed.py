"""A scheme as a study: its material, its parameters with limits, and the records."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from pyrofit.config import Study, parameters_in
from pyrofit.config.check.expressions import ends_of
from pyrofit.config.uses import parameters_of_heated
from pyrofit.effects import known_effects
from pyrofit.effects.base import changed
from pyrofit.effects.substance import main_reaction
from pyrofit.errors import StudyError
from pyrofit.model.base import named_by
from pyrofit.model.experiment import Experiment
from pyrofit.model.material import Material, Reaction
from pyrofit.model.parameters import Parameter
from pyrofit.scheme.arrangements import ARRANGEMENTS
from pyrofit.scheme.arrangements.base import PREFIX, REFERENCE_RATE_1_S, Limits, Template
from pyrofit.scheme.masses import masses_of
from pyrofit.scheme.records import MassRecord
from pyrofit.scheme.schemes import Scheme
from pyrofit.scheme.settings import SchemeSettings

OWN = "study"
"""Identifier of the scheme that the study describes."""
VOLATILE = "volatile"
LAG = "tga_lag"
ENERGY = 30.0, 400.0
"""Limits of an activation energy [kJ/mol]."""
ORDER = 0.3, 4.0
"""Limits of an order; published ones of PMMA are 0.87 to 3.56."""
CATALYSIS = 0.0, 100.0
"""Limits of the factor of autocatalysis."""
_OFFSET = 4.0
"""Limits of a laboratory's temperature offset, in standard deviations."""


@dataclass(frozen=True, eq=False)
class Posed:
    """A scheme as it is fitted.

    Parameters
    ----------
    scheme
        The scheme; None of the one that the study describes.
    study
        The study with the scheme's material and parameters, and with lag and offsets.
    names
        Estimated parameters.
    offsets
        Names of the temperature offsets among them.
    """

    scheme: Scheme | None
    study: Study
    names: tuple[str, ...]
    offsets: tuple[str, ...]

    @property
    def count(self) -> int:
        """Number of parameters, nuisance offsets not counted."""
        return len(self.names) - len(self.offsets)

    @property
    def name(self) -> str:
        """Identifier."""
        return self.scheme.name if self.scheme else OWN

    @property
    def words(self) -> str:
        """The scheme in words."""
        return self.scheme.words if self.scheme else "the scheme of the study"


def template_of(study: Study) -> Template:
    """Return the data that schemes take from the material of a study.

    Raises
    ------
    StudyError
        No component of the virgin material reacts.
    """
    material = study.material
    try:
        _, reaction = main_reaction(material)
    except ValueError as error:
        raise StudyError(f"study '{study.name}': {error}; give the material a reaction") from None
    reacting = {r.reactant for r in material.reactions.values()}
    products = {n: y for n, y in reaction.products.items() if n not in reacting}
    return Template(
        reactant=reaction.reactant,
        component=material.components[reaction.reactant],
        reaction=changed(reaction, products={}),
        products=products,
        inert={n: c for n, c in material.components.items() if n not in reacting},
        composition={n: s for n, s in material.composition.items() if n not in reacting},
        residue=sum(max(ends_of(study, y)) for y in products.values()),
    )


def pose_scheme(
    study: Study, scheme: Scheme, records: Sequence[MassRecord], settings: SchemeSettings
) -> Posed:
    """Return a scheme as it is fitted to records of a study."""
    template = template_of(study)
    limits = _limits(scheme, template, [r for r in records if r.calibrated])
    material = _material(scheme, template)
    extra, offsets = _of_records(study, scheme, records, settings)
    limits |= extra
    yields = [name for y in template.products.values() for name in sorted(named_by(y))]
    free = [n for n in dict.fromkeys(yields) if study.parameters[n].lower is not None]
    parameters = dict(study.parameters) | {
        PREFIX + name: Parameter(unit=x.unit, lower=x.lower, upper=x.upper, label=x.label)
        for name, x in limits.items()
    }
    experiments: dict[str, Experiment] = dict(study.experiments)
    for record in records:
        experiments[record.experiment] = _placed(study, scheme, record, offsets)
    made = study.model_copy(
        update={"material": material, "parameters": parameters, "experiments": experiments}
    )
    nuisances = tuple(dict.fromkeys(offsets.values()))
    named = [PREFIX + name for name in limits if PREFIX + name not in nuisances]
    return Posed(scheme, made, _with_needed(made, (*named, *free, *nuisances), records), nuisances)


def own(study: Study, records: Sequence[MassRecord]) -> Posed:
    """Return the study's own scheme as it is fitted: with the parameters of its kinetics."""
    return Posed(None, study, _with_needed(study, masses_of(study).estimate, records), ())


def _with_needed(
    study: Study, names: tuple[str, ...], records: Sequence[MassRecord]
) -> tuple[str, ...]:
    """Return names with those of further parameters that records use and that have no value."""
    used = parameters_of_heated(study.material)
    used |= parameters_in(*(study.experiments[r.experiment] for r in records))
    return (*names, *sorted(used - set(names) - set(study.fixed_values())))


def _limits(scheme: Scheme, template: Template, records: Sequence[MassRecord]) -> dict[str, Limits]:
    """Return the limits of the scheme's parameters; temperatures are those of the records."""
    first = min(r.temperature_at(0.9) for r in records) - 80.0
    last = max(r.temperature_at(0.1) for r in records) + 40.0
    limits: dict[str, Limits] = {}
    for i in range(1, scheme.reactions + 1):
        if i > 1:
            limits |= ARRANGEMENTS[scheme.arrangement].shares(i, scheme.reactions, template)
        words = f"of reaction {i}"
        # A small component may react before the main loss.
        low = first if i == 1 else min(first, 400.0)
        limits[f"T_{i}"] = Limits("K", low, last, f"reference temperature {words}")
        limits[f"E_{i}"] = Limits("kJ/mol", *ENERGY, f"activation energy {words}")
        if scheme.order:
            limits[f"n_{i}"] = Limits("-", *ORDER, f"order {words}")
    if scheme.catalysis:
        limits["K"] = Limits("-", *CATALYSIS, "factor of autocatalysis")
    if scheme.volatile:
        for key, q in known_effects()[VOLATILE].quantities.items():
            limits[f"volatile_{key}"] = Limits(q.unit, q.lower, q.upper, q.label)
    return limits


def _material(scheme: Scheme, template: Template) -> Material:
    reactions = [_reaction(template, i, scheme) for i in range(1, scheme.reactions + 1)]
    material = ARRANGEMENTS[scheme.arrangement].build(template, reactions)
    if scheme.volatile:
        effect = known_effects()[VOLATILE]
        at = {key: f"{PREFIX}volatile_{key}" for key in effect.quantities}
        material = effect.material(material, at)
    return material


def _reaction(template: Template, i: int, scheme: Scheme) -> Reaction:
    return changed(
        template.reaction,
        A_1_s=None,
        E_J_mol=f"{PREFIX}E_{i}",
        reference_temperature_K=f"{PREFIX}T_{i}",
        reference_rate_1_s=REFERENCE_RATE_1_S,
        order=f"{PREFIX}n_{i}" if scheme.order else 1.0,
        catalysis=f"{PREFIX}K" if scheme.catalysis else 0.0,
    )


def _of_records(
    study: Study, scheme: Scheme, records: Sequence[MassRecord], settings: SchemeSettings
) -> tuple[dict[str, Limits], dict[str, str]]:
    """Return limits of lag and offsets, and the offset's parameter by laboratory."""
    limits: dict[str, Limits] = {}
    if scheme.lag:
        q = next(iter(known_effects()[LAG].strength.values()))
        limits["lag"] = Limits(q.unit, q.lower, q.upper, q.label)
    free = [r for r in records if not _has_offset(study, r)]
    laboratories = list(dict.fromkeys(r.laboratory for r in free))
    if len(laboratories) < 2:
        return limits, {}
    reach = _OFFSET * settings.laboratory_shift_K
    offsets = {}
    for i, laboratory in enumerate(laboratories, 1):
        words = f"temperature offset of {laboratory or 'the other records'}"
        limits[f"offset_{i}"] = Limits("K", -reach, reach, words)
        offsets[laboratory] = f"{PREFIX}offset_{i}"
    return limits, offsets


def _placed(
    study: Study, scheme: Scheme, record: MassRecord, offsets: Mapping[str, str]
) -> Experiment:
    """Return the experiment of a record with lag and offset, where the scheme has them."""
    update: dict[str, str] = {}
    if scheme.lag:
        update["lag_s"] = f"{PREFIX}lag"
    if record.laboratory in offsets and not _has_offset(study, record):
        update["temperature_offset_K"] = offsets[record.laboratory]
    experiment: Experiment = study.experiments[record.experiment]
    return changed(experiment, **update) if update else experiment


def _has_offset(study: Study, record: MassRecord) -> bool:
    """Tell whether the study gives the temperature of a record an offset of its own."""
    return bool(study.experiments[record.experiment].temperature_offset_K != 0.0)  # type: ignore[union-attr]


def may_lag(study: Study, records: Sequence[MassRecord]) -> bool:
    """Tell whether no record has a lag already."""
    return all(study.experiments[r.experiment].lag_s == 0.0 for r in records)  # type: ignore[union-attr]
