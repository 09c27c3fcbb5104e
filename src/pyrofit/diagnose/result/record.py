"""The results of a diagnosis as plain numbers and words, keys as in docs/diagnosis_json.md."""

from collections.abc import Iterable
from dataclasses import asdict, dataclass

import numpy as np
import pandas as pd

from pyrofit.config import Study, candidate_effects
from pyrofit.config.resolve import obstacle
from pyrofit.cost.distances import root_mean_square
from pyrofit.diagnose.advise.free_corrections import Probe
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import Base, model_of
from pyrofit.diagnose.base.prediction import HELD_OUT, prediction_of
from pyrofit.diagnose.judge.claim_tests import Trust
from pyrofit.diagnose.judge.final_fits import FinalFits
from pyrofit.diagnose.judge.findings import Finding, Verdict
from pyrofit.diagnose.judge.intervals import interval_over_models, values_of
from pyrofit.diagnose.judge.kinetics_alone import kinetics_alone
from pyrofit.diagnose.judge.weights import group_weights
from pyrofit.diagnose.result.candidates import candidate_records, confusability_of, screened
from pyrofit.diagnose.result.phases import describe_windows
from pyrofit.diagnose.result.verdict_text import form_words, sentences
from pyrofit.diagnose.search.stepwise import Search
from pyrofit.diagnose.settings import Settings
from pyrofit.effects import known_effects
from pyrofit.errors import DataError
from pyrofit.estimate.posterior import limit_of
from pyrofit.numerics import functions, linear
from pyrofit.results.diagnosis_schema import (
    Diagnosis,
    OfBase,
    OfEvidence,
    OfExperiment,
    OfExtended,
    OfGap,
    OfNoise,
    OfNotTried,
    OfOtherTerm,
    OfParameter,
    OfProbe,
    OfProfile,
    OfSolver,
    OfTakenAway,
    OfVerdict,
    OfWindow,
)
from pyrofit.solver.arrays import FloatArray

SCHEMA = 1
CALIBRATION = "calibration"


@dataclass(frozen=True, eq=False)
class Misfit:
    """How a model meets a channel: its curve, and its misfit in the signal's unit and the noise."""

    curve: FloatArray
    chi2: float
    rms: float


Misfits = list[tuple[Misfit, Misfit]]
"""Misfit of every channel with the base and with the final model."""


def content(
    study: Study,
    found: Search,
    verdict: Verdict,
    final: FinalFits,
    solver: OfSolver,
    processes: int = 1,
) -> Diagnosis:
    """Return the record of a diagnosis, without advice."""
    misfits = _before_and_after(found, final)
    return Diagnosis(
        schema=SCHEMA,
        settings=_settings(found.base.settings),
        study=study.name,
        verdict=_verdict(verdict),
        noise=_noise(found, misfits),
        base=_base(study, found, final),
        windows=_windows(found),
        screen=screened(found),
        confusability=confusability_of(found),
        needed=found.spare + float(functions.log(found.base.model.points)),
        ambiguity=found.base.settings.ambiguous_chi2,
        not_tried=_not_tried(study),
        candidates=candidate_records(found, verdict, final, processes),
        extended=OfExtended(parameters=_extended(study, found, final)),
        gap=_gap(found, verdict, misfits),
        solver=solver,
        kinetics_alone=kinetics_alone(final.of(found.end)),
        profiles=[],
        probes=[],
        next_experiment=[],
        extended_study="",
    )


def advised(
    found: Diagnosis,
    profiles: list[OfProfile],
    probes: Iterable[Probe],
    designs: list[OfExperiment],
) -> Diagnosis:
    """Return the record of a diagnosis with advice."""
    # The coefficients of a probe stay out: its shape shows them.
    shown = [
        OfProbe(
            probe=p.probe,
            what=p.what,
            unit=p.unit,
            chi2=p.chi2,
            absorbed=p.absorbed,
            shape=[list(pair) for pair in p.shape],
        )
        for p in probes
    ]
    parts = {"profiles": profiles, "probes": shown, "next_experiment": designs}
    return found.model_copy(update=parts)


def _settings(settings: Settings) -> dict[str, int | float | list[float]]:
    return {
        name: list(value) if isinstance(value, tuple) else value
        for name, value in asdict(settings).items()
    }


def _verdict(verdict: Verdict) -> OfVerdict:
    catalogue = known_effects()
    leading = [finding.leading for finding in verdict.findings]
    return OfVerdict(
        kind=verdict.kind,
        effects=leading,
        groups=[catalogue[name].group for name in leading],
        forms=[form_words(finding) for finding in verdict.findings],
        sets=[finding.effects for finding in verdict.findings],
        evidence=[_evidence(finding) for finding in verdict.findings],
        other_terms=[
            [OfOtherTerm(words=o.words, above=o.above) for o in finding.others]
            for finding in verdict.findings
        ],
        confirmed=verdict.confirmed,
        words=sentences(verdict),
        reasons=list(verdict.reasons),
        suspects=list(verdict.suspects),
        weights=group_weights(verdict.search),
        taken_away=[OfTakenAway(effect=e, reason=reason) for e, reason in verdict.taken_away],
    )


def _trust(finding: Finding) -> Trust:
    """Return the evidence for or against the leading effect."""
    return (finding.kept or list(finding.judged))[0].trust


def _evidence(finding: Finding) -> OfEvidence:
    """Return the tests of the leading effect besides its gain."""
    trust = _trust(finding)
    return OfEvidence(
        agreement=trust.disagree,
        predictions=trust.gains,
        expected={n: g if np.isfinite(g) else None for n, g in trust.powers.items()},
        known={name: list(both) for name, both in trust.known.items()},
        implausible=trust.implausible,
        weight=finding.weight,
    )


