"""The places of a study that `init` has marked, because measured files do not tell their values."""

MARK = "CHANGE"


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
