"""How many fits of a part of the search are done, and the time left, of these and as a whole."""

import time
from collections.abc import Callable

from pyrofit.logs import Tell
from pyrofit.running.durations import in_words

EVERY_S = 10.0
"""Time between two lines [s]."""

ROUGHLY, SECOND, TO_THE_END = "roughly", "from a second start", "to the end"
"""Parts of a round of fits."""
_FIRST = {ROUGHLY: (0.25, 0.45), SECOND: (0.45, 0.70), TO_THE_END: (0.70, 0.75)}
_LATER = {ROUGHLY: (0.75, 0.85), SECOND: (0.85, 0.92), TO_THE_END: (0.92, 0.95)}
"""Shares of a whole diagnosis that are done as a part begins and ends.

Those of the first round are medians of three diagnoses of twins with known truth.
"""


class Whole:
    """Estimates the time left of a whole diagnosis, which ends once no effect is missing.

    Parameters
    ----------
    clock
        Returns the time [s].
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock, self._began, self._rounds = clock, clock(), 0

    def begin(self, part: str) -> None:
        """Note that a part of a round begins."""
        self._rounds += part == ROUGHLY

    def left(self, part: str, share: float) -> float:
        """Return the time left [s], when a share of the fits of a part is done."""
        first, last = (_FIRST if self._rounds <= 1 else _LATER)[part]
        done = first + share * (last - first)
        return (self._clock() - self._began) * (1.0 - done) / done


class SearchProgress:
    """Tells how many of some fits are done.

    Parameters
    ----------
    part
        The part of a round.
    whole
        Knows the time left of the whole diagnosis.
    count
        Their number.
    tell
        Takes a line.
    clock
        Returns the time [s].
    """

    def __init__(
        self,
        part: str,
        whole: Whole,
        count: int,
        tell: Tell,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._part, self._whole, self._count, self._tell = part, whole, count, tell
        self._clock = clock
        whole.begin(part)
        self._began = self._last = clock()

    def __call__(self, done: int) -> None:
        """Tell that so many are done, if the last line is long ago and some are left."""
        now = self._clock()
        if not 0 < done < self._count or now - self._last < EVERY_S:
            return
        self._last = now
        left = (now - self._began) / done * (self._count - done)
        whole = max(self._whole.left(self._part, done / self._count), left)
        self._tell(
            f"one effect more, {self._part}: {done} of {self._count} fits, about "
            f"{in_words(left)} left; the diagnosis: about {in_words(whole)} left"
        )