def _noise(found: Search, misfits: Misfits) -> list[OfNoise]:
    base = found.base.model.base
    return [
        OfNoise(
            experiment=name,
            signal=signal,
            role=_role(found, i),
            points=noise.sd.size,
            unit=_unit(base, i),
            sd_median=float(np.median(noise.total_sd)),
            words=noise.describe(),
            stated=noise.stated,
            white=noise.white,
            chi2_base=misfits[i][0].chi2,
        )
        for i, ((name, signal), noise) in enumerate(
            zip(base.channels, base.likelihood.noise, strict=True)
        )
    ]


def _role(found: Search, channel: int) -> str:
    return CALIBRATION if channel in found.base.model.base.calibrated else HELD_OUT


def _not_tried(study: Study) -> list[OfNotTried]:
    """Return the effects of the catalogue that are no candidates, and why."""
    candidates = candidate_effects(study)
    others = [name for name in known_effects() if name not in candidates]
    unlisted = "diagnosis.effects does not list it"
    return [OfNotTried(effect=name, reason=obstacle(study, name) or unlisted) for name in others]


def _base(study: Study, found: Search, final: FinalFits) -> OfBase:
    first = found.rounds[0].lack()
    trial = found.base
    return OfBase(
        chi2=trial.fit.chi2,
        points=trial.model.points,
        chi2_critical=first.chi2_critical,
        scan=first.scan,
        scan_critical=first.scan_critical,
        score=first.score,
        score_critical=first.score_critical,
        adequate=first.adequate,
        parameters=_parameters(study, final.of(trial)),
    )


def _parameters(study: Study, trial: FittedModel) -> dict[str, OfParameter]:
    """Return the base's parameters with 95 % intervals, each in the unit that the study gives."""
    values, sd = values_of(trial)
    size = len(trial.model.names) - trial.numbers
    found = {}
    for i, name in enumerate(trial.model.names[:size]):
        given = study.parameters[name]
        x = trial.fit.x[i]
        within = interval_over_models(trial, i, values, sd, given.factor)
        found[name] = OfParameter(**within, unit=given.unit, at_limit=bool(limit_of(x)))
    return found


def _extended(study: Study, found: Search, final: FinalFits) -> dict[str, OfParameter]:
    """Return the base's parameters beside the effects that the search ended with, if any."""
    return _parameters(study, final.of(found.end)) if found.end.effects else {}


def _windows(found: Search) -> list[OfWindow]:
    models = {"base": (found.base, found.rounds[0].lack())}
    if found.end is not found.base:
        models["extended"] = (found.end, found.end_lack)
    return [
        window
        for name, (trial, lack) in models.items()
        for window in describe_windows(name, trial, lack.windows, lack.scan_critical)
    ]


def _misfits(trial: FittedModel) -> list[Misfit]:
    """Return misfit, in the signal's unit and in the noise, of every channel."""
    base = trial.model.base
    model = model_of(base, trial.model.effects, range(len(base.channels)))
    curves = model.likelihood.curves(trial.fit.x)
    if curves is None:
        raise DataError(
            "diagnosis: a held-out run does not finish with the fitted parameters; with "
            "diagnosis.hold_out, leave out those furthest from the fitted experiments"
        )
    white = model.by_channel(model.residuals(trial.fit.x))
    targets = [term.target for _, term in model.likelihood.problem.cost.terms]
    parts = model.likelihood.split(curves)
    return [
        Misfit(c, linear.dot(w, w), root_mean_square(c - t.value))
        for c, t, w in zip(parts, targets, white, strict=True)
    ]


def _before_and_after(found: Search, final: FinalFits) -> Misfits:
    """Return the misfit of every channel with the base and with the final model."""
    ends = (_misfits(final.of(trial)) for trial in (found.base, found.end))
    return list(zip(*ends, strict=True))


def _unit(base: Base, channel: int) -> str:
    name, signal = base.channels[channel]
    return base.likelihood.problem.runs[name].experiment.quantity(signal).unit_text


def _gap(found: Search, verdict: Verdict, misfits: Misfits) -> list[OfGap]:
    base = found.base.model.base
    powers = [_trust(finding).powers for finding in verdict.findings]

    def tells(channel: int) -> bool | None:
        if channel in base.calibrated or not powers:
            return None
        name = prediction_of(found.base, channel)
        return any(of.get(name, 0.0) >= base.settings.informative_gain for of in powers)

    rows = []
    for i, (before, after) in enumerate(misfits):
        noise = base.likelihood.noise[i]
        name, signal = base.channels[i]
        row = OfGap(
            experiment=name,
            signal=signal,
            role=_role(found, i),
            tells=tells(i),
            points=noise.sd.size,
            unit=_unit(base, i),
            noise_sd=float(np.median(noise.total_sd)),
            rms_before=before.rms,
            rms_after=after.rms,
            chi2_before=before.chi2,
            chi2_after=after.chi2,
        )
        rows.append(row)
    return rows


def curve_records(found: Search, final: FinalFits) -> pd.DataFrame:
    """Return measured and simulated curves of all channels before and after, SI units."""
    base = found.base.model.base
    problem = base.likelihood.problem
    parts = []
    misfits = _before_and_after(found, final)
    for i, (name, signal, index) in enumerate(problem.picks):
        before, after = misfits[i]
        target = problem.cost.terms[i][1].target
        T = problem.runs[name].requests[signal].temperature_K
        columns = {
            "experiment": name,
            "signal": signal,
            "role": _role(found, i),
            "time_s": target.time_s,
            "temperature_K": np.nan if T is None else T[index],
            "measured": target.value,
            "sd": base.likelihood.noise[i].total_sd,
            "before": before.curve,
            "after": after.curve,
        }
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)
