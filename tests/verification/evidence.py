"""What a verification test states: two curves or a number, an error measure, a tolerance."""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from cases import Curve, rms_over_mean

SHOWN_DIGITS = 2
DIFFERENT = "different by"


class Axis(NamedTuple):
    """A quantity in SI units and how an axis shows it."""

    name: str
    unit: str
    factor: float = 1.0
    offset: float = 0.0

    def shown(self, values: Curve) -> Curve:
        return values * self.factor + self.offset

    @property
    def label(self) -> str:
        return f"{self.name} [{self.unit}]"


TIME = Axis("time", "s")
DEPTH = Axis("depth", "mm", 1e3)
TEMPERATURE = Axis("temperature", "°C", 1.0, -273.15)
MLR = Axis("mass loss rate", "g/(m² s)", 1e3)
MASS = Axis("mass fraction", "-")


class Line(NamedTuple):
    """Our curve and the other at the same x, SI units."""

    x: Curve
    ours: Curve
    other: Curve


@dataclass(frozen=True)
class Measure:
    """How far two curves are apart, in one number."""

    name: str
    of: Callable[[Curve, Curve], float]
    unit: str = ""


def largest_difference(curve: Curve, other: Curve) -> float:
    return float(np.abs(curve - other).max())


RMS_OVER_MEAN = Measure("rms difference / mean", rms_over_mean, "%")
LARGEST = Measure("largest difference", largest_difference)
LARGEST_K = Measure("largest difference", largest_difference, "K")
RMS_K = Measure("rms difference", lambda a, b: float(np.sqrt(np.mean((a - b) ** 2))), "K")


def shown(value: float, unit: str = "") -> str:
    """A number with two significant digits and its unit; per cent are converted."""
    if unit == "%":
        value *= 100.0
    small = value != 0.0 and abs(value) < 1e-3
    text = f"{value:.{SHOWN_DIGITS - 1}e}" if small else f"{value:.{SHOWN_DIGITS}g}"
    mantissa, _, exponent = text.partition("e")
    if exponent:
        text = f"{float(mantissa):g}e{int(exponent)}"
    return f"{text} {unit}".strip()


class Picture(NamedTuple):
    """What is drawn of a case: curves, or errors against sizes with the slope ``order``."""

    x: Axis
    y: Axis
    lines: Mapping[str, Line]
    other: str
    order: float | None = None


@dataclass(frozen=True)
class Case:
    """One row of the page."""

    section: str
    title: str
    source: str
    measure: str
    tolerance: str
    measured: str
    note: str = ""
    picture: Picture | None = None

    @property
    def known_difference(self) -> bool:
        """Whether the other solves another equation."""
        return self.tolerance.startswith(DIFFERENT)

    @property
    def slug(self) -> str:
        words = f"{self.title} {short(self.source)}".lower()
        return re.sub(r"[^a-z0-9]+", "-", words).strip("-")


@dataclass(frozen=True)
class Evidence:
    """The fixture: asserts what a test states, and hands the row to the page."""

    section: str
    keep: Callable[[Case], None]

    def curve(
        self,
        title: str,
        x: Axis,
        y: Axis,
        lines: Line | Mapping[str, Line],
        source: str,
        tolerance: float,
        measure: Measure = LARGEST,
        note: str = "",
    ) -> float:
        """Assert that our curves are within ``tolerance`` of the others; return the measure."""
        lines = {"": lines} if isinstance(lines, Line) else lines
        measured = max(measure.of(line.ours, line.other) for line in lines.values())
        case = Case(
            self.section,
            title,
            source,
            measure.name,
            shown(tolerance, measure.unit),
            shown(measured, measure.unit),
            note,
            Picture(x, y, lines, short(source)),
        )
        self.keep(case)
        assert measured <= tolerance, f"{title}: {case.measured}, above {case.tolerance}"
        return measured

    def number(
        self,
        title: str,
        measured: float,
        tolerance: float,
        measure: str,
        source: str,
        unit: str = "",
        note: str = "",
    ) -> None:
        """Assert that a number without a curve is within ``tolerance``."""
        limit, found = shown(tolerance, unit), shown(measured, unit)
        self.keep(Case(self.section, title, source, measure, limit, found, note))
        assert measured <= tolerance, f"{title}: {found}, above {limit}"

    def order(
        self,
        title: str,
        size: Axis,
        error: Axis,
        lines: Mapping[str, tuple[Curve, Curve]],
        source: str,
        tolerance: float = 0.2,
        order: float = 2.0,
        note: str = "",
    ) -> None:
        """Assert the slope of log error over log size; ``lines`` holds sizes and errors."""
        slopes = [np.polyfit(np.log(h), np.log(e), 1)[0] for h, e in lines.values()]
        worst = float(max(slopes, key=lambda slope: abs(slope - order)))
        pairs = {name: Line(h, e, e) for name, (h, e) in lines.items()}
        case = Case(
            self.section,
            title,
            source,
            "observed order",
            f"{order:.2g} ± {tolerance:.2g}",
            f"{worst:.2f}",
            note,
            Picture(size, error, pairs, short(source), order),
        )
        self.keep(case)
        assert abs(worst - order) <= tolerance, f"{title}: {worst}"

    def difference(
        self,
        title: str,
        x: Axis,
        y: Axis,
        line: Line,
        source: str,
        expected: tuple[float, float],
        why: str,
        measure: Measure = RMS_OVER_MEAN,
    ) -> None:
        """Assert the size, between two limits, of a difference that is known and explained."""
        measured, (low, high) = measure.of(line.ours, line.other), expected
        case = Case(
            self.section,
            title,
            source,
            measure.name,
            f"{DIFFERENT} {shown(low, measure.unit)} to {shown(high, measure.unit)}",
            shown(measured, measure.unit),
            why,
            Picture(x, y, {"": line}, short(source)),
        )
        self.keep(case)
        assert low <= measured <= high, f"{title}: {case.measured}, not {case.tolerance}"


def short(source: str) -> str:
    """The words of a source before its details: the name in a legend."""
    return re.split(r"[:;,(]", source, maxsplit=1)[0].strip()
