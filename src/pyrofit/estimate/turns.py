"""Searches that take turns: all their questions are answered at once.

A search written as one loop asks for one cost after the other. Here several run, one at a time,
each until it asks; when all wait, their questions are answered together, and they go on in order.
The solver answers a certain number together, or multiples of it. The questions beyond wait until
others have asked again: none is answered alone while more searches run.
Each search is a greenlet: to change from one to the next takes less than a microsecond, from one
thread to the next some thirty. Each finds a generator of its own as numpy's global one, which it
must seed.
"""

from collections import deque
from collections.abc import Callable, Sequence
from typing import Any, Generic, TypeVar

import numpy as np
from greenlet import greenlet

Question = TypeVar("Question")
Answer = TypeVar("Answer")
Result = TypeVar("Result")
RANDOM: Any = np.random
"""Of which numpy declares too little."""


class _Turn(Generic[Question, Answer, Result]):
    """One search, and where it stands."""

    question: Question
    result: Result

    def __init__(self, search: Callable[[Callable[[Question], Answer]], Result]) -> None:
        self._generator = np.random.MT19937()
        self._greenlet = greenlet(lambda: search(self._ask))
        self._go()

    @property
    def waits(self) -> bool:
        """Whether it has asked and not ended."""
        return not self._greenlet.dead

    def go_on(self, answer: Answer) -> None:
        """Let it run with an answer until it asks again or ends; raise its errors."""
        self._go(answer)

    def stop(self) -> None:
        """End it where it waits."""
        self._greenlet.throw()

    def _go(self, *answer: Answer) -> None:
        before = RANDOM.get_bit_generator()
        RANDOM.set_bit_generator(self._generator)
        try:
            found = self._greenlet.switch(*answer)
        finally:
            RANDOM.set_bit_generator(before)
        if self.waits:
            self.question = found
        else:
            self.result = found

    def _ask(self, question: Question) -> Answer:
        assert self._greenlet.parent is not None
        answer: Answer = self._greenlet.parent.switch(question)
        return answer


def in_turns(
    searches: Sequence[Callable[[Callable[[Question], Answer]], Result]],
    answer: Callable[[list[Question]], Sequence[Answer]],
    together: int = 1,
) -> list[Result]:
    """Run searches side by side and return their results.

    Parameters
    ----------
    searches
        Called with the function by which each asks.
    answer
        Answers questions of searches, those that have waited longest.
    together
        Questions that are answered at once, or a multiple of it. If fewer searches are left, all
        that they ask.

    Raises
    ------
    BaseException
        Any error of a search or of the answering; all other searches end, too.
    """
    turns: list[_Turn[Question, Answer, Result]] = []
    try:
        turns.extend(map(_Turn, searches))
        waiting = deque(turn for turn in turns if turn.waits)
        while waiting:
            beyond = len(waiting) % together if len(waiting) > together else 0
            first = [waiting.popleft() for _ in range(len(waiting) - beyond)]
            found = answer([turn.question for turn in first])
            for turn, one in zip(first, found, strict=True):
                turn.go_on(one)
            waiting.extend(turn for turn in first if turn.waits)
        return [turn.result for turn in turns]
    finally:
        for turn in turns:
            turn.stop()
