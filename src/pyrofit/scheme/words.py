"""The result in sentences, and the rule of the choice."""

from pyrofit.scheme.choice import Candidate, Choice
from pyrofit.scheme.settings import SchemeSettings

RULE = (
    "The log scores of the heating rates left out are summed. A scheme predicts as "
    "well as the best one if its sum is at most one standard error of the "
    "difference lower. This standard error counts as {least:g} at least and "
    "{largest:g} at most. A scheme of a lower BIC than the best one's may lose "
    "{largest:g}: further parameters must pay in the fit and in predictions. The chosen "
    "scheme is the one with the fewest parameters among these, and with the lowest "
    "BIC among equals."
)


def sentences(choice: Choice, settings: SchemeSettings) -> str:
    """State the chosen scheme, its predictions, and its misfit."""
    chosen, own = choice.chosen, choice.own
    said = [
        f"Chosen: {chosen.fitted.posed.words} ({chosen.fitted.posed.count} parameters). It "
        f"predicts heating rates left out of the fit with an rms of {chosen.left_out_rms:.2g} of "
        f"the initial mass; the scheme of the study, {_own(own)}.",
        _against_own(choice.gain, settings),
    ]
    held = {c.fitted.name: choice.held_out[c.fitted.name] for c in (chosen, own)}
    if held[chosen.fitted.name]:
        parts = zip(held[chosen.fitted.name], held[own.fitted.name], strict=True)
        text = ", ".join(f"{a.record.rate:g} K/min {a.rms:.2g} ({b.rms:.2g})" for a, b in parts)
        said.append(
            f"Records that no scheme was fitted to (the study's scheme in brackets): {text}."
        )
    if choice.best is not chosen:
        said.append(
            f"{_capital(choice.best.fitted.posed.words)} predict best, by "
            f"{choice.best.log_score - chosen.log_score:.1f} of log score only."
        )
    said.append(_left(chosen, settings))
    return " ".join(said)


def _against_own(gain: float, settings: SchemeSettings) -> str:
    if abs(gain) <= settings.largest_margin:
        return f"Their log scores differ by {abs(gain):.1f} only: both predict equally well."
    side, word = ("above", "better") if gain > 0.0 else ("below", "worse")
    return (
        f"Its log score is {abs(gain):.1f} {side} that of the study's: it predicts clearly {word}."
    )


def _own(own: Candidate) -> str:
    return f"fitted alike, with {own.left_out_rms:.2g} ({own.fitted.posed.count} parameters)"


def _left(chosen: Candidate, settings: SchemeSettings) -> str:
    size = chosen.fitted.size
    scheme = chosen.fitted.posed.scheme
    assert scheme is not None
    text = (
        f"It leaves {size:g} of the initial mass unexplained."
        if size > 0.0
        else "It leaves nothing but noise."
    )
    if scheme.reactions == settings.most_reactions and size > 0.0:
        text += " It has as many reactions as are tried: more may predict better."
    return text


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
