"""The search: every effect alone, the leading ones in other forms, then pairs, then more."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

from pyrofit.diagnose.base.adequacy import LackOfFit
from pyrofit.diagnose.base.fit import blurred, has_better_noise, refitted_all, sharpened
from pyrofit.diagnose.base.fitted import (
    FittedModel,
    finishes,
    misfits_badly,
    polished,
    strengths_at_limit,
    up_to_date,
)
from pyrofit.diagnose.base.prediction import model_predictions, slab_experiments
from pyrofit.diagnose.search.branches import branches
from pyrofit.diagnose.search.refit import fixed_forms
from pyrofit.diagnose.search.restart import (
    best_of_each,
    from_other_starts,
    refitted_without,
    restarted,
)
from pyrofit.diagnose.search.step import (
    SearchContext,
    SearchStep,
    in_order,
    more,
    promising_or_kin,
    singles,
    with_forms,
)
from pyrofit.diagnose.search.step_start import step_from, with_sharp_noise
from pyrofit.numerics import functions

Fitting = Callable[[Sequence[SearchStep]], Sequence[Sequence[FittedModel]]]


@dataclass(frozen=True, eq=False)
class Search:
    """All steps in order, and the final model: the base itself, or one with effects."""

    rounds: tuple[SearchStep, ...]
    end: FittedModel
    end_lack: LackOfFit
    spare: float
    """2 log(M): fall of the penalised chi-square that a claim of one of M effects needs. Chi-square
    then falls by log(n) + 2 log(M) (Chen and Chen 2008, doi 10.1093/biomet/asn034)."""

    @property
    def base(self) -> FittedModel:
        """The base model's fit."""
        return self.rounds[0].start

    @property
    def trials(self) -> list[FittedModel]:
        """All fits with effects."""
        return [trial for step in self.rounds for trial in step.trials]


def search_effects(
    base: FittedModel, effects: Sequence[str], most: int, context: SearchContext
) -> Search:
    """Add effects to the base until one leaves only noise, none gains enough, or there are most.

    The first is tried even where the base leaves only noise.
    Where more than noise is left, or the noise exceeds the stated one, it is estimated about the
    final model. If that explains more, the search is repeated with it, from the models of the first
    search as well.

    Parameters
    ----------
    base
        The fitted base model.
    effects
        Names of the candidates.
    most
        Most effects of a model.
    context
        Noise, listener, processes, other starts.
    """
    found = Pass(effects, most, context).run(step_from(base, effects, context))
    if settled(found, most):
        return found
    sharper = sharpened(found.end, context.processes)
    if not has_better_noise(sharper, found.end.model.base):
        return found
    context.tell("once more, with the noise about the best model")
    carried = refitted_all([found.base, *_leading(found)], sharper, context.processes)
    start = step_from(carried[0], effects, context)
    return Pass(effects, most, context, tuple(carried[1:])).run(start)


def settled(found: Search, most: int) -> bool:
    """Tell whether a sharper noise cannot change the result of a search with at most some effects.

    As many effects as allowed that leave more than noise leave even more with a smaller noise.
    Where a signal scatters more than stated, that may be misfit. Its noise is then too large, and
    may have led the search to the misfit of another signal. The same holds for known values that a
    misfit of the base weighs too much.
    """
    end = found.end
    if not end.effects:
        return True
    if len(end.effects) >= most and not found.end_lack.adequate:
        return True
    if blurred(end.model.base):
        return False
    return found.end_lack.adequate or misfits_badly(end)


def _leading(found: Search) -> list[FittedModel]:
    """Return the best models of each number of effects, the final one among them."""
    best, most = [found.end], found.end.settings.most_carried
    for size in range(1, max(len(t.effects) for t in found.trials) + 1):
        of_size = [t for t in best_of_each(found.trials) if len(t.effects) == size]
        best += [t for t in of_size[:most] if t is not found.end]
    return best


