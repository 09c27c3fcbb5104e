"""Which code of effects, quantities and costs each step depends on."""

from collections.abc import Iterable

from pyrofit.config import Study
from pyrofit.config.keys.terms import TermSpec
from pyrofit.plugins import code_digest

Digests = dict[str, dict[str, str]]
"""Checksums by catalogue and name."""


def code_of(study: Study, terms: Iterable[TermSpec] = (), more: Iterable[str] = ()) -> Digests:
    """Hashes of the files that no step imports by name: of effects, quantities and own costs.

    Of effects these are the model's and some more, of costs those of some terms, of quantities
    those of all signals.
    """
    signals = [(e, s) for e in study.experiments.values() for s in e.signals]
    quantities = {experiment.quantity(signal).name for experiment, signal in signals}
    return {
        "quantities": {n: code_digest("quantities", n) for n in sorted(quantities)},
        "effects": {n: code_digest("effects", n) for n in sorted({*study.with_effects, *more})},
        "costs": {n: code_digest("costs", n) for n in sorted({term.kind for term in terms})},
    }


def all_terms(study: Study) -> list[TermSpec]:
    """Return the terms of all cost functions."""
    return [term for terms in study.imp.costs.values() for term in terms]


def code(study: Study) -> Digests:
    """Return hashes of code outside `pyrofit.provenance`: effects, quantities and own costs.

    Candidates of the diagnosis are left out: the other results do not depend on them.
    """
    stage = study.kinetics.cost if study.kinetics else ()
    truth = study.synthetic.effects if study.synthetic else ()
    return code_of(study, [*all_terms(study), *stage], truth)
