"""The places of a study that `init` has marked, because measured files do not tell their values."""

import re
from collections import Counter

MARK = "CHANGE"
_SHARED = re.compile(r"( +)(units|endothermic): ([^&*#][^#]*?)( # .*CHANGE.*)")
"""A value that the files of one instrument share, with its mark."""


def marked_lines(text: str) -> list[int]:
    r"""Return the numbers of the lines with a mark in a comment, from 1, without the heading.

    >>> marked_lines("# Change the places marked CHANGE\nh_W_m2K: 10 # CHANGE\nk: 0.2\n")
    [2]
    """
    comments = (line.partition("#")[2] for line in text.splitlines())
    return [
        number
        for number, comment in enumerate(comments, 1)
        if MARK in comment and f"marked {MARK}" not in comment
    ]


def asked_once(text: str) -> str:
    r"""Return a study in which a marked value that several files share stands once, with an anchor.

    >>> line = "  endothermic: positive # CHANGE to negative\n"
    >>> print(asked_once(3 * line), end="")
      endothermic: &endothermic_1 positive # CHANGE to negative
      endothermic: *endothermic_1
      endothermic: *endothermic_1
    """
    lines = text.split("\n")
    found = [_SHARED.fullmatch(line) for line in lines]
    counts = Counter(match.groups()[1:] for match in found if match)
    names: dict[tuple[str, ...], str] = {}
    for i, match in enumerate(found):
        if match is None or counts[match.groups()[1:]] < 2:
            continue
        indent, key, value, comment = match.groups()
        if (shared := names.get(match.groups()[1:])) is not None:
            lines[i] = f"{indent}{key}: *{shared}"
            continue
        name = f"{key}_{1 + sum(other.startswith(key) for other in names.values())}"
        names[match.groups()[1:]] = name
        lines[i] = f"{indent}{key}: &{name} {value}{comment}"
    return "\n".join(lines)
