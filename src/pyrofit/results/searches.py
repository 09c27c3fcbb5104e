"""Results of the searches: repetitions of SCE-UA, and the optimisers beside them."""

from collections.abc import Iterable
from typing import NamedTuple, TypedDict, cast

import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results, read_csv, read_json
from pyrofit.results.needed import EACH, Keys


class End(TypedDict):
    """Where a search from one start ended."""

    cost: float
    calls: int
    at_bound: list[str]
    """Names of the parameters at a limit."""
    parameters: dict[str, float]
    """SI units."""


class Repetition(TypedDict):
    """The best set of one repetition of SCE-UA."""

    cost_function: str
    repetition: int
    seed: int
    digest: str
    """Of the inputs of the search."""
    cost: float
    cost_refined: float
    """Of finer runs."""
    parameters: dict[str, float]
    """SI units."""
    calls: int
    failed_calls: int
    generations: int


class Searched(NamedTuple):
    """Ends of all searches, read at once."""

    repetitions: pd.DataFrame
    """The best set of every repetition of SCE-UA."""
    starts: dict[str, dict[str, list[End]]]
    """By cost function and optimiser, the ends from every start, best first."""


def read(study: Study, results: Results, optimisers: Iterable[str]) -> Searched:
    """Return the ends of all repetitions of SCE-UA and of all starts of the other optimisers.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    keys = list(optimisers)
    return Searched(
        summary(study, results),
        {c: {key: starts(study, results, c, key) for key in keys} for c in study.imp.costs},
    )


def repetition(study: Study, results: Results, cost: str, number: int) -> Repetition:
    """Return the result of one repetition."""
    needs: dict[Keys, type] = {("digest",): str, ("cost",): float, ("cost_refined",): float}
    needs |= {("parameters", name): float for name in study.imp.estimate}
    return cast(Repetition, read_json(results.repetition(cost, number, ".json"), needs))


def running_minimum(results: Results, cost: str, number: int) -> pd.DataFrame:
    """Return how the lowest cost of one repetition fell."""
    path = results.repetition(cost, number, "_convergence.csv")
    return read_csv(path, dict.fromkeys(("generation", "calls", "best_cost"), float))


def history(study: Study, results: Results, cost: str, number: int) -> pd.DataFrame:
    """Return every model call of one repetition: call, cost, status, parameters in SI units."""
    numbers = ("call", "cost", "status", *study.imp.estimate)
    return read_csv(results.repetition(cost, number, ".csv.gz"), dict.fromkeys(numbers, float))


def summary(study: Study, results: Results) -> pd.DataFrame:
    """Return the best set of every repetition."""
    numbers = ("cost", "cost_refined", "calls", "failed_calls", *study.imp.estimate)
    return read_csv(
        results.imp("summary.csv"),
        {"cost_function": object, **dict.fromkeys(numbers, float)},
        {("cost_function",): [(cost,) for cost in study.imp.costs]},
    )


def running_minima(study: Study, results: Results) -> pd.DataFrame:
    """Return how the lowest cost of every repetition fell."""
    numbers = ("repetition", "generation", "calls", "best_cost")
    return read_csv(
        results.imp("convergence.csv"),
        {"cost_function": object, **dict.fromkeys(numbers, float)},
        {("cost_function",): [(cost,) for cost in study.imp.costs]},
    )


def starts(study: Study, results: Results, cost: str, optimiser: str) -> list[End]:
    """Return the ends that an optimiser reached from every start on one cost, best first."""
    here = ("starts", EACH)
    needs: dict[Keys, type] = {(*here, "cost"): float, (*here, "calls"): float}
    needs[*here, "at_bound"] = list
    needs |= {(*here, "parameters", name): float for name in study.imp.estimate}
    found: list[End] = read_json(results.starts(cost, optimiser), needs)["starts"]
    return found


def end_of_descent(results: Results, cost: str) -> End:
    """Return where least squares got to from SCE-UA's best set."""
    found: End = read_json(results.descent(cost), {("end", "cost"): float})["end"]
    return found
