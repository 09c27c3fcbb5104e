"""Facts that a file states above its table: initial mass, sign of heat flow, gas, radiant flux."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from pyrofit.data.gas_steps import INERT, OXYGEN, change_of_gas
from pyrofit.quantities.units import SCALES, unit_key

_FIRST = 200
"""Lines in which facts are looked for."""
_NUMBER = r"([+-]?\d+(?:[.,]\d+)?)"
_MASS = re.compile(
    "|".join(
        (
            r"(?:(?:sample|initial|specimen|test)\s*)?(?:mass|weight|wt\.?)",
            r"(?:(?:sample|initial|specimen|test)\s*)?size",
            "probenmasse|einwaage|anfangsmasse",
            r"(?:mass|weight)\s*of\s*(?:the\s*)?(?:sample|specimen)",
            r"masse(?:\s*(?:initiale|(?:de\s+)?l?.?.?chantillon))?|poids(?:\s*initial)?",
            r"mas+a(?:\s*ini[cz]iale?)?|peso(?:\s*ini[cz]iale?)?|gewicht",
        )
    ),
    re.IGNORECASE,
)
_FLUX = re.compile(
    "|".join(
        (
            r"(?:(?:incident|external|radiant|irradiation|heat|cone)[\s_]*)*(?:flux|irradiance)",
            "bestrahlungsst.rke|w.rmestromdichte",
            r".clairement(?:\s+.nerg.tique)?",
        )
    ),
    re.IGNORECASE,
)
_GAS = re.compile(
    "|".join(
        (
            r"(?:(?:purge|sample|carrier|furnace|process|reactive|test)[\s_]*)*gas(?:\s*\d)?",
            r"(?:purge|protective)(?:\s*\d)?(?:\s*(?:gas|mfc))?(?:\s*\d)?",
            r"(?:(?:purge|sample|carrier|furnace|process|test)[\s_]*)*atmosphere(?:\s*\d)?",
            "atmosph.re|(?:spül|träger|ofen|probenraum)gas",
            r"gaz(?:\s+\w+)*|gas\s+(?:de|di)\s+\w+",
        )
    ),
    re.IGNORECASE,
)
_AREA = re.compile(
    r"(?:(?:exposed|sample|specimen|surface|test)\s*)*area|(?:proben?|ober)fl.che|surface\s+expos.e",
    re.IGNORECASE,
)
_EXO = re.compile(r"exo(?:therm(?:ic|al)?)?", re.IGNORECASE)
_UPWARD = re.compile(
    r"(?<![a-z])(exo|endo)(?:therm(?:ic|al)?)?[\s_-]*(up|down)(?![a-z])", re.IGNORECASE
)
_ANY_MASS = re.compile(rf"(?<![\w.,]){_NUMBER}\s*mg(?![\w/])")
_NOT_OF_SAMPLE = re.compile(
    "crucible|pan|tiegel|creuset|reference|calibr|resolution|balance|molar|range|offset", re.I
)
_UNIT = re.compile(r"[\[(]([^\[\]]*)[\])]$|/\s*(\S+)$")


@dataclass(frozen=True)
class Stated:
    """Facts that a file states; None or nothing where it does not.

    Parameters
    ----------
    mass_kg
        Initial mass of the sample [kg].
    exothermic_up
        Whether heat released is positive.
    gas
        Gas around the sample, in the words of the file.
    flux_kW_m2
        Radiant flux [kW/m2].
    then_gas
        A gas with oxygen to which the first gas is changed in the run; nothing where it is not.
    then_gas_s
        Time of that change [s], where the steps of the run tell it.
    area_m2
        Exposed area of the sample [m2].
    mass_named
        Whether a key names that mass; else it may be a nominal one.
    """

    mass_kg: float | None = None
    exothermic_up: bool | None = None
    gas: str = ""
    flux_kW_m2: float | None = None
    then_gas: str = ""
    then_gas_s: float | None = None
    area_m2: float | None = None
    mass_named: bool = True


def stated_in(lines: Sequence[Sequence[str]]) -> Stated:
    """Return the facts of lines of cells above a table; one that stands in two ways is left out.

    A fact stands as key and value in one line, or as a key above its value. Where no key tells the
    mass of the sample, the only mass in mg counts, in a title for example.

    >>> stated_in([["#SAMPLE MASS /mg:", "5.000"], ["#EXO:", "+1"], ["Purge Gas", "air"]])
    Stated(mass_kg=5e-06, exothermic_up=True, gas='air', flux_kW_m2=None, then_gas='', then_gas_s=None, area_m2=None, mass_named=True)
    >>> stated_in([["Flux (kW/m2)", "tig (s)"], ["25", "85"]]).flux_kW_m2
    25.0
    """  # noqa: E501
    rows = [
        [cell.strip().strip('"#:= ') for line in (row,) for cell in line] for row in lines[:_FIRST]
    ]
    rows = [_split(row) for row in rows]
    masses: set[float] = set()
    fluxes: set[float] = set()
    areas: set[float] = set()
    signs: set[bool] = set()
    gases: dict[str, None] = {}
    for i, row in enumerate(rows):
        for k, cell in enumerate(row):
            key, unit = _key(cell)
            value, behind = _value(rows, i, k)
            if _MASS.fullmatch(key):
                masses |= _number(value, unit or behind, "mass")
            elif _FLUX.fullmatch(key):
                fluxes |= _number(value, unit or behind, "heat flux")
            elif _AREA.fullmatch(key):
                areas |= _number(value, unit or behind, "area")
            elif _GAS.fullmatch(key) and (OXYGEN.search(value) or INERT.search(value)):
                gases[value.strip()] = None
            if (up := _exothermic_up(cell, value)) is not None:
                signs.add(up)
    found = Stated()
    named = bool(masses)
    masses = masses or _only_mass(lines[:_FIRST])
    if len(masses) == 1:
        found = replace(found, mass_kg=masses.pop(), mass_named=named)
    if len(areas) == 1:
        found = replace(found, area_m2=areas.pop())
    if len(signs) == 1:
        found = replace(found, exothermic_up=signs.pop())
    if len(fluxes) == 1:
        found = replace(found, flux_kW_m2=fluxes.pop() / 1e3)
    steps = [" ".join(line) for line in lines[:_FIRST]]
    parts = [cell for line in lines[:_FIRST] for cell in line]  # several steps may share a line
    changes = [change for of in (steps, parts) if (change := change_of_gas(of)) is not None]
    if changes:
        first, then, at = max(changes, key=lambda change: bool(change[0]))
        return replace(found, gas=first or " and ".join(gases), then_gas=then, then_gas_s=at)
    return replace(found, gas=" and ".join(gases))


def _split(row: Sequence[str]) -> list[str]:
    """Split key and value that a colon or a sign of equality separates; empty cells stay."""
    return [
        part.strip(' "#')
        for cell in row
        for part in re.split(r"\s*[:=]\s+|\s*[:=]$", cell)
        if part or not cell
    ]


def _only_mass(lines: Sequence[Sequence[str]]) -> set[float]:
    """Return the masses in mg that lines name, but for those of other things than the sample."""
    texts = [text for line in lines if not _NOT_OF_SAMPLE.search(text := " ".join(line))]
    found = (match[0] for text in texts for match in _ANY_MASS.finditer(text))
    return {mass for text in found for mass in _number(text, "", "mass")}


def _key(cell: str) -> tuple[str, str]:
    unit = _UNIT.search(cell)
    if unit is None:
        return cell.strip(), ""
    if unit.start() == 0:  # a key in brackets
        return cell.strip("[]() "), ""
    return cell[: unit.start()].strip(), (unit[1] or unit[2]).strip()


def _value(rows: Sequence[Sequence[str]], i: int, k: int) -> tuple[str, str]:
    """Return the cell of a value, and the one behind it, which may be its unit."""
    below = rows[i + 1] if i + 1 < len(rows) else []
    beside, behind, *_ = [*filter(None, rows[i][k + 1 :]), "", ""]
    if not re.match(_NUMBER, beside) and k < len(below) and re.fullmatch(_NUMBER, below[k]):
        return below[k], ""
    return beside, behind.strip("[]() ")


def _number(value: str, unit: str, kind: str) -> set[float]:
    """Return a value in SI units; nothing where it or its unit is unknown."""
    match = re.fullmatch(rf"{_NUMBER}\s*(.*)", value)
    if match is None:
        return set()
    key = unit_key(match[2].strip("[]() ") or unit)
    factor = next((f for word, f in SCALES[kind].items() if unit_key(word) == key), None)
    number = float(match[1].replace(",", "."))
    return set() if factor is None or number <= 0.0 else {float(f"{number * factor:.6g}")}


def exothermic_up(names: Iterable[str]) -> bool | None:
    """Return whether heat released is positive, where the names of columns tell it in one way.

    >>> exothermic_up(["Time (s)", "Heat flow, endo up (mW)"]), exothermic_up(["DSC_exo_up", "T"])
    (False, True)
    """
    signs = {up for name in names if (up := _upward(name)) is not None}
    return signs.pop() if len(signs) == 1 else None


def _upward(text: str) -> bool | None:
    """Return whether heat released points up, where words such as `endo up` tell it in one way."""
    found = _UPWARD.findall(text)
    signs = {(what.casefold() == "exo") == (way.casefold() == "up") for what, way in found}
    return signs.pop() if len(signs) == 1 else None


def _exothermic_up(cell: str, value: str) -> bool | None:
    """Return whether heat released points up, where a line tells it."""
    if _EXO.fullmatch(cell) and (text := value.strip().casefold()) in (
        "+1",
        "1",
        "-1",
        "up",
        "down",
    ):
        return text in ("+1", "1", "up")
    if (arrow := re.fullmatch(r"[\^↑]\s*(exo|endo)\w*", cell, re.IGNORECASE)) is not None:
        return arrow[1].casefold() == "exo"
    return _upward(cell)
