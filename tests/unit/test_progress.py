"""One line for searches side by side."""

import pytest

from pyrofit.diagnose.search.progress import Progress
from pyrofit.stages.progress import Told


def test_searches_side_by_side_share_a_line_with_the_time_left(
    capsys: pytest.CaptureFixture[str],
) -> None:
    now = [0.0]
    told = Told("RMSE 00 to 01", 2, 10, lambda: now[0])
    for generation in range(2, 11):
        now[0] += 1.5
        for search in told.of_each:
            search(generation, 100 * generation, 1.0 / generation)
    lines = capsys.readouterr().err.splitlines()
    # Every 3 s, two generations: the next line is due 2 s after the last one.
    assert [line.split()[5] for line in lines] == ["2", "4", "6", "8", "10"]
    assert lines[0].endswith("generation 2 of 10, 200 model calls, lowest cost 0.5")
    assert lines[1].endswith(
        "generation 4 of 10, 700 model calls, lowest cost 0.25, about 10 s left"
    )
    assert lines[-1].endswith("generation 10 of 10, 1,900 model calls, lowest cost 0.1")


def test_fits_of_a_diagnosis_are_counted_with_the_time_left() -> None:
    now, lines = [0.0], list[str]()
    told = Progress("one effect more", 30, lines.append, lambda: now[0])
    for done, at in ((1, 2.0), (6, 12.0), (8, 16.0), (29, 58.0), (30, 90.0)):
        now[0] = at
        told(done)
    assert lines == [
        "one effect more: 6 of 30 fits, about 48 s left",
        "one effect more: 29 of 30 fits, about 2 s left",
    ]
