"""Free corrections that would absorb the misfit that no effect of the catalogue explains.

Each correction (`pyrofit.diagnose.corrections`) is fitted jointly with all other
parameters. Its coefficients have a normal prior about zero, where the model is unchanged. A probe
shows the kind and the shape of a missing term; it is not an effect, nor is one claimed from it.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import chi2 as chi_squared

from pyrofit.diagnose.base.descent import Fit
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.corrections.correction import Correction, Shape
from pyrofit.diagnose.corrections.fit import corrected, with_coefficients
from pyrofit.diagnose.corrections.forms import fitted_corrections
from pyrofit.estimate.posterior import freedom
from pyrofit.parallel import parallel_map


@dataclass(frozen=True)
class Probe:
    """A free correction that was fitted.

    Parameters
    ----------
    probe
        ``flux``, ``conductivity``, ``heat_capacity``, ``front_heat_loss``, ``back_heat_loss`` or
        ``foil_heat_capacity``.
    what
        The same in words.
    coefficients
        By name, SI units.
    chi2
        Of the data and the known values, without the coefficients' priors.
    absorbed
        Share of the excess of chi-square that it takes away, at most 1.
    shape
        Abscissa (time [s] or temperature [K]) and correction, for drawing.
    unit
        Of the correction.
    """

    probe: str
    what: str
    coefficients: dict[str, float]
    chi2: float
    absorbed: float
    shape: Shape
    unit: str


def probes(trial: FittedModel, processes: int = 1) -> list[Probe]:
    """Fit all probes to the misfit of a fitted model.

    The excess is chi-square less that of the noise. That is the degrees of freedom, or chi-square
    of the best probe where this is lower, since the noise is rather over- than underestimated. A
    probe absorbs nothing where as many useless coefficients would gain as much by chance, with a
    probability above 1 %.

    Returns
    -------
    list of Probe
        The lowest chi-square first, 2 added per coefficient; none without a gasification.
    """
    wanted = fitted_corrections(trial)
    fits = parallel_map(lambda i: corrected(trial, wanted[i]), len(wanted), processes)
    found = [_probe(trial, *pair) for pair in zip(wanted, fits, strict=True)]
    noise = min([freedom(trial.fit.jacobian, trial.fit.x), *(probe.chi2 for probe in found)])
    judged = [replace(probe, absorbed=_absorbed(trial, probe, noise)) for probe in found]
    price = trial.settings.correction_price
    return sorted(judged, key=lambda probe: probe.chi2 + price * len(probe.coefficients))


def _absorbed(trial: FittedModel, probe: Probe, noise: float) -> float:
    gain = trial.fit.chi2 - probe.chi2
    if chi_squared.sf(gain, len(probe.coefficients)) > trial.settings.false_alarm_level:
        return 0.0
    return min(gain / (trial.fit.chi2 - noise), 1.0)


def _probe(trial: FittedModel, correction: Correction, fit: Fit) -> Probe:
    model = with_coefficients(trial.model, correction)
    sd = np.array(list(correction.sd.values()))
    values = model.likelihood.values(fit.x)
    c = values[-sd.size :]
    return Probe(
        probe=correction.probe,
        what=correction.what,
        coefficients=dict(zip(correction.sd, c.tolist(), strict=True)),
        chi2=fit.chi2 - float(np.sum((c / sd) ** 2)),
        absorbed=0.0,
        shape=correction.shape(model.likelihood.problem.values(values)),
        unit=correction.unit,
    )
