"""Whether a model describes its tests, in sentences."""

from collections.abc import Iterator, Sequence

from pyrofit.analysis.differing_repeats import WAY_OUT, differs
from pyrofit.config import Study
from pyrofit.experiments import kind_of
from pyrofit.model.heated import Baseline
from pyrofit.results.goodness import LEVEL, Goodness, Miss, SignalGoodness
from pyrofit.scheme.masses import FEWEST_RATES, fitted_rates
from pyrofit.show.text import listed, several
from pyrofit.show.units import celsius, difference, difference_unit

MOST_NAMED = 3
"""Signals and repeats that are named at most."""
ONE_SIDE = 0.5
"""Mean of a misfit over its rms, from which it is told as one to one side."""
OTHER_TOTAL = 0.1
"""Relative difference of integrals that is told."""


def next_step(study: Study, stage: str, found: Goodness) -> tuple[str, str]:
    """Return the step that a misfit of a stage leads to, and its command; empty if it is a test.

    Where only heated samples are fitted, it is that of the kinetics.
    """
    if _lacks_baseline(study, found):
        return (
            "The instrument may add a baseline to the heat flow: subtract it, or give the "
            "experiment a `baseline` of two parameters",
            "",
        )
    kinds = {kind_of(study.experiments[t.experiment]).stage for t in study.imp.channels}
    if stage == "imp" and kinds != {"kinetics"}:
        return "The step diagnose searches the missing effect", "pyrofit run STUDY diagnose"
    if len(fitted_rates(study)) < FEWEST_RATES:
        return (
            "Measure the mass at three heating rates or more, which tell the missing reactions",
            "",
        )
    return "More reactions may describe them: run the step scheme", "pyrofit run STUDY scheme"


def _lacks_baseline(study: Study, found: Goodness) -> bool:
    """Tell whether heat flows alone are missed, and the study has no baseline for them."""
    missed = _missed(found)
    given = [getattr(study.experiments[s.experiment], "baseline", None) for s in missed]
    return bool(given) and all(one == Baseline() for one in given)


def verdict_words(fit: str, found: Goodness) -> str:
    """Return one sentence: whether the model of a fit, in words, describes its tests."""
    model = f"The model of the {fit}" if fit else "The model"
    if found.describes:
        return f"{model} describes the tests: its misfit is within their noise (p = {found.p:.2g})."
    if found.p >= LEVEL:
        far_off = [s for s in found.signals if s.far_off]
        return (
            f"{model} does not describe the tests: it misses {_of_all(far_off, found)} "
            f"{_tenth(far_off)}. Lasting errors of the tests are as large, so the "
            "test of the noise cannot tell."
        )
    # Noise may exclude all signals together, and none alone.
    likely = min(found.signals, key=lambda s: s.p)
    missed = _missed(found) or [likely]
    excused = [s for s in found.signals if s.p >= LEVEL and s.far_off]
    beside = f" or {_tenth(excused)}" if excused else ""
    worst = max(found.signals, key=_share)
    of = "" if len(found.signals) == 1 else f", that of {_named([worst])}"
    return (
        f"{model} does not describe the tests: it misses {_of_all(missed, found)} by more than "
        f"noise does (p {_below(found.p)}){beside}. The rms misfit is "
        f"at most {100.0 * _share(worst):.2g} % of a signal's range{of}."
    )


def _missed(found: Goodness) -> list[SignalGoodness]:
    return [s for s in found.signals if s.p < LEVEL or s.far_off]


def _share(s: SignalGoodness) -> float:
    """Return the rms misfit of a signal over its range."""
    return s.rms / s.range if s.range else 0.0


def _tenth(far_off: Sequence[SignalGoodness]) -> str:
    """Say by how much signals are missed that noise may excuse."""
    heat = " or of its total heat" if any(s.heat_off for s in far_off) else ""
    return f"for long by more than a tenth of its range{heat}"


def _of_all(missed: Sequence[SignalGoodness], found: Goodness) -> str:
    """Say how many signals are missed, and which, unless all are."""
    names = "" if len(missed) == len(found.signals) else f" ({_named(missed)})"
    return f"{len(missed)} of {several(len(found.signals), 'signal')}{names}"


