"""Remarks on parts of a description that FDS expresses otherwise, or not at all."""

from collections.abc import Iterable
from typing import Literal, NamedTuple

Kind = Literal["approximate", "left out", "when read"]


class Remark(NamedTuple):
    """A part of the description that is not exactly in a deck.

    Parameters
    ----------
    kind
        Approximate, left out, or applied when FDS's output is read.
    what
        The part in words, with its key in the study.
    how
        The replacement, or the reason why there is none.
    """

    kind: Kind
    what: str
    how: str

    @property
    def line(self) -> str:
        """The remark in one line."""
        return f"{self.kind}: {self.what}: {self.how}"


def once(remarks: Iterable[Remark]) -> tuple[Remark, ...]:
    """Return each remark once, in order."""
    return tuple(dict.fromkeys(remarks))
