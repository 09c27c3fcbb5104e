"""Facts of each test in a README beside measured files."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from pyrofit_files.names import Label, label_of

_COLUMNS = {
    "mass_kg": (r"(?!.*final)(?!.*(cup|crucible|pan)).*mass\s*[\[(](mg|g|kg)[\])].*", 2),
    "thickness_m": (r".*thick\w*\s*[\[(](mm|cm|m)[\])].*", 1),
    "flux_W_m2": (r".*flux\s*[\[(](kw/m2|kw/m\^2|kw/m²)[\])].*", 1),
    "area_m2": (r".*surface area\s*[\[(](m2|cm2)[\])].*", 1),
    "diameter_m": (r"diameter\s*[\[(](mm|cm|m)[\])].*", 1),
}
_FACTORS = {
    "mg": 1e-6,
    "g": 1e-3,
    "kg": 1.0,
    "mm": 1e-3,
    "cm": 1e-2,
    "m": 1.0,
    "kw/m2": 1e3,
    "kw/m^2": 1e3,
    "kw/m²": 1e3,
    "m2": 1.0,
    "cm2": 1e-4,
}
_AREA = re.compile(r"surface area\D{0,12}?([\d.]+)\s*(m2|m\^2|cm2|cm\^2)", re.IGNORECASE)
_AREA_FACTORS = {"m2": 1.0, "m^2": 1.0, "cm2": 1e-4, "cm^2": 1e-4}
_SECTION = re.compile(r"#{1,3} ")
_NUMBER = re.compile(r"\d+(\.\d+)?")


@dataclass(frozen=True)
class StatedFacts:
    """Facts of a test that come from outside its file; None where unknown.

    Parameters
    ----------
    mass_kg, thickness_m, flux_W_m2
        Initial mass and thickness of the sample, and radiant flux.
    area_m2
        Exposed area.
    """

    mass_kg: float | None = None
    thickness_m: float | None = None
    flux_W_m2: float | None = None
    area_m2: float | None = None


def read_readme(folder: Path) -> dict[Label, StatedFacts]:
    """Return the facts of a folder's README by test; those of all tests under an empty name."""
    paths = sorted(p for p in folder.iterdir() if p.name.casefold() == "readme.md")
    if not paths:
        return {}
    text = paths[0].read_bytes().decode("utf-8", errors="replace")
    areas = {_area(m) for m in _AREA.finditer(text)}
    common = StatedFacts(area_m2=areas.pop() if len(areas) == 1 else None)
    facts = {Label(""): common}
    own = common
    heading: dict[str, tuple[int, float]] = {}
    for line in text.splitlines():
        cells = [cell.strip().replace("\\_", "_") for cell in line.strip().strip("|").split("|")]
        if "|" not in line:
            heading = {}
            # An area holds for the tables that follow it in its section.
            if _SECTION.match(line):
                own = common
            elif match := _AREA.search(line):
                own = replace(common, area_m2=_area(match))
        elif found := _heading(cells):
            heading = found
        elif heading and (values := _values(cells, heading)):
            name = re.sub(r"\s|\.csv$", "", cells[0], flags=re.IGNORECASE)
            label = label_of(name, folder.name)
            facts[label] = replace(own, **values)
    return facts


def stated_facts(label: Label, known: Mapping[Label, StatedFacts]) -> StatedFacts:
    """Return the facts of a test: those of the line that names it, else those of all tests."""
    fitting = [facts for other, facts in known.items() if other.word and _same(label, other)]
    different = set(fitting)
    return different.pop() if len(different) == 1 else known.get(Label(""), StatedFacts())


def _area(match: re.Match[str]) -> float:
    return float(match[1]) * _AREA_FACTORS[match[2].casefold()]


def _heading(cells: list[str]) -> dict[str, tuple[int, float]]:
    """Return place and factor of each column of a table that is known."""
    found: dict[str, tuple[int, float]] = {}
    if not re.match(r"(file|test)\b", cells[0], re.IGNORECASE):
        return found
    for i, cell in enumerate(cells):
        for key, (pattern, group) in _COLUMNS.items():
            match = re.fullmatch(pattern, cell, re.IGNORECASE)
            if match and key not in found:
                found[key] = i, _FACTORS[match[group].casefold()]
    return found


def _values(cells: list[str], heading: Mapping[str, tuple[int, float]]) -> dict[str, float]:
    values = {}
    for key, (i, factor) in heading.items():
        if i < len(cells) and _NUMBER.fullmatch(cells[i]):
            values[key] = float(cells[i]) * factor
    if (diameter := values.pop("diameter_m", None)) is not None:
        values["area_m2"] = 0.25 * math.pi * diameter**2
    return values


def _same(label: Label, other: Label) -> bool:
    """Tell whether a line of a README names a file: the facts stated by both must agree."""
    ours, theirs = ({*part.other} for part in (label, other))
    numbers = (
        label.repeat == other.repeat
        and label.heating_K_min == other.heating_K_min
        and label.flux_kW_m2 == other.flux_kW_m2
    )
    words = {label.word.casefold(), other.word.casefold()}
    kinds = len(words) == 1 or label.kind == other.kind
    kinds = kinds or ("sta" in words and {label.kind, other.kind} <= {"tga", "dsc"})
    gases = not (label.gas and other.gas) or label.gas == other.gas
    return numbers and kinds and gases and (ours <= theirs or theirs <= ours)
