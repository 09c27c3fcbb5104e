"""Predictions of other laboratories by models fitted to one: the table of docs/measured_pmma.md.

    python benchmarks/laboratories.py [config/pmma.yaml]

A model is fitted to the calibrated signals of the study's diagnosis and predicts those held out,
three times. First, the uncertain values of the other laboratories are as described. Second, they
are fitted to these laboratories' data, within the prior knowledge. Third, the material's
parameters are fitted to them as well.
"""

import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from pyrofit.config import (
    Study,
    as_study,
    calibration_channels,
    candidate_effects,
    diagnosed_material,
    diagnosed_parameters,
    held_out_channels,
    read_mapping,
)
from pyrofit.config.resolve import calibrated
from pyrofit.config.uses import parameters_in
from pyrofit.diagnose.base.descent import descend_chi_square
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import Base, Free, Model, extended, model_of
from pyrofit.diagnose.search.kinetics_first import kinetics_first
from pyrofit.estimate.likelihood import likelihood_of
from pyrofit.estimate.prior import NormalPrior, prior_of, within_known
from pyrofit.estimate.problem import make_problem
from pyrofit.estimate.targets import Measurements
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.reading import read_all

FOUND: Free = {
    "bubbling": ("volume", "temperature_K", "thinning"),
    "reaction_order": ("order",),
}
"""The effects that the diagnosis of `pmma` found."""
MODELS: dict[str, Free] = {
    "base": {},
    "effects found": FOUND,
    "swelling and order": {
        "swelling": ("step", "temperature_K"),
        "reaction_order": ("order",),
    },
}
STARTS = {"swelling": 1.0, "bubbling": 0.7, "reaction_order": 1.7}
SPREAD = 5
"""Starts beside the centre of the limits."""
DEGREES = ("as described", "uncertain fitted", "material fitted")
"""How far a held-out laboratory is fitted."""
KINETICS = ("T_A", "E_A", "T_B", "E_B", "w_A")
SHOWN = {"mlr": (1e3, "g/(m2 s)"), "mass": (1.0, "kg/m2"), "mass_fraction": (1.0, "-")}


def base_of(study: Study, measurements: Measurements, held_out: bool) -> Base:
    """Return the base against the calibrated signals, or against those held out as well."""
    channels = calibration_channels(study)
    count = len(channels)
    used = parameters_in(diagnosed_material(study), *calibrated(study).values())
    names = [n for n in diagnosed_parameters(study) if held_out or n in used]
    slabs = (c for c in held_out_channels(study) if study.serves(c.experiment, "imp"))
    channels += tuple(slabs) if held_out else ()
    material = diagnosed_material(study)
    problem = make_problem(study, names, channels, measurements, material, study.fixed_values())
    problem = within_known(study, problem)
    base = Base(
        likelihood_of(problem, prior_of(study, problem), tolerant=True), tuple(range(count))
    )
    return kinetics_first(base, KINETICS, candidate_effects(study), study.seed)


def centre(base: Base) -> FloatArray:
    """Return the middle of the limits, known parameters at their means."""
    likelihood = base.likelihood
    x = np.full(len(likelihood.problem.names), 0.5)
    known, span = likelihood.prior, likelihood.problem.upper - likelihood.problem.lower
    index = list(known.index)
    x[index] = (known.mean - likelihood.problem.lower[index]) / span[index]
    return x


def starts(base: Base, seed: int) -> list[FloatArray]:
    """Return the centre and points about it; parameters with known values stay."""
    return spread_about(centre(base), base.likelihood.prior, seed)


def spread_about(x: FloatArray, known: NormalPrior, seed: int) -> list[FloatArray]:
    """Return x and points spread over the limits; parameters with known values stay."""
    moved = [i for i in range(x.size) if i not in known.index]
    found = [x]
    for _ in range(SPREAD if moved else 0):
        other = x.copy()
        other[moved] = 0.1 + 0.8 * np.random.default_rng([seed, len(found)]).random(len(moved))
        found.append(other)
    return found


