"""Whether a sample released the mass it had, in words."""

import contextlib
from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from pyrofit.config import Study
from pyrofit.model.base import value_of
from pyrofit.model.slab import Layer, SlabExperiment
from pyrofit.numerics import linear
from pyrofit.results.recorded import About
from pyrofit.solver.lower import fractions
from pyrofit.solver.lower_experiment import thicknesses

Record = tuple[str, str]
"""Experiment and signal."""


def closure_lines(study: Study, signals: About) -> list[str]:
    """Return a line for every record of released mass or heat, and for pairs of equal samples.

    Parameters
    ----------
    study
        The study.
    signals
        The records of the series, by experiment and signal.
    """
    released = {
        (name, signal): about.released_kg_m2
        for name, experiment in study.experiments.items()
        for signal, about in signals[name].items()
        if about.released_kg_m2 is not None and isinstance(experiment, SlabExperiment)
    }
    records = Counter(name for name, _ in released)
    lines = [
        _line(study, *record, mass, several=records[record[0]] > 1)
        for record, mass in released.items()
    ]
    return lines + _heats(signals, released) + _spread(study, released)


def _heats(signals: About, released: Mapping[Record, float]) -> list[str]:
    """Return the total heat released of every record, and the effective heat of combustion."""
    masses = {name: mass for (name, _), mass in released.items()}
    lines = []
    for name, of in signals.items():
        for heat in (a.released_J_m2 for a in of.values() if a.released_J_m2 is not None):
            line = f"{name}: total heat released {heat * 1e-6:.3g} MJ/m²"
            if masses.get(name, 0.0) > 0.0:
                line += (
                    "; over the released mass that is an effective heat of combustion of "
                    f"{heat / masses[name] * 1e-6:.3g} MJ/kg"
                )
            lines.append(line)
    return lines


def _line(study: Study, name: str, signal: str, released: float, several: bool) -> str:
    experiment = study.experiments[name]
    assert isinstance(experiment, SlabExperiment)
    described = experiment.signals[signal]
    values = study.fixed_values()
    said = f"{name}{f', {signal}' if several else ''}: released {released:.3f}"
    try:
        thickness = sum(size for _, size in _reacting(study, experiment, values))
    except KeyError:
        return f"{said} kg/m²; thickness to be estimated"
    initial = None
    if described.sample_mass_kg is not None and described.sample_area_m2 is not None:
        initial = described.sample_mass_kg / described.sample_area_m2
    else:
        with contextlib.suppress(KeyError):
            layers = _reacting(study, experiment, values)
            initial = _mass(study, experiment, layers, values)
    if initial is not None:
        return f"{said} of {initial:.3f} kg/m² ({100.0 * released / initial:.1f} %)"
    return (
        f"{said} kg/m², {released / thickness:.0f} kg/m³ over the {thickness * 1e3:g} mm of the "
        "sample; initial mass not given, density to be estimated"
    )


def _reacting(
    study: Study, experiment: SlabExperiment, values: Mapping[str, float]
) -> list[tuple[Layer, float]]:
    """Return the layers that can release mass, with their thickness [m]: no inert board.

    KeyError if a parameter has no value.
    """
    reactants = {reaction.reactant for reaction in study.material.reactions.values()}
    return [
        (layer, size)
        for layer, size in _layers_of(experiment, values)
        if reactants & set(layer.composed(study.material.composition))
    ]


def described_mass(study: Study, experiment: SlabExperiment, values: Mapping[str, float]) -> float:
    """Return the mass of all layers per area [kg/m2]; KeyError if a parameter has no value."""
    layers = _layers_of(experiment, values)
    return _mass(study, experiment, layers, values)


def _layers_of(
    experiment: SlabExperiment, values: Mapping[str, float]
) -> list[tuple[Layer, float]]:
    """Return all layers with their thickness [m]; KeyError if a parameter has no value."""
    sizes = map(float, thicknesses(experiment.sample, values))
    return list(zip(experiment.sample.layers, sizes, strict=True))


def _mass(
    study: Study,
    experiment: SlabExperiment,
    layers: Sequence[tuple[Layer, float]],
    values: Mapping[str, float],
) -> float:
    """Return the mass of layers per area [kg/m2]; KeyError if a parameter has no value."""
    components = study.material.components
    own = np.isin(list(components), sorted(study.material.own))
    denser = np.where(own, value_of(experiment.sample.density_factor, values), 1.0)
    density = np.array([value_of(c.density_kg_m3, values) for c in components.values()])
    volumes = 1.0 / (denser * density)
    total = 0.0
    for layer, size in layers:
        composition = layer.composed(study.material.composition)
        share = fractions(composition, list(components), values)[:, 0]
        total += size / linear.dot(share, volumes)
    return total


def _spread(study: Study, released: Mapping[Record, float]) -> list[str]:
    """Give the largest difference between the released masses of equal samples."""
    groups: list[list[Record]] = []
    for record in released:
        for group in groups:
            if _are_equal(study, group[0], record):
                group.append(record)
                break
        else:
            groups.append([record])
    lines = []
    for group in groups:
        names = list(dict.fromkeys(name for name, _ in group))
        least, most = (end(group, key=released.__getitem__) for end in (min, max))
        apart = 100.0 * (1.0 - released[least] / released[most])
        if len(names) == 2:
            said = f"{names[0]} and {names[1]}: equal samples, released masses {apart:.1f} % apart"
            lines.append(said)
        elif len(names) > 2:
            farthest = f", those of {least[0]} and {most[0]}" if least[0] != most[0] else ""
            lines.append(
                f"{len(names)} equal samples: released masses at most {apart:.1f} % apart{farthest}"
            )
    return lines


def _are_equal(study: Study, first: Record, second: Record) -> bool:
    """Tell whether two records are of one quantity, and of samples that are described alike."""
    one, other = (study.experiments[name] for name, _ in (first, second))
    assert isinstance(one, SlabExperiment)
    assert isinstance(other, SlabExperiment)
    return (
        one.quantity(first[1]).name == other.quantity(second[1]).name
        and one.sample.layers == other.sample.layers
        and one.sample.density_factor == other.sample.density_factor
    )
