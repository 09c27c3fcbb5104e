"""Changes of gas that the steps of a run above a table tell."""

import re
from collections.abc import Sequence

OXYGEN = re.compile(
    r"(?<![a-z])(?:(?:synth(?:etic)? ?)?air|luft|aire|o2|oxygen|sauerstoff|oxyg.ne|oxidative"
    r"|oxidi[sz]ing)(?![a-z])",
    re.I,
)
_NONE = re.compile(
    "|".join(
        (
            r"\([^()]*\bpp[mb]\b[^()]*\)",
            r"(?:o2|oxygen)\s*[:=]?\s*(?:[<≤]|below|under)[^,;]*",
            r"(?:o2|oxygen|air)[ -]*free",
            r"free of (?:o2|oxygen|air)",
            r"(?:o2|oxygen|air)\s*[:=]?\s*0+(?:[.,]0*)?\s*(?:%|m?l|cc|scc)[^,;]*",
        )
    ),
    re.I,
)
"""Words for oxygen that is not there, or there in traces."""
INERT = re.compile(r"(?<![a-z])(?:n2|nitrogen|stickstoff|azote|ar|argon|he|helium)(?![a-z])", re.I)
_STEP = re.compile(
    r"switch|select|change|gaswechsel|isotherm|ramp|segment|dynami|method|program|until"
    r"|\b(?:then|dann|puis)\b|\W*\d+[):\]]",
    re.I,
)
"""A step of a run, and not the flow of a gas that an instrument has all the time."""
_SWITCH = re.compile(r"switch\w*|chang\w*|gaswechsel", re.I)
_NAMED = re.compile(r"gas\s*#?\s*(\d)\W+(.*)", re.I)
_CHOSEN = re.compile(r"(?:select|switch|change)\w*\W+(?:to\W+)?gas\W*(\d)", re.I)
_NUMBER = r"([+-]?\d+(?:[.,]\d+)?)"
_HOLD = re.compile(rf"(?:hold|isotherm\w*)\s+(?:for\s+)?{_NUMBER}\s*min", re.I)
_HEAT = re.compile(
    rf"(?:heat|cool)\s+from\s+{_NUMBER}\D+?{_NUMBER}\D+?at\s+{_NUMBER}\D*?/\s*min", re.I
)
_BEGINS = re.compile(r"\W*\d+\)|\W*\d+:")


def holds_oxygen(gas: str) -> bool:
    """Tell whether a gas holds oxygen, by its name or its part of the name of a file.

    >>> [holds_oxygen(gas) for gas in ("air", "N2", "Synthetic air", "O2-21", "chair")]
    [True, False, True, True, False]
    >>> [holds_oxygen(gas) for gas in ("10O2", "synthair", "oxidative", "CO2")]
    [True, True, True, False]
    >>> [holds_oxygen(gas) for gas in ("N2 (O2 < 3 ppm)", "O2-free argon", "N2 50, O2 0 ml/min")]
    [False, False, False]
    """
    return bool(OXYGEN.search(_NONE.sub(" ", gas)))


def change_of_gas(lines: Sequence[str]) -> tuple[str, str, float | None] | None:
    """Return the first gas, a later one with oxygen, and the time [s] of the change, if known.

    None where the lines tell no change from an inert gas to one with oxygen. Two gases of an
    instrument are no change: a step has to name them.

    Examples
    --------
    >>> steps = ["Switch the Gas to Nitrogen", "1) Hold for 2 min at 50 C"]
    >>> steps += ["2) Heat from 50 C to 250 C at 20 C/min", "3) Hold for 5 min at 250 C"]
    >>> change_of_gas([*steps, "  Switch the Gas to Oxygen at 45.0 ml/min"])
    ('Nitrogen', 'Oxygen', 720.0)
    >>> change_of_gas(["Gas1: Nitrogen", "Gas2: Air", "3: Select gas: 2"])
    ('Nitrogen', 'Air', None)
    >>> change_of_gas(["Purge gas: N2", "Gas 2: air", "O2 Flow (cc/min): 20"])
    >>> change_of_gas(["Gas switched to air at 700 C"])
    ('', 'air', None)
    """
    names: dict[str, str] = {}
    first, minutes, before = "", 0.0, 0.0
    known = True
    for line in lines:
        if (named := _NAMED.search(line)) and not _CHOSEN.search(line):
            names[named[1]] = named[2]
        if _BEGINS.match(line):
            lasts = _minutes(line)
            minutes += before
            before, known = lasts or 0.0, known and lasts is not None
        chosen = _CHOSEN.search(line)
        text = names.get(chosen[1], "") if chosen else line if _STEP.search(line) else ""
        inert, oxygen = INERT.search(text), OXYGEN.search(text)
        if inert and not oxygen:
            first = first or inert[0]
        elif oxygen and not first and _SWITCH.search(text):
            return "", oxygen[0], None
        elif oxygen and (first or chosen):
            first = first or next((m[0] for n in names.values() if (m := INERT.search(n))), "")
            return (
                (first, oxygen[0], 60.0 * minutes if known and minutes else None) if first else None
            )
    return None


def _minutes(line: str) -> float | None:
    """Return the duration of a step [min]; None where it tells none."""
    if (hold := _HOLD.search(line)) is not None:
        return _number(hold[1])
    if (heat := _HEAT.search(line)) is not None:
        start, end, rate = map(_number, heat.groups())
        return abs(end - start) / rate if rate else None
    return None


def _number(text: str) -> float:
    return float(text.replace(",", "."))
