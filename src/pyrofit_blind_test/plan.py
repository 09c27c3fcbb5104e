"""The cases of a plan: hidden effects, signals, noise and seed of each twin."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from pydantic import Field

from pyrofit.config import Study, digest, read_study
from pyrofit.effects import known_effects
from pyrofit.effects.base import Effect
from pyrofit.errors import StudyError, suggest
from pyrofit.experiments import kind_of
from pyrofit.model.base import Part
from pyrofit.model.experiment import Experiment
from pyrofit.seeds import seed_for
from pyrofit_blind_test import foreign
from pyrofit_blind_test.setting import DescriptionError, Draft, Hidden, Kind, Plan, Setting


class TwinPlan(Part):
    """One twin.

    Seeds and names of twins are digests of these fields: a renamed field would draw other twins.
    """

    kind: Kind = Field(description="kind of its hidden effects")
    hidden: Hidden = Field(description="hidden effects")
    without: tuple[str, ...] = Field((), description="effects removed from the candidates")
    strength: float = Field(description="fraction of the nominal strength")
    signals: str = Field(description="set of signals")
    noise: str = Field(description="kind of noise")
    seed: int = Field(description="seed of truth and noise")
    left_out: bool = Field(False, description="diagnosed again without the hidden effect")
    curves: str = Field("", description="case of another code whose curves it has")
    error: str = Field("", description="error of its description")
    same: tuple[str, ...] = Field((), description="effects that describe this error")

    @property
    def id(self) -> str:
        """Name of the twin, which does not reveal its hidden effects."""
        # Twins keep the names they had before there were curves of other codes and errors.
        later = {"curves": self.curves, "error": self.error, "same": self.same}
        empty = {name for name, value in later.items() if not value}
        identity = self.model_dump(mode="json", exclude=empty)
        return f"twin_{digest(identity)[:10]}"


def cases_of(setting: Setting, name: str) -> tuple[TwinPlan, ...]:
    """Return the cases of a plan, sorted by their names, so that each job has cases of all kinds.

    A seed depends on the case alone: a larger plan keeps the cases it had.

    Raises
    ------
    StudyError
        There is no such plan, the base study breaks a rule, or a truth may leave its limits.
    """
    plan = setting.plan(name)
    base = read_study(Path(setting.base))
    if setting.curves:
        drafts = list(foreign.drafts(setting, plan))
    else:
        _check_ranges(setting, base)
        makers = (_effects, _nulls, _forms, _pairs, _errors)
        drafts = [draft for make in makers for draft in make(setting, plan, base)]
    cases = sorted((_seeded(setting, plan, draft) for draft in drafts), key=lambda c: c.id)
    taken: list[TwinPlan] = []
    for case in cases:
        so_far = sum(other.kind == case.kind for other in taken)
        if so_far < plan.most.get(case.kind, len(cases)):
            taken.append(case)
    return tuple(taken)


def _check_ranges(setting: Setting, base: Study) -> None:
    """Refuse ranges of the truth that exceed a parameter's limits."""
    if base.synthetic is None:
        raise StudyError(f"{setting.base}: has no `synthetic`, so no truth to vary; add it")
    for name, by in setting.vary.items():
        if name not in base.synthetic.truth:
            known = suggest(name, base.synthetic.truth)
            raise StudyError(f"vary: unknown parameter '{name}'. {known}")
        at, parameter = base.synthetic.truth[name], base.parameters[name]
        lower, upper = parameter.lower, parameter.upper
        if lower is not None and upper is not None and not lower <= at - by < at + by <= upper:
            raise StudyError(
                f"vary.{name}: {at:g} -+ {by:g} passes the limits {lower:g} to {upper:g}; lower it"
            )


def chunk_of(cases: tuple[TwinPlan, ...], chunk: int, chunks: int) -> tuple[TwinPlan, ...]:
    """Return the cases of one job.

    Every case belongs to exactly one of the ``chunks`` jobs, numbered from 0.
    """
    return cases[chunk::chunks]


def strength_at(setting: Setting, effect: str, part: float = 1.0) -> dict[str, float]:
    """Return the strength null + part (nominal - null) of an effect, by name, in SI units."""
    (name, quantity), *_ = known_effects()[effect].strength.items()
    nominal = setting.nominal.get(effect, quantity.typical)
    return {name: quantity.value + part * (nominal - quantity.value)}


