"""The page of the blind test, with its tables and figures."""

from pathlib import Path

import pandas as pd

from pyrofit.errors import DataError
from pyrofit.results.files import write_csv, write_text
from pyrofit.show.text import markdown
from pyrofit_blind_test import foreign
from pyrofit_blind_test.figures import FIGURES, draw_blind_test
from pyrofit_blind_test.places import Places
from pyrofit_blind_test.plan import cases_of
from pyrofit_blind_test.power import power_of_diagnosis
from pyrofit_blind_test.rates import (
    DETECTABLE,
    bias,
    by_detectability,
    coverage,
    cpu_times,
    middles,
    rates,
    window_rates,
)
from pyrofit_blind_test.recovery import recovered_parameters, recovered_strengths
from pyrofit_blind_test.setting import Setting
from pyrofit_blind_test.table import diagnosed_twins, twins

TABLES = (
    *("twins", "rates", "by_detectability", "power", "middles", "strengths", "coverage"),
    *("parameters", "bias", "windows", "times"),
)
_POWER = (
    "Detectability from which half and nine tenths of the effects are rightly named, with 95 % "
    "intervals. A smooth rise from 0 to 1 is fitted; limits of 0.5 and 500 come from its prior."
)
_COVERAGE = "Strengths of named effects that are hidden. Right intervals hold 95 % of them."
_BIAS = (
    "Errors (fitted - truth) / truth of right claims, without and with the claimed effects, and "
    "how often the 95 % interval holds the truth. The truth of a conductivity or specific heat "
    "that depends on temperature is its value at 475 K."
)
_WINDOWS = (
    "Points in windows of the base, against points where the base misses the noise-free truth by "
    "more than half a standard deviation of the noise. Means over effects of 10 standard "
    "deviations or more. A window is the interval that stands out most, not all that is off."
)
_WRONG = [
    "id",
    "curves",
    "hidden",
    "named",
    "verdict",
    "strength",
    "signals",
    "noise",
    "detectability",
]


def write_results(setting: Setting, plan: str, places: Places, so_far: bool = False) -> None:
    """Write tables, figures and page of a plan whose jobs are done.

    With ``so_far``, of the twins that have been diagnosed. Jobs hold twins of all kinds at random.

    Raises
    ------
    StudyError
        There is no such plan.
    DataError
        Without ``so_far``, a job has not been run; with it, no twin has been diagnosed; or a result
        is broken.
    """
    cases = (
        _so_far(setting, plan, places)
        if so_far
        else diagnosed_twins(places, setting.plan(plan).chunks)
    )
    found, of_strengths = twins(places, cases), recovered_strengths(places, cases)
    of_parameters = recovered_parameters(places, cases)
    tables = {
        "twins": found,
        "rates": rates(found),
        "by_detectability": by_detectability(found),
        "power": power_of_diagnosis(found),
        "middles": middles(found),
        "strengths": of_strengths,
        "coverage": coverage(of_strengths),
        "parameters": of_parameters,
        "bias": bias(of_parameters),
        "windows": window_rates(found),
        "times": cpu_times(found),
    }
    for name, frame in tables.items():
        write_csv(places.table(name), frame)
    draw_blind_test(found, places)
    write_text(places.page, page(setting, plan, tables))


def _so_far(setting: Setting, plan: str, places: Places) -> list[str]:
    """Return the names of the twins of a plan that have been diagnosed."""
    found = [case.id for case in cases_of(setting, plan) if places.case(case.id).is_file()]
    if not found:
        raise DataError(
            f"{places.root}: no twin of plan '{plan}' has been diagnosed; run a job first"
        )
    return found


