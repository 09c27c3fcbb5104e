"""What the activation energies over conversion show."""

from pyrofit.config import Study
from pyrofit.show.facts import Facts
from pyrofit.show.subjects.isoconversional.names import NOTHING


def sentences(study: Study, facts: Facts) -> list[str]:
    """Return the findings of the analysis, and the reactions that it offers."""
    return [*(facts.isoconversional or [NOTHING]), *facts.offers]
