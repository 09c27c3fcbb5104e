"""Any test that an external program simulates: a template, a command, columns to read."""

from typing import Literal

from pydantic import Field

from pyrofit.experiments.base import Kind
from pyrofit.experiments.external.simulate import (
    course,
    designs,
    reference,
    request,
    simulate,
    synthetic,
)
from pyrofit.model.external import ExternalExperiment


class External(ExternalExperiment):
    """Any test that an external program simulates."""

    kind: Literal["external"] = Field(description="a test that an external program simulates")


KIND = Kind(
    description=External,
    words="external",
    stage="imp",
    simulate=simulate,
    reference=reference,
    request=request,
    synthetic=synthetic,
    course=course,
    designs=designs,
    files=None,
    can_lead=False,
)
