"""Parts of every kind of experiment: description, simulation, phases, designs, files."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, Protocol

import pandas as pd
from numpy.typing import NDArray

from pyrofit.experiments.from_files import FromFiles
from pyrofit.model.accuracy import Accuracy, Resolution
from pyrofit.model.experiment import Experiment
from pyrofit.model.material import Material
from pyrofit.solver.arrays import FloatArray, Values
from pyrofit.solver.curves import Curves, Request

Stage = Literal["kinetics", "imp"]
Asked = Mapping[str, Request]
"""Requests by signal."""
PHASES = ("heat-up", "onset", "plateau", "heated back", "burn-out", "tail")
"""Phases of a slab."""


@dataclass(frozen=True, eq=False)
class Course:
    """The simulated course of an experiment at some of its times, shape (n,) each."""

    conversion: FloatArray
    surface_temperature_K: FloatArray | None
    phase: NDArray[Any]
    """Position among `phases`."""
    phases: tuple[str, ...] = PHASES


@dataclass(frozen=True, eq=False)
class Idea:
    """A new test.

    Parameters
    ----------
    like
        The experiment it is derived from.
    change
        From the description of that experiment, effects included, to the new one.
    choices
        Short name, words and quantities of each choice of recorded signals.
    """

    like: str
    change: Callable[[Any], Any]
    choices: tuple[tuple[str, str, tuple[str, ...]], ...]

    @property
    def most_quantities(self) -> tuple[str, ...]:
        """Quantities of the choice that has most."""
        return max((quantities for _, _, quantities in self.choices), key=len)


class Simulate(Protocol):
    """Curves of experiments for many sets, as `pyrofit.simulate` has them."""

    def __call__(
        self,
        experiments: Sequence[Any],
        material: Material,
        values: Values,
        asked: Sequence[Asked],
        accuracy: Accuracy,
        sets: int = 1,
        led: bool = False,
    ) -> list[list[Curves]]:
        """Return the curves by experiment, then by set; signals as they were asked for.

        Where the sets are ``led``, the solver's own error is that of the first one in all.
        """
        ...


Designs = Callable[[Mapping[str, Any], Mapping[str, Any], Mapping[str, set[str]]], Iterator[Idea]]
"""From fitted experiments, fitted or predicted ones, and their recorded quantities to new tests."""


@dataclass(frozen=True)
class Kind:
    """A kind of experiment.

    Parameters
    ----------
    description
        Class of its description; ``kind`` names it in a study.
    words
        Its name in messages.
    stage
        Stage of the study that fits it.
    simulate
        The production solver. Kinds with the same function are simulated in one call.
    reference
        The reference solver: description, material, values, requests, resolution.
    request
        Request of a simulation: description, signal, measured series, times [s].
    synthetic
        Requests of the signals that are computed: description, their names.
    course
        Phases: description, material, values, a request at the wanted times, accuracy.
    designs
        New tests.
    files
        Rules by which a new study is written from files; None = it is not written.
    can_lead
        Whether a set can lead others in its simulation, see `Simulate`.
    """

    description: type[Experiment]
    words: str
    stage: Stage
    simulate: Simulate
    reference: Callable[[Any, Material, Mapping[str, float], Asked, Resolution], Curves]
    request: Callable[[Any, str, pd.DataFrame, FloatArray], Request]
    synthetic: Callable[[Any, Sequence[str]], dict[str, Request]]
    course: Callable[[Any, Material, Mapping[str, float], Request, Accuracy], Course]
    designs: Designs
    files: FromFiles | None
    can_lead: bool = True
