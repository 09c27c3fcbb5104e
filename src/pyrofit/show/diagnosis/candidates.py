"""Candidates, the best first."""

from collections.abc import Mapping

import pandas as pd

from pyrofit.config import Study
from pyrofit.effects import known_effects
from pyrofit.results import diagnosis
from pyrofit.results.diagnosis_candidates import OfCandidate, OfStrength
from pyrofit.results.files import Results
from pyrofit.show.diagnosis.words import (
    MOST,
    effect_name,
    prediction_name,
    ranked,
    remark_on_candidate,
)
from pyrofit.show.table import Table


def candidates_table(study: Study, results: Results) -> pd.DataFrame:
    """List the models with effects that were fitted, the best ones, and why each was rejected."""
    found = diagnosis.read(study, results)
    order = ranked(found, MOST)
    lowest = order[0].penalised if order else 0.0
    rows = [
        {
            "model": " + ".join(map(effect_name, c.effects)),
            "chi2": c.chi2,
            "gain": c.gain,
            "above_best": c.penalised - lowest,
            "fitted": "; ".join(_fitted(c)),
            "predictions": _predictions(study, c.predictions),
            "remark": remark_on_candidate(found, c),
        }
        for c in order
    ]
    columns = ("chi2", "gain", "above_best", "fitted", "predictions", "remark")
    table = pd.DataFrame(rows, columns=["model", *columns])
    return table if table["predictions"].any() else table.drop(columns="predictions")


def _fitted(candidate: OfCandidate) -> list[str]:
    """Write symbol, value and interval of each parameter of a candidate, by effect."""
    catalogue, free = known_effects(), candidate.free
    said = []
    for effect, names in free.items():
        parts = []
        for name in names:
            p = candidate.parameters[f"{effect}_{name}"]
            low, high = _widest(p)
            text = f"{p.value:.3g} ({low:.3g} to {high:.3g}) {p.unit}".rstrip(" -")
            parts.append(f"{catalogue[effect].quantities[name].symbol} {text}")
        said.append(f"{effect}: " * (len(free) > 1) + ", ".join(parts))
    return said


def _widest(p: OfStrength) -> tuple[float, float]:
    """Return the interval, over other forms and models where that is wider."""
    low, high = p.low_wide, p.high_wide
    return (p.low if low is None else low, p.high if high is None else high)


def _predictions(study: Study, gains: Mapping[str, float]) -> str:
    return "; ".join(f"{prediction_name(study, name)} {gain:+.1f}" for name, gain in gains.items())


TABLE = Table(
    place=210,
    make=candidates_table,
    title="Candidates, the best first",
    note="Each is the base model with one effect more, or several, all parameters refitted. Of "
    "fits with the same effects, the best is listed. Fitted: parameters by the symbols of the "
    "effect's equation. Gain: fall of chi-square below the model with one effect less from which "
    "the search went on. Above best: penalised chi-square, log(points) "
    "for each parameter of an effect. Predictions: gain of the log score for experiments left out "
    "or held out. Above 0 the effect improves them, and 2 is needed.",
    headings={
        "chi2": "chi-square",
        "above_best": "above best",
        "fitted": "fitted (95 % interval)",
    },
)
