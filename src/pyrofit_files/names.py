"""Facts of a test in the name of its measured file."""

import re
from dataclasses import dataclass

KINDS = {
    "tga": "tga",
    "dsc": "dsc",
    "tm-dsc": "dsc",
    "sta": "dsc",
    "mcc": "mcc",
    "cone": "cone",
    "fpa": "gasification",
    "gasification": "gasification",
    "capa": "gasification",
    "reflectivity": "reflectivity",
    "lfa": "diffusivity",
}
"""Kind of experiment by the word of a name, in lower case."""
_HEATING = re.compile(r"(\d+(?:[.-]\d+)?)k(?:min)?", re.IGNORECASE)
_FLUX = re.compile(r"q?(\d+(?:[.-]\d+)?)kw|hf(\d+)(?:scan|scalar)?", re.IGNORECASE)
_GAS = re.compile(r"(n2|ar|air|o2(?:-\d+)?)", re.IGNORECASE)
_REPEAT = re.compile(r"r?(\d{1,2})", re.IGNORECASE)
_GRAIN = "parallel", "perpendicular"
_FACING = {"hor": "horizontal", "vert": "vertical"}


@dataclass(frozen=True)
class Label:
    """Parts of the name of a measured file.

    Parameters
    ----------
    laboratory
        First word, which names the laboratory.
    material
        Words between laboratory and kind; nothing where there are none.
    word
        The word for the kind of experiment, as it is written; nothing where there is none.
    kind
        Kind of experiment, or of property.
    gas
        Atmosphere: N2, Ar, O2-21 ...
    heating_K_min, flux_kW_m2
        Number of the test.
    other
        Grain, orientation, pressure and other words.
    repeat
        Number of the repeat.
    """

    laboratory: str
    material: str = ""
    word: str = ""
    kind: str = ""
    gas: str = ""
    heating_K_min: float | None = None
    flux_kW_m2: float | None = None
    other: tuple[str, ...] = ()
    repeat: int | None = None

    @property
    def inert(self) -> bool:
        """Whether the atmosphere has no oxygen, as far as the name tells."""
        return not self.gas.upper().startswith(("O2", "AIR"))

    @property
    def conditions(self) -> str:
        """The conditions in words."""
        parts = [self.gas]
        if self.heating_K_min is not None:
            parts.append(f"{self.heating_K_min:g} K/min")
        if self.flux_kW_m2 is not None:
            parts.append(f"{self.flux_kW_m2:g} kW/m2")
        return ", ".join(part for part in (*parts, *self.other) if part)

    @property
    def group(self) -> tuple[object, ...]:
        """The properties that tests must share to be compared between laboratories."""
        gas = "inert" if self.inert else self.gas.upper()
        return self.kind, self.material, gas, self.heating_K_min, self.flux_kW_m2


def label_of(stem: str, folder: str = "") -> Label:
    """Return the parts of a file's name, which is given without its ending.

    Parameters
    ----------
    stem
        Name of the file.
    folder
        Name of its folder, which is that of the laboratory where the name begins with it.

    Examples
    --------
    >>> label = label_of("TIFP+UCT_Wood_Gasification_30kW_hor_parallel_R2")
    >>> label.laboratory, label.kind, label.conditions, label.repeat
    ('TIFP+UCT', 'gasification', '30 kW/m2, horizontal, parallel', 2)
    >>> label_of("LCPP_TGA_N2_2-5K_1").heating_K_min
    2.5
    """
    parts = stem.split("_")
    if folder and stem.casefold().startswith(folder.casefold() + "_"):
        parts = [folder, *stem[len(folder) + 1 :].split("_")]
    at = next((i for i, part in enumerate(parts) if part.casefold() in KINDS), None)
    if at is None:
        return Label(parts[0], other=tuple(parts[1:]))
    word = parts[at]
    middle = [part for part in parts[1:at] if part.casefold() not in ("wood", *_GRAIN)]
    before = [part for part in parts[1:at] if part.casefold() in _GRAIN]
    gas, heating, flux, repeat, other = "", None, None, None, []
    for part in [piece for given in (*before, *parts[at + 1 :]) for piece in _pieces(given)]:
        if match := _GAS.fullmatch(part):
            gas = match[1].upper()
        elif match := _HEATING.fullmatch(part):
            heating = float(match[1].replace("-", "."))
        elif match := _FLUX.fullmatch(part):
            flux = float((match[1] or match[2]).replace("-", "."))
        elif match := _REPEAT.fullmatch(part):
            repeat = int(match[1])
        else:
            other.append(_FACING.get(part.casefold(), part.casefold()))
    kind = KINDS[word.casefold()]
    material = "_".join(middle)
    return Label(parts[0], material, word, kind, gas, heating, flux, tuple(other), repeat)


def _pieces(part: str) -> list[str]:
    """Cut `hor-R1` as well as `hor_R1`."""
    match = re.fullmatch(r"(hor|vert|parallel|perpendicular)-(.+)", part, re.IGNORECASE)
    return [match[1], match[2]] if match else [part]
