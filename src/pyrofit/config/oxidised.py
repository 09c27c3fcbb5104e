"""Fitted tests in a gas with oxygen, of which the model knows nothing."""

from collections.abc import Iterator

from pyrofit.config.study import Study
from pyrofit.data.gas_steps import holds_oxygen


def oxidised(study: Study) -> Iterator[str]:
    """Yield a sentence for each gas with oxygen around samples in a furnace that a cost compares.

    The gas at a slab that burns is used up by the flame, so that `gas` of slabs is no matter.
    """
    terms = [term for terms in study.imp.costs.values() for term in terms]
    terms += study.kinetics.cost if study.kinetics is not None else []
    by_gas: dict[str, list[str]] = {}
    for name in dict.fromkeys(term.experiment for term in terms):
        gas = getattr(study.experiments.get(name), "gas", "")
        if holds_oxygen(gas):
            by_gas.setdefault(gas, []).append(name)
    for gas, names in by_gas.items():
        yield (
            f"experiments.{', '.join(names)}: the gas is {gas}, and the model has no oxidation. "
            "Take the test out of the costs, or read its values as those of this gas alone"
        )
