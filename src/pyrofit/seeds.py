"""Seeds of everything random, by identity."""

import hashlib


def seed_for(study_seed: int, *identity: object) -> int:
    """Return the seed of one search, a function of the study's seed and its identity alone.

    >>> seed_for(1, "RMSE", 3) == seed_for(1, "RMSE", 3) != seed_for(1, "RMSE", 4)
    True
    """
    text = "/".join(str(part) for part in (study_seed, *identity))
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:4], "little") % 2**30
