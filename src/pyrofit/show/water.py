"""Water that temperatures show and a model lacks, in words."""

from pyrofit.quantities.units import ICE_POINT_K
from pyrofit.show.text import listed
from pyrofit.steps.preview.record import Preview


def lacking_water(found: Preview) -> str:
    """Say where temperatures show water of which the model has none; nothing where they do not."""
    if not found.held_up:
        return ""
    at = found.held_up[0].temperature_K - ICE_POINT_K
    where = listed([one.experiment for one in found.held_up])
    return (
        f"{where}: near {at:.0f} °C the temperature rises more slowly than before and after, as "
        "where water evaporates. The model of this sample has none: give its layers a mass "
        "fraction of water (docs/own_study.md, a charring solid)."
    )
