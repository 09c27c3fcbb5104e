"""Descents are kept: a diagnosis that is broken off goes on with them, to the same bits."""

import os
import signal
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import linear
import numpy as np
import pytest
from small import measured, study

from pyrofit.diagnose.base.descent import descend_chi_square
from pyrofit.diagnose.base.journal import OF_ANY, Journal, name_of_descent
from pyrofit.diagnose.base.model import model_of
from pyrofit.diagnose.diagnosis import DiagnosisWork, examine
from pyrofit.diagnose.settings import Settings
from pyrofit.estimate.bounded_least_squares import Fit
from pyrofit.solver.arrays import FloatArray

X = np.array([0.2, 0.7])
FIT = Fit(0.3, X, np.array([0.1, np.nextafter(1.0, 2.0)]), np.eye(2) / 3.0, fresh=False)


def same(one: Fit, other: Fit) -> bool:
    return all(
        np.array_equal(getattr(one, name), getattr(other, name))
        and type(getattr(one, name)) is type(getattr(other, name))
        for name in OF_ANY
    )


def never(*of: object) -> Fit:
    raise AssertionError("made anew")


def test_kept_descent_comes_back_with_all_bits(tmp_path: Path) -> None:
    journal = Journal(tmp_path / "kept", worth_s=0.0)
    assert len(journal) == 0
    assert journal.fit("a", lambda: FIT, never) is FIT
    assert same(journal.fit("a", never, never), FIT)
    assert len(journal) == 1


def test_derivatives_of_the_end_are_made_there_again(tmp_path: Path) -> None:
    fresh = replace(FIT, fresh=True, returned=True)
    journal = Journal(tmp_path, worth_s=0.0)
    journal.fit("a", lambda: fresh, never)
    asked: list[FloatArray] = []

    def at_end(x: FloatArray) -> Fit:
        asked.append(x)
        return replace(FIT, fresh=True)

    assert same(journal.fit("a", never, at_end), fresh)
    assert np.array_equal(asked[0], X)


def test_short_descents_are_not_kept_and_broken_ones_are_made_anew(tmp_path: Path) -> None:
    journal = Journal(tmp_path)
    journal.fit("a", lambda: FIT, never)
    assert len(journal) == 0
    Journal(tmp_path, worth_s=0.0).fit("a", lambda: FIT, never)
    (path,) = tmp_path.iterdir()
    path.write_bytes(path.read_bytes()[:-40])
    assert journal.fit("a", lambda: FIT, never) is FIT


def test_name_tells_start_model_and_everything_else() -> None:
    def line(slope: float, bend: float = 0.0) -> Callable[[FloatArray], list[FloatArray]]:
        return lambda sets: [slope * x + bend * (x - X) ** 2 for x in sets]

    names = [
        name_of_descent(model, *asked)
        for model, *asked in [
            (line(1.0), X),
            (line(2.0), X),
            (line(1.0, 0.5), X),  # another model that is the same at the start
            (line(1.0), X + 1e-16 + 1e-15),
            (line(1.0), X, None, 0.1),
            (line(1.0), X, None, 0.2),
            (line(1.0), X, FIT, 0.2),
            (line(1.0), X, np.eye(2), 0.2),
        ]
    ]
    assert len(set(names)) == len(names)
    assert names[0] == name_of_descent(line(1.0), X.copy())


def test_descent_with_other_settings_is_another_one(tmp_path: Path) -> None:
    columns, y = linear.random_columns(1), np.zeros(linear.TOTAL)
    journal = Journal(tmp_path, worth_s=0.0)
    for most_steps, kept in ((50, 1), (1, 2), (50, 2)):
        settings = replace(Settings(), most_steps=most_steps)
        base = replace(linear.base(columns, y, settings=settings), journal=journal)
        descend_chi_square(model_of(base, {}), X)
        assert len(journal) == kept


def diagnosed(journal: Journal | None) -> DiagnosisWork:
    data = measured({"heater_ramp": 8.0}, 2)
    described = study(effects=["heater_ramp", "k_T"], most_effects=1)
    return examine(described, data, processes=2, advise=False, journal=journal)


@pytest.mark.long
def test_killed_diagnosis_goes_on_to_the_same_bits(tmp_path: Path) -> None:
    journal = Journal(tmp_path, worth_s=0.0)
    child = os.fork()
    if child == 0:
        os.setsid()
        diagnosed(journal)
        os._exit(0)
    while len(journal) < 4:
        assert os.waitpid(child, os.WNOHANG) == (0, 0), "it ended before it was killed"
        time.sleep(0.01)
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    kept = len(journal)
    before = {path.name: path.stat().st_mtime_ns for path in tmp_path.glob("*.npz")}
    found = diagnosed(Journal(tmp_path, worth_s=0.0))
    assert len(journal) > kept
    # None that was kept is written again.
    assert before == {name: (tmp_path / name).stat().st_mtime_ns for name in before}
    whole = diagnosed(None)
    assert found.content == whole.content
    assert found.curves.equals(whole.curves)
    assert np.array_equal(found.end.fit.x, whole.end.fit.x)