def measured_by(setting: Setting, base: Study, signals: str) -> dict[str, Experiment]:
    """Return the fitted experiments of the base that measure one of a set of signals."""
    wanted = setting.signals[signals]
    return {
        name: experiment
        for name, experiment in base.experiments.items()
        if any(quantity in wanted for quantity in experiment.signals)
        and (kind_of(experiment).stage == "kinetics" or name in setting.calibrate)
    }


def _visible(
    setting: Setting, base: Study, effects: Mapping[str, Effect], signals: str, names: Hidden
) -> bool:
    """Tell whether some calibrated experiment can have each of the effects."""
    experiments = measured_by(setting, base, signals).values()
    return all(any(effects[name].needs(e) for e in experiments) for name in names)


def _effects(setting: Setting, plan: Plan, base: Study) -> Iterator[Draft]:
    effects, noises = known_effects(), list(setting.noise)
    count = 0
    for i, name in enumerate(effects):
        for j, part in enumerate(plan.strengths):
            hidden = {name: strength_at(setting, name, part)}
            for k, signals in enumerate(setting.signals):
                if not _visible(setting, base, effects, signals, hidden):
                    continue
                for repeat in range(plan.effects):
                    # Twins that differ in one of the four loops differ in noise as well.
                    noise = noises[(i + j + k + repeat) % len(noises)]
                    full = part == 1.0
                    left_out = full and plan.left_out > 0 and count % plan.left_out == 0
                    count += full
                    yield {
                        "kind": "effect",
                        "hidden": hidden,
                        "strength": part,
                        "signals": signals,
                        "noise": noise,
                        "left_out": left_out,
                        "seed": repeat,
                    }


def _nulls(setting: Setting, plan: Plan, base: Study) -> Iterator[Draft]:
    for noise in setting.noise:
        for signals in setting.signals:
            for repeat in range(plan.nulls):
                yield {
                    "kind": "null",
                    "hidden": {},
                    "strength": 0.0,
                    "signals": signals,
                    "noise": noise,
                    "seed": repeat,
                }


def _forms(setting: Setting, plan: Plan, base: Study) -> Iterator[Draft]:
    for i, form in enumerate(setting.forms):
        hidden = {n: strength_at(setting, n) | given for n, given in form.hidden.items()}
        more = {"kind": "form", "hidden": hidden, "without": form.without}
        yield from _seen(setting, base, more, list(setting.signals), plan.forms, i)


def _pairs(setting: Setting, plan: Plan, base: Study) -> Iterator[Draft]:
    for i, pair in enumerate(setting.pairs):
        more = {"kind": "pair", "hidden": {name: strength_at(setting, name) for name in pair}}
        for draft in _seen(setting, base, more, list(setting.pair_signals), plan.pairs, i):
            yield {**draft, "left_out": plan.left_out == 1}


def _errors(setting: Setting, plan: Plan, base: Study) -> Iterator[Draft]:
    for i, (name, error) in enumerate(setting.errors.items()):
        sets = [s for s in setting.error_signals if _shows(setting, base, error, s)]
        more = {"kind": "error", "hidden": {}, "error": name, "same": error.same}
        yield from _seen(setting, base, more, sets, plan.errors, i)


def _shows(setting: Setting, base: Study, error: DescriptionError, signals: str) -> bool:
    """Tell whether the experiments of a set of signals are of all kinds that an error changes."""
    kinds = {experiment.kind for experiment in measured_by(setting, base, signals).values()}
    return set(error.truth) <= kinds


def _seen(
    setting: Setting, base: Study, more: Draft, sets: list[str], repeats: int, first: int
) -> Iterator[Draft]:
    """Yield drafts for every set of signals that shows their effects, with noise kinds in turn."""
    noises = list(setting.noise)
    for k, signals in enumerate(sets):
        if not _visible(setting, base, known_effects(), signals, more["hidden"]):
            continue
        for repeat in range(repeats):
            noise = noises[(first + k + repeat) % len(noises)]
            yield {**more, "strength": 1.0, "signals": signals, "noise": noise, "seed": repeat}


def _seeded(setting: Setting, plan: Plan, draft: Draft) -> TwinPlan:
    """Return the case of a draft; the seed of a draft is the number of its repetition."""
    start, end = setting.seeds[plan.seeds]
    identity = {key: value for key, value in draft.items() if key != "left_out"}
    return TwinPlan(
        **{**draft, "seed": start + seed_for(start, digest(identity)) % (end - start + 1)}
    )
