"""The costs that stored sets are scored under: the study's, the paper's, and those of others."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from inspect import Parameter, signature

import numpy as np

from pyrofit.config import Study, TermSpec
from pyrofit.config.keys.terms import channels_of
from pyrofit.cost import Target, known_costs
from pyrofit.errors import CostError, StudyError, suggest
from pyrofit.estimate.targets import Measurements, target_for, term_for

LIKELIHOOD = "chi2"
"""Name of the likelihood among the costs."""
EVERY = "_all"
"""End of the names of costs over all signals of the fitted experiments."""
TABLE_1 = {"none": "RMSE", "range": "NRMSE", "mean": "CV(RMSE)", "iqr": "IQRMSE"}


@dataclass(frozen=True)
class Measure:
    """A cost that sets are scored under.

    Parameters
    ----------
    name
        As it is asked for.
    words
        Its description.
    terms
        Its terms, Eq. 5; none of the likelihood.
    """

    name: str
    words: str
    terms: tuple[TermSpec, ...]


def measures_of(
    study: Study, measurements: Measurements, asked: Sequence[str] = ()
) -> tuple[list[Measure], list[str]]:
    """Return the costs to score by, and why others cannot be computed.

    They are those asked for, or all that can be computed from the measurements.

    Raises
    ------
    StudyError
        A cost that is asked for is unknown.
    CostError
        A cost that is asked for cannot be computed.
    """
    known = {m.name: m for m in _known(study, measurements)}
    if unknown := [name for name in asked if name not in known]:
        raise StudyError(f"unknown cost '{unknown[0]}'. {suggest(unknown[0], known)}")
    chosen, left_out = [], []
    for name in dict.fromkeys(asked or known):
        try:
            _check(study, known[name], measurements)
            chosen.append(known[name])
        except CostError as error:
            if asked:
                raise
            left_out.append(str(error))
    return chosen, left_out


def channels(study: Study) -> tuple[TermSpec, ...]:
    """Return the signals that the costs of the study compare, each once, all measured points."""
    return channels_of([term for terms in study.imp.costs.values() for term in terms])


def _known(study: Study, measurements: Measurements) -> Iterable[Measure]:
    """Yield all costs; the study's own come first, and the first of a name counts."""
    found: dict[str, Measure] = {}
    fitted = channels(study)
    every = _all_signals(study, fitted)
    own = [Measure(n, "cost function of the study", t) for n, t in study.imp.costs.items()]
    printed = [_measure(study, measurements, fitted, *given) for given in _STANDARD]
    if set(every) != {(c.experiment, c.signal) for c in fitted}:
        wide = [TermSpec(experiment=e, signal=s, kind="RMSE") for e, s in every]
        printed += [
            _measure(study, measurements, wide, f"{name}{EVERY}", f"{words}, all signals", *rest)
            for name, words, *rest in _STANDARD
            if name in ("NRMS", "GPYRO")
        ]
    likelihood = Measure(LIKELIHOOD, "chi-square of the likelihood", ())
    plain = [_measure(study, measurements, fitted, k, "added cost", k) for k in _plain_kinds()]
    for measure in (*own, *printed, likelihood, *plain):
        found.setdefault(measure.name, measure)
    return found.values()


_STANDARD: tuple[tuple[str, ...], ...] = (
    *(
        (f"RMSE_{norm}", f"{TABLE_1[norm]} of Eq. 4 and Table 1", "RMSE", norm)
        for norm in ("none", "mean", "iqr")
    ),
    ("RANGE_printed", "RANGE of Table 2, as printed", "RANGE", "mean"),
    ("RANGE_PROPTI", "RANGE as PROPTI codes it", "RANGE_PROPTI", "mean"),
    ("BANDS_printed", "BANDS of Table 2, as printed", "BANDS", "mean"),
    ("BANDS_PROPTI", "BANDS as PROPTI codes it", "BANDS_PROPTI", "mean"),
    ("NRSE", "NRSE of Eq. 1 at the measured peak", "NRSE"),
    ("THR_above", "THR of Eq. 2, first rise above half of the peak", "THR_above"),
    ("THR_below", "THR of Eq. 3, fall below half of the peak", "THR_below"),
    ("THR_above_literal", "Eq. 2 as printed", "THR_above_literal"),
    ("THR_below_literal", "Eq. 3 as printed", "THR_below_literal"),
    ("NRMS", "NRMS of MaCFP, rms over the measured range", "RMSE", "range"),
    ("GPYRO", "objective of Gpyro, eps 0.1, zeta 2", "GPYRO"),
)
"""Name, words, kind and normalisation."""


def _plain_kinds() -> list[str]:
    """Return the kinds of cost that need no option."""
    return [
        kind
        for kind, cost in known_costs().items()
        if all(
            p.default is not Parameter.empty
            for p in signature(cost).parameters.values()
            if p.kind is Parameter.KEYWORD_ONLY
        )
        and kind not in ("RMSE", "RANGE", "BANDS")
    ]


def _all_signals(study: Study, fitted: Iterable[TermSpec]) -> list[tuple[str, str]]:
    experiments = dict.fromkeys(c.experiment for c in fitted)
    return [(e, s) for e in experiments for s in study.experiments[e].signals]


def _measure(
    study: Study,
    measurements: Measurements,
    signals: Sequence[TermSpec],
    name: str,
    words: str,
    kind: str,
    normalisation: str | None = None,
) -> Measure:
    terms = []
    for channel in signals:
        update: dict[str, object] = {"kind": kind, "normalisation": normalisation}
        update["options"] = _options(study, measurements, channel, kind)
        terms.append(channel.model_copy(update=update))
    return Measure(name, words, tuple(terms))


def _options(
    study: Study, measurements: Measurements, channel: TermSpec, kind: str
) -> Mapping[str, float]:
    """Return the options that a kind needs of a signal, from the measured curve."""
    target = target_for(study, channel, measurements)
    experiment = study.experiments[channel.experiment]
    if kind == "GPYRO" and experiment.quantity(channel.signal).is_temperature:
        initial = getattr(getattr(experiment, "sample", None), "initial_temperature_K", None)
        return {"reference": initial if isinstance(initial, float) else float(target.value[0])}
    moment = MOMENTS.get(kind.removesuffix("_literal"))
    return {} if moment is None else {"time_s": moment(target)}


def peak(target: Target) -> float:
    """Return the time [s] of the largest measured value."""
    return float(target.time_s[target.value.argmax()])


def rise(target: Target) -> float:
    """Return the first time [s] at which a curve is half of its range above its lowest value."""
    return float(target.time_s[_upper_half(target).argmax()])


def fall(target: Target) -> float:
    """Return the last such time [s], the end of a curve that stays above."""
    return float(target.time_s[np.flatnonzero(_upper_half(target))[-1]])


MOMENTS = {"NRSE": peak, "THR_above": rise, "THR_below": fall}
"""The time at which a cost of a single point is taken."""


def _upper_half(target: Target) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    lowest, highest = float(target.value.min()), float(target.value.max())
    return np.asarray(target.value >= 0.5 * (lowest + highest))


def _check(study: Study, measure: Measure, measurements: Measurements) -> None:
    for term in measure.terms:
        try:
            term_for(study, term, measurements)
        except CostError as error:
            place = f"{term.experiment}.{term.signal}"
            raise CostError(
                f"cost '{measure.name}' cannot be computed for {place}: {error}"
            ) from None
