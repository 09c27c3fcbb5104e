"""From where an effect is fitted, and when that is enough; descents end where the test says."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

import linear
import numpy as np
import pytest

from pyrofit.diagnose import refit
from pyrofit.diagnose.descent import Fit
from pyrofit.diagnose.refit import SAME, STARTS, from_best_start, from_elsewhere, look_at, polished
from pyrofit.solver.arrays import FloatArray

# The data say nothing of k, so that it is wide.
COLUMNS = {**linear.random_columns(3, "k_T"), "k": np.zeros(linear.TOTAL)}
Y = np.random.default_rng(1).standard_normal(linear.TOTAL)


@pytest.fixture
def ends(monkeypatch: pytest.MonkeyPatch) -> Callable[[Iterable[float]], list[FloatArray]]:
    """Let descents end with given chi-squares, one after the other; return where they started."""

    def planned(chi2: Iterable[float]) -> list[FloatArray]:
        waiting: Iterator[float] = iter(chi2)
        begun: list[FloatArray] = []

        def descend(model: object, x: FloatArray, jacobian: FloatArray | None = None) -> Fit:
            begun.append(x)
            return replace(trial().fit, x=x, chi2=next(waiting))

        monkeypatch.setattr(refit, "descend", descend)
        return begun

    return planned


def trial() -> linear.Trial:
    return linear.fit(COLUMNS, Y)


def test_search_from_elsewhere_goes_on_while_it_lowers_but_not_for_ever(
    ends: Callable[[Iterable[float]], list[FloatArray]],
) -> None:
    given = trial()
    wide = len(list(refit._elsewhere(given)))
    assert wide >= 2
    for falls, rounds in (([0.0], 1), ([0.5 * SAME], 1), ([2.0, 0.0], 2), ([2.0] * 9, 3)):
        lowest = given.fit.chi2
        planned = []
        for fall in falls:
            lowest -= fall
            planned += [lowest, *[lowest + 1.0] * (wide - 1)]
        begun = ends(planned)
        (found,) = polished([given])
        assert len(begun) == rounds * wide
        assert found.fit.chi2 == pytest.approx(given.fit.chi2 - sum(falls[:rounds]))


def test_starts_end_once_two_lead_to_the_same_valley(
    ends: Callable[[Iterable[float]], list[FloatArray]],
) -> None:
    given = trial()
    (seen,) = look_at(given, ["k_T"])
    best = given.fit.chi2
    assert len(refit.starts(seen, best)) == STARTS == 3
    for chi2, tried in (
        ([best - 20.0, best - 20.1, best - 30.0], 2),
        ([best - 20.0, best - 25.0, best - 30.0], 3),
        # The first leads nowhere: that the second comes back to no effect says nothing.
        ([best + 5.0, best, best - 30.0], 3),
    ):
        begun = ends(chi2)
        first = from_best_start(given, seen)
        assert first.fit.chi2 == min(best, chi2[0])
        found = from_elsewhere(given, seen, first)
        assert len(begun) == tried
        assert found.fit.chi2 == min(best, *chi2[:tried])
