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
    words: str = ""


PLACES = {
    "flux": Place("front", "flux_factor", "factor on the flux", "-", 0.03, "flux"),
    "thickness": Place(
        "sample", "thickness_factor", "factor on the thickness", "-", 0.02, "thickness"
    ),
    "h": Place("front", "h_change_W_m2K", "change of h at the front", "W/(m2 K)", 2.0, "h"),
    "gas": Place(
        "front", "gas_rise_K", "change of the gas temperature", "K", 10.0, "gas temperature"
    ),
    "start": Place(
        "sample", "initial_temperature_K", "initial temperature", "K", 2.0, "initial temperature"
    ),
    "back_loss": Place(
        "back", "loss_factor", "factor on the back loss", "-", 0.1, "loss of the back"
    ),
    "flame": Place("flame", "flux_W_m2", "heat flux of the flame", "W/m2", 5e3, "flame"),
}
"""Default uncertainties of the apparatus, by the end of the input's name."""


def uncertain_numbers(experiment: Experiment) -> dict[str, float | str]:
    """Return the numbers of a slab that are uncertain and matter, or their parameters, by place."""
    if not isinstance(experiment, SlabExperiment):
        return {}
    found = {}
    for key, place in PLACES.items():
        part = getattr(experiment, place.part, None)
        value = None if part is None else getattr(part, place.key)
        if value is not None and _matters(experiment, key, value):
            found[key] = value
    return found


def _matters(experiment: SlabExperiment, key: str, value: float | str) -> bool:
    if key == "back_loss":
        return has_open_back(experiment)
    return key != "flame" or value != 0.0  # without a flux of its own, a flame heats nothing


def with_value(experiment: Experiment, place: Place, value: float | str) -> Experiment:
    """Return an experiment with a value, or the name of a parameter, in a place."""
    part = changed(getattr(experiment, place.part), **{place.key: value})
    return changed(experiment, **{place.part: part})
