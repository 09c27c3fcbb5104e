"""The choice as it is written: ``scheme.json`` and its curves."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict

import numpy as np
import pandas as pd

from pyrofit.cost.distances import root_mean_square
from pyrofit.estimate.posterior import interval, limit_of
from pyrofit.scheme.choice import Candidate, Choice
from pyrofit.scheme.fit import FittedScheme
from pyrofit.scheme.prediction import PredictedRecord
from pyrofit.scheme.settings import SchemeSettings
from pyrofit.scheme.words import RULE, sentences
from pyrofit.steps.scheme.record import (
    EXTENDED,
    OfRecord,
    OfScheme,
    OfSchemeParameter,
    SchemeChoice,
)


def scheme_found(choice: Choice, settings: SchemeSettings) -> SchemeChoice:
    """Return the result."""
    chosen = choice.chosen.fitted
    scheme = chosen.posed.scheme
    assert scheme is not None
    schemes = [_scheme(choice, c) for c in choice.candidates]
    return SchemeChoice(
        study=chosen.posed.study.name,
        chosen=chosen.name,
        best=choice.best.fitted.name,
        largest=scheme.reactions == settings.most_reactions,
        rule=RULE.format(least=settings.as_good, largest=settings.largest_margin),
        words=sentences(choice, settings),
        schemes=schemes,
        own=_scheme(choice, choice.own),
        parameters=parameters_of(chosen),
        settings=asdict(settings),
        extended_study=EXTENDED,
    )


def _scheme(choice: Choice, candidate: Candidate) -> OfScheme:
    fitted = candidate.fitted
    held_out = choice.held_out[fitted.name]
    return OfScheme(
        name=fitted.name,
        words=fitted.posed.words,
        parameters=fitted.posed.count,
        bic=fitted.bic,
        discrepancy=fitted.size,
        rms=root_mean_square([root_mean_square(r) for r in fitted.residuals()]),
        predicted_rms=candidate.left_out_rms if candidate.left_out else None,
        held_out_rms=root_mean_square([p.rms for p in held_out]) if held_out else None,
        log_score=candidate.log_score if candidate.left_out else None,
        margin=choice.margins.get(fitted.name),
        records=[*_fitted_records(candidate), *(_record(p, p.rms, None) for p in held_out)],
    )


def _fitted_records(candidate: Candidate) -> list[OfRecord]:
    left_out = {p.record.experiment: p for p in candidate.left_out}
    rows = []
    for record, residual in zip(
        candidate.fitted.records, candidate.fitted.residuals(), strict=True
    ):
        out = left_out.get(record.experiment)
        predicted = PredictedRecord(record, record.mass + residual, 0.0)
        rows.append(_record(predicted, predicted.rms, None if out is None else out.rms))
    return rows


def _record(met: PredictedRecord, rms: float, predicted: float | None) -> OfRecord:
    record = met.record
    return OfRecord(
        experiment=record.experiment,
        heating_rate_K_min=record.rate,
        laboratory=record.laboratory,
        calibrated=record.calibrated,
        rms=rms,
        predicted_rms=predicted,
    )


def parameters_of(fitted: FittedScheme) -> dict[str, OfSchemeParameter]:
    """Return the parameters of a fit with linear 95 % intervals, in their units."""
    spread = np.sqrt(np.diag(fitted.spread()))
    found = {}
    for name, x, sd in zip(fitted.posed.names, fitted.x, spread, strict=True):
        p = fitted.posed.study.parameters[name]
        low, high = (limit / p.factor for limit in p.bounds_si)
        ends = interval(float(x), float(sd))
        found[name] = OfSchemeParameter(
            label=p.label,
            unit=p.unit,
            value=low + float(x) * (high - low),
            low=low + ends[0] * (high - low),
            high=low + ends[1] * (high - low),
            at_limit=bool(limit_of(float(x))),
        )
    return found


def curves_of(choice: Choice) -> pd.DataFrame:
    """Return the records with the curves of the study's scheme, the chosen one, its predictions.

    ``predicted`` comes from a fit without the record's heating rate; of a record that is not
    fitted, it is the prediction itself.
    """
    before = _curves(choice.own, choice.held_out)
    after = _curves(choice.chosen, choice.held_out)
    out = {p.record.experiment: p.curve for p in choice.chosen.left_out}
    frames = []
    for met in after.values():
        record = met.record
        name = record.experiment
        frames.append(
            pd.DataFrame(
                {
                    "experiment": name,
                    "calibrated": record.calibrated,
                    "time_s": record.time_s,
                    "temperature_K": record.temperature_K,
                    "measured": record.mass,
                    "before": before[name].curve,
                    "after": met.curve,
                    "predicted": out.get(name, met.curve),
                }
            )
        )
    return pd.concat(frames, ignore_index=True)


def _curves(
    candidate: Candidate, held_out: Mapping[str, Sequence[PredictedRecord]]
) -> dict[str, PredictedRecord]:
    fitted = candidate.fitted
    pairs = zip(fitted.records, fitted.residuals(), strict=True)
    found = {r.experiment: PredictedRecord(r, r.mass + residual, 0.0) for r, residual in pairs}
    return found | {p.record.experiment: p for p in held_out[fitted.name]}
