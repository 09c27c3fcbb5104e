"""Poses the estimation of a study's parameters: names, terms, material and limits.

All steps and the Python interface pose theirs here. `pyrofit.estimate.pose_likelihood` adds noise
and known values; it is apart, so that a search does not depend on the code of the likelihood.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from pyrofit.config import (
    Study,
    TermSpec,
    calibration_channels,
    diagnosed_material,
    diagnosed_parameters,
    kinetics_of,
)
from pyrofit.estimate.prior import within_known
from pyrofit.estimate.problem import Problem, make_problem
from pyrofit.estimate.targets import Measurements
from pyrofit.model.material import Material


@dataclass(frozen=True)
class Estimation:
    """Which parameters are estimated, from which signals, with which material.

    Parameters
    ----------
    names
        Names of the parameters.
    terms
        Terms of a cost, or the channels of a likelihood.
    material
        The material, whose kinetics may be published ones.
    """

    names: Sequence[str]
    terms: Sequence[TermSpec]
    material: Material


def of_kinetics(study: Study, terms: Sequence[TermSpec] | None = None) -> Estimation:
    """Return the estimation of the kinetics; by default from all their channels.

    Raises
    ------
    StudyError
        The study has no such stage.
    """
    stage = kinetics_of(study)
    return Estimation(stage.estimate, stage.channels if terms is None else terms, study.material)


def of_imp(study: Study, terms: Sequence[TermSpec] | None = None) -> Estimation:
    """Return the estimation of the inverse modelling; by default from all its channels."""
    stage = study.imp
    material = study.material_with(stage.kinetics)
    return Estimation(stage.estimate, stage.channels if terms is None else terms, material)


def of_both(study: Study) -> Estimation:
    """Return the estimation from all channels that are fitted: of the kinetics too, if fitted."""
    imp = of_imp(study)
    if study.imp.kinetics != "fitted":
        return imp
    stage = kinetics_of(study)
    names = dict.fromkeys([*stage.estimate, *imp.names])
    return Estimation(list(names), [*stage.channels, *imp.terms], imp.material)


def of_diagnosis(
    study: Study, terms: Sequence[TermSpec] | None = None, names: Sequence[str] | None = None
) -> Estimation:
    """Return the estimation of the diagnosis; by default of all its parameters and signals."""
    return Estimation(
        diagnosed_parameters(study) if names is None else names,
        calibration_channels(study) if terms is None else terms,
        diagnosed_material(study),
    )


def pose(
    study: Study, estimation: Estimation, measurements: Measurements, fixed: Mapping[str, float]
) -> Problem:
    """Return the problem. Parameters of known value are estimated near it, see `within_known`.

    Parameters
    ----------
    study, estimation
        The study, and what of it is estimated.
    measurements
        Measured series by (experiment, signal), SI units.
    fixed
        Values of all other parameters, SI units.

    Raises
    ------
    CostError
        A cost does not fit its target.
    """
    names, terms, material = estimation.names, estimation.terms, estimation.material
    return within_known(study, make_problem(study, names, terms, measurements, material, fixed))
