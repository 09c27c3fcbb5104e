"""Score answers to the benchmark of hidden effects. This file needs NumPy and pandas only.

    python score.py FOLDER [ANSWER.csv ...] [--common]

It reads truth.csv and catalogue.csv of the folder; without answers, those of its folder answers.
With --common all answers are scored on the sets that each of them has answered.
"""

import argparse
import sys
from collections.abc import Iterable, Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd

ANSWER = ("set", "effect", "strength", "low", "high", "sure")
NUMBERS = ("strength", "low", "high", "sure", "size_sd")
LARGE, EDGES = 10.0, (0.0, 3.0, 10.0, 30.0, np.inf)
"""Size from which an effect should be named, and limits of classes of size [sd of the noise]."""
Names = dict[str, str]
Row = dict[str, object]


class AnswerError(ValueError):
    """A file of the benchmark breaks a rule."""


def read_rows(path: Path, columns: Sequence[str]) -> pd.DataFrame:
    """Read a table; names that are left out are empty.

    Raises
    ------
    AnswerError
        The file is missing, lacks a column, or has a word for a number.
    """
    if not path.is_file():
        raise AnswerError(f"{path}: there is no such file; give the folder of the benchmark")
    table = pd.read_csv(path, dtype=str, keep_default_na=False)
    if missing := [name for name in columns if name not in table]:
        raise AnswerError(f"{path}: lacks the column '{missing[0]}'; add it")
    try:
        return table.assign(**{n: pd.to_numeric(table[n]) for n in NUMBERS if n in table})
    except ValueError as error:
        raise AnswerError(f"{path}: {error}; give numbers") from None


def vet(path: Path, answer: pd.DataFrame, truth: pd.DataFrame, catalogue: pd.DataFrame) -> None:
    """Refuse an answer that does not follow the rules.

    Raises
    ------
    AnswerError
        Names file and row of the first mistake, and the rule.
    """
    claims, known = answer["effect"] != "", catalogue["effect"]
    named = answer["set"][claims]
    rules = {
        "unknown set; give a folder of sets": ~answer["set"].isin(truth["set"]),
        "unknown effect; give one of catalogue.csv": claims & ~answer["effect"].isin(known),
        "the set has this effect twice; give it once": answer.duplicated(["set", "effect"]),
        "sure must be 0 or 1": ~answer["sure"].isin([0, 1]),
        "low must not exceed high": answer["low"] > answer["high"],
        "another row of the set names an effect; take out one": ~claims & answer["set"].isin(named),
    }
    for rule, broken in rules.items():
        if broken.any():
            at = int(broken.to_numpy().argmax())
            row = f"{answer['set'][at]}, '{answer['effect'][at]}'"
            raise AnswerError(f"{path}, line {at + 2} ({row}): {rule}")


def judge_sets(answer: pd.DataFrame, truth: pd.DataFrame, catalogue: pd.DataFrame) -> pd.DataFrame:
    """Return one row for each set that is answered.

    Effects that no data can tell apart (`same_as` of the catalogue) count as one name. A claim is
    right if all its names are hidden, or describe the error of a wrong description.
    """
    name = dict(zip(catalogue["effect"], catalogue["same_as"], strict=True))
    group = dict(zip(catalogue["effect"], catalogue["group"], strict=True))
    claims = dict(list(answer.groupby("set")))
    sets = ((claims.get(of), hidden) for of, hidden in truth.groupby("set"))
    return pd.DataFrame([_judged(c, h, name, group) for c, h in sets if c is not None])


def _judged(answer: pd.DataFrame, truth: pd.DataFrame, name: Names, group: Names) -> Row:
    def one(effects: Iterable[str], by: Names) -> set[str]:
        return {by[effect] for effect in effects}

    hidden = [effect for effect in truth["effect"] if effect]
    allowed = [*hidden, *truth["also_right"].iloc[0].split()]
    claimed = [effect for effect in answer["effect"] if effect]
    sure = list(answer["effect"][(answer["sure"] == 1) & (answer["effect"] != "")])
    both = answer.merge(truth[["effect", "strength"]], on="effect", suffixes=("", "_true"))
    stated = both.dropna(subset=["low", "high", "strength_true"])
    inside = stated["strength_true"].between(stated["low"], stated["high"])
    return {
        "kind": truth["kind"].iloc[0],
        "size_sd": truth["size_sd"].iloc[0],
        "claim": bool(claimed),
        "right": bool(claimed) and one(claimed, name) <= one(allowed, name),
        "whole": one(claimed, name) == one(hidden, name),
        "sure": bool(sure),
        "sure_wrong": not one(sure, name) <= one(allowed, name),
        "group_wrong": not one(sure, group) <= one(allowed, group),
        "strengths": len(stated),
        "covered": int(inside.sum()),
    }


