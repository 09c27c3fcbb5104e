"""Free corrections that explain the data nearly as well as a claimed effect does.

No catalogue holds all physics: an effect outside it may be mistaken for one inside. In the place of
a claimed effect, each free correction of another term of the model is therefore fitted. The models
are compared by the marginal likelihood, in Laplace's approximation (MacKay 2003, chapter 28):

    -2 ln Z = chi2 + log det(J^T J + Pi) - log det Pi

Pi holds the inverse variances of the priors: 12 for a value anywhere within its limits, and 36 more
for a coefficient of a correction, whose prior is normal. Where a model misfits, the variance of the
noise is that of `inflation`; the corrections are not fitted again under it.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from pyrofit.diagnose.base.descent import refreshed
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.inflation import Inflation
from pyrofit.diagnose.corrections.correction import Correction
from pyrofit.diagnose.corrections.fit import corrected, with_coefficients
from pyrofit.diagnose.corrections.forms import SAME_TERM, fitted_corrections
from pyrofit.effects import known_effects
from pyrofit.estimate.posterior import UNIFORM, curvature
from pyrofit.numerics import linear
from pyrofit.parallel import parallel_map


@dataclass(frozen=True)
class OtherTerm:
    """A free correction that takes the place of an effect.

    Parameters
    ----------
    words
        The correction in words.
    above
        Its -2 ln Z less that of the model with the effect.
    most
        Value of ``above`` up to which it explains the data nearly as well.
    """

    words: str
    above: float
    most: float

    @property
    def fits_as_well(self) -> bool:
        """Whether the data do not exclude it against the effect with high odds."""
        return self.above <= self.most


def other_terms(
    end: FittedModel,
    without: Sequence[FittedModel],
    inflation: Inflation,
    processes: int = 1,
) -> list[list[OtherTerm]]:
    """Return the free corrections in the place of each effect of a model.

    Parameters
    ----------
    end
        The model, its derivatives made at the fit.
    without
        The same model fitted without each of its effects, in their order.
    inflation
        By how much misfit of the model raises the variance of the noise.
    processes
        Processes that share the fits.
    """
    tasks = [
        (k, correction)
        for k, reduced in enumerate(without)
        for correction in _rivals(reduced, end.effects[k])
    ]
    above = parallel_map(
        lambda i: _above(end, without[tasks[i][0]], tasks[i][1], inflation), len(tasks), processes
    )
    found: list[list[OtherTerm]] = [[] for _ in without]
    for (k, correction), size in zip(tasks, above, strict=True):
        found[k].append(OtherTerm(correction.what, size, end.settings.certain_evidence))
    return found


def _rivals(reduced: FittedModel, effect: str) -> list[Correction]:
    """Return the corrections of other terms than the one that an effect changes."""
    group = known_effects()[effect].group
    found = fitted_corrections(reduced)
    return [correction for correction in found if group not in SAME_TERM[correction.probe]]


def _above(
    end: FittedModel, reduced: FittedModel, correction: Correction, inflation: Inflation
) -> float:
    """Return -2 ln Z of a correction in the place of an effect, less that of the effect.

    The fit starts where the model without the effect has its minimum, and at the parameters of the
    model with the effect.
    """
    model = with_coefficients(reduced.model, correction)
    kept = [end.model.names.index(name) for name in reduced.model.names]
    starts = (reduced.fit.x, end.fit.x[kept])
    fit = min((corrected(reduced, correction, x) for x in starts), key=lambda one: one.chi2)
    # Inverse variance in x of a coefficient.
    narrow = (2.0 * end.settings.widest_correction) ** 2
    others = reduced.numbers * math.log(UNIFORM) + len(correction.sd) * math.log(UNIFORM + narrow)
    own = end.numbers * math.log(UNIFORM)
    corrected_model = FittedModel(model, refreshed(model, fit))
    return float(_size(corrected_model, inflation) - others - (_size(end, inflation) - own))


def _size(trial: FittedModel, inflation: Inflation) -> float:
    """Return chi2 + log det(J^T J + Pi) under the inflated noise."""
    rows = inflation.rows(trial)[:, None]
    return inflation.chi2(trial) + linear.log_det(curvature(rows * trial.fit.jacobian))