@dataclass(frozen=True, eq=False)
class Pass:
    """One pass of the search under one noise.

    ``carried`` are models that an earlier pass found, fitted under this noise.
    """

    effects: Sequence[str]
    most: int
    context: SearchContext
    carried: tuple[FittedModel, ...] = ()

    @property
    def spare(self) -> float:
        """Fall of chi-square that the best of as many effects reaches by chance."""
        return 2.0 * float(functions.log(max(len(self.effects), 1)))

    def run(self, first: SearchStep) -> Search:
        """Search from the first look at the base model."""
        if not self.carried:
            first = with_sharp_noise(first, self.context)
        (first,) = self._fitted([first], lambda steps: [self._singles(steps[0])])
        best, best_lack, rounds = first.start, first.lack, [first]
        beam = branches([first], self.spare, self.context)
        while beam:
            steps = [self._onwards(beam[0])]
            added = len(beam[0].effects) - len(best.effects)
            if best.penalised - steps[0].start.penalised >= added * self.spare:
                best, best_lack = steps[0].start, steps[0].lack
            if best_lack().passes or len(beam[0].effects) >= self.most:
                break
            steps += [self._onwards(trial) for trial in beam[1:]]
            steps = self._more(steps)
            rounds += [step.done() for step in steps]
            beam = branches(steps, self.spare, self.context)
        # An exchange may drop an effect, so forms are fitted after it. A split needs them: only an
        # effect with free forms looks like two. What a split brings has no forms yet.
        found = self._not_above_carried(Search(tuple(rounds), best, best_lack(), self.spare))
        if len(found.end.effects) > 1:
            found = self._exchanged(found)
        whole = self._formed(found)
        found = self._split(whole)
        return self._finishing(found if found.end is whole.end else self._formed(found))

    def _not_above_carried(self, found: Search) -> Search:
        """Return the search ended with the best carried model, where that ranks before its end."""
        return self._ended_best(found, self.carried)

    def _ended_best(self, found: Search, trials: Sequence[FittedModel]) -> Search:
        """Return the search ended with the best of some models, where that ranks before its end."""
        best = min([found.end, *trials], key=self._rank)
        return found if best is found.end else self._ended(found, best)

    def _rank(self, trial: FittedModel) -> float:
        return trial.penalised + self.spare * len(trial.effects)

    def _finishing(self, found: Search) -> Search:
        """Return the search ended with the best model whose held-out runs finish.

        A property that an effect changes may leave its physical range outside the fitted data.
        """
        if finishes(found.end):
            return found
        self.context.tell("held-out runs do not finish with the final model; it is left out")
        ranked = sorted(found.trials, key=self._rank)
        return self._ended(found, next(filter(finishes, ranked), found.base))

    def _ended(self, found: Search, best: FittedModel) -> Search:
        step = self._onwards(best)
        return replace(found, end=step.start, end_lack=step.lack())

    def _onwards(self, trial: FittedModel) -> SearchStep:
        return step_from(up_to_date(trial), self._others(trial), self.context)

    def _singles(self, step: SearchStep) -> Sequence[FittedModel]:
        trials = singles(step, self.context)
        return in_order([*trials, *from_other_starts(trials, self.context)])

    def _more(self, steps: Sequence[SearchStep]) -> list[SearchStep]:
        """Fit one effect more to the models that are carried on, the best one first."""
        settings = steps[0].start.settings
        others = [settings.candidates_of_second_branch] * (len(steps) - 1)
        mosts = [settings.candidates_of_first_branch, *others]
        return self._fitted(
            steps, lambda given: more(list(zip(given, mosts, strict=True)), self.context)
        )

    def _fitted(self, steps: Sequence[SearchStep], fitting: Fitting) -> list[SearchStep]:
        """Fit one effect more; where that leads to a lower start, fit the leading ones from it."""
        fits = fitting(steps)
        trials = [
            best_of_each([*own, *self._carried(step)])
            for step, own in zip(steps, fits, strict=True)
        ]
        tasks = [(step.start, own) for step, own in zip(steps, trials, strict=True)]
        found = list(steps)
        lower: list[int] = []
        for k, start in enumerate(restarted(tasks, self.context)):
            if start is not found[k].start:
                self.context.tell(f"a lower minimum without the last effect: {start.fit.chi2:.1f}")
                found[k] = step_from(start, [seen.effect for seen in found[k].looks], self.context)
                lower.append(k)
        refitted = [(found[k], found[k].start.settings.most_refitted) for k in lower]
        again = more(refitted, self.context)
        for k, own in zip(lower, again, strict=True):
            trials[k] = best_of_each([*trials[k], *own])
        return [replace(step, trials=tuple(own)) for step, own in zip(found, trials, strict=True)]

    def _carried(self, step: SearchStep) -> list[FittedModel]:
        """Return the models of an earlier pass that have one effect more than a step's start."""
        size, effects = len(step.start.effects) + 1, set(step.start.effects)
        return [t for t in self.carried if len(t.effects) == size and effects <= set(t.effects)]

    def _exchanged(self, found: Search) -> Search:
        """Try other effects in the place of each of the final model; take the best model."""
        others, effects = self._others(found.end), found.end.effects
        if not others:
            return found
        reduced = refitted_without(found.end, effects, self.context.processes)
        steps = [step_from(up_to_date(without), others, self.context) for without in reduced]
        chosen = [
            replace(step, looks=tuple(promising_or_kin(step, effect)))
            for step, effect in zip(steps, effects, strict=True)
        ]
        found = self._with_more(found, chosen, len(others))
        size = len(effects)
        same = [t for step in found.rounds for t in step.trials if len(t.effects) == size]
        return self._ended_best(found, same)

    def _split(self, found: Search) -> Search:
        """Try two effects in the place of each one with free forms; take the best model.

        An effect with free forms may look like two others. Where it leaves nothing but noise, the
        search has hardly tried a second effect beside one of these.
        """
        if not found.end_lack.adequate or len(found.end.effects) >= self.most:
            return found
        settings = found.end.settings
        steps = [
            step_from(up_to_date(first), self._others(found.end, first), self.context)
            for effect, free in found.end.model.effects.items()
            if len(free) > 1
            for first in in_the_place(found, effect)[: settings.most_split]
        ]
        whole = SearchStep(found.base, partial(getattr, found, "end_lack"), (), (found.end,))
        before = len(found.rounds)
        found = self._with_more(found, steps, settings.most_beside)
        pairs = [t for step in found.rounds[before:] for t in step.trials]
        inside = [t for t in pairs if not strengths_at_limit(t) and finishes(t)]
        split = self._ended_best(found, inside)
        if split.end is found.end or not self._predicts_better(split.end, found.end):
            return found
        return replace(split, rounds=(*split.rounds, whole)) if split.end_lack.adequate else found

    def _predicts_better(self, trial: FittedModel, end: FittedModel) -> bool:
        """Tell whether a model is better with its predictions of experiments left out as well."""
        if not slab_experiments(end):
            return True
        scores = model_predictions(
            [trial, end], self.context.processes, False, made=self.context.made
        )
        return self._rank(trial) - self._rank(end) < 2.0 * (scores[0].total - scores[1].total)

    def _others(self, *models: FittedModel) -> list[str]:
        """Return the candidates that none of some models has."""
        had = {effect for model in models for effect in model.effects}
        return [effect for effect in self.effects if effect not in had]

    def _with_more(self, found: Search, steps: Sequence[SearchStep], most: int) -> Search:
        """Return the search with further steps, each fitted with one effect more."""
        trials = more([(step, most) for step in steps], self.context, found.end.penalised)
        tried = [replace(step, trials=own).done() for step, own in zip(steps, trials, strict=True)]
        return replace(found, rounds=(*found.rounds, *tried))

    def _formed(self, found: Search) -> Search:
        """Fit form parameters of the final model that pay, before a test may reject an effect."""
        best = found.end
        for _ in range(best.settings.most_form_parameters):
            tasks = [(best, *form) for form in fixed_forms(best)]
            formed = in_order(with_forms(tasks, self.context.processes))
            if not formed or formed[0].penalised >= best.penalised:
                break
            (best,) = polished(formed[:1], self.context.processes)
        return found if best is found.end else self._ended(found, best)


def replacing(found: Search, effect: str) -> Iterator[tuple[str, FittedModel]]:
    """Yield the models with one effect in the place of one of the end's, and its name."""
    others = set(found.end.effects) - {effect}
    for trial in found.trials:
        (*rest,) = set(trial.effects) - others
        if others <= set(trial.effects) and len(rest) == 1:
            yield rest[0], trial


def in_the_place(found: Search, effect: str) -> list[FittedModel]:
    """Return the models with the strength of another effect in one's place, the best first."""
    rivals: dict[str, FittedModel] = {}
    for name, trial in sorted(replacing(found, effect), key=lambda one: one[1].penalised):
        if name != effect and len(trial.model.effects[name]) == 1:
            rivals.setdefault(name, trial)
    return list(rivals.values())
