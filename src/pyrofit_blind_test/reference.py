"""The keys of the blind test, for the reference page."""

from pyrofit.config.reference import with_keys
from pyrofit.model.accuracy import Resolution
from pyrofit_blind_test.setting import Setting

_HEAD = """\
# Keys of the blind test

Those of `blind_test.yaml`.
"""


def blind_test_keys() -> str:
    """Return the part of the reference page with every key of the blind test."""
    return with_keys(_HEAD, Setting, elsewhere=(Resolution,))
