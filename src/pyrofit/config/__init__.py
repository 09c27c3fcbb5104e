"""The study description: the only reader of YAML, and all checks that need no measured data.

`study` says what a study is made of, `checks` and `numbers` what must hold between its parts and
for its numbers, `read` reads it, `words` says in plain words what is wrong, `uses` which parameters
a part uses.
"""

from pyrofit.config.read import as_study, digest, read_mapping, read_study
from pyrofit.config.study import Imp, Kinetics, Study, TermSpec
from pyrofit.config.uses import parameters_in

__all__ = [
    "Imp",
    "Kinetics",
    "Study",
    "TermSpec",
    "as_study",
    "digest",
    "parameters_in",
    "read_mapping",
    "read_study",
]
