"""Whether the kinetics of the small samples are those of the slab.

Small samples (TGA, DSC, MCC) tell the kinetics without heat transfer. The model is fitted to them
alone, and its parameters are compared with those of the fit to all signals. The fit to all signals
may give way at the kinetics where something is missing from the model of the slab.
"""

import numpy as np

from pyrofit.diagnose.base.descent import descend_chi_square
from pyrofit.diagnose.base.fitted import FittedModel, up_to_date
from pyrofit.diagnose.base.model import model_of
from pyrofit.diagnose.judge.intervals import values_of
from pyrofit.results.diagnosis_schema import OfKinetics


def kinetics_alone(trial: FittedModel) -> list[OfKinetics]:
    """Return the parameters that small samples tell, SI units; none without a slab beside them.

    ``difference`` is that of the fit to all signals from the fit to the small samples alone, in
    standard deviations of the latter.
    """
    base = trial.model.base
    small = [i for i in trial.model.channels if not base.shows_the_slab(i)]
    if not small or len(small) == len(trial.model.channels):
        return []
    model = model_of(base, trial.model.effects, small)
    alone = up_to_date(FittedModel(model, descend_chi_square(model, trial.fit.x)))
    values, sd = values_of(alone)
    joint, _ = values_of(trial)
    shown = np.any(alone.fit.jacobian[: model.points] != 0.0, axis=0)
    return [
        OfKinetics(
            parameter=model.names[i],
            alone=float(values[i]),
            sd=float(sd[i]),
            all=float(joint[i]),
            difference=float((joint[i] - values[i]) / sd[i]),
        )
        for i in np.flatnonzero(shown).tolist()
    ]
