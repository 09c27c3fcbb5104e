"""The study with a chosen scheme, of a study with known values."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from pyrofit.config import as_study, diagnosed_parameters, read_study
from pyrofit.scheme.extended import scheme_keys
from pyrofit.scheme.posed import Posed, pose_scheme
from pyrofit.scheme.records import MassRecord
from pyrofit.scheme.schemes import Scheme
from pyrofit.scheme.settings import SchemeSettings

CONFIG = Path(__file__).parents[2] / "config"


def fitted(posed: Posed) -> Any:
    """Return a fit of a scheme in the middle of its limits."""
    of = posed.study.parameters
    middle = {n: of[n].factor * (of[n].lower + of[n].upper) / 2 for n in posed.names}  # type: ignore[operator]
    return SimpleNamespace(posed=posed, values=middle)


@pytest.mark.parametrize("scheme", [Scheme(order=True), Scheme(reactions=2, volatile=True)])
def test_the_diagnosis_of_pmma_estimates_the_same_but_the_kinetics(scheme: Scheme) -> None:
    study = read_study(CONFIG / "pmma.yaml")
    assert study.kinetics is not None
    temperature = np.linspace(400.0, 700.0, 50)
    mass = 1.0 / (1.0 + np.exp((temperature - 630.0) / 8.0))
    records = [
        MassRecord(
            term.experiment, term.signal, 10.0, "", True, term, temperature, temperature, mass
        )
        for term in study.kinetics.cost
    ]
    posed = pose_scheme(study, scheme, records, SchemeSettings())
    # Read as a file is: what no stage estimates may not be known.
    made = as_study(scheme_keys(study, fitted(posed), {}), "extended.yaml")
    gone = set(study.kinetics.estimate)
    assert set(diagnosed_parameters(made)) == set(diagnosed_parameters(study)) - gone
    assert "tga_offset" in diagnosed_parameters(made)