def _named(signals: Sequence[SignalGoodness]) -> str:
    """Name signals, the one of the largest misfit first."""
    ordered = sorted(signals, key=_share, reverse=True)
    names = [f"{s.signal.replace('_', ' ')} of {s.experiment}" for s in ordered]
    more = len(names) - MOST_NAMED
    return listed(names[:MOST_NAMED] + ([f"{more} more"] if more > 0 else []))


def goodness_sentences(study: Study, stage: str, fit: str, found: Goodness) -> list[str]:
    """Return the verdict, the windows of misfit, repeats that differ, and what follows."""
    said = [verdict_words(fit, found)]
    if not found.describes:
        said += missed_most(study, found)
        said.append(
            "Its values are apparent values of this model, and their intervals include the "
            f"misfit. {next_step(study, stage, found)[0]}."
        )
    said += list(repeats_that_differ(study, found))
    return said


def of_one_rate(names: Sequence[str]) -> Iterator[str]:
    """Say which parameters rest on one heating rate, and what tells them."""
    if names:
        follow = "follows" if len(names) == 1 else "follow"
        yield (
            f"The tests have one heating rate: {listed(names)} {follow} from the order of reaction "
            "that the model assumes, and intervals take it as exact. Do not publish such a value."
        )
        yield f"To determine {listed(names)}, measure at three heating rates or more."


def missed_most(study: Study, found: Goodness, most: int = MOST_NAMED) -> list[str]:
    """Return where the signals are missed that are missed most, a sentence for each."""
    missed = sorted((s for s in found.signals if s.misses), key=_share)[::-1]
    return [where_missed(study, s) for s in missed[:most]]


def where_missed(study: Study, s: SignalGoodness) -> str:
    """Return the windows in which a signal is missed, with their size, and its integral."""
    experiment = study.experiments[s.experiment]
    quantity = experiment.quantity(s.signal)
    unit = difference_unit(quantity)
    rms = float(difference(quantity, s.rms))
    windows = [
        _window(w, float(difference(quantity, w.mean)), float(difference(quantity, w.rms)), unit)
        for w in s.misses
    ]
    said = f"{s.experiment}, {experiment.words(s.signal)}: simulated {listed(windows)}."
    if s.rms > max(max(abs(w.mean), w.rms) for w in s.misses):
        said += f" The rms misfit of the whole record is {_size(rms, unit)}."
    if s.total is not None and abs(s.total - 1.0) > OTHER_TOTAL:
        said += f" Its simulated integral is {100.0 * s.total:.0f} % of the measured one."
    return said


def _window(w: Miss, mean: float, rms: float, unit: str) -> str:
    side = "too high" if mean > 0.0 else "too low"
    if abs(mean) < ONE_SIDE * rms:
        mean, side = rms, "off (rms), to both sides,"
    begin, end, of = f"{w.start_s:.0f}", f"{w.end_s:.0f}", "s"
    if w.start_K is not None and w.end_K is not None:
        begin, end, of = f"{celsius(w.start_K):.0f}", f"{celsius(w.end_K):.0f}", "°C"
    place = f"at {begin} {of}" if begin == end else f"from {begin} to {end} {of}"
    return f"{_size(abs(mean), unit)} {side} {place}"


def repeats_that_differ(study: Study, found: Goodness) -> Iterator[str]:
    """Yield a sentence on each repeat that differs from the others of its test."""
    for r in found.repeats[:MOST_NAMED]:
        quantity = study.experiments[r.experiment].quantity(r.signal)
        said = differs(r.kind, r.size, r.low, r.high, quantity, r.held)
        yield f"{r.experiment} {said}. {WAY_OUT}."
    more = len(found.repeats) - MOST_NAMED
    if more > 0:
        said = "differ from their repeats; pyrofit check names them"
        yield f"{several(more, 'further record')} {said}."


def _size(value: float, unit: str) -> str:
    """Write a number with its unit to two digits, without an exponent where it is large."""
    text = f"{value:.2g}"
    text = f"{float(text):.0f}" if value >= 10.0 else text
    return text if unit in ("–", "-") else f"{text} {unit}"


def _below(p: float) -> str:
    return "< 0.001" if p < 1e-3 else f"= {p:.2g}"
