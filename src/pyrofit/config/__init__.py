"""The study description: the only reader of YAML, and all checks that need no measured data.

`keys` holds what may stand in a study, `expand` makes a complete description of it, `check` the
rules between its parts. `read` goes through them in this order, each once. `words` states errors in
plain words, `resolve` holds the defaults of a study, `uses` finds the parameters that a part uses.
"""

from pyrofit.config.expand.effects import true_description
from pyrofit.config.keys.diagnosis import Diagnosis
from pyrofit.config.keys.known import Known
from pyrofit.config.keys.stages import Imp, Kinetics
from pyrofit.config.keys.study import Study
from pyrofit.config.keys.terms import TermSpec
from pyrofit.config.read import as_study, digest, read_study
from pyrofit.config.resolve import (
    calibration_channels,
    candidate_effects,
    diagnosed_material,
    diagnosed_parameters,
    held_out_channels,
    kinetics_of,
)
from pyrofit.config.uses import parameters_in
from pyrofit.config.yaml_file import as_yaml, read_mapping

__all__ = [
    "Diagnosis",
    "Imp",
    "Kinetics",
    "Known",
    "Study",
    "TermSpec",
    "as_study",
    "as_yaml",
    "calibration_channels",
    "candidate_effects",
    "diagnosed_material",
    "diagnosed_parameters",
    "digest",
    "held_out_channels",
    "kinetics_of",
    "parameters_in",
    "read_mapping",
    "read_study",
    "true_description",
]
