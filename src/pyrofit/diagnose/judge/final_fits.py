"""The models that a verdict rests on, fitted with runs as fine as the study asks for.

The search uses coarser runs where the noise hides the difference. Part of their error does not show
in chi-square, as the fitted parameters make up for it. It shifts these instead, so the models of
the verdict are fitted once more.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from pyrofit.diagnose.base.accuracy import with_accuracy
from pyrofit.diagnose.base.fitted import FittedModel, Key, all_up_to_date
from pyrofit.diagnose.judge.findings import Verdict
from pyrofit.model.accuracy import Accuracy


@dataclass(frozen=True, eq=False)
class FinalFits:
    """The fits of base, final model, and of all models that a claim rests on.

    Parameters
    ----------
    fits
        By the key of the model. A model whose fine runs do not finish has its coarse fit.
    leading
        Keys of `leading_models`.
    """

    fits: Mapping[Key, FittedModel]
    leading: tuple[Key, ...]

    def of(self, trial: FittedModel) -> FittedModel:
        """Return the final fit of a model, the trial itself if there is none."""
        return self.fits.get(trial.key, trial)


def final_fits(verdict: Verdict, accuracy: Accuracy | None, processes: int = 1) -> FinalFits:
    """Return the final fits of a verdict's models.

    Parameters
    ----------
    verdict
        Its base and `leading_models` are fitted.
    accuracy
        Of the runs. With None, the fits of the search are the final ones.
    """
    base, leading = verdict.search.base, leading_models(verdict)
    models = {base.key: base, **leading}
    trials = list(models.values())
    fits = (
        all_up_to_date(trials, processes)
        if accuracy is None
        else with_accuracy(base, trials, accuracy, processes)
    )
    return FinalFits(dict(zip(models, fits, strict=True)), tuple(leading))


def leading_models(verdict: Verdict) -> dict[Key, FittedModel]:
    """Return the final model, and if there is a claim all others that nothing speaks against.

    None if the final model has no effects.
    """
    end = verdict.search.end
    if not end.effects:
        return {}
    found = {end.key: end}
    if verdict.kind != "unknown":
        judged = verdict.judged.items()
        found |= {k: ones[0].trial for k, ones in judged if not any(one.rejected for one in ones)}
        found |= {one.trial.key: one.trial for f in verdict.findings for one in f.instead}
    return found
