"""Predictions of others, in files as MaCFP names them."""

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from pyrofit.data.csvfile import read_table
from pyrofit.data.series import read_series
from pyrofit.data.spec import SeriesSpec
from pyrofit.errors import DataError
from pyrofit.quantities import known_quantities
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.outputs import BACK, FRONT, MASS, RATE

NAME = re.compile(
    r"(?P<who>.+?)_gasification_q?(?P<flux>\d+(?:[.-]\d+)?)(?:kw)?"
    r"(?:_(?P<thickness>\d+(?:[.-]\d+)?)mm)?(?:_(?P<what>mass|mlr|temp)[a-z]*)?(?:_r?\d+)?",
    re.IGNORECASE,
)
"""`UMD_Gasification_65kW_6mm`, `X_Gasification_q50_MLR_R3`, `X_GASIFICATION_q10_18mm`."""
FORMS = "INSTITUTE_Gasification_65kW_6mm.csv or INSTITUTE_Gasification_q50_MLR_R3.csv"
COLUMNS = (
    (RATE, re.compile(r"mlr|mass\s*loss|mass.*rate|massflux", re.IGNORECASE)),
    (MASS, re.compile(r"mass|weight|^m\b", re.IGNORECASE)),
    (BACK, re.compile(r"back|bottom|rear", re.IGNORECASE)),
    (FRONT, re.compile(r"front|top", re.IGNORECASE)),
)
"""Quantities by words in a header; the first that fits."""
_TIME = re.compile(r"#?\s*(time|t)\b", re.IGNORECASE)


class PredictedCurve(NamedTuple):
    """A predicted curve.

    Parameters
    ----------
    who
        The institute, as its file names it.
    flux_W_m2, thickness_m
        Stated flux and thickness; NaN where the name has no thickness.
    quantity
        Name of a quantity, see `pyrofit.quantities`.
    time_s, value
        Times after the start of exposure, and values in SI units, shape (n,).
    file
        The file.
    """

    who: str
    flux_W_m2: float
    thickness_m: float
    quantity: str
    time_s: FloatArray
    value: FloatArray
    file: Path


class OtherPredictions(NamedTuple):
    """Predicted curves, and why files of folders are left out, in words."""

    curves: list[PredictedCurve]
    left: list[str]


def read_predictions(paths: Iterable[Path], area_m2: float) -> OtherPredictions:
    """Read files, and all CSV files of folders, whose names state a flux.

    Files of folders with other names, such as those of TGA, are passed over. A file of a folder
    that breaks a rule is left out, and told. Headers are recognised by words. Units are those that
    the file states; masses belong to ``area_m2``.

    Raises
    ------
    DataError
        A file that is named itself is missing, its name states no flux, or a column breaks a rule.
        A folder has no file that can be read.
    """
    curves: list[PredictedCurve] = []
    left: list[str] = []
    for path in paths:
        if not path.is_dir():
            curves += read_prediction(path, area_m2)
            continue
        inside = sorted(p for p in path.rglob("*") if p.suffix.lower() == ".csv")
        read = 0
        for file in (p for p in inside if NAME.fullmatch(p.stem)):
            try:
                curves += read_prediction(file, area_m2)
                read += 1
            except DataError as error:
                left.append(str(error))
        if not read:
            said = left[0] if left else f"{path}: no file has a name such as {FORMS}. Rename them."
            raise DataError(said)
    return OtherPredictions(curves, left)


def read_prediction(path: Path, area_m2: float) -> list[PredictedCurve]:
    """Read the curves of one file.

    Raises
    ------
    DataError
        The name states no flux, there is no column of time, or no column of a known quantity.
    """
    told = NAME.fullmatch(path.stem)
    if told is None:
        raise DataError(f"{path}: the name states no institute and flux. Rename it to {FORMS}.")
    flux = 1e3 * _number(told["flux"])
    thick = 1e-3 * _number(told["thickness"]) if told["thickness"] else float("nan")
    table = read_table(path)
    names = list(table.columns)
    times = [name for name in names if _TIME.match(name) and not _quantity(name)]
    times = times or [name for name in names if _TIME.fullmatch(name.strip())]
    if len(times) != 1:
        raise DataError(
            f"{path}: {len(times)} columns may be the time, of {', '.join(names)}. "
            "Name one `Time`, with the unit s."
        )
    curves = []
    for name in (n for n in names if n not in times):
        quantity = _quantity(name)
        if quantity:
            columns = {"time": times[0], "value": name}
            area = None if known_quantities()[quantity].is_temperature else area_m2
            spec = SeriesSpec(quantity, path, columns, sample_area_m2=area)
            frame = read_series(spec, lambda _: table).frame
            value = frame[known_quantities()[quantity].column].to_numpy(float)
            time = frame["time_s"].to_numpy(float)
            curves.append(PredictedCurve(told["who"], flux, thick, quantity, time, value, path))
    if not curves:
        raise DataError(
            f"{path}: no column is known: {', '.join(names)}. Name one `Mass`, `MLR`, `T Back` or "
            "`T Top`, with a unit such as g, g/m2/s or K."
        )
    return curves


def matching(
    curves: Sequence[PredictedCurve], flux_W_m2: float, thickness_m: float, quantity: str
) -> list[PredictedCurve]:
    """Return the curves of a flux (within 3 %) and thickness (within 10 %, where it is stated).

    A mass loss rate is derived from a mass of who gives no rate. Temperatures of the back stand for
    those at an interface behind the sample.
    """
    wanted = BACK if known_quantities()[quantity].place == "interface" else quantity
    alike = [
        c
        for c in curves
        if abs(c.flux_W_m2 / flux_W_m2 - 1.0) <= 0.03
        and not abs(c.thickness_m / thickness_m - 1.0) > 0.10
    ]
    found = [c for c in alike if c.quantity == wanted]
    if wanted == RATE:
        have = {c.who for c in found}
        found += [_rate(c) for c in alike if c.quantity == MASS and c.who not in have]
    return found


def _rate(curve: PredictedCurve) -> PredictedCurve:
    """Return the mass loss rate of a predicted mass: differences, means over the intervals."""
    middle = 0.5 * (curve.time_s[1:] + curve.time_s[:-1])
    rate = -np.diff(curve.value) / np.diff(curve.time_s)
    return curve._replace(quantity=RATE, time_s=middle, value=rate)


def _quantity(header: str) -> str:
    return next((q for q, words in COLUMNS if words.search(header)), "")


def _number(text: str) -> float:
    return float(text.replace("-", "."))
