"""Independent work shared by processes; the results do not depend on how many there are."""

import multiprocessing
import os
import signal
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import TypeVar

Result = TypeVar("Result")
Work = Callable[[int], Result]
NUMBER = 4
"""Bytes of a piece's number; a pipe holds 65536 bytes, more than there ever are pieces."""


def shared(work: Work[Result], count: int, processes: int = 1) -> list[Result]:
    """Return ``[work(0), ..., work(count - 1)]``, computed by some processes.

    The processes are forks: what ``work`` knows is not copied, what it returns is. Each takes the
    next piece when it is free, and ends by itself, even if this process is killed.

    Raises
    ------
    RuntimeError
        A process was ended before its work was done.

    Whatever ``work`` raises is raised here.

    Examples
    --------
    >>> shared(lambda i: i * i, 5, processes=2)
    [0, 1, 4, 9, 16]
    """
    forks = "fork" in multiprocessing.get_all_start_methods()
    if processes == 1 or count < 2 or not forks:
        return [work(i) for i in range(count)]
    context = multiprocessing.get_context("fork")
    pieces = _numbers(count)
    results: dict[int, Result] = {}
    running = []
    for _ in range(min(processes, count)):
        ours, theirs = context.Pipe(duplex=False)
        process = context.Process(target=_do, args=(work, pieces, theirs), daemon=True)
        process.start()
        theirs.close()
        running.append((process, ours))
    os.close(pieces)
    for process, ours in running:
        try:
            found = ours.recv()
        except EOFError:
            raise RuntimeError("a process of the diagnosis was ended; run it again") from None
        if isinstance(found, Exception):
            raise found
        results |= found
        process.join()
    return [results[i] for i in range(count)]


def _numbers(count: int) -> int:
    """Return a pipe from which several processes read the numbers up to count, each once."""
    pipe, entrance = os.pipe()
    os.write(entrance, b"".join(i.to_bytes(NUMBER) for i in range(count)))
    os.close(entrance)
    return pipe


def _do(
    work: Work[Result], pieces: int, results: "Connection[dict[int, Result] | Exception, None]"
) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the first process answers it, and ends this one
    try:
        taken = iter(lambda: os.read(pieces, NUMBER), b"")
        results.send({i: work(i) for i in map(int.from_bytes, taken)})
    except Exception as error:
        results.send(error)
    results.close()
