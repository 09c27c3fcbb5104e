"""Map a function over numbers in several processes; the results do not depend on how many."""

import mmap
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from multiprocessing.connection import wait
from typing import Any, TypeVar

Result = TypeVar("Result")
Work = Callable[[int], Result]
NUMBER = 4
"""Bytes of a piece's number."""
LOOK_S = 1.0
"""Time after which pieces are counted again [s]."""
MOST_PIECES = 4096
"""As many numbers a pipe holds everywhere."""


class _Crew:
    """The processes of a map, as one of them sees it."""

    idle: mmap.mmap | bytes = b""
    """Of each a byte that is 1 once it has no piece left, shared by all."""


def spare() -> int:
    """Return how many processes of the map that this work belongs to have nothing left to do.

    As many threads more may serve the work, if its result does not depend on their number.
    """
    return sum(_Crew.idle[:])


@contextmanager
def _alone_of(processes: int) -> Iterator[None]:
    """Let the work of this process have the threads of several."""
    before = _Crew.idle
    _Crew.idle = bytes([1] * (processes - 1)) or before
    try:
        yield
    finally:
        _Crew.idle = before


def parallel_map(
    work: Work[Result], count: int, processes: int = 1, told: Callable[[int], None] | None = None
) -> list[Result]:
    """Return ``[work(0), ..., work(count - 1)]``, computed by some processes.

    The processes are forks: the data of ``work`` are not copied, its results are. Each takes the
    next piece when it is free, and ends by itself, even if this process is killed. This process
    calls ``told`` with the number of pieces that are done, again and again.

    Raises
    ------
    RuntimeError
        A process was ended before its work was done.

    Whatever ``work`` raises is raised here.

    Examples
    --------
    >>> parallel_map(lambda i: i * i, 5, processes=2)
    [0, 1, 4, 9, 16]
    """
    forks = "fork" in multiprocessing.get_all_start_methods()
    if processes == 1 or count < 2 or not forks:
        with _alone_of(processes if count == 1 else 1):
            return list(_one_by_one(work, count, told))
    context = multiprocessing.get_context("fork")
    pieces = _numbers(count)
    running: dict[Any, multiprocessing.process.BaseProcess] = {}
    idle = mmap.mmap(-1, processes)
    idle[count:] = bytes([1] * max(processes - count, 0))
    done = mmap.mmap(-1, count)
    for k in range(min(processes, count)):
        ours, theirs = context.Pipe(duplex=False)
        # An end held open by a process that reads nothing would keep the writers waiting for ever.
        unread = [*running, ours]
        running[ours] = context.Process(
            target=_do, args=(work, pieces, theirs, unread, (idle, done), k), daemon=True
        )
        running[ours].start()
        theirs.close()
    os.close(pieces)
    results: dict[int, Result] = {}
    try:
        while running:
            for end in wait(list(running), LOOK_S if told else None):
                results |= _received(end)
                running.pop(end).join()
            if told is not None:
                told(sum(done[:]))
    finally:
        for process in running.values():
            process.terminate()
    return [results[i] for i in range(count)]


def _one_by_one(
    work: Work[Result], count: int, told: Callable[[int], None] | None
) -> Iterator[Result]:
    for i in range(count):
        yield work(i)
        if told is not None:
            told(i + 1)


def _received(results: Any) -> dict[int, Any]:
    try:
        found = results.recv()
    except EOFError:
        raise RuntimeError("a process was ended from outside; run it again") from None
    if isinstance(found, Exception):
        raise found
    return dict(found)


def _numbers(count: int) -> int:
    """Return a pipe from which several processes read the numbers up to count, each once."""
    assert count <= MOST_PIECES
    pipe, entrance = os.pipe()
    os.write(entrance, b"".join(i.to_bytes(NUMBER) for i in range(count)))
    os.close(entrance)
    return pipe


def _do(
    work: Work[Result],
    pieces: int,
    results: Any,
    unread: Sequence[Any],
    shared: tuple[mmap.mmap, mmap.mmap],
    own: int,
) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the first process answers it, and ends this one
    for end in unread:
        end.close()
    _Crew.idle, done = shared
    found = {}
    try:
        taken = iter(lambda: os.read(pieces, NUMBER), b"")
        for i in map(int.from_bytes, taken):
            found[i] = work(i)
            done[i] = 1
        shared[0][own] = 1
        results.send(found)
    except Exception as error:
        results.send(error)
    results.close()
