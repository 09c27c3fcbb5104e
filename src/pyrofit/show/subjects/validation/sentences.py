"""How well sets predict unfitted data, in sentences."""

from collections.abc import Sequence

from pyrofit.analysis.scores import Score, by_signal
from pyrofit.analysis.uses import ESTIMATES, FITTED, UNKNOWN
from pyrofit.config import Study
from pyrofit.show.facts import Facts
from pyrofit.show.names import places_of, scored
from pyrofit.show.text import listed
from pyrofit.show.units import difference, difference_unit


def sentences(study: Study, facts: Facts) -> list[str]:
    """Say how well the sets predict signals outside their fit, and how exact the solver is."""
    if not study.validation.experiments:
        return []
    found = facts.scores
    return [*_predicted(found), _solver(found)]


def _predicted(found: Sequence[Score]) -> list[str]:
    """Say how well each signal is predicted where it was not fitted."""
    said = []
    for signal, group in by_signal(found).items():
        ours = [score for score in group if score.found_by == ESTIMATES]
        free = [score for score in ours if score.use not in (FITTED, UNKNOWN)]
        if not free:
            continue
        text = f"The estimates predict the {signal} of {places_of(free)} with {scored(free)}"
        fitted = [score for score in ours if score.use == FITTED]
        text += f" (fitted data: {scored(fitted)})" if fitted else ""
        said.append(f"{text}.")
    return said


def _solver(found: Sequence[Score]) -> str:
    parts = []
    for signal, group in by_signal(found).items():
        quantity, most = group[0].quantity, max(score.solver for score in group)
        if quantity.relative:
            parts.append(f"{100 * most:.2g} % of the mean {signal}")
        else:
            size = float(difference(quantity, most))
            parts.append(f"{size:.2g} {difference_unit(quantity)} of the {signal}")
    return f"The solver's own error, estimated for every curve, is at most {listed(parts)}."
