"""Facts that table, figure and sentences of data worth share."""

from collections.abc import Iterator

from pyrofit.config import Study
from pyrofit.steps.worth.record import OfTest, Sds, Worth

LITTLE = 5.0
"""Narrowing below which a test is said to tell nothing new [%]."""


def share_left(found: Worth, test: OfTest, checked: bool = False) -> dict[str, float]:
    """Return the share of each standard deviation that a test leaves [%], parameters first."""
    before, after = (found.now_checked, test.checked) if checked else (found.now, test.sds)
    if before is None or after is None:
        return {}
    return {
        name: 100.0 * then / now if now > 0.0 else 100.0
        for (name, now), (_, then) in zip(_all(before), _all(after), strict=True)
    }


def _all(sds: Sds) -> Iterator[tuple[str, float]]:
    yield from sds.parameters.items()
    yield from sds.predictions.items()


def label(study: Study, found: Worth, name: str) -> str:
    """Return the name of a parameter, or of a prediction in words."""
    if name not in found.predictions:
        return name
    one = found.predictions[name]
    return f"{study.experiments[one.experiment].words(one.signal)} of {one.experiment}"


def symbol(study: Study, found: Worth, name: str) -> str:
    """Return the name of a parameter, or symbol and experiment of a prediction."""
    if name not in found.predictions:
        return name
    one = found.predictions[name]
    return f"{study.experiments[one.experiment].quantity(one.signal).symbol} {one.experiment}"
