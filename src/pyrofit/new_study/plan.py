"""Which experiments and signals a new study fits, and which test the model."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from pyrofit.experiments import files_of
from pyrofit.experiments.base import Stage
from pyrofit.new_study.draft import MeasuredFile


@dataclass(frozen=True)
class TermOfPlan:
    """A term of a cost of a new study."""

    experiment: str
    signal: str
    normalisation: str


@dataclass(frozen=True)
class PartOfPlan:
    """Experiments of one stage.

    Parameters
    ----------
    runs
        All of them.
    held_out
        Names of those that no cost uses.
    terms
        Terms of the cost.
    """

    runs: tuple[MeasuredFile, ...]
    held_out: tuple[str, ...]
    terms: tuple[TermOfPlan, ...]

    @property
    def fitted(self) -> tuple[MeasuredFile, ...]:
        """Experiments that the cost uses."""
        used = {term.experiment for term in self.terms}
        return tuple(run for run in self.runs if run.name in used)


def part_of(stage: Stage, records: Iterable[MeasuredFile]) -> PartOfPlan:
    """Return the experiments of a stage, those it holds out, and the terms of its cost.

    Of two or more fluxes of a kind, the experiments with the largest are held out. So are records
    of temperatures alone at this flux, which may be of the same tests. Of three or
    more heating rates, those with the middle one are: any correct kinetics predict a rate between
    others. Tests in a gas with oxygen are held out beside others: the model has no oxidation.
    """
    runs = tuple(run for run in records if run.of.stage == stage)
    rate = any(_shows_loss(run) for run in runs)
    oxidised = [run.name for run in runs if run.in_oxygen]
    held: list[str] = oxidised if len(oxidised) < len(runs) else []
    for kind in dict.fromkeys(run.kind for run in runs):
        own = [run for run in runs if run.kind == kind and run.name not in held]
        own = [run for run in own if _shows_loss(run) or not rate]
        held += _with_temperatures(runs, _last(own)) if stage == "imp" else _middle(own)
    terms = [
        TermOfPlan(run.name, signal, normalisation)
        for run in runs
        if run.name not in held and (stage == "imp" or _shows_loss(run) or not rate)
        for signal, normalisation in _terms(run)
    ]
    if len({term.signal for term in terms}) == 1 and stage == "kinetics":
        terms = [TermOfPlan(term.experiment, term.signal, "") for term in terms]
    return PartOfPlan(runs, tuple(held), tuple(terms))


def _numbers(runs: Sequence[MeasuredFile]) -> dict[str, float | str]:
    """Return the number of each experiment by name; the name where the number is not known."""
    return {run.name: run.number if run.told else run.name for run in runs}


def _last(runs: Sequence[MeasuredFile]) -> list[str]:
    """Return the experiments with the largest of two or more numbers."""
    numbers = _numbers(runs)
    if len(set(numbers.values())) < 2:
        return []
    if all(isinstance(number, float) for number in numbers.values()):
        last: float | str = max(n for n in numbers.values() if isinstance(n, float))
    else:
        last = list(numbers.values())[-1]
    return [name for name, number in numbers.items() if number == last]


def _with_temperatures(runs: Sequence[MeasuredFile], held: Sequence[str]) -> list[str]:
    """Return held-out experiments, and records of temperatures alone of their kind and number."""
    tests = {(run.kind, run.number) for run in runs if run.name in held and run.told}
    alone = [run for run in runs if not _shows_loss(run) and run.name not in held]
    return [*held, *(run.name for run in alone if run.told and (run.kind, run.number) in tests)]


def _middle(runs: Sequence[MeasuredFile]) -> list[str]:
    """Return the experiments with the middle of three or more heating rates; none that is held."""
    ramps = [run for run in runs if not files_of(run.kind).facts(run.frames).get("set_point_K")]
    numbers = {run.name: run.number for run in ramps}
    different = sorted(set(numbers.values()))
    if len(different) < 3:
        return []
    middle = different[len(different) // 2]
    return [name for name, number in numbers.items() if number == middle]


def _shows_loss(run: MeasuredFile) -> bool:
    """Tell whether the cost can use more of an experiment than temperatures."""
    return run.path is None or not all(found.of.is_temperature for found in run.signals)


def _terms(run: MeasuredFile) -> list[tuple[str, str]]:
    """Return the signals of a cost, and the divisor of each.

    Those are all rates, signals of the released mass where no rate of it is recorded, and the
    temperatures of slabs; of other samples a temperature only where there is nothing else.
    """
    if run.path is None:
        return [(files_of(run.kind).computed_signal, "mean")]
    rates = [f for f in run.signals if f.of.relative]
    losses = [f for f in run.signals if f.of.released is not None]
    others = [f for f in run.signals if not f.of.relative and not f.of.is_temperature]
    chosen = [*rates, *([] if any(f.of.relative for f in losses) else others)] or list(
        run.signals[:1]
    )
    if run.of.stage == "imp":
        chosen += [f for f in run.signals if f.of.is_temperature and f not in chosen]
    return [(f.signal, "mean" if f.of.relative else "range") for f in chosen]


def uncompared(part: PartOfPlan) -> list[str]:
    """Say which signals of fitted experiments no term compares: a mass beside its own rate."""
    compared = {(term.experiment, term.signal) for term in part.terms}
    return [
        f"{run.name}, {found.signal}: in no cost, as the rate is of the same load cell."
        for run in part.fitted
        for found in run.signals
        if (run.name, found.signal) not in compared
    ]


def heats(runs: Iterable[MeasuredFile]) -> tuple[str, ...]:
    """Return the keys of material and reactions on which signals rest, besides the kinetics."""
    found = (f.of.rests_on for run in runs for f in run.signals)
    return tuple(dict.fromkeys(key for keys in found for key in keys))


def titles(runs: Sequence[MeasuredFile]) -> dict[str, str]:
    """Return by experiment what makes its title unique; empty where it is so already.

    >>> titles([MeasuredFile("tga", "a", None, 10.0), MeasuredFile("tga", "b", None, 10.0)])
    {'a': ' (a)', 'b': ' (b)'}
    """
    same = [(run.kind, run.number) for run in runs]
    return {
        run.name: f" ({run.name})" if same.count((run.kind, run.number)) > 1 else "" for run in runs
    }