def page(setting: Setting, plan: str, tables: dict[str, pd.DataFrame]) -> str:
    """Return the page as Markdown."""
    found, all_rates = tables["twins"], tables["rates"]
    seeds = setting.plan(plan).seeds
    overall = all_rates[all_rates["by"] == "all"].drop(columns=["by", "of"])
    by = {
        f"By {what}": all_rates[all_rates["by"] == what].drop(columns="by")
        for what in ("signals", "noise")
    }
    sections = [
        f"# {_title(setting, plan)}\n\n{_summary(found, seeds, len(cases_of(setting, plan)))}",
        _section("Rates", overall, "With 95 % intervals of Clopper and Pearson."),
        *(_section(title, frame) for title, frame in by.items()),
        _section("By detectability", tables["by_detectability"]),
        _section("Power", tables["power"], _POWER),
        _section("Strengths: 95 % intervals that hold the truth", tables["coverage"], _COVERAGE),
        _section("Intervals that miss the true strength", _uncovered(tables["strengths"])),
        _section("Base parameters before and after the repair", tables["bias"], _BIAS),
        _section("Windows of the base", tables["windows"], _WINDOWS),
        _section("Sets and gaps of claimed effects", tables["middles"]),
        _section("CPU time of a diagnosis", tables["times"]),
        _section("Wrong claims", _wrong(found), "Of twins with one hidden effect or none."),
        _section(f"Effects of {DETECTABLE:g} sd or more that are not claimed", _missed(found)),
        _section(
            "Pairs", found[found["kind"] == "pair"][_WRONG].sort_values("hidden", kind="stable")
        ),
        _section("Wrong descriptions", _errors(found)),
        _section("A hidden effect removed from the candidates", _left_out(found)),
        "## Figures\n",
        *(
            f"![{name}](figures/{name}.svg)\n\n{caption}\n"
            for name, (_, caption) in FIGURES.items()
        ),
    ]
    return "\n".join(sections)


def _title(setting: Setting, plan: str) -> str:
    if not setting.curves:
        return f"Blind test of the diagnosis, plan {plan}"
    code = foreign.read_manifest(Path(setting.curves)).code
    return f"Blind test of the diagnosis on curves of {code}, plan {plan}"


def _summary(found: pd.DataFrame, seeds: str, planned: int) -> str:
    of = f" of {planned}" if len(found) < planned else ""
    count = found["kind"].value_counts()
    kinds = ", ".join(f"{count[kind]} {kind}" for kind in count.index)
    return (
        f"{len(found)}{of} twins ({kinds}), seeds of the range '{seeds}'. The diagnosis reads the "
        "measurements of each twin, not its truth. Detectability is the number of standard "
        "deviations of the noise by which the best base model misses the truth. An effect of "
        f"{DETECTABLE:g} or more should be named. A claim is a verdict that names one effect, an "
        "ambiguous set, or several effects. The best fit gives the name of a set. A second effect "
        "that is not hidden makes a claim wrong. Effects that these signals cannot distinguish, "
        "such as a slow heater and a late clock, count as one.\n"
    )


def _section(title: str, frame: pd.DataFrame, note: str = "") -> str:
    body = markdown(frame) if len(frame) else "None.\n"
    return f"## {title}\n\n" + (f"{note}\n\n" if note else "") + body


def _wrong(found: pd.DataFrame) -> pd.DataFrame:
    single = found["kind"].isin(["effect", "null"])
    wrong = found[single & found["claim"] & ~found["right"]]
    return wrong[_WRONG].sort_values(["hidden", "id"])


def _missed(found: pd.DataFrame) -> pd.DataFrame:
    single = (found["kind"] == "effect") & (found["detectability"] >= DETECTABLE)
    return found[single & ~found["claim"]][_WRONG].sort_values(["hidden", "id"])


def _uncovered(strengths: pd.DataFrame) -> pd.DataFrame:
    columns = ["id", "effect", "signals", "truth", "value", "low", "high", "low_wide", "high_wide"]
    missed = strengths[~strengths["covered_wide"].astype(bool)]
    return missed[columns].sort_values(["effect", "id"])


def _errors(found: pd.DataFrame) -> pd.DataFrame:
    wrong = found[found["kind"] == "error"].sort_values(["surely_wrong", "error"])
    return wrong[["id", "error", "verdict", "named", "confirmed", "surely_wrong", "signals"]]


def _left_out(found: pd.DataFrame) -> pd.DataFrame:
    again = found[found["left_out"] != ""].sort_values(["left_out_wrong", "hidden"])
    return again[["id", "hidden", "left_out", "left_out_named", "left_out_wrong", "signals"]]
