"""The stability of a diagnosis in sentences."""

from collections import Counter

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.diagnosis.words import effect_name
from pyrofit.show.text import listed, several
from pyrofit.steps.stability.facts import Stability, claimed_by, read


def sentences(study: Study, results: Results) -> list[str]:
    """Return the sentences on the stability of a diagnosis."""
    found = read(study, results)
    return [
        _of_draws(found),
        _of_verdicts(found),
        *_of_searches(found),
        *_of_claimed(found),
        *_of_others(found),
    ]


def _of_draws(found: Stability) -> str:
    part = 100.0 * found.draws[0].disturbance
    return (
        f"Random noise with {part:g} % of the estimated standard deviation was added to the data, "
        f"and the diagnosis repeated: {several(len(found.draws), 'time')}."
    )


def _of_verdicts(found: Stability) -> str:
    kinds = Counter(draw.kind for draw in found.draws)
    shown = listed([f"'{kind}' ({n})" for kind, n in kinds.most_common()])
    kind = found.measured.verdict.kind
    verdicts = f"Verdict on the measured data: '{kind}'. Verdicts on the disturbed data: {shown}. "
    if not any([found.claimed, *map(claimed_by, found.draws)]):
        return f"{verdicts}No data set leads to a claimed effect."
    same = sum(set(claimed_by(draw)) == set(found.claimed) for draw in found.draws)
    return f"{verdicts}The same effects are claimed from {_of(same, found)} disturbed data sets."


def _of(times: int, found: Stability) -> str:
    return f"{times} of {len(found.draws)}"


def _of_searches(found: Stability) -> list[str]:
    """Tell which effects every search finds, whatever the tests of a claim say of them."""
    every = [e for e in found.effects if found.times_final(e) == len(found.draws)]
    return [f"Every search ends with {listed(list(map(effect_name, every)))}."] if every else []


def _of_claimed(found: Stability) -> list[str]:
    """Tell how often the effects of the measured data are claimed again."""
    times = {effect: found.times_claimed(effect) for effect in found.claimed}
    every = [effect_name(e) for e, n in times.items() if n == len(found.draws)]
    rest = [f"{effect_name(e)} ({_of(n, found)})" for e, n in times.items() if n < len(found.draws)]
    said = [f"Named from all data sets: {listed(every)}."] if every else []
    if rest:
        said.append(
            f"Not claimed from every disturbed data set: {listed(rest)}. Such a claim is not firm."
        )
    return said


def _of_others(found: Stability) -> list[str]:
    """Tell which effects only disturbed data name."""
    others = [e for e in found.effects if e not in found.claimed and found.times_claimed(e)]
    shares = [f"{effect_name(e)} ({_of(found.times_claimed(e), found)})" for e in others]
    return [f"Named from disturbed data only: {listed(shares)}."] if others else []
