"""What a study can take from a published material: numbers for its parameters, and why not more."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from pyrofit.config.resolve import diagnosed_material
from pyrofit.config.uses import HEATS, parameters_in
from pyrofit.errors import DataError
from pyrofit.model.base import named_by, numbers
from pyrofit.model.material import Material, Reaction
from pyrofit_compare.published import PublishedSet
from pyrofit_exchange.macfp.forms import Nothing
from pyrofit_exchange.macfp.material import has_heat, material_of
from pyrofit_explore.model import ExploredModel
from pyrofit_explore.sets import reference_temperature

PROPERTIES = (
    "density_kg_m3",
    "conductivity_W_mK",
    "specific_heat_J_kgK",
    "emissivity",
    "absorption_1_m",
)
"""Keys of a component that a set gives."""
CURVE = "part of a curve or an expression here"
VARIES = "varies with temperature there"
SEVERAL = "several values there"
LACKING = "not in the set"
OTHERS = "other components there"
KINETICS = "kinetics alone there"


class Taken(NamedTuple):
    """Values by parameter in the units of the study, and a line that tells what is taken."""

    values: dict[str, float]
    said: str


def what_can_be_taken(model: ExploredModel, one: PublishedSet) -> Taken:
    """Return what a study can take from a published set.

    A parameter is taken that stands by itself for a number of the set, clipped to its limits.
    Reactions correspond in their order, if both have as many and the same scheme. Else a parameter
    of all virgin components, or of all residues, takes the one number that those of the set have.

    Parameters
    ----------
    model
        The study, for its material and the parameters that the page shows.
    one
        The set.
    """
    study = model.study
    own = diagnosed_material(study)
    names = [name for name in model.problem.names if name in parameters_in(own)]
    try:
        match = _Match(own, Material.model_validate(material_of(one.strict)), one)
    except (DataError, ValueError) as error:
        return Taken({}, f"MaCFP: {one.name} cannot be read as a material: {error}")
    values, told = {}, []
    left: dict[str, list[str]] = {}
    for name in names:
        found = match.value(name)
        if isinstance(found, str):
            left.setdefault(found, []).append(name)
            continue
        p = study.parameters[name]
        low, high = p.bounds_si
        values[name] = min(max(found, low), high) / p.factor
        unit = "" if p.unit == "-" else f" {p.unit}"
        clipped = f", a limit ({found / p.factor:.4g} there)" if not low <= found <= high else ""
        told.append(f"{name} {values[name]:.4g}{unit}{clipped}")
    reasons = [f"{', '.join(of)} ({why})" for why, of in left.items()]
    if len(names) < len(model.problem.names):
        reasons.append("those of the apparatus")
    what, rest = ("; ".join(some) or "nothing" for some in (told, reasons))
    return Taken(values, f"MaCFP: {one.name}. Taken: {what}. Not taken: {rest}.")


@dataclass(frozen=True)
class _Match:
    """The materials of a study and of a set, side by side."""

    own: Material
    given: Material
    one: PublishedSet

    @cached_property
    def scheme(self) -> tuple[dict[str, str], dict[str, str], str]:
        """Components and reactions of the set by those of the study, or why there are none."""
        ours, theirs = self.own.reactions, self.given.reactions
        if len(ours) != len(theirs):
            return {}, {}, f"{len(ours)} reactions here, {len(theirs)} there"
        to: dict[str, str] = {}
        back: dict[str, str] = {}
        for a, b in zip(ours.values(), theirs.values(), strict=True):
            pairs = [(a.reactant, b.reactant), *zip(a.products, b.products, strict=False)]
            for ours_is, theirs_is in pairs:
                known = to.setdefault(ours_is, theirs_is), back.setdefault(theirs_is, ours_is)
                if known != (theirs_is, ours_is):
                    return {}, {}, "another scheme of reactions there"
        if {to[c] for c in _virgin(self.own) if c in to} != _virgin(self.given) & set(back):
            return {}, {}, "another scheme of reactions there"
        return to, dict(zip(ours, theirs, strict=True)), ""

    def value(self, name: str) -> float | str:
        """Return the SI value that a set gives for a parameter, or why it gives none.

        The numbers of virgin components decide, if the parameter stands for some of them.
        """
        found = list(self._found(name))
        deciding = [v for v, is_virgin in found if is_virgin] or [v for v, _ in found]
        values = [v for v in deciding if isinstance(v, float)]
        reasons = [v for v in deciding if isinstance(v, str)]
        if not values or SEVERAL in reasons or VARIES in reasons:
            return reasons[0]
        return values[0] if all(v == values[0] for v in values) else SEVERAL

    def _found(self, name: str) -> Iterator[tuple[float | str, bool]]:
        """Yield value or reason of each place of a parameter, and whether it is a virgin one."""
        virgin = _virgin(self.own)
        for of, share in self.own.composition.items():
            if share == name:
                to, _, why = self.scheme
                yield (self.given.composition[to[of]] if of in to else why or OTHERS), True
        for of, component in self.own.components.items():
            for at, leaf, _ in numbers(component):
                if name in named_by(leaf):
                    value = self._property(of, at, name) if leaf == name else CURVE
                    yield value, of in virgin
        for of, reaction in self.own.reactions.items():
            for at, leaf, _ in numbers(reaction):
                if name in named_by(leaf):
                    yield (self._of_reaction(of, at, name) if leaf == name else CURVE), True

    def _property(self, of: str, at: str, name: str) -> float | str:
        if at not in PROPERTIES:
            return CURVE if at.split(".")[0] in PROPERTIES else LACKING
        if not has_heat(self.one.strict):
            return KINETICS
        theirs = [self.given.components[c] for c in self._counterparts(of, at, name)]
        values = [getattr(c, at) for c in theirs]
        if not values:
            return OTHERS
        if any(v is None for v in values):
            return LACKING
        expands = at == "density_kg_m3" and any(c.expansion != 1.0 for c in theirs)
        if expands or not all(isinstance(v, float) for v in values):
            return VARIES
        return values[0] if all(v == values[0] for v in values) else SEVERAL

    def _counterparts(self, of: str, at: str, name: str) -> set[str]:
        """Return the components of the set that one of the study stands for."""
        to = self.scheme[0]
        if to:
            return {to[of]} & set(self.given.components) if of in to else set()
        for group in (_virgin, _residues):
            ours = group(self.own)
            if of in ours and all(getattr(self.own.components[c], at) == name for c in ours):
                return group(self.given)
        return set()

    def _of_reaction(self, of: str, at: str, name: str) -> float | str:
        ours = self.own.reactions[of]
        to, reactions, why = self.scheme
        if at in HEATS:
            return self._heat(of, at, name)
        if not reactions:
            return why
        theirs = self.given.reactions[reactions[of]]
        if at == "reference_temperature_K":
            assert isinstance(theirs.A_1_s, float)
            assert isinstance(theirs.E_J_mol, float)
            T = reference_temperature(ours, theirs.A_1_s, theirs.E_J_mol)
            return "its rate is never that of the study" if T is None else T
        if at in ("A_1_s", "E_J_mol", "order"):
            return _number(theirs, at)
        if at.startswith("products."):
            product = to.get(at.removeprefix("products."), "")
            return theirs.products.get(product, LACKING)
        return LACKING

    def _heat(self, of: str, at: str, name: str) -> float | str:
        """Return a heat of a reaction; of all reactions, where the set has but one."""
        strict, ours = self.one.strict, self.own.reactions.values()
        if not has_heat(strict):
            return KINETICS
        assert strict.thermodynamics is not None
        of_gas = strict.combustion.heat if strict.combustion else None
        form = strict.thermodynamics.heat_of_pyrolysis if at == HEATS[0] else of_gas
        if form is None or isinstance(form, Nothing):
            return LACKING
        _, reactions, why = self.scheme
        if reactions:
            return _number(self.given.reactions[reactions[of]], at)
        virgin, theirs = _virgin(self.own), list(self.given.reactions.values())
        whole = all(getattr(r, at) == name and r.reactant in virgin for r in ours)
        return _number(theirs[0], at) if whole and len(theirs) == 1 else why


def _number(reaction: Reaction, at: str) -> float | str:
    value: float | str = getattr(reaction, at)
    return value


def _virgin(material: Material) -> set[str]:
    return {name for name, share in material.composition.items() if share != 0.0}


def _residues(material: Material) -> set[str]:
    """Return the components that are formed and do not react."""
    reactions: Mapping[str, Reaction] = material.reactions
    formed = {name for r in reactions.values() for name in r.products}
    return formed - {r.reactant for r in reactions.values()}
