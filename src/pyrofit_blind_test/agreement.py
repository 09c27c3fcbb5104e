"""The difference of another code's curves from those of pyrofit that has the same effects."""

from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.errors import StudyError
from pyrofit_blind_test import foreign
from pyrofit_blind_test.detectability import unexplained
from pyrofit_blind_test.plan import TwinPlan
from pyrofit_blind_test.setting import Setting
from pyrofit_blind_test.twin import describe_twin


def agreement(setting: Setting) -> pd.DataFrame:
    """Return one row per case: differences of true model and noise-free curves of another code.

    ``at_truth_sd`` is the root of the sum of squared differences over the noise. ``fitted_sd`` is
    the part that no parameter of the base takes up, and ``largest_sd`` the largest of its
    differences. The signals are those of the set that has most; the noise is the first kind.

    Raises
    ------
    StudyError
        The setting has no curves of another code.
    DataError
        A curve is missing, or a simulation of the truth does not finish.
    """
    if not setting.curves:
        raise StudyError("this blind test has no curves of another code; give `curves`")
    folder = Path(setting.curves)
    names = foreign.read_manifest(folder).cases
    return pd.DataFrame([{"case": name, **_row(setting, folder, name)} for name in names])


def _row(setting: Setting, folder: Path, name: str) -> dict[str, object]:
    truth = foreign.read_manifest(folder).truth(name)
    case = TwinPlan(
        kind=truth.kind,
        hidden=truth.effects,
        strength=1.0,
        signals=max(setting.signals, key=lambda one: len(setting.signals[one])),
        noise=next(iter(setting.noise)),
        seed=0,
        curves=name,
    )
    _, study = describe_twin(setting, case)
    left = unexplained(study, foreign.clean(folder, name, study), setting.known)
    largest = max(float(np.abs(off).max()) for _, off in left.differences.values())
    return {
        "effects": " + ".join(sorted(truth.effects)),
        "points": left.points,
        "at_truth_sd": left.start,
        "fitted_sd": left.size,
        "largest_sd": largest,
    }
