"""The models that a step carries on: those that gain enough and predict left-out experiments."""

from collections.abc import Sequence

from pyrofit.diagnose.base.fitted import FittedModel, strengths_at_limit
from pyrofit.diagnose.base.inflation import by_significant_misfit
from pyrofit.diagnose.base.prediction import model_predictions, slab_experiments
from pyrofit.diagnose.search.step import SearchContext, SearchStep, in_order
from pyrofit.effects import known_effects

Claim = tuple[FittedModel, FittedModel]
"""A model, and the one that it was started from."""


def branches(
    steps: Sequence[SearchStep], spare: float, context: SearchContext
) -> list[FittedModel]:
    """Return the models that are carried on, the best first.

    Those that gain enough are compared by penalised chi-square. Where several experiments show the
    slab, each of them is also predicted from the others. The sum of the log scores, doubled, counts
    as much as chi-square does. A model whose predictions get worse comes behind all others.
    """
    claims = _claims(steps, spare)
    if len(claims) > 1 and slab_experiments(claims[0][0]):
        claims = _by_prediction(claims, context)
    settings = steps[0].start.settings
    found = [trial for trial, _ in claims][: settings.branches]
    if not found:
        return []
    lowest = min(trial.fit.chi2 for trial in found)
    return [trial for trial in found if trial.fit.chi2 <= settings.far_chi2_ratio * lowest]


def _claims(steps: Sequence[SearchStep], spare: float) -> list[Claim]:
    """Return the best models that gain enough, one for each set of groups of effects.

    Those with a strength at a limit, which may not be claimed, only where there are no others.
    """
    found = [
        (trial, step.start)
        for step in steps
        for trial in step.trials
        if _gain(step.start, trial) >= spare
    ]
    inside = [c for c in found if not strengths_at_limit(c[0])]
    start = {id(trial): start for trial, start in inside or found}
    best: dict[frozenset[str], FittedModel] = {}
    for trial in in_order([trial for trial, _ in inside or found]):
        best.setdefault(_groups(trial), trial)
    most = steps[0].start.settings.most_predicted
    return [(trial, start[id(trial)]) for trial in list(best.values())[:most]]


def _gain(start: FittedModel, trial: FittedModel) -> float:
    """Return the fall of penalised chi-square.

    From the third effect on, the noise counts as large as the misfit that is left, as the verdict
    has it. Otherwise misfit that no effect explains would keep the search alive, each further
    effect explaining a bit of it. Of two effects, each may leave the misfit of the other.
    """
    if len(start.effects) < start.settings.free_effects:
        return start.penalised - trial.penalised
    inflation = by_significant_misfit(trial)
    return inflation.penalised(start) - inflation.penalised(trial)


def _groups(trial: FittedModel) -> frozenset[str]:
    catalogue = known_effects()
    return frozenset(catalogue[effect].group for effect in trial.effects)


def _by_prediction(claims: Sequence[Claim], context: SearchContext) -> list[Claim]:
    """Return claims in the order of penalised chi-square less twice the log scores."""
    starts = {id(start): start for _, start in claims}
    models = [*(trial for trial, _ in claims), *starts.values()]
    found = model_predictions(models, context.processes, held_out=False, made=context.made)
    own = found[: len(claims)]
    before = dict(zip(starts, found[len(claims) :], strict=True))

    def order(k: int) -> tuple[bool, float]:
        trial, start = claims[k]
        gains = [own[k].scores[name] - s for name, s in before[id(start)].scores.items()]
        worse = sum(gains) < 0.0 or min(gains) <= -trial.settings.informative_gain
        return worse, trial.penalised - 2.0 * own[k].total

    return [claims[k] for k in sorted(range(len(claims)), key=order)]