def scores(sets: pd.DataFrame) -> dict[str, tuple[int, int]]:
    """Return hits and number of cases, by quantity."""

    def share(hits: "pd.Series[bool]") -> tuple[int, int]:
        return int(hits.sum()), len(hits)

    single, size = sets[sets["kind"] == "effect"], sets["size_sd"]
    large, sure = single[single["size_sd"] >= LARGE], sets[sets["sure"]]
    null, pair = sets[sets["kind"] == "null"], sets[sets["kind"] == "pair"]
    found = {
        f"one effect of {LARGE:g} sd or more: named right": share(large["right"]),
        f"one effect of {LARGE:g} sd or more: claimed": share(large["claim"]),
        "no effect: claimed (false alarm)": share(null["claim"]),
        "any claim: wrong name": share(~sets[sets["claim"]]["right"].astype(bool)),
        "sure claim: wrong name (surely wrong)": share(sure["sure_wrong"]),
        "sure claim: wrong group": share(sure["group_wrong"]),
        "two effects: both named, no other": share(pair["whole"]),
        "strength in its interval": (int(sets["covered"].sum()), int(sets["strengths"].sum())),
    }
    for low, high in pairwise(EDGES):
        here = single[(size[single.index] >= low) & (size[single.index] < high)]
        to = "more" if np.isinf(high) else f"{high:g}"
        found[f"one effect of {low:g} to {to} sd: named right"] = share(here["right"])
    return found


def share_interval(hits: int, of: int) -> tuple[float, float]:
    """Return the 95 % interval of a share (Wilson 1927, doi 10.1080/01621459.1927.10502953).

    >>> [round(end, 3) for end in share_interval(0, 100)]
    [0.0, 0.037]
    """
    z2 = 1.959964**2
    middle = (hits + 0.5 * z2) / (of + z2)
    half = np.sqrt(z2 * (hits * (of - hits) / of + 0.25 * z2)) / (of + z2)
    return max(float(middle - half), 0.0), min(float(middle + half), 1.0)


def _words(hits: int, of: int) -> str:
    if not of:
        return "–"
    low, high = (100.0 * end for end in share_interval(hits, of))
    return f"{hits} of {of}: {100.0 * hits / of:.0f} % ({low:.0f} to {high:.0f})"


def table(folder: Path, paths: Sequence[Path] = (), common: bool = False) -> str:
    """Return the scores of answers as a table in Markdown, one column for each.

    Raises
    ------
    AnswerError
        A file is missing or breaks a rule.
    """
    truth = read_rows(folder / "truth.csv", ("set", "kind", "effect", "strength", "size_sd"))
    catalogue = read_rows(folder / "catalogue.csv", ("effect", "group", "same_as"))
    paths = paths or sorted((folder / "answers").glob("*.csv"))
    if not paths:
        raise AnswerError(f"{folder / 'answers'}: there is no answer; put a CSV file there")
    answers = {path.stem: read_rows(path, ANSWER) for path in paths}
    for path, answer in zip(paths, answers.values(), strict=True):
        vet(path, answer, truth, catalogue)
    if common:
        shared = set.intersection(*(set(answer["set"]) for answer in answers.values()))
        answers = {name: one[one["set"].isin(shared)] for name, one in answers.items()}
    if empty := [name for name, one in answers.items() if one.empty]:
        raise AnswerError(f"{empty[0]}: there is no set to score; answer more sets")
    judged = {name: judge_sets(one, truth, catalogue) for name, one in answers.items()}
    columns = [scores(one) for one in judged.values()]
    rows = [["quantity", *judged], ["---"] * (len(judged) + 1)]
    rows.append(["sets", *(f"{len(one)} of {truth['set'].nunique()}" for one in judged.values())])
    rows += [[quantity, *(_words(*one[quantity]) for one in columns)] for quantity in columns[0]]
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


def main() -> None:
    """Print the table of answers."""
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("answers", type=Path, nargs="*")
    parser.add_argument("--common", action="store_true")
    given = parser.parse_args()
    try:
        sys.stdout.write(table(given.folder, given.answers, given.common))
    except AnswerError as error:
        raise SystemExit(str(error)) from None


if __name__ == "__main__":
    main()
