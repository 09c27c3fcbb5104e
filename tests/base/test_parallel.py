"""Work shared by processes: every piece once, in order, whoever does it."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from pyrofit.parallel import parallel_map, spare


@pytest.mark.parametrize("processes", [1, 2, 5])
@pytest.mark.parametrize("count", [0, 1, 2, 3, 300])
def test_every_piece_is_done_once_and_in_its_place(count: int, processes: int) -> None:
    assert parallel_map(lambda i: i * i, count, processes) == [i * i for i in range(count)]


@pytest.mark.parametrize("processes", [1, 2])
def test_pieces_that_are_done_are_counted(processes: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pyrofit.parallel.LOOK_S", 0.01)
    counted: list[int] = []
    parallel_map(lambda i: time.sleep(0.03), 20, processes, counted.append)
    assert counted == sorted(counted)
    assert counted[-1] == 20
    assert len(set(counted)) > 1


def test_process_that_is_free_takes_the_next_piece(tmp_path: Path) -> None:
    def work(i: int) -> int:
        if i == 0:
            while not (tmp_path / "19").exists():
                time.sleep(0.001)
        (tmp_path / str(i)).touch()
        return os.getpid()

    first, *others = parallel_map(work, 20, processes=2)
    assert first not in others


def test_processes_without_a_piece_are_spare_for_the_others() -> None:
    """Four of five at once with one piece, all but one with two as soon as the first has ended."""

    def one_of_two(i: int) -> tuple[int, int]:
        before, waited = spare(), 0.0
        while i == 0 and spare() == 0 and waited < 20.0:
            time.sleep(0.01)
            waited += 0.01
        return before, spare()

    assert parallel_map(lambda i: spare(), 1, processes=5) == [4]
    assert parallel_map(lambda i: spare(), 3, processes=1) == [0, 0, 0]
    (before, after), (alone, _) = parallel_map(one_of_two, 2, processes=2)
    assert (before, after, alone) == (0, 1, 0)
    assert set(parallel_map(lambda i: spare(), 2, processes=4)) <= {2, 3}
    assert spare() == 0


def test_error_of_work_that_has_all_processes_leaves_none_spare() -> None:
    with pytest.raises(ZeroDivisionError):
        parallel_map(lambda i: 1 // i, 1, processes=3)
    assert spare() == 0


def test_error_of_a_piece_is_raised_here_at_once(tmp_path: Path) -> None:
    def work(i: int) -> None:
        if i == 1:
            raise ZeroDivisionError
        time.sleep(0.05)
        (tmp_path / str(i)).touch()

    with pytest.raises(ZeroDivisionError):
        parallel_map(work, 1000, processes=2)
    assert len(list(tmp_path.iterdir())) < 500


def test_processes_end_even_if_the_one_that_shares_is_killed(tmp_path: Path) -> None:
    """Their results, more than a pipe holds, are read by nobody then."""
    code = """
import os, signal, sys, time
from pathlib import Path
from pyrofit.parallel import parallel_map
def work(i):
    Path(sys.argv[1], str(os.getpid())).touch()
    while os.getppid() == parent:
        time.sleep(0.01)
    return b"x" * 1_000_000
parent = os.getpid()
parallel_map(work, 2, processes=2)
"""
    parent = subprocess.Popen([sys.executable, "-c", code, str(tmp_path)])
    _until(lambda: len(list(tmp_path.iterdir())) == 2)
    parent.kill()
    parent.wait()
    _until(lambda: not any(_runs(int(path.name)) for path in tmp_path.iterdir()))


def _until(done: Callable[[], bool]) -> None:
    end = time.monotonic() + 60.0
    while not done():
        assert time.monotonic() < end
        time.sleep(0.01)


def _runs(pid: int) -> bool:
    status = Path(f"/proc/{pid}/stat")
    return status.exists() and status.read_text().rpartition(")")[2].split()[0] != "Z"


def test_end_of_a_process_is_an_error() -> None:
    def work(i: int) -> int:
        if i == 3:
            os.kill(os.getpid(), signal.SIGKILL)
        return i

    with pytest.raises(RuntimeError, match="run it again"):
        parallel_map(work, 5, processes=2)
