"""How well the kinetics reproduce the mass, in sentences."""

from pyrofit.analysis.uses import all_rates, rates_in_fit
from pyrofit.config import Study
from pyrofit.show.facts import Facts
from pyrofit.show.subjects.kinetics.drawing import rate_of
from pyrofit.show.text import span


def sentences(study: Study, facts: Facts) -> list[str]:
    """Say how well the kinetics reproduce the mass."""
    assert study.kinetics is not None
    if not rates_in_fit(study):
        return []
    table = facts.tables["table3"]
    rows = table[table["quantity"] == "RMSE of mass fraction"]
    used = rows[rows["used_in_fit"] == "yes"]
    other = rows[rows["used_in_fit"] == "no"]
    fitted, every = (
        len({rate_of(study, name) for name in names})
        for names in (rates_in_fit(study), all_rates(study))
    )
    text = (
        f"The kinetics, fitted to {fitted} of {every} heating rates, miss the mass fraction there "
        f"by {span(used['fitted'])} (RMSE)"
    )
    if len(other):
        text += f", and by {span(other['fitted'])} at the others"
    said = [f"{text}."]
    said += [
        f"The published set '{label}' misses it by {span(rows[label])} at all rates."
        for label in study.kinetics.sets
    ]
    return said
