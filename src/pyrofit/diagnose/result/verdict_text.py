"""The verdict in plain words."""

from collections.abc import Sequence

from pyrofit.diagnose.judge.findings import Finding, Verdict
from pyrofit.effects import known_effects


def form_words(finding: Finding) -> str:
    """Say in which form an effect is found.

    The forms of one group that cannot be told apart are all named; a fitted form parameter is said.
    """
    catalogue = known_effects()
    titles = " or ".join(catalogue[name].title for name in finding.effects)
    trial = (finding.kept or list(finding.judged))[0].trial
    fitted = trial.model.effects[finding.leading][1:]
    labels = [catalogue[finding.leading].form[name].label for name in fitted]
    return (titles or catalogue[finding.leading].title) + "".join(f", {x} fitted" for x in labels)


def sentences(verdict: Verdict) -> str:
    """State the findings and their certainty in a few sentences."""
    said = {
        "none": _none,
        "named": _named,
        "ambiguous": _ambiguous,
        "multiple": _multiple,
        "partly": _partly,
        "unknown": _unknown,
    }[verdict.kind](verdict)
    return " ".join(filter(None, said))


def _none(verdict: Verdict) -> list[str]:
    return [
        "These data show no missing effect.",
        _because(verdict.reasons),
    ]


def _named(verdict: Verdict) -> list[str]:
    (finding,) = verdict.findings
    return [
        f"The model lacks: {finding.group} ({form_words(finding)}).",
        "With it, no test shows a lack of fit, and predictions improve.",
        _because(verdict.reasons),
    ]


def _ambiguous(verdict: Verdict) -> list[str]:
    if len(verdict.findings) > 1:
        several = f"The model seems to lack {_several(verdict)}, but that is not confirmed."
        return [several, _because(verdict.reasons)]
    (finding,) = verdict.findings
    said = [f"The model lacks an effect; these data leave open which: {_listed(finding)}."]
    if len(finding.effects) == 1:
        said = [f"The model seems to lack {_listed(finding)}, but that is not confirmed."]
    families = {known_effects()[name].family for name in finding.effects}
    if len(families) > 1 and "apparatus" in families:
        said.append("Check the apparatus first: it may cause the same misfit.")
    told = [reason for reason in verdict.reasons if reason != finding.open_words]
    return [*said, _because(told)]


def _multiple(verdict: Verdict) -> list[str]:
    lacks = "lacks" if verdict.confirmed else "seems to lack"
    return [
        f"The model {lacks} {_several(verdict)}.",
        "Without any one of them, the fit is significantly worse.",
        _because(verdict.reasons),
    ]


def _partly(verdict: Verdict) -> list[str]:
    """Name the confirmed effects, and those suspected for the rest."""
    catalogue = known_effects()
    suspects = " or ".join(catalogue[suspect.effect].title for suspect in verdict.suspects)
    helps = "They improve the fit and the log scores of predictions, but explain only a part"
    if len(verdict.findings) == 1:
        helps = "It improves the fit and the log scores of predictions, but explains only a part"
    return [
        f"The model lacks {_several(verdict)}.",
        f"{helps} of the misfit.",
        _because(verdict.reasons),
        f"Leading candidates for the rest: {suspects}." if suspects else "",
    ]


def _unknown(verdict: Verdict) -> list[str]:
    said = ["Model and measurements disagree, and no effect of the catalogue explains it."]
    if verdict.findings:
        names = " with ".join(form_words(finding) for finding in verdict.findings)
        said = [
            "Model and measurements disagree; the missing effect is not known.",
            f"The model with {names} fits best, but does not pass the tests of a claim.",
        ]
    return [*said, _because(verdict.reasons)]


def _several(verdict: Verdict) -> str:
    *first, last = (_listed(finding) for finding in verdict.findings)
    return f"{len(verdict.findings)} effects: {', '.join(first)}, and {last}" if first else last


def _because(reasons: Sequence[str]) -> str:
    return " ".join(f"{reason[0].upper()}{reason[1:]}." for reason in reasons)


def _listed(finding: Finding) -> str:
    catalogue = known_effects()
    return " or ".join(f"{catalogue[n].title} ({catalogue[n].family})" for n in finding.effects)
