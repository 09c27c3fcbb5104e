"""A kind of experiment whose sample follows a temperature programme."""

from collections.abc import Callable, Collection, Iterator, Mapping

import numpy as np

from pyrofit.effects.base import changed
from pyrofit.experiments.base import Course, Idea, Kind
from pyrofit.experiments.conversion import conversion
from pyrofit.experiments.from_files import FromFiles
from pyrofit.experiments.heated.simulate import reference, request, simulate, synthetic
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.material import Material
from pyrofit.quantities import quantities_of
from pyrofit.simulate import simulate_tga
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Request
from pyrofit.solver.outputs import MASS_FRACTION

PHASES = ("heat-up", "onset", "main reaction", "end of reaction", "residue")
ENDS = (0.02, 0.2, 0.9, 0.99)


def course(
    experiment: HeatedExperiment,
    material: Material,
    values: Mapping[str, float],
    request: Request,
    accuracy: Accuracy,
) -> Course:
    """Return the simulated course at the times of a request."""
    curves = simulate_tga(experiment, material, values, request, accuracy)
    return of_mass(curves.signals[MASS_FRACTION])


def of_mass(mass: FloatArray) -> Course:
    """Return the course of a heated sample from its mass, shape (n,)."""
    converted = conversion(mass)
    return Course(converted, None, np.searchsorted(ENDS, converted).astype(float), PHASES)


RATE_FACTOR = 3.0
"""How much slower and faster than all measured ones a new test is."""


def designs(
    kind: str,
    words: str,
    own: Mapping[str, HeatedExperiment],
    recorded: Mapping[str, Collection[str]],
) -> Iterator[Idea]:
    """Yield a slower and a faster test than those measured, which record the same."""
    rates = {name: e.heating_rate_K_min for name, e in own.items() if not e.is_isothermal}
    if not rates:
        return
    slowest, fastest = min(rates, key=lambda n: rates[n]), max(rates, key=lambda n: rates[n])
    for like, factor in ((slowest, 1.0 / RATE_FACTOR), (fastest, RATE_FACTOR)):
        rate = factor * rates[like]
        quantities = tuple(q for q in quantities_of(kind) if q in recorded[like])
        choice = f"{kind}_{rate:.3g}_K_min", f"{words} at {rate:.3g} K/min", quantities
        yield Idea(like, _at_rate(rate), (choice,))


def _at_rate(rate: float) -> Callable[[HeatedExperiment], HeatedExperiment]:
    return lambda heated: changed(heated, heating_rate_K_min=rate)


def heated_kind(
    name: str, words: str, description: type[HeatedExperiment], files: FromFiles
) -> Kind:
    """Return a kind with the solvers, phases and new tests that all heated samples share."""
    return Kind(
        description=description,
        words=words,
        stage="kinetics",
        simulate=simulate,
        reference=reference,
        request=request,
        synthetic=synthetic,
        course=course,
        designs=lambda own, measured, recorded: designs(name, words, own, recorded),
        files=files,
    )
