"""Kinds of experiment: one folder each, named as in a study.

Each folder defines ``KIND``; this file registers it.
"""

from typing import Annotated

from pydantic import Field

from pyrofit.experiments import cone, dsc, gasification, mcc, tga
from pyrofit.experiments.base import Kind, Stage
from pyrofit.experiments.cone import Cone
from pyrofit.experiments.dsc import Dsc
from pyrofit.experiments.gasification import Gasification
from pyrofit.experiments.mcc import Mcc
from pyrofit.experiments.tga import Tga
from pyrofit.model.experiment import Experiment
from pyrofit.quantities import quantities_of
from pyrofit.quantities.base import Quantity

KINDS: dict[str, Kind] = {
    "cone": cone.KIND,
    "gasification": gasification.KIND,
    "tga": tga.KIND,
    "dsc": dsc.KIND,
    "mcc": mcc.KIND,
}
"""Kinds of experiment by name."""
AnyExperiment = Annotated[Cone | Tga | Dsc | Mcc | Gasification, Field(discriminator="kind")]


def kind_of(experiment: Experiment) -> Kind:
    """Return the kind of an experiment.

    >>> KINDS["tga"].stage
    'kinetics'
    """
    return KINDS[experiment.kind]


def kinds_of(stage: Stage) -> list[str]:
    """Return the words for the kinds of experiment that a stage fits.

    >>> kinds_of("imp")
    ['cone calorimeter', 'gasification']
    """
    return [kind.words for kind in KINDS.values() if kind.stage == stage]


def measurable(kind: str) -> dict[str, Quantity]:
    """Return the quantities that may be measured in a kind of experiment, by name.

    >>> [name for name in measurable("cone") if name not in measurable("gasification")]
    ['heat_release_rate']
    """
    return quantities_of(KINDS[kind].description.LIKE) | quantities_of(kind)
