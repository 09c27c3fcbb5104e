"""Base of all experiments: a title and measured signals."""

from collections.abc import Iterable
from typing import ClassVar, Self

from pydantic import Field, model_validator

from pyrofit.errors import suggest
from pyrofit.model.base import Part
from pyrofit.model.repeats import AnyRepeats, Nuisances, RepeatOf
from pyrofit.model.signal import Signal
from pyrofit.quantities import known_quantities, quantities_of
from pyrofit.quantities.base import Quantity


class Experiment(Part):
    """Base of all experiments; a kind of experiment adds its sample."""

    LIKE: ClassVar[str] = ""
    """Another kind of experiment; its quantities are measured in this one, too."""
    kind: str
    title: str = Field("", description="name in figures")
    laboratory: str = Field(
        "",
        description="laboratory that made it; effects of apparatus and surroundings belong to one",
    )
    signals: dict[str, Signal] = Field(
        default_factory=dict, description="measured quantities by name"
    )
    repeats: AnyRepeats | None = Field(
        None, description="records of equal tests, each an experiment of its own"
    )
    uncertain: Nuisances | None = Field(
        None,
        description="properties of the test that the diagnosis estimates besides the model, about "
        "the described values; for a test with `repeats` give them there",
    )
    repeat: RepeatOf | None = Field(
        None,
        description="the repeated test or the uncertain properties, as noted when a study is read; "
        "list yours in `repeats` or `uncertain`",
    )

    @model_validator(mode="after")
    def _known_signals(self) -> Self:
        known = self.measurable
        for name, signal in self.signals.items():
            if not signal.quantity and name not in known:
                raise ValueError(f"unknown signal '{name}'. {suggest(name, known)}")
            if signal.quantity and signal.quantity not in known:
                raise ValueError(
                    f"signal '{name}': unknown quantity '{signal.quantity}'. "
                    + suggest(signal.quantity, known)
                )
            _check_place(name, signal, known[signal.quantity or name])
        return self

    @property
    def measurable(self) -> dict[str, Quantity]:
        """The quantities that may be measured in it, by name."""
        return quantities_of(self.LIKE) | quantities_of(self.kind)

    @property
    def jumps(self) -> bool:
        """Whether signals jump or bend sharply, which no smooth curve follows."""
        return False

    def quantity(self, signal: str) -> Quantity:
        """Return the quantity of a signal: the one it names, else the one of its own name."""
        return known_quantities()[self.signals[signal].quantity or signal]

    @property
    def synthetic_span(self) -> tuple[float, str]:
        """Length of a computed record [s] or [K], and the keys that set it."""
        raise NotImplementedError

    def as_simulated(self, signals: Iterable[str]) -> Self:
        """Return the inputs of its curves, with some signals: not how it was recorded."""
        shown = {s: self.signals[s].as_simulated() for s in signals}
        return self.model_copy(
            update={"title": "", "laboratory": "", "repeat": None, "signals": shown}
        )

    def words(self, signal: str) -> str:
        """Return a signal's name in words: its quantity's, and its own where that is another."""
        title = self.quantity(signal).title
        return f"{title} ({signal})" if self.signals[signal].quantity else title

    def metric(self, signal: str) -> str:
        """Return the name of the score of a prediction of a signal."""
        quantity = self.quantity(signal)
        return quantity.metric.replace(quantity.title, self.words(signal))


_KEYS = {"depth_m": ("depth",), "follows": ("depth",), "layer": ("interface",)}
"""Keys of a signal that tell where it is measured, and the places that have them."""
_NEEDED = {
    "depth": ("depth_m", "the depth below the initial front [m], such as `depth_m: 0.003`"),
    "interface": ("layer", "behind which layer it is, such as `layer: 1` for the front one"),
}


def _check_place(name: str, signal: Signal, quantity: Quantity) -> None:
    """Refuse a signal that does not tell where it is measured, or tells it of another quantity."""
    key, way = _NEEDED.get(quantity.place, ("", ""))
    if key and getattr(signal, key) is None:
        raise ValueError(f"signal '{name}': {key} is missing; give {way}")
    for key, places in _KEYS.items():
        if getattr(signal, key) is not None and quantity.place not in places:
            having = [q.name for q in known_quantities().values() if q.place in places]
            raise ValueError(
                f"signal '{name}': {key} has no meaning for the {quantity.title}; leave it out, or "
                f"give `quantity: {' or '.join(having)}`"
            )
