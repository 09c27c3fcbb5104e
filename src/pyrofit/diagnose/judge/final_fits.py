"""The models that a verdict rests on, fitted with runs as fine as the study asks for.

The search uses coarser runs where the noise hides the difference. Part of their error does not show
in chi-square, as the fitted parameters make up for it. It shifts these instead, so the models of
the verdict are fitted once more.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from pyrofit.diagnose.base.accuracy import with_accuracy
from pyrofit.diagnose.base.fitted import FittedModel, all_up_to_date
from pyrofit.diagnose.judge.findings import Judged, Verdict
from pyrofit.model.accuracy import Accuracy

Key = frozenset[tuple[str, tuple[str, ...]]]


@dataclass(frozen=True, eq=False)
class FinalFits:
    """Base, final model, and all other models that nothing speaks against.

    Parameters
    ----------
    fits
        By the key of the model.
    kept
        Keys of those that nothing speaks against.
    """

    fits: Mapping[Key, FittedModel]
    kept: tuple[Key, ...]

    def of(self, trial: FittedModel) -> FittedModel:
        """Return the final fit of a model, the trial itself if there is none."""
        return self.fits.get(key_of(trial), trial)


def key_of(trial: FittedModel) -> Key:
    """Return the key of a model: its effects and their fitted parameters."""
    return frozenset(trial.model.effects.items())


def final_fits(verdict: Verdict, accuracy: Accuracy | None, processes: int = 1) -> FinalFits:
    """Return the final fits of a verdict's models.

    Parameters
    ----------
    verdict
        Base, final model, and models that nothing speaks against are fitted.
    accuracy
        Of their runs; by default that of the search.
    """
    base, kept = verdict.search.base, kept_models(verdict)
    models = kept | {key_of(trial): trial for trial in (base, verdict.search.end)}
    trials = list(models.values())
    fits = (
        all_up_to_date(trials, processes)
        if accuracy is None
        else with_accuracy(base, trials, accuracy, processes)
    )
    return FinalFits(dict(zip(models, fits, strict=True)), tuple(kept))


def kept_models(verdict: Verdict) -> dict[Key, FittedModel]:
    """Return the models that nothing speaks against in any of their effects' places."""
    judged: dict[Key, list[Judged]] = {}
    for finding in verdict.findings:
        for one in finding.judged:
            judged.setdefault(key_of(one.trial), []).append(one)
    return {
        key: ones[0].trial for key, ones in judged.items() if not any(one.rejected for one in ones)
    } | {key_of(one.trial): one.trial for finding in verdict.findings for one in finding.instead}