def with_starts(effects: Free, x: FloatArray) -> FloatArray:
    """Return x with the effects' strengths where they are often met."""
    for effect, free in effects.items():
        x = extended(x, effect, STARTS[effect], free[1:])
    return x


def best(model: Model, begins: Sequence[FloatArray]) -> FittedModel:
    """Return the lowest end of descents, twice descended."""
    ends = [descend_chi_square(model, x) for x in begins]
    lowest = min(ends, key=lambda end: end.chi2)
    return FittedModel(model, descend_chi_square(model, lowest.x))


def fitted(
    base: Base, effects: Free, seed: int, channels: Sequence[int] | None = None
) -> FittedModel:
    """Return the best fit of the base with effects to channels, by default the calibrated ones."""
    begins = [with_starts(effects, x) for x in starts(base, seed)]
    return best(model_of(base, effects, channels), begins)


def values_of(trial: FittedModel) -> dict[str, float]:
    """Return the fitted values by name, SI units."""
    names = trial.model.names
    return dict(zip(names, trial.model.likelihood.values(trial.fit.x).tolist(), strict=True))


def of_laboratory(whole: Base, trial: FittedModel, names: Sequence[str], free: set[str]) -> Model:
    """Return a model of some held-out experiments, with some parameters free.

    Others keep the values of a fit to the calibrated signals; uncertain values of the
    experiments that were not fitted are as described.
    """
    channels = [i for i in whole.held_out if whole.channels[i][0] in names]
    model = model_of(whole, trial.model.effects, channels)
    likelihood = model.likelihood
    problem, known = likelihood.problem, likelihood.prior
    of_known = [problem.names[i] for i in known.index]
    described = dict(zip(of_known, known.mean.tolist(), strict=True))
    fixed = {**problem.fixed, **described, **values_of(trial)}
    kept = [i for i, name in enumerate(problem.names) if name in free]
    at = [k for k, i in enumerate(known.index) if i in kept]
    prior = NormalPrior(tuple(kept.index(known.index[k]) for k in at), known.mean[at], known.sd[at])
    smaller = replace(
        problem,
        names=tuple(problem.names[i] for i in kept),
        lower=problem.lower[kept],
        upper=problem.upper[kept],
        fixed={n: v for n, v in fixed.items() if n not in free},
    )
    return replace(model, likelihood=replace(likelihood, problem=smaller, prior=prior))


def at_fit(model: Model, trial: FittedModel) -> FloatArray:
    """Return where a model of a laboratory starts: at the fit, and as described."""
    likelihood, fit = model.likelihood, values_of(trial)
    problem, known = likelihood.problem, likelihood.prior
    mean = dict(zip((problem.names[i] for i in known.index), known.mean.tolist(), strict=True))
    values = [fit.get(name, mean.get(name, 0.0)) for name in problem.names]
    return likelihood.scaled(np.array(values))


def rms(model: Model, x: FloatArray) -> dict[tuple[str, str], float]:
    """Return the root mean square of simulated less measured by channel, SI units."""
    likelihood = model.likelihood
    curves = likelihood.curves(x)
    assert curves is not None
    found = {}
    terms = (term for _, term in likelihood.problem.cost.terms)
    picks = likelihood.problem.picks
    for (name, signal, _), term, curve in zip(picks, terms, likelihood.split(curves), strict=True):
        found[name, signal] = float(np.sqrt(np.mean((curve - term.target.value) ** 2)))
    return found


def predictions(
    whole: Base, trial: FittedModel, seed: int
) -> dict[str, dict[tuple[str, str], float]]:
    """Return the rms of held-out signals, laboratory by laboratory, and three times."""
    runs = whole.likelihood.problem.runs
    names = dict.fromkeys(whole.channels[i][0] for i in whole.held_out)
    places: dict[str, list[str]] = {}
    for name in names:
        places.setdefault(runs[name].experiment.laboratory, []).append(name)
    shared = {n for n in material_names(trial) if n not in KINETICS}
    found: dict[str, dict[tuple[str, str], float]] = {d: {} for d in DEGREES}
    for own in places.values():
        uncertain = {p for n in own for p in runs[n].experiment.repeat.nuisances.values()}
        for degree, free in zip(DEGREES, (set(), uncertain, uncertain | shared), strict=True):
            model = of_laboratory(whole, trial, own, free)
            x = at_fit(model, trial)
            begins = spread_about(x, model.likelihood.prior, seed)
            found[degree] |= rms(model, best(model, begins).fit.x if free else x)
    return found


