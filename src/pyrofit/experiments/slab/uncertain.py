"""Numbers of a slab's description that are uncertain: its apparatus, by default."""

from dataclasses import dataclass

from pyrofit.effects.base import changed, has_open_back
from pyrofit.model.experiment import Experiment
from pyrofit.model.slab import SlabExperiment


@dataclass(frozen=True)
class Place:
    """A number of a slab's description that varies: its part and key, words, unit, sd."""

    part: str
    key: str
    label: str
    unit: str
    sd: float


PLACES = {
    "flux": Place("front", "flux_factor", "factor on the flux", "-", 0.03),
    "thickness": Place("sample", "thickness_factor", "factor on the thickness", "-", 0.02),
    "h": Place("front", "h_change_W_m2K", "change of h at the front", "W/(m2 K)", 2.0),
    "gas": Place("front", "gas_rise_K", "change of the gas temperature", "K", 10.0),
    "start": Place("sample", "initial_temperature_K", "initial temperature", "K", 2.0),
    "back_loss": Place("back", "loss_factor", "factor on the back loss", "-", 0.1),
}
"""Default uncertainties of the apparatus, by the end of the input's name."""


def described_number(experiment: Experiment, place: Place) -> float | None:
    """Return the number that is described, if it is one and matters."""
    value = stated(experiment, place)
    return value if isinstance(value, float) else None


def stated(experiment: Experiment, place: Place) -> float | str | None:
    """Return the number, or the name of a parameter, that stands in a place and matters."""
    if not isinstance(experiment, SlabExperiment):
        return None
    if place.key == "loss_factor" and not has_open_back(experiment):
        return None
    found: float | str | None = getattr(getattr(experiment, place.part), place.key)
    return found


def with_value(experiment: Experiment, place: Place, value: float | str) -> Experiment:
    """Return an experiment with a value, or the name of a parameter, in a place."""
    part = changed(getattr(experiment, place.part), **{place.key: value})
    return changed(experiment, **{place.part: part})
