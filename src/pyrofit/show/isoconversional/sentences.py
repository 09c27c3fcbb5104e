"""What the activation energies over conversion show."""

from pyrofit.config import Study
from pyrofit.show.facts import Facts

_NOTHING = (
    "Nothing speaks against one reaction: the activation energy does not vary with conversion by "
    "more than its errors, and the fitted model has the same."
)


def sentences(study: Study, facts: Facts) -> list[str]:
    """Return the findings of the analysis."""
    return list(facts.isoconversional) or [_NOTHING]
