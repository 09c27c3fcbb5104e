"""The boxes that random sets are drawn from."""

from functools import cache
from pathlib import Path
from typing import NamedTuple

from pyrofit.config import read_study
from pyrofit.effects import known_effects
from pyrofit.effects.apply import with_effects
from pyrofit.experiments import Gasification
from pyrofit.model.material import Material

ROOT = Path(__file__).parents[1]
SEED = 2020
BATCH = 64
"""Sets that are drawn and run together."""
BASES = (("paper", "Table 3"), ("paper", "described"), ("pmma", "described"))
"""Study and kinetics: published ones, or with the limits of their parameters."""
DURATION_S = {"capa_25": 1700.0, "capa_60": 420.0}

Limits = dict[str, tuple[float, float]]


class Case(NamedTuple):
    """A box that sets are drawn from."""

    study: str
    kinetics: str
    effect: str
    experiment: str

    @property
    def words(self) -> str:
        """Name in tables."""
        return " / ".join(self)


@cache
def cases() -> list[Case]:
    """Return all boxes; an effect the description has already, or cannot have, is left out."""
    found = []
    for study, kinetics in BASES:
        for effect in ("", *known_effects()):
            for experiment in DURATION_S:
                case = Case(study, kinetics, effect, experiment)
                try:
                    described(case)
                except ValueError:
                    continue
                found.append(case)
    return found


@cache
def described(case: Case) -> tuple[Gasification, Material, Limits]:
    """Return experiment, material and limits of a box in SI units."""
    study = read_study(ROOT / "config" / f"{case.study}.yaml")
    names = study.imp.estimate if case.kinetics != "described" else tuple(study.parameters)
    limits = {n: study.parameters[n] for n in names}
    box = {n: (p.lower * p.factor, p.upper * p.factor) for n, p in limits.items()}
    material = study.material_with(case.kinetics)
    experiments = {case.experiment: study.experiments[case.experiment]}
    if case.effect:
        effect = known_effects()[case.effect]
        own = {q: f"{case.effect}_{q}" for q in effect.quantities}
        material, experiments = with_effects(material, experiments, {case.effect: own})
        box |= {own[q]: (x.lower, x.upper) for q, x in effect.quantities.items()}
    return experiments[case.experiment], material, box
