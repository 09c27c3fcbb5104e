"""Densities that vary with temperature: in a study, an expansion of the volume."""

from typing import Any

import numpy as np

from pyrofit.errors import DataError
from pyrofit.model.properties import PowerLaw
from pyrofit.model.properties import Table as StudyTable
from pyrofit_exchange.macfp.forms import REFERENCE_K, Line, Power, Single, number_or_none, single

_GRID_K = tuple(np.arange(250.0, 1001.0, 50.0).tolist())


def constant_of(form: Any, name: str, key: str) -> float:
    """Return the value of a constant property of a component.

    Raises
    ------
    DataError
        It varies with temperature.
    """
    if isinstance(form, Single):
        return form.value
    raise DataError(
        f"component '{name}': '{key}' varies with temperature; a study has a number for it."
    )


def density_of(form: Any, name: str) -> tuple[float, Any]:
    """Return density and expansion; a density that varies is an expansion of the volume."""
    if isinstance(form, Power):
        law = {
            "value": 1.0,
            "exponent": -form.exponent,
            "reference_temperature_K": form.reference,
        }
        return form.base, law
    if isinstance(form, Line):
        T = np.array(_GRID_K)
        density = form.intercept + form.slope * T
        at = form.intercept + form.slope * REFERENCE_K
        if density.min() <= 0.0:
            raise DataError(f"component '{name}': 'Density' falls below zero within 1000 K.")
        return at, {"temperature_K": list(_GRID_K), "value": (at / density).tolist()}
    return constant_of(form, name, "Density"), None


def density_back(component: Any) -> Any:
    """Return the density of a component as the data base has it.

    Raises
    ------
    TypeError
        The data base has no words for the expansion.
    """
    density, expansion = number_or_none(component.density_kg_m3), component.expansion
    if isinstance(expansion, int | float):
        if expansion != 1.0:
            raise TypeError("an expansion that does not vary with temperature")
        return single(density)
    if isinstance(expansion, PowerLaw) and number_or_none(expansion.value) == 1.0:
        return Power(
            form="Gpyro Power Law",
            base=density,
            exponent=-number_or_none(expansion.exponent),
            reference=number_or_none(expansion.reference_temperature_K),
        )
    if isinstance(expansion, StudyTable):
        T = np.array(expansion.temperature_K)
        rho = density / np.array([number_or_none(v) for v in expansion.value])
        slope = (rho[-1] - rho[0]) / (T[-1] - T[0])
        if np.allclose(rho, rho[0] + slope * (T - T[0]), rtol=1e-9):
            return Line(form="Linear", slope=float(slope), intercept=float(rho[0] - slope * T[0]))
    raise TypeError("this expansion")
