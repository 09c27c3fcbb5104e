"""Table 3: the kinetics, ours beside the published ones."""

import pandas as pd

from pyrofit.analysis.uses import all_rates, rates_in_fit
from pyrofit.config import Study
from pyrofit.results import kinetics
from pyrofit.results.files import Results
from pyrofit.show.subjects.kinetics.drawing import rate_of
from pyrofit.show.table import Row, Table
from pyrofit.solver.outputs import MASS_FRACTION

_PAPER_UNIT = "kJ/kmol"
_ROWS = (
    ("A", "1/s", "A_1_s", 1.0),
    ("E", "kJ/mol", "E_J_mol", 1e-3),
    # PAPER: Table 3 prints E in kJ/kmol, which is the same number as J/mol.
    ("E", _PAPER_UNIT, "E_J_mol", 1.0),
    ("order n", "-", "order", 1.0),
    ("mass fraction", "-", MASS_FRACTION, 1.0),
)


def table3(study: Study, results: Results) -> pd.DataFrame:
    """Table 3: A, E, n and mass fraction of each reaction, RMSE at every rate, the lowest cost.

    Returns
    -------
    pandas.DataFrame
        One row per quantity; columns ``quantity``, ``of`` (reaction or experiment), ``unit``,
        ``used_in_fit`` (for the heating rates), ``fitted`` (the estimates) and one per published
        set. A study with published values has the set of the lowest cost, too, and that cost.
    """
    sets = kinetics.kinetic_sets(study, results)
    rows: list[Row] = [
        {
            "quantity": quantity,
            "of": f"reaction {reaction}",
            "unit": unit,
            **{label: getattr(chosen[reaction], key) * factor for label, chosen in sets.items()},
        }
        for reaction in sets["fitted"]
        for quantity, unit, key, factor in _ROWS
        if study.published or unit != _PAPER_UNIT
    ]
    if kinetics.LOWEST in sets:
        cost = {kinetics.LOWEST: kinetics.read_fit(study, results).cost}
        rows.append({"quantity": "cost", "of": "fit", "unit": "-", **cost})
    rows += _scores(study, results, list(sets))
    return pd.DataFrame(rows, columns=["quantity", "of", "unit", "used_in_fit", *sets])


def _scores(study: Study, results: Results, sets: list[str]) -> list[Row]:
    scores = kinetics.read_kinetic_scores(study, results, all_rates(study))
    scores = scores.set_index(["experiment", "set"])
    used = set(rates_in_fit(study))
    return [
        {
            "quantity": "RMSE of mass fraction",
            "of": rate_of(study, name),
            "unit": "-",
            "used_in_fit": "yes" if name in used else "no",
            **{label: scores.loc[(name, label), "rmse_mass_fraction"] for label in sets},
        }
        for name in all_rates(study)
    ]


TABLE = Table(
    place=20,
    applies=lambda study: study.kinetics is not None,
    make=table3,
    title="Kinetic parameters, and how well they reproduce the mass",
    paper="Table 3",
    note="Fitted: the estimates, which maximise the likelihood. The set of the lowest cost stands "
    "beside them where values are published; the cost is computed for no other set. The RMSE of "
    "the mass fraction is over all measured points of a heating rate; 'used in fit' is about our "
    "fit.",
    headings={"used_in_fit": "used in fit"},
)
