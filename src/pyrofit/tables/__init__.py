"""The tables of a study, as CSV (every digit) and Markdown (four digits)."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import pandas as pd

from pyrofit.config import Study
from pyrofit.errors import StudyError, suggest
from pyrofit.files import Results, write_csv, write_text
from pyrofit.tables.imp import costs, table4
from pyrofit.tables.kinetics import table3
from pyrofit.tables.text import groups, markdown, turned
from pyrofit.tables.validation import validation


@dataclass(frozen=True)
class Table:
    """A table: when a study has it, how it is made from results, and how it is read."""

    applies: Callable[[Study], bool]
    make: Callable[[Study, Results], pd.DataFrame]
    title: str
    note: str = ""
    headings: Mapping[str, str] = field(default_factory=dict)
    group_by: str | None = None
    upright: str | None = None
    """Column whose values become the headings where the table is read: few rows, many columns."""


TABLES: dict[str, Table] = {
    "table3": Table(
        applies=lambda study: study.kinetics is not None,
        make=table3,
        title="Table 3. Kinetic parameters, and how well they reproduce the measured mass",
        note="E in kJ/kmol is the same number as in J/mol. The cost is the fitness of our fit; it "
        "is not computed for published sets. The RMSE of the mass fraction is over all "
        "measured points of a heating rate; 'used in fit' is about our fit.",
        headings={"used_in_fit": "used in fit"},
    ),
    "table4": Table(
        applies=lambda study: True,
        make=table4,
        title="Table 4. Best set, mean and standard deviation over the repetitions",
        note="sigma is the standard deviation over the n repetitions with n − 1 as divisor: the "
        "scatter of the optimiser, not the uncertainty of the parameter. "
        "'At bound': the best value lies within 0.5 % of the limits' distance from a limit. "
        "'Spread > 20 % of limits': sigma exceeds this share of it, the data do not determine the "
        "parameter.",
        headings={
            "published_best": "published best",
            "published_mean": "published mean",
            "published_sigma": "published sigma",
            "lower_limit": "lower limit",
            "upper_limit": "upper limit",
        },
        group_by="cost_function",
    ),
    "costs": Table(
        applies=lambda study: True,
        make=costs,
        title="Optimisers compared on the same costs",
        note="Model calls are those of all repetitions, and of all starts. The ratio is the best "
        "of least squares over the best of SCE-UA. 'From SCE-UA's best': where least squares gets "
        "from there; a set that it lowers is no minimum. 'At bound': within 0.1 % of the limits' "
        "distance.",
        headings={
            "cost_function": "cost function",
            "sceua_best": "SCE-UA best",
            "sceua_mean": "SCE-UA mean",
            "sceua_calls": "SCE-UA model calls",
            "sceua_failed_calls": "failed calls",
            "least_squares_from_sceua": "least squares from SCE-UA's best",
            "starts": "random starts of least squares",
            "starts_at_best": "of these within 1 % of the best",
            "least_squares_best": "least squares best",
            "least_squares_calls": "least squares model calls",
            "least_squares_at_bound": "least squares at bound",
        },
        upright="cost_function",
    ),
    "validation": Table(
        applies=lambda study: bool(study.validation.experiments),
        make=validation,
        title="Scores of every set at every predicted experiment",
        note="CV(RMSE) is the RMSE divided by the mean of the measured mass loss rate. 'Held-out "
        "signal': not fitted, though another signal of the same experiment was.",
        headings={
            "cost_function": "cost function",
            "found_by": "found by",
            "cv_rmse": "CV(RMSE) [-]",
            "rmse_K": "RMSE [K]",
        },
        group_by="experiment",
    ),
}


def make_table(name: str, study: Study, results: Results) -> None:
    """Write one table to ``tables/<name>.csv`` and ``.md``.

    Raises
    ------
    StudyError
        There is no such table, or the study does not have it.
    """
    if name not in TABLES:
        raise StudyError(f"unknown table '{name}'. {suggest(name, TABLES)}")
    table = TABLES[name]
    if not table.applies(study):
        raise StudyError(f"study '{study.name}' has no {name}: it lacks what the table shows")
    frame = table.make(study, results)
    folder = results.root / "tables"
    write_csv(folder / f"{name}.csv", frame)
    write_text(folder / f"{name}.md", _page(study, table, frame))


def readable(table: Table, frame: pd.DataFrame) -> list[tuple[str, pd.DataFrame]]:
    """Return a table as it is read: in parts with a heading each, columns named in words."""
    if table.upright is not None:
        frame = turned(frame, table.upright, table.headings)
    headings = dict(table.headings)
    return [
        (heading, part.rename(columns=headings)) for heading, part in groups(frame, table.group_by)
    ]


def _page(study: Study, table: Table, frame: pd.DataFrame) -> str:
    synthetic = " (synthetic data)" if study.is_synthetic else ""
    parts = [f"# {table.title}{synthetic}\n"]
    for heading, part in readable(table, frame):
        parts += [f"## {heading}\n"] if heading else []
        parts.append(markdown(part))
    parts += [table.note + "\n"] if table.note else []
    return "\n".join(parts)
