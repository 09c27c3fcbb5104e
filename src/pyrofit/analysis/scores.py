"""Scores of all sets at all predicted signals."""

from collections.abc import Iterable
from dataclasses import dataclass

import pandas as pd

from pyrofit.analysis.uses import predicted_sets, title_of, use_of
from pyrofit.config import Study
from pyrofit.quantities.base import Quantity


@dataclass(frozen=True)
class Score:
    """How well one set predicts one signal.

    Parameters
    ----------
    experiment, signal
        Title of the experiment, and the signal in words.
    quantity
        Quantity of the signal.
    cost_function, found_by
        The set: cost function and optimiser.
    use
        Whether the set's cost was fitted to the signal: 'fitted', 'held-out signal', 'held out'.
    points
        Measured points.
    value, solver
        CV(RMSE) of a relative quantity, else RMSE in SI units; the solver's own error in the same
        measure.
    """

    experiment: str
    signal: str
    quantity: Quantity
    cost_function: str
    found_by: str
    use: str
    points: float
    value: float
    solver: float


def scores_of_sets(study: Study, predicted: pd.DataFrame) -> list[Score]:
    """Return the scores, experiments and signals together, in the order of their first set."""
    sets = {chosen.label: chosen for chosen in predicted_sets(study)}
    found = []
    for row in predicted.to_dict("records"):
        name, signal, chosen = row["experiment"], row["signal"], sets[row["set"]]
        quantity = study.experiments[name].quantity(signal)
        measure = "cv_rmse" if quantity.relative else "rmse_si"
        found.append(
            Score(
                experiment=title_of(study, name),
                signal=study.experiments[name].words(signal),
                quantity=quantity,
                cost_function=chosen.cost,
                found_by=chosen.origin,
                use=use_of(study, chosen.cost, name, signal),
                points=row["points"],
                value=float(row[measure]),
                solver=float(row[f"solver_{measure}"]),
            )
        )
    experiments, signals = (
        list(dict.fromkeys(values))
        for values in ([s.experiment for s in found], [s.signal for s in found])
    )
    return sorted(found, key=lambda s: (experiments.index(s.experiment), signals.index(s.signal)))


def by_signal(found: Iterable[Score]) -> dict[str, list[Score]]:
    """Return scores by their signal in words, in order of appearance."""
    groups: dict[str, list[Score]] = {}
    for score in found:
        groups.setdefault(score.signal, []).append(score)
    return groups
