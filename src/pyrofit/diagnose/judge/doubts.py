"""Why a claim is not sure, in words."""

from collections.abc import Iterator, Sequence

import numpy as np

from pyrofit.diagnose.base.prediction import HELD_OUT
from pyrofit.diagnose.judge.findings import Finding, Judged
from pyrofit.effects import known_effects


def infirm(finding: Finding) -> Iterator[str]:
    """Say why the leading effect is not firm, and the measurement to make."""
    effect = known_effects()[finding.leading]
    if finding.implausible:
        (quantity,) = effect.strength.values()
        strength = finding.judged[0].trial.strength(finding.leading)
        unit = "" if quantity.unit == "-" else f" {quantity.unit}"
        check = f": {effect.check}" if effect.check else ""
        yield (
            f"the apparatus is described incompletely: the {quantity.label} would be "
            f"{strength:.3g}{unit}, {finding.implausible:.2g} standard deviations from the "
            f"plausible value{check}"
        )
    if finding.wrong_instead:
        yield (
            f"the known value of {' and '.join(finding.wrong_instead)} may be wrong instead: "
            f"without it, the model fits as well without {effect.title}"
        )
    if not finding.weighs:
        least = finding.judged[0].trial.settings.claimed_weight
        yield (
            f"{100.0 * finding.weight:.0f} % of the weight of all models have an effect of the "
            f"group {effect.group}; a claim needs {100.0 * least:g} %"
        )


def open_to_terms(finding: Finding) -> str:
    """Name other terms of the model that explain the data nearly as well as an effect does."""
    terms = ", or ".join(finding.open_terms)
    return f"{effect_title(finding.leading)} may be replaced by {terms}, with nearly as good a fit"


def replaceable(findings: Sequence[Finding]) -> list[str]:
    """Name two effects that explain the data nearly as well as one, or one as two."""
    exchanges = {one.replaced: one for finding in findings for one in finding.instead}
    return [
        f"{_joined(one.replaced)} may be replaced by {_joined(one.by)}, with nearly as good a fit"
        for one in exchanges.values()
    ]


def hardly_agreeing(finding: Finding) -> Iterator[str]:
    """Say that the experiments do not agree well enough on the strength for a claim beside misfit.

    An effect that stands for another one explains a part of each experiment, with a strength of its
    own in each. Where only noise is left, the tests of the residuals tell this.
    """
    first = finding.kept[0]
    p, title = first.trust.disagree, effect_title(first.effect)
    if p is None:
        yield f"one experiment alone shows {title}, so no strengths can be compared"
    elif p < first.trial.settings.firm_agreement:
        yield (
            f"the experiments ask for different strengths of {title} (p = {p:.2g}, "
            f"{first.trial.settings.firm_agreement:g} is needed beside other misfit)"
        )


def still_missed(finding: Finding) -> Iterator[str]:
    """Say that even with the effect a signal misfits by several times its noise.

    A model that is so far from the data gains by effects that stand for another one.
    """
    first = finding.kept[0]
    model, most = first.trial.model, first.trial.settings.misfit_beside_claim
    parts = model.by_channel(first.trial.fit.residuals)
    misfits = [float(np.sqrt(np.mean(part**2))) for part in parts]
    place = int(np.argmax(misfits))
    if misfits[place] > most:
        problem = model.likelihood.problem
        name, signal = problem.picks[place][:2]
        experiment = problem.runs[name].experiment
        yield (
            f"with {effect_title(first.effect)}, the {experiment.words(signal)} of "
            f"{experiment.title or name} is missed by {misfits[place]:.2g} times its noise; "
            f"{most:g} times is the most beside a claim"
        )


def _joined(effects: Sequence[str]) -> str:
    return " together with ".join(map(effect_title, effects))


def effect_title(effect: str) -> str:
    """Return the title of an effect."""
    return known_effects()[effect].title


def unconfirmed(judged: Judged) -> str:
    """Say that predictions do not confirm an effect."""
    if not judged.trust.predicts:
        return f"no prediction clearly confirms {effect_title(judged.effect)}"
    trust = judged.trust
    out = trust.worse[0].removeprefix(f"{HELD_OUT}: ") if trust.outvoted else ""
    beside = f" beside {out}" if out else ""
    return (
        f"with {effect_title(judged.effect)}, the log score of held-out signals{beside} gains "
        f"{trust.held_out_gain:+.1f} only; a confirmation needs {trust.settings.informative_gain:g}"
    )


def outvoted(judged: Sequence[Judged]) -> list[str]:
    """Say with which effects one held-out experiment is predicted worse, against several others."""
    by_name: dict[str, list[str]] = {}
    for one in judged:
        if one.trust.outvoted:
            (name,) = one.trust.worse
            by_name.setdefault(name, []).append(
                f"{effect_title(one.effect)} ({one.trust.gains[name]:+.1f})"
            )
    return [
        f"the prediction of {name.removeprefix(f'{HELD_OUT}: ')} gets worse with "
        f"{', '.join(worse)} (log score in brackets), others improve: check how its "
        "apparatus is described"
        for name, worse in by_name.items()
    ]
