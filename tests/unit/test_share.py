"""Work shared by processes: every piece once, in order, whoever does it."""

import os
import signal
import time

import pytest

from pyrofit.diagnose.share import shared


@pytest.mark.parametrize("processes", [1, 2, 5])
@pytest.mark.parametrize("count", [0, 1, 2, 3, 300])
def test_every_piece_is_done_once_and_in_its_place(count: int, processes: int) -> None:
    assert shared(lambda i: i * i, count, processes) == [i * i for i in range(count)]


def test_process_that_is_free_takes_the_next_piece() -> None:
    def work(i: int) -> int:
        time.sleep(0.5 if i == 0 else 0.001)
        return os.getpid()

    first, *others = shared(work, 20, processes=2)
    assert first not in others


def test_error_of_a_piece_is_raised_here() -> None:
    with pytest.raises(ZeroDivisionError):
        shared(lambda i: 1 // (i - 3), 5, processes=2)


def test_end_of_a_process_is_an_error() -> None:
    def work(i: int) -> int:
        if i == 3:
            os.kill(os.getpid(), signal.SIGKILL)
        return i

    with pytest.raises(RuntimeError, match="run it again"):
        shared(work, 5, processes=2)
