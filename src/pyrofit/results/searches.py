"""Results of the searches: repetitions of SCE-UA, and the optimisers beside them."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import pandas as pd
from pydantic import Field

from pyrofit.config import Study
from pyrofit.results.files import Results, read_csv
from pyrofit.results.record import Record, check_names, read_record


class End(Record):
    """Where a search from one start ended."""

    cost: float = Field(description="lowest cost")
    calls: int = Field(description="model calls")
    at_bound: list[str] = Field(description="names of the parameters at a limit")
    parameters: dict[str, float] = Field(description="SI units")


class Starts(Record):
    """All ends of an optimiser on one cost."""

    cost_function: str = Field(description="its name")
    seed: int = Field(description="seed of the starts")
    starts: list[End] = Field(min_length=1, description="the ends, best first")


class Descent(Record):
    """Where least squares got to from SCE-UA's best set."""

    cost_function: str = Field(description="its name")
    end: End = Field(description="the end")


class Repetition(Record):
    """The best set of one repetition of SCE-UA."""

    cost_function: str = Field(description="its name")
    repetition: int = Field(description="its number")
    seed: int = Field(description="seed of the search")
    digest: str = Field(description="of the inputs of the search")
    cost: float = Field(description="lowest cost")
    cost_refined: float = Field(description="the same by finer runs")
    parameters: dict[str, float] = Field(description="SI units")
    calls: int = Field(description="model calls")
    failed_calls: int = Field(description="those of them that failed")
    generations: int = Field(description="generations of the search")


class AllSearches(NamedTuple):
    """Ends of all searches, read at once."""

    repetitions: pd.DataFrame
    """The best set of every repetition of SCE-UA."""
    starts: dict[str, dict[str, list[End]]]
    """By cost function and optimiser, the ends from every start, best first."""


def read(study: Study, results: Results, optimisers: Iterable[str]) -> AllSearches:
    """Return the ends of all repetitions of SCE-UA and of all starts of the other optimisers.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    keys = list(optimisers)
    return AllSearches(
        best_of_repetitions(study, results),
        {c: {key: read_starts(study, results, c, key) for key in keys} for c in study.imp.costs},
    )


def repetition(study: Study, results: Results, cost: str, number: int) -> Repetition:
    """Return the result of one repetition."""
    path = results.repetition(cost, number, ".json")
    found = read_record(path, Repetition)
    check_names(path, "parameters", found.parameters, study.imp.estimate)
    return found


def running_minimum(results: Results, cost: str, number: int) -> pd.DataFrame:
    """Return how the lowest cost of one repetition fell."""
    path = results.repetition(cost, number, "_convergence.csv")
    return read_csv(path, dict.fromkeys(("generation", "calls", "best_cost"), float))


def history(study: Study, results: Results, cost: str, number: int) -> pd.DataFrame:
    """Return every model call of one repetition: call, cost, status, parameters in SI units."""
    numbers = ("call", "cost", "status", *study.imp.estimate)
    return read_csv(results.repetition(cost, number, ".csv.gz"), dict.fromkeys(numbers, float))


def best_of_repetitions(study: Study, results: Results) -> pd.DataFrame:
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


def read_starts(study: Study, results: Results, cost: str, optimiser: str) -> list[End]:
    """Return the ends that an optimiser reached from every start on one cost, best first."""
    path = results.starts(cost, optimiser)
    found = read_record(path, Starts).starts
    check_ends(path, "starts", found, study.imp.estimate)
    return found


def check_ends(path: Path, place: str, ends: Sequence[End], names: Sequence[str]) -> None:
    """Refuse ends of a search that lack a parameter.

    Raises
    ------
    DataError
        With the first one.
    """
    for i, end in enumerate(ends):
        check_names(path, f"{place}.{i}.parameters", end.parameters, names)


def end_of_descent(results: Results, cost: str) -> End:
    """Return where least squares got to from SCE-UA's best set."""
    return read_record(results.descent(cost), Descent).end
