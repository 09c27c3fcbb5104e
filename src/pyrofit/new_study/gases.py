"""The gas around a sample, as names and columns of files tell it."""

import re

import numpy as np

from pyrofit.data.csvfile import FileTable
from pyrofit.data.gas_steps import holds_oxygen
from pyrofit.experiments import KINDS, measurable

_OXYGEN_PERCENT = 0.5
"""Oxygen above which a gas is no nitrogen with traces."""


def gas_of(name: str) -> str:
    """Return the gas with oxygen that the name of a file tells; nothing where it tells none.

    >>> gas_of("board_TGA_O2-21_10K_1"), gas_of("wood air 10K"), gas_of("pair_N2"), gas_of("O2")
    ('O2-21', 'air', '', 'O2')
    >>> gas_of("a_10O2"), gas_of("a_synthair"), gas_of("a oxidative"), gas_of("CO2"), gas_of("5%O2")
    ('10O2', 'synthair', 'oxidative', '', '5%O2')
    >>> gas_of("wood_air-dried_10K"), gas_of("air_dry"), gas_of("board O2-free")
    ('', '', '')
    """
    match = re.search(
        r"(?<![A-Za-z0-9.])((?:synth(?:etic)?)? ?air|luft|aire|oxygen|oxidative|oxidi[sz]ing"
        r"|(?:\d+(?:[.,]\d+)?)?[ %]*o2(?:-\d+)?)(?![A-Za-z0-9])(?![ -]*(?:dr|free))",
        name.replace("_", " "),
        re.I,
    )
    return match[1] if match else ""


def gas_of_columns(kind: str, table: FileTable) -> str:
    """Return the gas with oxygen that a column of a heated sample tells; nothing where none does.

    In the combustor of a microscale calorimeter it is not that around the sample.
    """
    gases = _gases(kind, table)
    if gases is None:
        return ""
    if gases and holds_oxygen(gases[0]):
        return gases[0]
    for name, values in table.columns.items():
        percent = float(np.nan_to_num(values).mean()) if table.units[name] == "%" else 0.0
        if re.fullmatch(r"o_?2|oxygen", name.strip(), re.I) and percent > _OXYGEN_PERCENT:
            return f"O2 {percent:.3g} %"
    return ""


def then_gas(kind: str, table: FileTable) -> str:
    """Return a gas with oxygen that follows another one in a column of gases, or nothing."""
    first, *later = _gases(kind, table) or [""]
    return "" if holds_oxygen(first) else next(filter(holds_oxygen, later), "")


def _gases(kind: str, table: FileTable) -> list[str] | None:
    """Return the gases that a column of text names in their order; None where none is shown.

    That is the case for samples whose mass is not measured in that gas.
    """
    of_sample = any(q.has_sign or "mass" in q.scales for q in measurable(kind).values())
    if KINDS[kind].stage != "kinetics" or not of_sample:
        return None
    for name, texts in table.texts.items():
        if re.fullmatch(r"(purge|sample)?\W*gas|atmosphere|gaz", name, re.I):
            return list(texts)
    return []
