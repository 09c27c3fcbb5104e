"""Baselines of the benchmark: nothing, a sparse regression, forward selection by AIC and BIC.

The baselines that fit share pyrofit's solver, its fit of the base model, and its estimate of the
noise. They differ from the diagnosis in how they choose effects.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import inf
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.config import read_study
from pyrofit.constants import QUANTILE
from pyrofit.diagnose.base.fit import Setup, set_up
from pyrofit.diagnose.base.fitted import FittedModel, followed, up_to_date
from pyrofit.diagnose.base.model import strength_of
from pyrofit.diagnose.search.refit import from_best_start, from_elsewhere, look_at, starts
from pyrofit.diagnose.search.score_test import Screening
from pyrofit.effects import same_as
from pyrofit.errors import DataError
from pyrofit.estimate.posterior import interval
from pyrofit.logs import Tell
from pyrofit.numerics import functions, linear
from pyrofit.results.files import read_csv, write_csv
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.reading import read_all
from pyrofit_blind_test.benchmark.score import ANSWER
from pyrofit_blind_test.benchmark.write import Row, answer_of, data_sets

NAMES = ("none", "sparse", "aic", "bic")
NONE: list[Row] = [{"effect": "", "sure": 0}]
"""The answer that no effect is missing."""
RIDGE = 0.05
"""Ridge of the sparse regression, the default of PySINDy."""
RAISE = 1.1
"""Factor by which the limit of the sparse regression rises until few enough effects are left."""
MOST_EFFECTS = 2
"""Effects of an answer at most; no set has more."""
MOST_FOLLOWED = 3
"""Effects that each of its steps fits to the end, the leading ones of a rough fit of all."""
CLEAR = 10.0
"""Advantage in AIC or BIC that leaves a rival no support (Kass and Raftery 1995, doi
10.1080/01621459.1995.10476572)."""


def answer_all(
    folder: Path,
    names: Sequence[str] = NAMES,
    first: int | None = None,
    tell: Tell = lambda text: None,
) -> None:
    """Write the answers of baselines; sets that all have answered are not answered again.

    Parameters
    ----------
    folder
        Folder of the benchmark.
    names
        Baselines, of `NAMES`.
    first
        Only answer the first sets by name. Names are digests, so these are drawn at random.
    tell
        Is told the progress.

    Raises
    ------
    DataError
        There are no sets, or a file is broken.
    """
    sets = sorted(data_sets(folder).glob("*/study.yaml"))[:first]
    if not sets:
        raise DataError(
            f"{data_sets(folder)}: there are no sets; run pyrofit benchmark write first"
        )
    answers = {name: _so_far(answer_of(folder, name)) for name in names}
    done = set.intersection(*({row["set"] for row in rows} for rows in answers.values()))
    for path in sets:
        of = path.parent.name
        if of in done:
            continue
        tell(of)
        for name, rows in _of_set(path, names):
            kept = [row for row in answers[name] if row["set"] != of]
            answers[name] = [*kept, *({"set": of, **row} for row in rows)]
            write_csv(answer_of(folder, name), pd.DataFrame(answers[name], columns=list(ANSWER)))


def _so_far(path: Path) -> list[Row]:
    if not path.is_file():
        return []
    table = read_csv(path, {"set": object, "effect": object, "sure": int})
    return [{str(key): value for key, value in row.items()} for row in table.to_dict("records")]


def _of_set(path: Path, names: Sequence[str]) -> Iterator[tuple[str, list[Row]]]:
    """Yield name and answer of each baseline to a set."""
    if "none" in names:
        yield "none", NONE
    if set(names) <= {"none"}:
        return
    study = read_study(path)
    measurements = {key: frame for key, (frame, _) in read_all(study).items()}
    rough = study.model_copy(update={"accuracy": study.accuracy.coarsened()})
    setup = set_up(rough, measurements)
    if "sparse" in names:
        yield "sparse", sparse(setup.base, look_at(setup.base, setup.candidates))
    prices = {"aic": 2.0, "bic": float(functions.log(setup.base.model.points))}
    wanted = [name for name in prices if name in names]
    path_taken = list(forward(setup)) if wanted else []
    for name in wanted:
        yield name, paying(path_taken, prices[name])


def sparse(base: FittedModel, looks: Sequence[Screening]) -> list[Row]:
    """Regress the residuals of the base on the change by each effect at a small strength.

    The part that the base parameters can make up for is taken from both, see `Screening`. An
    effect needs sqrt(log(n) + 2 log(M)) standard deviations, as one of M (Chen and Chen 2008, doi
    10.1093/biomet/asn034), and more if more than two effects have that. One whose strength leaves
    its limits is left out. No claim is sure.
    """
    seen = [look for look in looks if look.sizes[0] > 1e-9]
    if not seen:
        return NONE
    columns = np.column_stack([look.changes[:, 0] / look.sizes[0] for look in seen])
    price = functions.log(base.model.points) + 2.0 * functions.log(len(seen))
    least = float(np.sqrt(price))
    found = thresholded(columns, -base.fit.residuals, least)
    while len(found) > MOST_EFFECTS:
        least *= RAISE
        found = thresholded(columns, -base.fit.residuals, least)
    rows = []
    for k, (at, sd) in found.items():
        name, quantity = seen[k].effect, strength_of(seen[k].effect)[1]
        step = (seen[k].strengths[0] - quantity.value) / seen[k].sizes[0]
        value, half = quantity.value + at * step, QUANTILE * sd * abs(step)
        if quantity.lower <= value <= quantity.upper:
            ends = {"low": value - half, "high": value + half}
            rows.append({"effect": name, "strength": value, **ends, "sure": 0})
    return rows or NONE


def thresholded(
    columns: FloatArray, target: FloatArray, least: float
) -> dict[int, tuple[float, float]]:
    """Return the sequentially thresholded least squares of a target, by column.

    Coefficients below a limit are set to zero, and the others are fitted again, until none is below
    it (Brunton et al. 2016, doi 10.1073/pnas.1517384113). This is the regression of PySINDy.

    Parameters
    ----------
    columns
        Columns of norm 1, shape (n, m).
    target
        Target of unit noise, shape (n,).
    least
        Least size of a coefficient.

    Returns
    -------
    dict
        Coefficient and its standard deviation, by position of the column.
    """
    kept = np.arange(columns.shape[1])
    while True:
        A = columns[:, kept]
        inverse = linear.inverse(linear.gram(A) + RIDGE * np.eye(kept.size))
        x = linear.product(inverse, A.T, target)
        large = np.abs(x) >= least
        if large.all():
            sd = np.sqrt(np.diag(inverse))
            return {int(k): (float(a), float(s)) for k, a, s in zip(kept, x, sd, strict=True)}
        kept = kept[large]


def forward(setup: Setup) -> Iterator[tuple[FittedModel, float]]:
    """Yield the base, then models with one effect more: each the one of the lowest chi-square.

    Beside each stands the rise of chi-square of the best rival of its last effect. A step that
    lowers chi-square by less than 2 is the last one.
    """
    model, left = setup.base, list(setup.candidates)
    yield model, inf
    for _ in range(MOST_EFFECTS):
        trials = [_roughly(model, look) for look in look_at(model, left)]
        trials.sort(key=lambda trial: trial.fit.chi2)
        trials[:MOST_FOLLOWED] = map(followed, trials[:MOST_FOLLOWED])
        trials.sort(key=lambda trial: trial.fit.chi2)
        if not trials or model.fit.chi2 - trials[0].fit.chi2 < 2.0:
            return
        model, added = up_to_date(trials[0]), trials[0].effects[-1]
        others = [t.fit.chi2 for t in trials if t.effects[-1] not in same_as(added)]
        yield model, min(others, default=inf) - model.fit.chi2
        left = [effect for effect in left if effect not in same_as(added)]


def _roughly(model: FittedModel, look: Screening) -> FittedModel:
    """Fit an effect in addition, roughly, from several strengths."""
    rough = model.settings.rough_gain
    best = from_best_start(model, look, rough)
    return from_elsewhere(model, look, best, starts(look)[1:], rough)


def paying(taken: Sequence[tuple[FittedModel, float]], price: float) -> list[Row]:
    """Return the answer of forward selection that pays a price for each effect.

    An effect is sure if it lowers the criterion by `CLEAR` more than no effect and than its rival.
    """
    sure = []
    for (before, _), (after, ahead) in pairwise(taken):
        gain = before.fit.chi2 - after.fit.chi2 - price
        if gain <= 0.0:
            break
        sure.append(int(min(gain, ahead) > CLEAR))
    model, _ = taken[len(sure)]
    return [
        strength_row(model, effect, s) for effect, s in zip(model.effects, sure, strict=True)
    ] or NONE


def strength_row(model: FittedModel, effect: str, sure: int) -> Row:
    """Return the row of an effect of a fitted model: its strength with the linear interval."""
    k, problem = model.model.position(effect), model.model.likelihood.problem
    x = float(model.fit.x[k])
    ends = interval(x, float(np.sqrt(model.posterior.covariance()[k, k])))
    value, low, high = (float(problem.lower[k] + at * problem.span[k]) for at in (x, *ends))
    return {"effect": effect, "strength": value, "low": low, "high": high, "sure": sure}
