"""Fitted tests in a gas with oxygen, where the model of a furnace lacks oxidation or the oxygen."""

from collections.abc import Iterable, Iterator

from pyrofit.config.keys.study import Study
from pyrofit.data.gas_steps import holds_oxygen


def oxidised(study: Study, fitted: Iterable[str] | None = None) -> Iterator[str]:
    """Yield a sentence for each gas with oxygen around samples in a furnace that are fitted.

    Those are the experiments given, by default all that a cost of the study compares.

    There is none where a reaction needs oxygen and the test tells how much its gas holds. The gas
    at a slab that burns is used up by the flame, so that `gas` of slabs is no matter.
    """
    terms = [term for terms in study.imp.costs.values() for term in terms]
    terms += study.kinetics.cost if study.kinetics is not None else []
    by_gas: dict[str, list[str]] = {}
    for name in dict.fromkeys((t.experiment for t in terms) if fitted is None else fitted):
        experiment = study.experiments.get(name)
        gas = getattr(experiment, "gas", "")
        told = study.material.oxidises and getattr(experiment, "oxygen", 0.0) != 0.0
        if holds_oxygen(gas) and not told:
            by_gas.setdefault(gas, []).append(name)
    for gas, names in by_gas.items():
        yield f"experiments.{', '.join(names)}: the gas is {gas}, and " + _rest(study)


def _rest(study: Study) -> str:
    if study.material.oxidises:
        return (
            "its `oxygen` is 0, with which no reaction with an oxygen_order runs. Give its volume "
            "fraction, of air `oxygen: 0.209`"
        )
    return (
        "the model has no oxidation. Take the test out of the costs, read its values as those of "
        "this gas alone, or describe a reaction with an oxygen_order"
    )
