"""The keys of the blind test, for the reference page."""

from pyrofit.config.reference import with_keys
from pyrofit.hidden.setting import Setting

_HEAD = """\
# Keys of the blind test

Those of `hidden_effects.yaml`.
"""


def blind_test_keys() -> str:
    """Return the part of the reference page with every key of the blind test."""
    return with_keys(_HEAD, Setting)
