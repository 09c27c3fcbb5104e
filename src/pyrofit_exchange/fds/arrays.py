"""Arrays of Fortran namelists: the places that ``MATL_ID(1,1:2)='A','B'`` fills."""

import itertools
import re
from collections.abc import Mapping
from typing import Any

from pyrofit_exchange.fds.versions import FdsError

Place = tuple[int, ...]


def array(keys: Mapping[str, list[Any]], name: str, rank: int, source: str) -> dict[Place, Any]:
    """Return the values that a namelist gives to an array, by place; the first index runs fastest.

    Parameters
    ----------
    keys
        Keys of a namelist as `pyrofit_exchange.fds.parse.read_namelists` has them.
    name
        Name of the array.
    rank
        Number of its indices.
    source
        File and line, for messages.

    Examples
    --------
    >>> array({"MATL_ID(1,1:2)": ["A", "B"]}, "MATL_ID", 2, "")
    {(1, 1): 'A', (1, 2): 'B'}
    >>> array({"THICKNESS": [0.005, 0.01]}, "THICKNESS", 1, "")
    {(1,): 0.005, (2,): 0.01}
    """
    found: dict[Place, Any] = {}
    for key, given in keys.items():
        own, _, indices = key.partition("(")
        if own != name:
            continue
        places = _places(indices.rstrip(")"), len(given), rank)
        if places is None or len(given) > len(places):
            raise FdsError(f"{source}: {key} has {len(given)} values, which do not fit; correct it")
        found |= dict(zip(places, given, strict=False))
    return found


def _places(indices: str, count: int, rank: int) -> list[Place] | None:
    if not indices:
        return [(n + 1, *[1] * (rank - 1)) for n in range(count)]
    spans = []
    for index in indices.split(","):
        span = re.fullmatch(r"(\d+)(?::(\d+))?", index)
        if not span:
            return None
        first = int(span[1])
        last = int(span[2]) if span[2] else first
        spans.append(range(first, last + 1))
    if len(spans) != rank:
        return None
    single = all(len(span) == 1 for span in spans)
    if single and count > 1:  # a place is where the values begin
        return [(spans[0][0] + n, *(span[0] for span in spans[1:])) for n in range(count)]
    return [place[::-1] for place in itertools.product(*reversed(spans))]
