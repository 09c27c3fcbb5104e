"""Whether a sample released the mass it had, in words."""

import contextlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from pyrofit.config import Study
from pyrofit.data.closure import Closure
from pyrofit.model.base import value_of
from pyrofit.model.experiment import Gasification
from pyrofit.solver.lower import fractions
from pyrofit.solver.lower_experiment import thicknesses


def closure_lines(study: Study, signals: Mapping[str, Any]) -> list[str]:
    """Return a line for every measured mass loss rate, and one for every pair of equal samples.

    Parameters
    ----------
    study
        The study.
    signals
        ``signals`` of the measurements' summary, with ``released_kg_m2`` for each mass loss rate.
    """
    released = {
        name: float(signals[name]["mlr"]["released_kg_m2"])
        for name, experiment in study.kinds(Gasification).items()
        if "mlr" in experiment.signals
    }
    lines = [_line(study, name, study.experiments[name], mass) for name, mass in released.items()]
    return lines + _spread(study, released)


def _line(study: Study, name: str, experiment: Any, released: float) -> str:
    values = study.fixed_values()
    signal = experiment.signals["mlr"]
    try:
        thickness = sum(thicknesses(experiment.sample, values))
    except KeyError:
        return f"{name}: released {released:.3f} kg/m²; thickness to be estimated"
    initial = None
    if signal.sample_mass_kg is not None and signal.sample_area_m2 is not None:
        initial = signal.sample_mass_kg / signal.sample_area_m2
    else:
        with contextlib.suppress(KeyError):
            initial = _described_mass(study, experiment, values)
    if initial is not None:
        return f"{name}: {Closure(released, initial, released / initial).describe()}"
    return (
        f"{name}: released {released:.3f} kg/m², {released / thickness:.0f} kg/m³ over the "
        f"{thickness * 1e3:g} mm of the sample; initial mass not given, density to be estimated"
    )


def _described_mass(study: Study, experiment: Gasification, values: Mapping[str, float]) -> float:
    """Return the mass per area [kg/m2]; KeyError where a parameter has no value."""
    components = study.material.components
    volumes = np.array([1.0 / value_of(c.density_kg_m3, values) for c in components.values()])
    total = 0.0
    sizes = thicknesses(experiment.sample, values)
    for layer, size in zip(experiment.sample.layers, sizes, strict=True):
        composition = layer.composition or study.material.composition
        share = fractions(composition, list(components), values)[:, 0]
        total += float(size) / float(share @ volumes)
    return total


def _spread(study: Study, released: Mapping[str, float]) -> list[str]:
    """Say how far apart the released masses of equal samples are."""
    lines = []
    names = list(released)
    for i, a in enumerate(names):
        for b in names[i + 1 :]:
            if study.experiments[a].sample.layers == study.experiments[b].sample.layers:  # type: ignore[union-attr]
                apart = abs(released[a] - released[b]) / max(released[a], released[b])
                lines.append(f"{a} and {b}: equal samples, released masses {apart:.1%} apart")
    return lines
