"""The tables of a study, as CSV (every digit) and Markdown (four digits)."""

from pathlib import Path

import pandas as pd

from pyrofit.config import Study
from pyrofit.errors import StudyError, suggest
from pyrofit.results.files import Results, write_csv, write_text
from pyrofit.tables.answer import answer
from pyrofit.tables.compared import COMPARED_TABLES
from pyrofit.tables.describe import titled
from pyrofit.tables.determined import channels, determined, distances
from pyrofit.tables.diagnosed import DIAGNOSIS_TABLES
from pyrofit.tables.imp import costs, table4
from pyrofit.tables.kinetics import table3
from pyrofit.tables.known import has_known, known_values
from pyrofit.tables.parameters import table5, table6
from pyrofit.tables.table import Table
from pyrofit.tables.text import groups, markdown, turned
from pyrofit.tables.truth import known, truth
from pyrofit.tables.validation import validation

TABLES: dict[str, Table] = {
    "answer": Table(
        applies=lambda study: True,
        make=answer,
        title="The answer: estimate, 95 % interval, and the best set of each cost function",
        note="Estimate: the optimum of the likelihood, which weighs each point by its noise; the "
        "interval says how far other values fit as well, the model taken as right. Best sets: of "
        "the lowest cost, by whichever optimiser found it. Values of one column belong together.",
        headings={"low": "95 % low", "high": "95 % high"},
        group_by="fit",
    ),
    "table3": Table(
        applies=lambda study: study.kinetics is not None,
        make=table3,
        title="Kinetic parameters, and how well they reproduce the mass",
        paper="Table 3",
        note="E in kJ/kmol is the same number as in J/mol. The cost is the fitness of our fit; it "
        "is not computed for published sets. The RMSE of the mass fraction is over all "
        "measured points of a heating rate; 'used in fit' is about our fit.",
        headings={"used_in_fit": "used in fit"},
    ),
    "table4": Table(
        applies=lambda study: True,
        make=table4,
        title="Best set, mean and standard deviation over the repetitions",
        paper="Table 4",
        note="sigma is the standard deviation over the n repetitions with n − 1 as divisor: the "
        "scatter of the optimiser, not the uncertainty of the parameter. "
        "'At bound': the best value lies within 0.5 % of the limits' distance from a limit. "
        "'Spread > 20 % of limits': sigma exceeds this share of it, the optimiser finds no one "
        "value. 'By the data': from the 95 % interval, see 'What the data determine'.",
        headings={
            "published_best": "published best",
            "published_mean": "published mean",
            "published_sigma": "published sigma",
            "lower_limit": "lower limit",
            "upper_limit": "upper limit",
        },
        group_by="cost_function",
    ),
    "table5": Table(
        applies=lambda study: True,
        make=table5,
        title="Symbols and units",
        paper="Table 5",
        note="Lauer et al. (2020) print kJ/kg for E and m/K for k, two misprints; here stand "
        "kJ/kmol, as in their Table 3, and W/(m K). kJ/kmol is the same number as J/mol. The code "
        "and its files of results are in SI units; a parameter is given and shown in the unit "
        "behind its name. Where T stands for A, it is the temperature at which the rate constant "
        "has a given value.",
        headings={
            "paper_unit": "unit in Lauer et al. (2020), corrected",
            "si_unit": "SI unit",
            "parameters": "parameters of this study [unit]",
        },
    ),
    "table6": Table(
        applies=lambda study: True,
        make=table6,
        title="Sampling limits",
        paper="Table 6",
        note="All optimisers search within these limits, the same for all cost functions, as in "
        "Lauer et al. (2020), who give none for the kinetics.",
        headings={
            "lower_limit": "lower limit",
            "upper_limit": "upper limit",
            "published_lower": "published lower limit",
            "published_upper": "published upper limit",
            "published_lowest": "published best sets, lowest",
            "published_highest": "published best sets, highest",
        },
        group_by="stage",
    ),
    "determined": Table(
        applies=lambda study: True,
        make=determined,
        title="95 % intervals of the parameters, and what the data determine",
        note="Low, high: 95 % interval about the optimum of the likelihood, chi-square divided by "
        "its value per degree of freedom where that exceeds 1; 'noise alone': without that "
        "division, where that differs. Width in per cent of the "
        "distance of the limits: up to 20 determined, up to 50 weakly determined, else "
        "undetermined. Linear: from the parabola of chi-square; profile: all other parameters "
        "fitted anew at each value. All intervals take the model and its other values as exact, "
        "those of the inverse modelling the kinetics as well.",
        headings={
            "low": "95 % low",
            "high": "95 % high",
            "width_percent": "width [% of limits]",
            "ends": "cut off",
            "noise_low": "noise alone, low",
            "noise_high": "noise alone, high",
            "strongest_correlation": "strongest correlation",
        },
        group_by="fit",
    ),
    "known_values": Table(
        applies=has_known,
        make=known_values,
        title="Known values and estimates",
        note="Known: mean and standard deviation (sd) given under `known`. They are data of the "
        "analysis of the likelihood; optimisers of costs search within 3 sd of the known value. "
        "Distance: estimate minus known value, over its sd.",
        headings={
            "known": "known value",
            "known_sd": "its sd",
            "low": "95 % low",
            "high": "95 % high",
            "away_sd": "distance [sd]",
        },
        group_by="fit",
    ),
    "noise": Table(
        applies=lambda study: True,
        make=channels,
        title="Noise of the signals, and how the optimum fits them",
        note="Estimated from the measured series alone; sd is the standard deviation. Floors are "
        "added to it in squares: 0.5 s of timing and the solver's error; for TGA without a stated "
        "uncertainty it is what no model comes nearer than. p: probability that white noise looks "
        "as correlated as the whitened scatter. Chi-square per point is near 1 where the model "
        "fits within the noise.",
        headings={"chi2_per_point": "chi-square per point"},
        group_by="fit",
    ),
    "distances": Table(
        applies=lambda study: True,
        make=distances,
        title="The optimisers' sets beside the optimum of the likelihood",
        note="The optimum weighs each point by its noise, the costs do not: their own minima, "
        "found by least squares, are off it as well. 'Inside': parameters less than 1.96 standard "
        "deviations off.",
        headings={
            "cost_function": "cost function",
            "chi2_per_freedom": "chi-square per degree of freedom",
            "within": "parameters inside their interval",
            "farthest": "farthest parameter",
            "distance_sd": "its distance [sd]",
        },
    ),
    "truth": Table(
        applies=lambda study: bool(known(study)),
        make=truth,
        title="Truth and the best sets",
        note="Errors are estimate minus truth, in per cent of the truth and of the distance "
        "between the limits. An inverse modelling with fitted kinetics takes those of the "
        "optimiser with the lower cost.",
        headings={
            "sceua_best": "SCE-UA best",
            "sceua_error_truth_percent": "SCE-UA error [% of truth]",
            "sceua_error_limits_percent": "SCE-UA error [% of limits]",
            "least_squares_best": "least squares best",
            "least_squares_error_truth_percent": "least squares error [% of truth]",
            "least_squares_error_limits_percent": "least squares error [% of limits]",
            "cmaes_best": "CMA-ES best",
            "cmaes_error_truth_percent": "CMA-ES error [% of truth]",
            "cmaes_error_limits_percent": "CMA-ES error [% of limits]",
        },
        group_by="fit",
    ),
    "costs": Table(
        applies=lambda study: True,
        make=costs,
        title="Optimisers compared on the same costs",
        note="Model calls are those of all repetitions, and of all starts. The ratio is the lowest "
        "cost of the others over the best of SCE-UA. 'From SCE-UA's best': where least squares "
        "gets from there; a set that it lowers is no minimum. The solver's error is 4/3 of what "
        "twice the cells and half the steps change. 'At bound': within 0.1 % of the limits' "
        "distance.",
        headings={
            "cost_function": "cost function",
            "sceua_best": "SCE-UA best",
            "sceua_best_solver_error": "solver's error in it",
            "sceua_mean": "SCE-UA mean",
            "sceua_at_lowest": "repetitions within 1 % of the lowest cost of all",
            "sceua_calls": "SCE-UA model calls",
            "sceua_failed_calls": "failed calls",
            "least_squares_from_sceua": "least squares from SCE-UA's best",
            "least_squares_starts": "random starts of least squares",
            "least_squares_starts_at_best": "of these within 1 % of its best",
            "least_squares_best": "least squares best",
            "least_squares_calls": "least squares model calls",
            "least_squares_at_bound": "least squares at bound",
            "cmaes_starts": "random starts of CMA-ES",
            "cmaes_starts_at_best": "of these within 1 % of its best",
            "cmaes_best": "CMA-ES best",
            "cmaes_calls": "CMA-ES model calls",
            "cmaes_at_bound": "CMA-ES at bound",
            "lowest_by": "the lower of the two",
        },
        upright="cost_function",
    ),
    "validation": Table(
        applies=lambda study: bool(study.validation.experiments),
        make=validation,
        title="Scores of every set at every predicted experiment",
        note="CV(RMSE) is the RMSE divided by the mean of the measured mass loss rate. 'Held-out "
        "signal': not fitted, though another signal of the same experiment was. 'Solver': the "
        "solver's own error in the same measure, estimated by running again with twice the cells "
        "and half the steps.",
        headings={
            "cost_function": "cost function",
            "found_by": "found by",
            "cv_rmse": "CV(RMSE) [-]",
            "solver_cv_rmse": "solver, CV(RMSE) [-]",
            "rmse_K": "RMSE [K]",
            "solver_rmse_K": "solver, RMSE [K]",
        },
        group_by="experiment",
    ),
    **COMPARED_TABLES,
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
    write_table(results.root / "tables", name, table, frame, study)


def make_diagnosis_tables(study: Study, results: Results) -> dict[str, pd.DataFrame]:
    """Write the tables of the diagnosis to ``diagnosis/tables``; return them, none without rows."""
    folder = results.diagnosis("tables")
    frames = diagnosis_tables(study, results)
    for name, table in DIAGNOSIS_TABLES.items():
        if name in frames:
            write_table(folder, name, table, frames[name], study)
        else:  # of an earlier diagnosis
            for kind in ("csv", "md"):
                (folder / f"{name}.{kind}").unlink(missing_ok=True)
    return frames


def diagnosis_tables(study: Study, results: Results) -> dict[str, pd.DataFrame]:
    """Return the tables of the diagnosis that have rows."""
    frames = {name: table.make(study, results) for name, table in DIAGNOSIS_TABLES.items()}
    return {name: frame for name, frame in frames.items() if len(frame)}


def write_table(folder: Path, name: str, table: Table, frame: pd.DataFrame, study: Study) -> None:
    """Write a table to ``<folder>/<name>.csv`` and ``.md``."""
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
    parts = [f"# {titled(study, table.title, table.paper)}{synthetic}\n"]
    for heading, part in readable(table, frame):
        parts += [f"## {heading}\n"] if heading else []
        parts.append(markdown(part))
    parts += [table.note + "\n"] if table.note else []
    return "\n".join(parts)
