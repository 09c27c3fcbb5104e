"""By how much the misfit of a search's end raises the variance of the noise."""

from pyrofit.diagnose.base.inflation import Inflation, by_misfit, none_for
from pyrofit.diagnose.search.stepwise import Search


def inflation_by_misfit(found: Search) -> Inflation:
    """Return the inflation by the misfit of a search's end, none where it leaves only noise."""
    return none_for(found.end) if found.end_lack.adequate else by_misfit(found.end)
