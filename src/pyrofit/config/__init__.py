"""The study description: the only reader of YAML, and all checks that need no measured data.

`study` defines the parts of a study, `known` the known values of its parameters. `stages` defines
its stages, `terms` the terms of its costs and `diagnosis` its diagnosis.
`repeats` makes experiments of repeats, with `repeated_names` and `nuisances`.
`resolve` holds the defaults of a study. `checks`, `stage_checks`, `diagnosis_checks` and `numbers`
hold the rules between its parts and for its numbers. `effects` puts effects in, `read` reads and
checks a study, `words` states its errors in plain words, `uses` finds the parameters that a part
uses.
"""

from pyrofit.config.diagnosis import Diagnosis
from pyrofit.config.effects import true_description
from pyrofit.config.known import Known
from pyrofit.config.read import as_study, digest, read_study
from pyrofit.config.resolve import (
    calibration_channels,
    candidate_effects,
    diagnosed_material,
    diagnosed_parameters,
    held_out_channels,
    kinetics_of,
)
from pyrofit.config.stages import Imp, Kinetics
from pyrofit.config.study import Study
from pyrofit.config.terms import TermSpec
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