def material_names(trial: FittedModel) -> set[str]:
    """Return the parameters that all laboratories share."""
    problem = trial.model.likelihood.problem
    return set(problem.names) & parameters_in(problem.material)


def noise(whole: Base) -> dict[tuple[str, str], float]:
    """Return the scatter of points and between repeats of held-out signals, SI units."""
    found = {}
    for i in whole.held_out:
        size = whole.likelihood.noise[i].total_sd
        found[whole.channels[i]] = float(np.sqrt(np.mean(size**2)))
    return found


def shown(signal: str, value: float) -> str:
    """Return a value in the unit that is shown."""
    factor, _ = SHOWN.get(signal, (1.0, "K"))
    return f"{factor * value:.3g}"


def table(rows: Mapping[tuple[str, str], Sequence[float]], heads: Sequence[str]) -> str:
    """Return rows as a table of Markdown."""
    lines = ["| signal | unit | " + " | ".join(heads) + " |", "|---" * (len(heads) + 2) + "|"]
    for (name, signal), values in rows.items():
        unit = SHOWN.get(signal, (1.0, "K"))[1]
        cells = " | ".join(shown(signal, v) for v in values)
        lines.append(f"| {name} {signal} | {unit} | {cells} |")
    return "\n".join(lines)


def report(study: Study) -> str:
    """Return the tables of all models."""
    measurements = {key: frame for key, (frame, _) in read_all(study).items()}
    base, whole = (base_of(study, measurements, both) for both in (False, True))
    trials: dict[str, FittedModel] = {}
    for words, effects in MODELS.items():
        trials[words] = fitted(base, effects, study.seed)
        print(words, round(trials[words].fit.chi2), values_of(trials[words]), file=sys.stderr)
    calibration = {words: rms(t.model, t.fit.x) for words, t in trials.items()}
    heads = list(MODELS)
    parts = ["## Calibrated", table(_joined(calibration), heads), chi2_table(trials)]
    found = {words: predictions(whole, trial, study.seed) for words, trial in trials.items()}
    floor = noise(whole)
    for degree in DEGREES:
        rows = _joined({words: of[degree] for words, of in found.items()})
        rows = {key: [*values, floor[key]] for key, values in rows.items()}
        parts += [f"## Held out, {degree}", table(rows, [*heads, "noise"])]
    return "\n\n".join(parts)


def chi2_table(trials: Mapping[str, FittedModel]) -> str:
    """Return chi-square of each model, and parameters, as a table."""
    return table_of(
        {
            words: {"chi-square": f"{trial.fit.chi2:.0f}"}
            | {name: f"{value:.4g}" for name, value in values_of(trial).items()}
            for words, trial in trials.items()
        }
    )


def table_of(columns: Mapping[str, Mapping[str, str]]) -> str:
    """Return columns of named cells as a table of Markdown."""
    lines = ["| | " + " | ".join(columns) + " |", "|---" * (len(columns) + 1) + "|"]
    names = dict.fromkeys(n for cells in columns.values() for n in cells)
    rows = ([name, *(cells.get(name, "") for cells in columns.values())] for name in names)
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines)


def _joined(
    by_words: Mapping[str, Mapping[tuple[str, str], float]],
) -> dict[tuple[str, str], list[float]]:
    keys = next(iter(by_words.values()))
    return {key: [of[key] for of in by_words.values()] for key in keys}


if __name__ == "__main__":
    named = (sys.argv[1:] or ["config/pmma.yaml"])[0]
    print(report(as_study(read_mapping(Path(named)), named)))
