"""Curves of published materials at the experiments of a study."""

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property

from pyrofit.errors import DataError, StudyError, suggest
from pyrofit.model.slab import SlabExperiment
from pyrofit_compare.published import PublishedSet, material_in, published, shown_by
from pyrofit_explore.model import ExploredModel, Simulated


class PublishedSets:
    """The parameter sets of the MaCFP data base, read when they are first asked for."""

    @cached_property
    def sets(self) -> Mapping[str, PublishedSet]:
        """The sets by name; none where the data base is not on this machine."""
        try:
            return published()[0]
        except DataError:
            return {}

    def simulate(self, model: ExploredModel, name: str, values: Mapping[str, float]) -> Simulated:
        """Return the curves of a published material in the apparatus of a study.

        Parameters
        ----------
        model
            The study. Tests that the set does not describe have no curve: slabs, where it has
            kinetics alone, and layers of a composition of their own.
        name
            Name of the set.
        values
            Values of the parameters of the apparatus, SI units.

        Raises
        ------
        StudyError
            There is no such set.
        """
        if name not in self.sets:
            raise StudyError(f"no published set '{name}'. {suggest(name, self.sets)}")
        one = self.sets[name]
        shown = {n for n, e in shown_by(model.study, one).items() if not _has_other_layers(e)}
        problem = replace(
            model.problem,
            material=material_in(model.study, one),
            runs={n: run for n, run in model.problem.runs.items() if n in shown},
        )
        return replace(model, problem=problem).simulate(values)


def _has_other_layers(experiment: object) -> bool:
    layers = experiment.sample.layers if isinstance(experiment, SlabExperiment) else ()
    return any(layer.composition or layer.beside for layer in layers)
