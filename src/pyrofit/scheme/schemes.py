"""The schemes: number and arrangement of the reactions, and extras that they may have."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

from pyrofit.scheme.arrangements import ARRANGEMENTS

PARALLEL = "parallel"
EXTRAS = ("order", "catalysis", "volatile", "lag")


@dataclass(frozen=True, order=True)
class Scheme:
    """A reaction scheme.

    Parameters
    ----------
    reactions
        How many reactions decompose the material, an early volatile not counted.
    arrangement
        Name of a module in `pyrofit.scheme.arrangements`; of one reaction always 'parallel'.
    order
        Whether each reaction has an order n, else all are of first order.
    catalysis
        Whether the product of the only reaction speeds it up.
    volatile
        Whether an early volatile leaves by a reaction of its own.
    lag
        Whether the sample's temperature lags behind the recorded one.
    """

    reactions: int = 1
    arrangement: str = PARALLEL
    order: bool = False
    catalysis: bool = False
    volatile: bool = False
    lag: bool = False

    @property
    def name(self) -> str:
        """Identifier.

        >>> Scheme(2, "parallel", order=True).name, Scheme(volatile=True).name
        ('parallel_2_order', 'single_volatile')
        """
        base = "single" if self.reactions == 1 else f"{self.arrangement}_{self.reactions}"
        return "_".join([base, *(extra for extra in EXTRAS if getattr(self, extra))])

    @property
    def words(self) -> str:
        """The scheme in words.

        >>> Scheme(volatile=True, order=True).words
        'one reaction of order n with an early volatile'
        """
        count = ("one", "two", "three", "four", "five", "six")[self.reactions - 1]
        kind = "" if self.reactions == 1 else f" {self.arrangement}"
        kind = " autocatalytic" if self.catalysis else kind
        noun = "reaction" if self.reactions == 1 else "reactions"
        degree = "of order n" if self.order else "of first order"
        extras = ["an early volatile"] * self.volatile + ["a temperature lag"] * self.lag
        tail = f" with {' and '.join(extras)}" if extras else ""
        return f"{count}{kind} {noun} {degree}{tail}"

    def extensions(self, most_reactions: int, lag: bool) -> Iterator["Scheme"]:
        """Yield the schemes with one more feature; ``lag`` tells whether a lag is possible."""
        if self.reactions < most_reactions and not self.catalysis:
            kinds = sorted(ARRANGEMENTS) if self.reactions == 1 else [self.arrangement]
            for kind in kinds:
                yield replace(self, reactions=self.reactions + 1, arrangement=kind)
        for extra in EXTRAS:
            possible = {"lag": lag, "catalysis": self.reactions == 1}.get(extra, True)
            if possible and not getattr(self, extra):
                yield replace(self, **{extra: True})  # type: ignore[arg-type]
