"""Standard deviations of parameters and predictions after planned tests."""

from collections.abc import Sequence

import numpy as np

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.steps.worth import record
from pyrofit.steps.worth.facts import LITTLE, share_left, symbol
from pyrofit.steps.worth.record import OfTest, Worth

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
