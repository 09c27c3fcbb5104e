"""The places of a study that `init` has marked, because measured files do not tell their values."""

MARK = "CHANGE"


def marked_lines(text: str) -> list[int]:
    r"""Return the numbers of the lines that are marked, from 1; the heading is none of them.

    >>> marked_lines("# Change the places marked CHANGE\nh_W_m2K: 10 # CHANGE\nk: 0.2\n")
    [2]
    """
    return [
        number
        for number, line in enumerate(text.splitlines(), 1)
        if MARK in line and f"marked {MARK}" not in line
    ]
