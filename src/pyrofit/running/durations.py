"""Durations in words."""


def in_words(seconds: float) -> str:
    """Return a duration in words, rounded.

    >>> in_words(42.0), in_words(600.0), in_words(90_000.0), in_words(360_000.0)
    ('42 s', '10 min', '25 h', '4.2 days')
    """
    if seconds < 120.0:
        return f"{seconds:.0f} s"
    if seconds < 7200.0:
        return f"{seconds / 60.0:.0f} min"
    hours = seconds / 3600.0
    return f"{hours:.0f} h" if hours < 72.0 else f"{hours / 24.0:.1f} days"
