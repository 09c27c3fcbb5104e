"""Parts of a slab experiment that no version of FDS has, or that are applied to its output."""

from collections.abc import Iterator

from pyrofit.model.base import value_of
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.slab import SlabExperiment
from pyrofit_exchange.fds.materials import Values
from pyrofit_exchange.fds.remarks import Remark


def unwritten(experiment: SlabExperiment, values: Values) -> Iterator[Remark]:
    """Yield the parts of a slab experiment that are not in its deck."""
    sample = experiment.sample
    if sample.edge is not None and value_of(sample.edge.h_W_m2K, values) > 0.0:
        what = "edge loss (sample.edge)"
        yield Remark("left out", what, "conduction has one dimension")
    if change := value_of(sample.emissivity_change, values):
        what = f"emissivity with conversion, {change:.3g} in all (sample.emissivity_change)"
        yield Remark("left out", what, "an emissivity belongs to a component")
    for number in ("density", "conductivity"):
        if (factor := value_of(getattr(sample, f"{number}_factor"), values)) != 1.0:
            times = f"{factor:.4g} times the material's (sample.{number}_factor)"
            what = f"{number} of the piece, {times}"
            yield Remark("left out", what, "the material is written once for all tests")
    if heat := value_of(sample.gas_specific_heat_J_kgK, values):
        what = f"enthalpy of the gas, {heat:.4g} J/(kg K) (sample.gas_specific_heat_J_kgK)"
        yield Remark("left out", what, "the gas leaves without taking up heat")
    for name, signal in experiment.signals.items():
        for key, unit in (("delay_s", "s"), ("offset", "SI")):
            if shift := value_of(getattr(signal, key), values):
                what = f"{key} of {shift:.4g} {unit} (signals.{name}.{key})"
                yield Remark("when read", what, "it belongs to the record, not to the sample")


def unwritten_heated(experiment: HeatedExperiment, values: Values) -> Iterator[Remark]:
    """Yield the parts of a heated sample's description that are not in its deck."""
    for key, unit in (("lag_s", "s"), ("temperature_offset_K", "K")):
        if shift := value_of(getattr(experiment, key), values):
            what = f"{key} of {shift:.4g} {unit} ({key})"
            yield Remark("when read", what, "the temperature is that of the sample")
