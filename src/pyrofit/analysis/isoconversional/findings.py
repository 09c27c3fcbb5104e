"""What the activation energies over conversion tell, in sentences: each finding is a function."""

from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np

from pyrofit.analysis.isoconversional.analyse import Analysis
from pyrofit.analysis.isoconversional.line import Energies
from pyrofit.solver.arrays import FloatArray

CONSTANT = 0.1
"""Range of E over its mean up to which it counts as constant (ICTAC 2011: 10 to 20 %)."""
_CORE = 0.1, 0.9
"""Conversions between which E is judged."""
_APART_K = 3.0
_FALLING = 0.01
_LAST_K = 20.0
_NO_LINE = 2.0
_RATIO = 3.0
_LEAST_J_MOL = 3e4

Finding = Callable[[Analysis], Iterator[str]]


def findings(analysis: Analysis) -> list[str]:
    """Return sentences on what the analysis shows, the most important first."""
    return [text for finding in FINDINGS for text in finding(analysis)]


def most_accurate(energies: dict[str, Energies]) -> Energies:
    """Return the energies of advanced Vyazovkin, the most accurate method where E varies."""
    return energies["vyazovkin"]


def _varies(analysis: Analysis) -> Iterator[str]:
    found = most_accurate(analysis.energies)
    known = _core(analysis) & np.isfinite(found.value)
    if known.sum() < 2:
        return
    value, error, at = found.value[known], found.error[known], analysis.levels[known]
    low, high = int(np.argmin(value)), int(np.argmax(value))
    span = value[high] - value[low]
    own = float(np.sqrt(error[low] * error[low] + error[high] * error[high]))
    if span > max(own, CONSTANT * float(value.mean())):
        yield (
            f"E varies with conversion from {_kJ(value[low])} (at {at[low]:.2f}) to "
            f"{_kJ(value[high])} kJ/mol (at {at[high]:.2f}), by more than its errors. One reaction "
            "cannot describe this; `pyrofit scheme` chooses a scheme of more reactions."
        )


def _model(analysis: Analysis) -> Iterator[str]:
    if not analysis.model:
        return
    found, model = most_accurate(analysis.energies), most_accurate(analysis.model)
    known = np.isfinite(found.value) & np.isfinite(model.value)
    apart = np.abs(model.value - found.value)
    outside = known & (apart > found.error)
    # One level in twenty is outside a 95 % interval by chance.
    if outside.sum() <= max(2, 0.1 * known.sum()):
        return
    worst = int(np.argmax(np.where(outside, apart, 0.0)))
    yield (
        f"E of the fitted model lies outside the isoconversional E at {outside.sum()} of "
        f"{known.sum()} conversions. The largest difference is at {analysis.levels[worst]:.2f}: "
        f"the model has {_kJ(model.value[worst])} kJ/mol, the records "
        f"{_kJ(found.value[worst])} ± {_kJ(found.error[worst])} kJ/mol."
    )


def _crossing(analysis: Analysis) -> Iterator[str]:
    curves, at = analysis.runs.curves, analysis.runs.at
    order = sorted(
        (i for i, curve in enumerate(curves) if curve.rate_K_min is not None),
        key=lambda i: curves[i].rate_K_min or 0.0,
    )
    for one, other in pairwise(order):
        if curves[one].condition == curves[other].condition:
            continue
        apart = at[one].temperature_K - at[other].temperature_K
        crossed = np.isfinite(apart) & (apart > analysis.temperature_sd_K * 2.0)
        if crossed.any():
            yield (
                f"The curves of {curves[one].name} and {curves[other].name} cross: at conversion "
                f"{_where(analysis.levels[crossed])} the slower heating is the hotter one. "
                "Check rates, temperatures and masses of both."
            )


def _repeats(analysis: Analysis) -> Iterator[str]:
    temperature = analysis.runs.stacked("temperature_K")
    middle = int(np.argmin(np.abs(analysis.levels - 0.5)))
    for group in analysis.runs.groups:
        curves = [analysis.runs.curves[i] for i in group]
        at = temperature[group, middle]
        if len(group) < 2 or curves[0].rate_K_min is None or not np.isfinite(at).all():
            continue
        if at.max() - at.min() > _APART_K:
            cold, hot = curves[int(np.argmin(at))].name, curves[int(np.argmax(at))].name
            yield (
                f"Repeats at {curves[0].condition} differ by {at.max() - at.min():.1f} K at half "
                f"of the conversion: {cold} and {hot}. E contains their mean."
            )


def _incomplete(analysis: Analysis) -> Iterator[str]:
    names = []
    for curve in analysis.runs.curves:
        if curve.rate_K_min is None:
            continue
        late = curve.temperature_K >= curve.temperature_K[-1] - _LAST_K
        part = curve.conversion[late]
        third = max(1, part.size // 3)
        if float(part[-third:].mean() - part[:third].mean()) > _FALLING:
            names.append(curve.name)
    if names:
        yield (
            f"The mass still falls at the end of {', '.join(names)}. Conversion rests on the last "
            "mass, so E at high conversion depends on where the records end."
        )


def _no_line(analysis: Analysis) -> Iterator[str]:
    broken = most_accurate(analysis.energies).stretch > _NO_LINE
    if broken.any():
        yield (
            f"At conversion {_where(analysis.levels[broken])} the rates do not follow one "
            "activation energy from one heating programme to the next. Reactions that overlap "
            "change their order there, or a record is wrong; the errors are wider for it."
        )


def _low(analysis: Analysis) -> Iterator[str]:
    value = most_accurate(analysis.energies).value
    low = np.isfinite(value) & (value < _LEAST_J_MOL)
    if low.any():
        yield (
            f"E is below {_kJ(_LEAST_J_MOL)} kJ/mol at conversion {_where(analysis.levels[low])}. "
            "That is no activation energy of a decomposition: look for drying, evaporation, a "
            "wrong temperature or a wrong time."
        )


def _few(analysis: Analysis) -> Iterator[str]:
    conditions = {curve.condition for curve in analysis.runs.curves}
    rates = [curve.rate_K_min for curve in analysis.runs.curves if curve.rate_K_min]
    if len(conditions) == 2:
        yield (
            "Two heating programmes give a line, but no test of it. A third one would tell "
            "whether one activation energy holds at each conversion."
        )
    if len(rates) == len(analysis.runs.curves) and max(rates) < _RATIO * min(rates):
        yield (
            f"The heating rates {min(rates):g} and {max(rates):g} K/min are close, so E is "
            "uncertain. Records whose rates differ by a factor of 5 or more tell it better."
        )


FINDINGS: tuple[Finding, ...] = (
    _varies,
    _model,
    _crossing,
    _repeats,
    _no_line,
    _low,
    _incomplete,
    _few,
)


def _core(analysis: Analysis) -> FloatArray:
    levels = analysis.levels
    return np.asarray((levels > _CORE[0] - 1e-9) & (levels < _CORE[1] + 1e-9))


def _kJ(value: float) -> str:
    return f"{value / 1e3:.0f}"


def _where(levels: FloatArray) -> str:
    """Return levels in words, as '0.15' or '0.15 to 0.30'."""
    first, last = float(levels.min()), float(levels.max())
    return f"{first:.2f}" if first == last else f"{first:.2f} to {last:.2f}"
