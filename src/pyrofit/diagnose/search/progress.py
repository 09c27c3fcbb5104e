"""How many fits of a part of the search are done, and the time left."""

import time
from collections.abc import Callable

from pyrofit.logs import Tell
from pyrofit.running.durations import in_words

EVERY_S = 10.0
"""Time between two lines [s]."""


class Progress:
    """Tells how many of some fits are done.

    Parameters
    ----------
    words
        The kind of fits.
    count
        Their number.
    tell
        Takes a line.
    clock
        Returns the time [s].
    """

    def __init__(
        self, words: str, count: int, tell: Tell, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._words, self._count, self._tell, self._clock = words, count, tell, clock
        self._began = self._last = clock()

    def __call__(self, done: int) -> None:
        """Tell that so many are done, if the last line is long ago and some are left."""
        now = self._clock()
        if not 0 < done < self._count or now - self._last < EVERY_S:
            return
        self._last = now
        left = (now - self._began) / done * (self._count - done)
        self._tell(f"{self._words}: {done} of {self._count} fits, about {in_words(left)} left")
