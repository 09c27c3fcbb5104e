"""A sentence beside a figure: whether the model describes the signals that it shows."""

from collections.abc import Collection

from pyrofit.analysis.best_predicting import of_answer
from pyrofit.analysis.uses import FITTED, title_of
from pyrofit.config import Study
from pyrofit.show.facts import Facts
from pyrofit.show.goodness import where_missed
from pyrofit.show.names import all_scored


def verdict_on(study: Study, facts: Facts, stage: str, pairs: Collection[tuple[str, str]]) -> str:
    """Return how many of some fitted signals are missed, and where the worst one is.

    Predictions of the estimates at signals that were not fitted are scored instead.
    """
    tested = [s for s in facts.goodness[stage].signals if (s.experiment, s.signal) in pairs]
    missed = [s for s in tested if s.misses or s.far_off]
    said = []
    if missed:
        worst = max(missed, key=lambda s: s.rms / s.range if s.range else 0.0)
        of = f"{len(missed)} of the {len(tested)} fitted signals"
        said.append(f"The fit misses {of if tested[1:] else 'the fitted signal'} shown here.")
        said += [f"The worst: {where_missed(study, worst)}"] if worst.misses else []
    elif tested:
        said.append("The fit describes these signals within their noise.")
    if stage == "imp":
        names = {(title_of(study, e), study.experiments[e].words(s)) for e, s in pairs}
        mine = [s for s in of_answer(facts.scores) if (s.experiment, s.signal) in names]
        free = [s for s in mine if s.use != FITTED]
        said += [f"Unfitted signals: the estimates predict {all_scored(free)}."] if free else []
    return " ".join(said)
