"""The parts of every arrangement of reactions."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from pyrofit.model.material import Component, Material, Reaction

PREFIX = "scheme_"
"""Beginning of the names of a scheme's parameters."""
REFERENCE_RATE_1_S = 1e-3
"""Rate constant at the reference temperature of a reaction."""


@dataclass(frozen=True)
class Limits:
    """Limits of a parameter, in its unit."""

    unit: str
    lower: float
    upper: float
    label: str


@dataclass(frozen=True)
class Template:
    """Data that a scheme takes from the study's own material.

    Parameters
    ----------
    reactant
        Name of the component of which the virgin material has most.
    component
        Its properties, which all reacting components have.
    reaction
        Its reaction, with the heats.
    products
        Solid yields that do not react further.
    inert
        Other components that stay, by name.
    composition
        Mass fractions of the virgin material that do not react.
    residue
        Largest sum of the solid yields.
    """

    reactant: str
    component: Component
    reaction: Reaction
    products: Mapping[str, float | str]
    inert: Mapping[str, Component]
    composition: Mapping[str, float | str]
    residue: float


Build = Callable[[Template, Sequence[Reaction]], Material]
Share = Callable[[int, int, Template], dict[str, Limits]]


@dataclass(frozen=True)
class Arrangement:
    """An arrangement of reactions.

    Parameters
    ----------
    equation
        In symbols.
    build
        Makes the material from the template and the reactions, which have rates only.
    shares
        Limits of the parameter that a reaction beyond the first brings, by its number and how many
        reactions there are.
    """

    equation: str
    build: Build
    shares: Share


def numbered(template: Template, i: int) -> str:
    """Return the name of the i-th reacting component, i from 1, and of its reaction."""
    return template.reactant if i == 1 else f"{template.reactant}_{i}"
