"""Decks of the base of the tests of effects."""

from functools import cache

from bases import Base, having, pmma

from pyrofit.effects import known_effects
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.slab import SlabExperiment
from pyrofit_exchange.fds.export import text_of_file
from pyrofit_exchange.fds.heated import heated_deck
from pyrofit_exchange.fds.parse import read_namelists
from pyrofit_exchange.fds.predicted import PredictedByPyrofit, predict_slab
from pyrofit_exchange.fds.slab import Deck, slab_deck
from pyrofit_exchange.fds.versions import OLD, Version


def lines(deck: Deck) -> list[str]:
    return text_of_file(deck, []).splitlines()


def keys(deck: Deck, group: str) -> list[dict[str, list[object]]]:
    return [
        of for name, of, _ in read_namelists(text_of_file(deck, []), deck.name) if name == group
    ]


@cache
def base() -> Base:
    return pmma()


def predicted(of: Base, name: str) -> PredictedByPyrofit:
    experiment = of.experiments[name]
    assert isinstance(experiment, SlabExperiment)
    return predict_slab(experiment, of.material, of.values, Accuracy())


def deck_of(
    of: Base, name: str, version: Version = OLD, like: PredictedByPyrofit | None = None
) -> Deck:
    """Return the deck of an experiment; ``like`` spares the simulation."""
    experiment = of.experiments[name]
    if isinstance(experiment, HeatedExperiment):
        return heated_deck(name, experiment, of.material, of.values, version, 800.0)
    assert isinstance(experiment, SlabExperiment)
    curve = like or predicted(of, name)
    return slab_deck(name, experiment, of.material, of.values, version, curve)


def with_effect(of: Base, name: str) -> Base:
    """Return a base with an effect at its typical strength."""
    effect = known_effects()[name]
    return having(of, {name: {key: q.typical for key, q in effect.strength.items()}})
