"""Searches that take turns: what all of them ask is answered at once.

A search written as one loop asks for one cost after the other. Here several run, one at a time,
each until it asks; when all wait, their questions are answered together, and they go on in order.
Each finds a generator of its own as numpy's global one, which it must seed.
"""

import threading
from collections.abc import Callable, Sequence
from typing import Any, Generic, TypeVar

import numpy as np

Question = TypeVar("Question")
Answer = TypeVar("Answer")
Result = TypeVar("Result")
RANDOM: Any = np.random
"""Of which numpy declares too little."""


class _Stopped(BaseException):
    """Ends a search whose answer will never come."""


class _Turn(Generic[Question, Answer, Result]):
    """One search, and where it stands."""

    def __init__(self, search: Callable[[Callable[[Question], Answer]], Result]) -> None:
        self.waits = False
        self.question: Question
        self.answer: Answer
        self.result: Result
        self._search = search
        self._error: BaseException | None = None
        self._stopped = False
        self._generator = np.random.MT19937()
        self._on, self._off = threading.Semaphore(0), threading.Semaphore(0)
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def go(self) -> None:
        """Let it run until it asks or ends; raise what it raises."""
        before = RANDOM.get_bit_generator()
        RANDOM.set_bit_generator(self._generator)
        try:
            self._on.release()
            self._off.acquire()
        finally:
            RANDOM.set_bit_generator(before)
        if self._error is not None:
            raise self._error

    def stop(self) -> None:
        """End it where it waits."""
        self._stopped = True
        self._on.release()
        self._thread.join()

    def _run(self) -> None:
        self._on.acquire()
        try:
            if not self._stopped:
                self.result = self._search(self._ask)
        except _Stopped:
            pass
        except BaseException as error:
            self._error = error
        self.waits = False
        self._off.release()

    def _ask(self, question: Question) -> Answer:
        self.question, self.waits = question, True
        self._off.release()
        self._on.acquire()
        if self._stopped:
            raise _Stopped
        return self.answer


def in_turns(
    searches: Sequence[Callable[[Callable[[Question], Answer]], Result]],
    answer: Callable[[list[Question]], Sequence[Answer]],
) -> list[Result]:
    """Run searches side by side and return their results.

    Parameters
    ----------
    searches
        Called with the function by which each asks.
    answer
        Answers the questions of all that have not ended, in the order of the searches.

    Raises
    ------
    BaseException
        What a search or the answering raises; all other searches end, too.
    """
    turns: list[_Turn[Question, Answer, Result]] = []
    try:
        turns.extend(map(_Turn, searches))
        for turn in turns:
            turn.go()
        while waiting := [turn for turn in turns if turn.waits]:
            found = answer([turn.question for turn in waiting])
            for turn, one in zip(waiting, found, strict=True):
                turn.answer = one
                turn.go()
        return [turn.result for turn in turns]
    finally:
        for turn in turns:
            turn.stop()
