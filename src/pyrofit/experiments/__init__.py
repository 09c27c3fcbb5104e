"""Kinds of experiment: one folder each, named as in a study.

Each folder defines ``KIND``; this file registers it.
"""

from typing import Annotated

from pydantic import Field

from pyrofit.experiments import cone, dsc, external, gasification, mcc, tga
from pyrofit.experiments.base import Kind, Stage
from pyrofit.experiments.cone import Cone
from pyrofit.experiments.dsc import Dsc
from pyrofit.experiments.external import External
from pyrofit.experiments.from_files import FromFiles
from pyrofit.experiments.gasification import Gasification
from pyrofit.experiments.mcc import Mcc
from pyrofit.experiments.tga import Tga
from pyrofit.model.experiment import Experiment
from pyrofit.quantities import known_quantities, quantities_of
from pyrofit.quantities.base import Quantity

KINDS: dict[str, Kind] = {
    "cone": cone.KIND,
    "gasification": gasification.KIND,
    "tga": tga.KIND,
    "dsc": dsc.KIND,
    "mcc": mcc.KIND,
    "external": external.KIND,
}
"""Kinds of experiment by name."""
OF_FILES = {name: kind for name, kind in KINDS.items() if kind.files is not None}
"""Kinds of experiment that a new study can be written for."""
AnyExperiment = Annotated[
    Cone | Tga | Dsc | Mcc | Gasification | External, Field(discriminator="kind")
]


def kind_of(experiment: Experiment) -> Kind:
    """Return the kind of an experiment.

    >>> KINDS["tga"].stage
    'kinetics'
    """
    return KINDS[experiment.kind]


def files_of(kind: str) -> FromFiles:
    """Return the rules by which a new study is written for one of `OF_FILES`."""
    files = KINDS[kind].files
    assert files is not None
    return files


def kinds_of(stage: Stage) -> list[str]:
    """Return the words for the kinds of experiment that a stage fits.

    >>> kinds_of("imp")
    ['cone calorimeter', 'gasification', 'external']
    """
    return [kind.words for kind in KINDS.values() if kind.stage == stage]


def measurable(kind: str) -> dict[str, Quantity]:
    """Return the quantities that may be measured in a kind of experiment, by name.

    >>> [name for name in measurable("cone") if name not in measurable("gasification")]
    ['heat_release_rate']
    """
    if KINDS[kind].files is None:
        return known_quantities()
    return quantities_of(KINDS[kind].description.LIKE) | quantities_of(kind)
