"""Data worth: table and figure, and a section of the report."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.page import page_of_step
from pyrofit.show.table import Row, Table
from pyrofit.show.text import listed, several
from pyrofit.show.units import difference, difference_unit
from pyrofit.steps.worth import record
from pyrofit.steps.worth.facts import LITTLE, label, share_left, symbol
from pyrofit.steps.worth.record import OfTest, Worth

NOW = "none: standard deviation now"


def tests(study: Study, results: Results) -> pd.DataFrame:
    """List the present standard deviations, then the shares of them that each test leaves [%]."""
    found = record.read(study, results)
    rows: list[Row] = [_now(study, found)]
    for test in found.tests:
        rows.append(_row(study, found, test.words, test.gain_bit, share_left(found, test)))
        if again := share_left(found, test, checked=True):
            rows.append(_row(study, found, f"{test.words}: refits", None, again))
    return pd.DataFrame(rows)


def _now(study: Study, found: record.Worth) -> Row:
    row: Row = {"test": NOW, "gain_bit": None}
    for name, sd in found.now.parameters.items():
        unit = study.parameters[name].unit
        row[name] = f"{sd:.2g}" + ("" if unit == "-" else f" {unit}")
    for name, sd in found.now.predictions.items():
        one = found.predictions[name]
        quantity = study.experiments[one.experiment].quantity(one.signal)
        shown = float(difference(quantity, sd))
        row[label(study, found, name)] = f"{shown:.2g} {difference_unit(quantity)}"
    return row


def _row(
    study: Study, found: record.Worth, words: str, gain: float | None, left: dict[str, float]
) -> Row:
    shown = {label(study, found, name): f"{value:.0f} %" for name, value in left.items()}
    return {"test": words, "gain_bit": None if gain is None else round(gain, 1), **shown}


TABLES = {
    "worth": Table(
        place=60,
        make=tests,
        title="Worth of planned tests",
        note="First row: standard deviations with the data so far, widened by the dispersion. "
        "Other rows: the share that a test leaves of them. Gain: logarithm to base 2 of the factor "
        "by which the volume of the parameters' uncertainty falls. Refits: spread of the "
        "parameters fitted to drawn data with the test, over that without it.",
        headings={"gain_bit": "gain [bit]"},
    ),
}


MOST_TESTS = 18
"""Tests that the figure shows; the table has all."""


def draw_worth(study: Study, results: Results) -> Canvas:
    """Draw the share of each standard deviation that the best tests leave, checks in brackets."""
    found = record.read(study, results)
    tests = found.tests[:MOST_TESTS]
    names = _narrowed(found, tests)
    left = np.array([[share_left(found, test)[name] for name in names] for test in tests])
    canvas, (ax,) = style.panels(1, 1, style.TWO_COLUMNS, 34.0 + 6.4 * len(tests))
    image = ax.imshow(left, cmap="cividis", vmin=0.0, vmax=100.0, aspect="auto")
    for i, test in enumerate(tests):
        again = share_left(found, test, checked=True)
        for k, name in enumerate(names):
            colour = "white" if left[i, k] < 55.0 else "black"
            text = f"{left[i, k]:.0f}" + (f"\n({again[name]:.0f})" if again else "")
            ax.text(k, i, text, ha="center", va="center", color=colour, fontsize=6)
    labels = [symbol(study, found, name) for name in names]
    ax.set_xticks(range(len(names)), labels, rotation=45, ha="right", rotation_mode="anchor")
    ax.set_yticks(range(len(tests)), [test.words for test in tests], fontsize=6.5)
    ax.tick_params(length=0)
    parameters = sum(name in found.now.parameters for name in names)
    if 0 < parameters < len(names):
        ax.axvline(parameters - 0.5, color="white", linewidth=2.5)
    canvas.colorbar(image, ax=ax, label="standard deviation left [%]", shrink=0.9)
    return canvas


def _narrowed(found: Worth, tests: Sequence[OfTest]) -> list[str]:
    """Return the parameters and predictions that some test narrows, all where none does."""
    names = [*found.now.parameters, *found.now.predictions]
    left = {name: min(share_left(found, test)[name] for test in tests) for name in names}
    return [name for name in names if left[name] < 100.0 - LITTLE] or names


FIGURES = {
    "worth": Figure(
        place=10,
        make=draw_worth,
        title="Standard deviations that planned tests leave",
        caption="Left of the white line parameters, right of it predicted curves (root mean square "
        "over the record). Dark: the test narrows it much; 100: it tells nothing new. In brackets: "
        "spread of refits of drawn data, with the test over without it. Columns that none of "
        "these tests narrows by 5 % are left out; the table has them.",
    ),
}


UNLIKE = 15.0
"""Difference of the check from the linear number that is mentioned [% of the present sd]."""
MOST_NAMED = 3


def sentences(study: Study, results: Results) -> list[str]:
    """Return the sentences on the worth of planned tests."""
    found = record.read(study, results)
    return [_best(study, found), *_check(study, found), *_useless(found), *_left_out(found)]


def _best(study: Study, found: Worth) -> str:
    test = found.tests[0]
    left = share_left(found, test)
    parameters = sorted(study.imp.estimate, key=lambda name: left[name])[:MOST_NAMED]
    names = [*parameters, *found.predictions]
    shares = [f"{left[name]:.0f} % ({label(study, found, name)})" for name in names]
    exact = "described" if found.apparatus == "exact" else "uncertain"
    return (
        f"With the apparatus taken as {exact}, {test.words} narrows parameters and predictions "
        f"most, of {several(len(found.tests), 'planned test')}. Of the present standard "
        f"deviations it leaves {listed(shares)}."
    )


def _check(study: Study, found: Worth) -> list[str]:
    """Say how far refits of drawn data agree with the linear numbers."""
    checked = [test for test in found.tests if test.checked is not None]
    if not checked:
        return []
    apart = {
        (test.words, name): abs(value - share_left(found, test)[name])
        for test in checked
        for name, value in share_left(found, test, checked=True).items()
    }
    (words, name), most = max(apart.items(), key=lambda pair: pair[1])
    about = f"The best {len(checked)} were checked by refits of {found.draws} drawn data sets"
    if most <= UNLIKE:
        return [
            f"{about}, which agree: the numbers differ by at most {most:.0f} percentage points."
        ]
    return [
        f"{about}. Their numbers differ most for {label(study, found, name)} with {words}, by "
        f"{most:.0f} percentage points: the linear numbers are rough there."
    ]


def _useless(found: Worth) -> list[str]:
    none = [test.words for test in found.tests if _narrows(found, test) < LITTLE]
    return [f"Nothing is narrowed by {LITTLE:g} % or more by {listed(none)}."] if none else []


def _narrows(found: Worth, test: OfTest) -> float:
    return max(100.0 - left for left in share_left(found, test).values())


def _left_out(found: Worth) -> list[str]:
    return [f"Left out, as its simulation does not finish: {words}." for words in found.left_out]


PAGE = page_of_step(
    "worth",
    heading="Next measurements",
    text="By how much each planned test would narrow parameters and predictions.",
    tables=TABLES,
    figures=FIGURES,
    sentences=sentences,
)
