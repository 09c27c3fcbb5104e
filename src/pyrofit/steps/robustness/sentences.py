"""Errors on twins of known truth, in sentences."""

import pandas as pd

from pyrofit.analysis.cost_tests import SIGNIFICANT
from pyrofit.config import Study
from pyrofit.results.files import Results, read_csv
from pyrofit.show.text import listed
from pyrofit.steps.robustness.twins import errors_of_twins, recovered


def sentences(study: Study, results: Results) -> list[str]:
    """Return the sentences on the twins of known truth."""
    table = read_csv(results.of_step("robustness", "table.csv"))
    found = errors_of_twins(study, results)
    kept = recovered(study, found)
    lost = [name for name in study.imp.estimate if name not in kept]
    said = []
    for added, rows in table.groupby("added", sort=False):
        sizes = rows.set_index("cost_function")["error_percent"]
        text = ", ".join(f"{cost} {size:.2g} %" for cost, size in sizes.items())
        p = rows["p"].iloc[0]
        said.append(f"{added}: {text}" + (f", {_apart(p)}" if pd.notna(p) else ""))
    left = f" without {listed(lost)}, which no cost function recovers" if lost else ""
    return [f"Median error of the parameters in per cent of their limits{left}. {'; '.join(said)}."]


def _apart(p: float) -> str:
    return f"{'they differ' if p <= SIGNIFICANT else 'no difference shown'} (p = {p:.2g})"
