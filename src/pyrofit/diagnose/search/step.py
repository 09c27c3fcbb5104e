"""One round of the search: every effect more in addition to a model, and in other forms."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import islice

import numpy as np

from pyrofit.diagnose.base.adequacy import LackOfFit
from pyrofit.diagnose.base.fitted import FittedModel, followed, polished
from pyrofit.diagnose.base.model import strength_of
from pyrofit.diagnose.base.prediction import Made
from pyrofit.diagnose.search.progress import ROUGHLY, SECOND, TO_THE_END, SearchProgress, Whole
from pyrofit.diagnose.search.refit import (
    fixed_forms,
    from_best_start,
    from_elsewhere,
    model_with,
    model_with_form,
    starts,
    with_form,
)
from pyrofit.diagnose.search.score_test import Screening
from pyrofit.effects import known_effects
from pyrofit.logs import Tell
from pyrofit.parallel import parallel_map
from pyrofit.solver.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class SearchContext:
    """Inputs of a search, or of the judgement: generator of noise draws, listener, processes."""

    rng: np.random.Generator
    tell: Tell = lambda text: None
    processes: int = 1
    other_starts: tuple[FloatArray, ...] = ()
    """Other ends of the base's fits, or points of its limits: starts of leading models as well."""
    made: Made = field(default_factory=dict)
    """Fits of the predictions of models that were compared before."""
    whole: Whole = field(default_factory=Whole)
    """How far the whole diagnosis is."""


@dataclass(frozen=True, eq=False)
class SearchStep:
    """One step of the search.

    Parameters
    ----------
    start
        The model that gets one effect more.
    lack
        Returns the lack of fit of that model, which is drawn when it is first asked for.
    looks
        Change of that model by each effect.
    trials
        The fits with one effect more, the best penalised chi-square first.
    """

    start: FittedModel
    lack: Callable[[], LackOfFit]
    looks: tuple[Screening, ...]
    trials: tuple[FittedModel, ...] = ()

    def done(self) -> "SearchStep":
        """Return the step with its fits alone: its looks take most of the memory of a search."""
        return SearchStep(self.start, _not_kept, (), self.trials)


def _not_kept() -> LackOfFit:
    raise AssertionError("the lack of fit of a step that is done is not kept")


Tried = Sequence[tuple[SearchStep, int]]
"""Steps, each with the largest number of effects that are tried. They share the processes."""


def singles(step: SearchStep, context: SearchContext) -> tuple[FittedModel, ...]:
    """Fit every effect alone, then the leading ones that have several forms in these."""
    (trials,) = _polished([step.start], _fitted([(step, len(step.looks))], context), context)
    most = step.start.settings.most_formed
    leading = [trial for trial in trials if fixed_forms(trial)][:most]
    (formed,) = _forms([step.start], [leading], context)
    return in_order([*trials, *formed])


def more(
    tried: Tried, context: SearchContext, best: float = np.inf
) -> list[tuple[FittedModel, ...]]:
    """Fit one effect more in each step, those that promise most, then its best model in forms.

    Fits that gain next to nothing, or end far above ``best``, the penalised chi-square of a model
    at hand, stay rough.
    """
    if not tried:
        return []
    begun = [step.start for step, _ in tried]
    trials = _polished(begun, _fitted(tried, context, best), context, best)
    leading = [
        _promising(start, of_step[:1], best) for start, of_step in zip(begun, trials, strict=True)
    ]
    formed = _forms(begun, leading, context)
    return [in_order([*own, *forms]) for own, forms in zip(trials, formed, strict=True)]


@dataclass(frozen=True, eq=False)
class _Try:
    """An effect that is fitted in addition, in the step of this number."""

    step: int
    start: FittedModel
    seen: Screening


def _promising(start: FittedModel, trials: Sequence[FittedModel], best: float) -> list[FittedModel]:
    """Return the trials from a start that may become its best: those worth a closer fit.

    They do not end far above the best one, or the best one at hand, and gain enough over the start.
    """
    lowest = min([best, *(trial.penalised for trial in trials)])
    highest = lowest + start.settings.hopeless_chi2
    most = start.fit.chi2 - start.settings.hopeless_gain
    return [t for t in trials if t.penalised <= highest and t.fit.chi2 <= most]


def _fitted(tried: Tried, context: SearchContext, best: float = np.inf) -> list[list[FittedModel]]:
    """Fit one effect more in each step, those that promise most.

    Roughly first, weak ones from a second start as well. Those that may become the best are then
    fitted to the end, from the other starts, too.
    """
    tries = [
        _Try(k, step.start, seen)
        for k, (step, most) in enumerate(tried)
        for seen in most_promising(step, most)
    ]
    models = [model_with(one.start, one.seen.effect) for one in tries]
    rough = tried[0][0].start.settings.rough_gain
    others = [starts(one.seen)[1:] for one in tries]
    found: dict[int, FittedModel] = {}

    def fit(which: Sequence[int], how: Callable[[int], FittedModel], part: str) -> None:
        told = SearchProgress(part, context.whole, len(which), context.tell)
        ends = parallel_map(lambda k: how(which[k]).fit, len(which), context.processes, told)
        found.update((i, FittedModel(models[i], end)) for i, end in zip(which, ends, strict=True))

    def promises(i: int) -> bool:
        of_step = [trial for k, trial in found.items() if tries[k].step == tries[i].step]
        return found[i] in _promising(tries[i].start, of_step, best)

    def first(i: int) -> FittedModel:
        return from_best_start(tries[i].start, tries[i].seen, rough)

    def second(i: int) -> FittedModel:
        return from_elsewhere(tries[i].start, tries[i].seen, found[i], others[i][:1], rough)

    def to_the_end(i: int) -> FittedModel:
        left = others[i][1:] if i in weak else others[i]
        return from_elsewhere(tries[i].start, tries[i].seen, followed(found[i]), left)

    # Most effects promise nothing, and a rough fit takes few runs. Weak ones start again before the
    # choice: a minimum near the null value would hide a lower one at the usual strength.
    every = range(len(tries))
    fit(every, first, ROUGHLY)
    weak = [i for i in every if _is_weak(found[i], tries[i])]
    fit(weak, second, SECOND)
    fit([i for i in every if promises(i)], to_the_end, TO_THE_END)
    _told([found[i] for i in every], context)
    return [[found[i] for i in every if tries[i].step == k] for k in range(len(tried))]


