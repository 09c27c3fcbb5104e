"""The estimates of a study: value, 95 % interval, and whether the data determine it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import pandas as pd

from pyrofit.config import Study
from pyrofit.constants import QUANTILE
from pyrofit.results.goodness import APPARENT, AS_DESCRIBED, MISFIT, ONE_RATE
from pyrofit.results.identification import Identified

Grade = Literal[
    "determined",
    "determined as described",
    "weakly determined",
    "rests on one heating rate",
    "apparent value",
    "at a limit",
    "undetermined",
]
GRADES: tuple[Grade, ...] = (
    "determined",
    AS_DESCRIBED,
    "weakly determined",
    ONE_RATE,
    "apparent value",
    "at a limit",
    "undetermined",
)
"""How well the data determine a parameter, the best first."""

_CUT_OFF = {
    (True, True): "both",
    (True, False): "lower",
    (False, True): "upper",
    (False, False): None,
}


@dataclass(frozen=True)
class Estimated:
    """The estimate of one parameter, in its own unit.

    Parameters
    ----------
    stage
        'kinetics' or 'imp'.
    name, unit, value, low, high
        The parameter, its estimate, and the 95 % interval.
    width
        Width of the interval as a fraction of the search range.
    apparatus
        How far usual errors of the apparatus move the estimate, with 95 %.
    most
        The largest of these errors in words; empty where there is none.
    cut_off
        Which ends a limit cuts off: 'lower', 'upper', 'both', or none.
    noise_low, noise_high
        Ends of the interval if noise alone kept model and data apart, where they differ.
    method
        'linear', 'profile', or 'misfit' of a model that misses the tests.
    bound
        'lower' or 'upper' where the estimate is at a limit, else empty.
    verdict
        The analysis's verdict in words.
    partner, correlation
        Parameter of the strongest correlation, and its size; none where there is none.
    """

    stage: str
    name: str
    unit: str
    value: float
    low: float
    high: float
    width: float
    apparatus: float
    most: str
    cut_off: str | None
    noise_low: float | None
    noise_high: float | None
    method: str
    bound: str
    verdict: str
    partner: str
    correlation: float | None

    @property
    def rests_on_description(self) -> bool:
        """Whether usual errors of the apparatus move it farther than its interval, which has none.

        The interval of a model that misses the tests has them.
        """
        apart = self.method != MISFIT
        return apart and self.apparatus > max(self.high - self.value, self.value - self.low)

    @property
    def grade(self) -> Grade:
        """How well the data determine it; at a limit, only whether it is undetermined."""
        if self.verdict.startswith("undetermined"):
            return "undetermined"
        if self.bound:
            return "at a limit"
        if self.verdict == APPARENT:
            return APPARENT
        if self.verdict == AS_DESCRIBED:
            return AS_DESCRIBED
        if self.verdict == ONE_RATE:
            return ONE_RATE
        return "determined" if self.verdict == "determined" else "weakly determined"


def estimates_of(study: Study, identified: Identified) -> list[Estimated]:
    """Return the estimates of all stages, in the study's order."""
    return [
        _estimated(study, stage, row, identified.correlations[stage])
        for stage, frame in identified.estimates.items()
        for row in frame.to_dict("records")
    ]


def _estimated(
    study: Study, stage: str, row: Mapping[Any, Any], related: pd.DataFrame
) -> Estimated:
    name = str(row["parameter"])
    factor = study.parameters[name].factor
    partner, size = _strongest(related, name)
    return Estimated(
        stage=stage,
        name=name,
        unit=study.parameters[name].unit,
        value=float(row["estimate"]) / factor,
        low=float(row["low"]) / factor,
        high=float(row["high"]) / factor,
        width=float(row["width"]),
        apparatus=QUANTILE * float(row["apparatus_sd"]) / factor,
        most=str(row["apparatus_most"]),
        cut_off=_CUT_OFF[bool(row["low_open"]), bool(row["high_open"])],
        noise_low=_another(row, "low", factor),
        noise_high=_another(row, "high", factor),
        method=str(row["method"]),
        bound=str(row["bound"]),
        verdict=str(row["verdict"]),
        partner=partner,
        correlation=size,
    )


def _another(row: Mapping[Any, Any], end: str, factor: float) -> float | None:
    """Return an end of the interval of noise alone where it is not that of the interval."""
    noise = float(row[f"noise_{end}"])
    return None if noise == float(row[end]) else noise / factor


def _strongest(related: pd.DataFrame, name: str) -> tuple[str, float | None]:
    others = related[name].drop(name)
    if others.empty or not others.any():
        return "", None
    partner = str(others.abs().idxmax())
    return partner, float(others[partner])


def by_grade(found: list[Estimated]) -> dict[Grade, list[Estimated]]:
    """Return estimates by how well the data determine them, the best first, no grade empty."""
    groups = {grade: [e for e in found if e.grade == grade] for grade in GRADES}
    return {grade: members for grade, members in groups.items() if members}
