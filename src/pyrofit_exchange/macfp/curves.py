"""Properties of a parameter set, in whichever of its dialects they are written."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from pyrofit.errors import DataError
from pyrofit.quantities.units import ICE_POINT_K
from pyrofit_exchange.macfp.forms import (
    NOTHING,
    Line,
    Lines,
    PerComponent,
    Power,
    Single,
    Table,
    alike,
    single,
)
from pyrofit_exchange.macfp.network import Network

GRAIN = "perpendicular"
"""Direction that is taken of an anisotropic property."""
FLUX_W_M2 = 30e3
"""Radiant flux at which a property is taken that depends on it."""
_AT_K = 300.0
_CELSIUS_BELOW = 150.0
_KILO_BELOW = 20.0


class UnknownFormError(Exception):
    """A form that is not known, in words."""


def property_curves(given: Any, network: Network, key: str, notes: list[str]) -> Any:
    """Return a property of all components; nothing where the file has none.

    Raises
    ------
    DataError
        Its form is not known.
    """
    if not isinstance(given, Mapping):
        return NOTHING
    try:
        curves = _all(given, network, key, notes)
    except (UnknownFormError, TypeError, ValueError, KeyError, IndexError) as error:
        raise DataError(f"'{key}': {error}: this form of a property is not known.") from None
    curves = [_usual_unit(curve, key, notes) for curve in curves]
    first = curves[0]
    if all(alike(c.model_dump(), first.model_dump()) for c in curves):
        return first
    return PerComponent(form="Component Specific", value=tuple(curves))


def _all(given: Mapping[str, Any], network: Network, key: str, notes: list[str]) -> list[Any]:
    """Return the curve of each component."""
    form = str(given.get("Form", "")).casefold()
    value: Any = next((given[k] for k in ("Value", "Values", "value") if k in given), None)
    parts = given.get("Components", value)
    if isinstance(parts, Mapping):
        return [_part(parts, name, key, notes) for name in network.names]
    if isinstance(given.get("Form"), list):
        return _grouped(given, network, notes)
    temperatures = given.get("Temperatures", given.get("Temperature"))
    several = isinstance(value, list) and temperatures is None and len(value) > 1
    known = form.startswith(("linear", "piecewise", "gpyro"))
    if several and not known:
        if any(isinstance(x, str) for x in value) or "function" in form:
            return _opaque(key, form or str(value), network, notes)
        return _listed(value, network, notes, key)
    return [_curve(given, key, notes)] * len(network.names)


def _listed(value: Sequence[Any], network: Network, notes: list[str], key: str) -> list[Any]:
    """Return a curve for each component: one per component of the file, or virgin and char."""
    numbers = [_curve({"Form": "Single Value", "Value": x}, key, notes) for x in value]
    places = [i for i in network.place if i is not None]
    if len(value) == 2 and len(network.names) > 2:
        notes.append(f"{key}: two values are taken as those of the virgin material and of the rest")
        return [numbers[0 if r else 1] for r in network.reacting]
    if len(value) <= max(places):
        raise UnknownFormError(f"{len(value)} values for {len(places)} components")
    last = numbers[-1]
    return [last if i is None else numbers[i] for i in network.place]


def _grouped(given: Mapping[str, Any], network: Network, notes: list[str]) -> list[Any]:
    """Return curves of groups of components: a table of temperatures and values, or a number."""
    curves: list[Any] = []
    for group, value in zip(given["Form"], given["Value"], strict=True):
        many = group if isinstance(group[0], list) else [group]
        if isinstance(value, list):
            curve: Any = _table(value[0], value[1], notes)
        else:
            curve = single(float(value))
        curves += [curve] * len(many)
    return curves


def _part(parts: Mapping[str, Any], name: str, key: str, notes: list[str]) -> Any:
    """Return the curve of a component by its name; that of the last one where it is not named."""
    given = parts.get(name, list(parts.values())[-1])
    if isinstance(given, Mapping) and GRAIN in given:
        note = f"{key} depends on direction: taken {GRAIN} to the grain"
        if note not in notes:
            notes.append(note)
        given = given[GRAIN]
    if isinstance(given, Mapping):
        return _curve(given, key, notes)
    return NOTHING if given is None else single(float(given))


def _curve(given: Mapping[str, Any], key: str, notes: list[str]) -> Any:
    """Return the curve of one component."""
    form = str(given.get("Form", "")).casefold()
    if given.get("Segments"):
        return _segments(given["Segments"])
    if "C0" in given and "Temperatures" in given:
        return _segments([given])
    if isinstance(given.get("Parameters"), Mapping):
        _once(notes, f"not expressible: {key} as a polynomial: taken at {_AT_K:g} K")
        return single(_shomate(given["Parameters"], _AT_K))
    if "Heat Flux" in given:
        _once(notes, f"{key} depends on the radiant flux: taken at {FLUX_W_M2 / 1e3:g} kW/m2")
        return single(float(np.interp(FLUX_W_M2, given["Heat Flux"], given["Values"])))
    base = next((given[k] for k in ("c0", "k0") if k in given), None)
    if base is not None:
        exponent = given.get("nc", given.get("nk"))
        return _power(base, exponent, given["T0"])
    if form.startswith("gpyro"):
        return _power(given["Base Value"], given["Exponent"], given["Reference Temperature"])
    temperatures = given.get("Temperatures", given.get("Temperature"))
    if temperatures is not None:
        return _table(temperatures, given.get("Values", given.get("Value")), notes)
    if form.startswith("piecewise"):
        (a, b), (c, d) = given["Slope"], given["Intercept"]
        return Lines(
            form="Piecewise Linear", boundary=given["Boundary"], slope=(a, b), intercept=(c, d)
        )
    if form.startswith("linear"):
        return Line(form="Linear", slope=given["Slope"], intercept=given["Intercept"])
    if form == "none":
        return NOTHING
    return _constant(given, key, notes)


def _constant(given: Mapping[str, Any], key: str, notes: list[str]) -> Any:
    value = given.get("Value", given.get("Values"))
    value = value[0] if isinstance(value, list) and len(value) == 1 else value
    if isinstance(value, str):
        _once(notes, f"{key}: '{value}' is no number: taken as none")
        return NOTHING
    if value is None:
        raise UnknownFormError(f"the form '{given.get('Form', '')}'")
    return single(float(value))


def _power(base: Any, exponent: Any, reference: Any) -> Power:
    return Power(
        form="Gpyro Power Law", base=float(base), exponent=float(exponent), reference=reference
    )


def _shomate(parameters: Mapping[str, Any], T: float) -> float:
    """Return c = (A + B t + C t^2 + D t^3 + E/t^2)/M with t = T/1000."""
    a, b, c, d, e = (float(parameters[k]) for k in "ABCDE")
    t = T / 1e3
    return (a + b * t + c * t**2 + d * t**3 + e / t**2) / float(parameters.get("M", 1.0))


def _segments(segments: Sequence[Mapping[str, Any]]) -> Table:
    """Return a table of straight lines that meet; where they do not, both ends stand 0.02 K off."""
    T: list[float] = []
    values: list[float] = []
    for segment in segments:
        for end in segment["Temperatures"]:
            at = end if not T or end > T[-1] else T[-1] + 0.02
            T.append(float(at))
            values.append(float(segment["C0"] + segment["C1"] * end))
    return Table(form="Table", temperatures=tuple(T), values=tuple(values))


def _table(temperatures: Sequence[float], values: Sequence[float], notes: list[str]) -> Any:
    T = [float(x) for x in temperatures]
    if min(T) < _CELSIUS_BELOW:
        _once(notes, f"temperatures from {min(T):g} on are taken as degrees Celsius")
        T = [x + ICE_POINT_K for x in T]
    return Table(form="Table", temperatures=tuple(T), values=tuple(float(x) for x in values))


def _usual_unit(curve: Any, key: str, notes: list[str]) -> Any:
    """Return a heat capacity in J/(kg K), and no absorption coefficient that cannot be one."""
    if key == "Heat Capacity" and isinstance(curve, Single | Table):
        values = curve.values if isinstance(curve, Table) else (curve.value,)
        if max(values) < _KILO_BELOW:
            _once(notes, f"{key} below {_KILO_BELOW:g} is taken in kJ/(kg K)")
            scaled = tuple(1e3 * x for x in values)
            if isinstance(curve, Table):
                return curve.model_copy(update={"values": scaled})
            return single(scaled[0])
    if key == "Absorption" and isinstance(curve, Single) and curve.value <= 1.0:
        _once(notes, f"{key} {curve.value:g} is no absorption coefficient in 1/m: taken as none")
        return NOTHING
    return curve


def _opaque(key: str, form: str, network: Network, notes: list[str]) -> list[Any]:
    if key != "Absorption":
        raise UnknownFormError(f"the form '{form}'")
    _once(notes, f"not expressible: {key} of the form '{form}': taken as none")
    return [NOTHING] * len(network.names)


def _once(notes: list[str], note: str) -> None:
    if note not in notes:
        notes.append(note)