def _is_weak(end: FittedModel, one: _Try) -> bool:
    """Tell whether an effect ends near its null value, or gains next to nothing.

    Chi-square may have a minimum there, and a lower one at the effect's usual strength.
    """
    effect, settings = one.seen.effect, one.start.settings
    _, quantity = strength_of(effect)
    share = (end.strength(effect) - quantity.value) / (quantity.typical - quantity.value)
    if abs(share) < settings.weak_share:
        return True
    return end.fit.chi2 > (1.0 - settings.little_gain_share) * one.start.fit.chi2


def most_promising(step: SearchStep, most: int) -> list[Screening]:
    """Return at most some looks of a step, the lowest linearised chi-square first."""
    return sorted(step.looks, key=lambda look: float(look.ahead.min()))[:most]


def promising_or_kin(step: SearchStep, effect: str) -> list[Screening]:
    """Return the looks to try in the place of an effect: the leading ones, and all of its group."""
    catalogue, most = known_effects(), step.start.settings.most_exchanged
    return [
        look
        for k, look in enumerate(most_promising(step, len(step.looks)))
        if k < most or catalogue[look.effect].group == catalogue[effect].group
    ]


def _forms(
    begun: Sequence[FittedModel],
    leading: Sequence[Sequence[FittedModel]],
    context: SearchContext,
) -> list[list[FittedModel]]:
    """Fit models of each step with one form parameter more, the best one with a second, if it pays.

    Models whose form parameter lowers the penalised chi-square are searched on from elsewhere:
    otherwise a further effect may gain only because its fit starts anew.
    """
    settings = begun[0].settings
    found: list[list[FittedModel]] = [[] for _ in leading]
    for _ in range(settings.most_form_parameters):
        tasks = [
            (k, trial, *form)
            for k, trials in enumerate(leading)
            for trial in trials
            for form in fixed_forms(trial)
        ]
        if not tasks:
            break
        formed = _told(with_forms([task[1:] for task in tasks], context.processes), context)
        paying: list[list[FittedModel]] = [[] for _ in leading]
        for (k, start, *_), trial in zip(tasks, formed, strict=True):
            found[k].append(trial)
            if trial.penalised < start.penalised:
                paying[k].append(trial)
        chosen = [in_order(trials)[: settings.most_polished_forms] for trials in paying]
        better = work_together(lambda trials: polished(trials, context.processes), chosen)
        for k, trials in enumerate(better):
            found[k] += trials
        leading = [in_order(trials)[:1] for trials in better]
    return found


def with_forms(tasks: Sequence[tuple[FittedModel, str, str]], processes: int) -> list[FittedModel]:
    """Fit a model with a form parameter of an effect more, for each such task."""
    fits = parallel_map(lambda i: with_form(*tasks[i]).fit, len(tasks), processes)
    return list(map(FittedModel, (model_with_form(*task) for task in tasks), fits))


def _polished(
    begun: Sequence[FittedModel],
    trials: Sequence[Sequence[FittedModel]],
    context: SearchContext,
    best: float = np.inf,
) -> list[list[FittedModel]]:
    """Return the trials of each step in order, the leading ones searched on from elsewhere."""
    orders = [in_order(of_step) for of_step in trials]
    leading = [
        _promising(start, order[: start.settings.most_polished], best)
        for start, order in zip(begun, orders, strict=True)
    ]
    better = work_together(lambda trials: polished(trials, context.processes), leading)
    return [
        list(in_order([*of_step, *(t for t in order if t not in chosen)]))
        for of_step, chosen, order in zip(better, leading, orders, strict=True)
    ]


def work_together(
    work: Callable[[list[FittedModel]], list[FittedModel]],
    lists: Sequence[Sequence[FittedModel]],
) -> list[list[FittedModel]]:
    """Apply ``work`` to all lists in one call; return lists of the same lengths."""
    ends = iter(work([trial for trials in lists for trial in trials]))
    return [list(islice(ends, len(trials))) for trials in lists]


def _told(trials: list[FittedModel], context: SearchContext) -> list[FittedModel]:
    for trial in trials:
        free = [f"{e} ({', '.join(f)})" for e, f in trial.model.effects.items()]
        context.tell(f"{' + '.join(free)}: chi-square {trial.fit.chi2:.1f}")
    return trials


def in_order(trials: Sequence[FittedModel]) -> tuple[FittedModel, ...]:
    """Return trials, the best penalised chi-square first."""
    return tuple(sorted(trials, key=lambda trial: trial.penalised))
