"""Whether the kinetics of the slab are those of the TGA: a table of docs/measured_pmma.md.

    python benchmarks/kinetics_agreement.py [config/pmma.yaml]

The base with the effects that the diagnosis found is fitted three times: to the TGA alone, to the
slab alone, and to both. The table has the kinetics with their standard deviations, which are wider
where chi-square exceeds the number of points.
"""

import sys
from pathlib import Path

import numpy as np
from laboratories import FOUND, KINETICS, base_of, fitted, table_of, values_of

from pyrofit.config import as_study, read_mapping
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import Base
from pyrofit.experiments import kind_of
from pyrofit.stages.reading import read_all

SHOWN = (*KINETICS, "reaction_order_order", "tga_offset")


def channels(base: Base, stage: str) -> tuple[int, ...]:
    """Return the calibrated channels of the experiments of a stage."""
    runs = base.likelihood.problem.runs
    named = enumerate(base.channels)
    return tuple(i for i, (name, _) in named if kind_of(runs[name].experiment).stage == stage)


def kinetics(trial: FittedModel) -> dict[str, str]:
    """Return the kinetics with their standard deviations; empty where the data show nothing."""
    likelihood = trial.model.likelihood
    sd = np.sqrt(np.diag(trial.posterior.covariance())) * likelihood.problem.span
    values = values_of(trial)
    shown = {}
    for name in SHOWN:
        at = trial.model.names.index(name)
        seen = np.any(trial.fit.jacobian[: trial.model.points, at] != 0.0)
        shown[name] = f"{values[name]:.4g} ± {sd[at]:.2g}" if seen else ""
    return shown


def report(name: str) -> str:
    """Return the table."""
    study = as_study(read_mapping(Path(name)), name)
    measurements = {key: frame for key, (frame, _) in read_all(study).items()}
    base = base_of(study, measurements, held_out=False)
    parts = {
        "TGA alone": channels(base, "kinetics"),
        "slab alone": channels(base, "imp"),
        "both": base.calibrated,
    }
    return table_of({w: kinetics(fitted(base, FOUND, study.seed, c)) for w, c in parts.items()})


if __name__ == "__main__":
    print(report(*sys.argv[1:] or ["config/pmma.yaml"]))
