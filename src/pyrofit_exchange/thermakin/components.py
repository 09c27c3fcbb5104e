"""Component files ``.cmp`` of ThermaKin; heats are negative where heat is taken up."""

from typing import NamedTuple

import numpy as np

from pyrofit.model.base import value_of
from pyrofit.model.material import Material
from pyrofit_exchange.fds.materials import Values, first_order_parts
from pyrofit_exchange.fds.namelists import nine_digits, unique
from pyrofit_exchange.fds.orders import same_half_time
from pyrofit_exchange.fds.properties import tabulated
from pyrofit_exchange.fds.remarks import Remark, once
from pyrofit_exchange.fitted_forms import quadratic, remark_on
from pyrofit_exchange.steps import left_out, steps_of

R_THERMAKIN = 8.314
OPAQUE_M2_KG = 1e4
"""Absorption of an opaque component, as in ThermaKin's samples."""
GAS, FOIL, BACK = "GAS", "FOIL", "BACK_FACE"
SOLID_TRANSPORT, NO_TRANSPORT = 2e-5, 1e-30


class Components(NamedTuple):
    """The component file, the parts that stand for components, the inexact terms, and the back."""

    text: str
    parts: dict[str, tuple[tuple[str, float], ...]]
    remarks: tuple[Remark, ...]
    back_emissivity: float


def component_file(
    material: Material,
    values: Values,
    length_m: float,
    gas_heat: float,
    foil: tuple[float, float],
    back_emissivity: float,
) -> Components:
    """Return the components and reactions of a material.

    Parameters
    ----------
    material, values
        The description and its numbers, SI units.
    length_m
        Absorption length of all its components; 0 = theirs.
    gas_heat
        Specific heat of the gas [J/(kg K)]; 0 = it takes no heat with it.
    foil
        Density [kg/m3] and specific heat [J/(kg K)] of a foil.
    back_emissivity
        Of the face behind sample and foil.
    """
    remarks = left_out(material, values)
    rated = {n: first_order_parts(material, values, n, remarks) for n in material.components}
    keys = {
        n: [f"{n}{k + 1}" if len(of) > 1 else n for k in range(len(of))] for n, of in rated.items()
    }
    ids = unique([key for of in keys.values() for key in of], 30)
    lines = [
        _component(ids[key], material, values, name, length_m, remarks)
        for name, of in keys.items()
        for key in of
    ]
    lines.append(_block(GAS, "G", (1000.0,), (gas_heat or 1.0,), (0.1,), 0.0, 1.0))
    density, heat = foil
    lines.append(_block(FOIL, "S", (density,), (heat,), (387.0,), 0.0, OPAQUE_M2_KG))
    lines.append(_block(BACK, "S", (1.0,), (1.0,), (100.0,), back_emissivity, OPAQUE_M2_KG))
    lines.append(
        "MIXTURES\nS SWELLING:           0\nL SWELLING:           0\nG SWELLING LIMIT:     1e-30\n"
        "PARALL CONDUCTIVITY:  1\nPARALL TRANSPORT:     0.5\n"
    )
    lines += _reactions(material, values, rated, keys, ids)
    named = {
        n: tuple((ids[k], w) for k, (w, _) in zip(keys[n], of, strict=True))
        for n, of in rated.items()
    }
    return Components("\n".join(lines), named, once(remarks), back_emissivity)


def _component(
    identifier: str,
    material: Material,
    values: Values,
    name: str,
    length_m: float,
    remarks: list[Remark],
) -> str:
    of = material.components[name]
    density = value_of(of.density_kg_m3, values)
    c, k = (quadratic(tabulated(p, values)) for p in (of.specific_heat_J_kgK, of.conductivity_W_mK))
    remarks += remark_on(
        c, f"specific heat of '{name}' (specific_heat_J_kgK)", "p0 + p1 T + p2 T^2"
    )
    remarks += remark_on(k, f"conductivity of '{name}' (conductivity_W_mK)", "p0 + p1 T + p2 T^2")
    if np.any(np.abs(tabulated(of.expansion, values) - 1.0) > 1e-9):
        what = f"swelling of '{name}' (components.{name}.expansion)"
        remarks.append(Remark("left out", what, "not written"))
    kappa = value_of(of.absorption_1_m or 0.0, values)
    if length_m > 0.0 and name in material.own:
        kappa = 1.0 / length_m
    absorption = kappa / density if kappa else OPAQUE_M2_KG
    eps = value_of(of.emissivity, values)
    return _block(identifier, "S", (density,), c.coefficients, k.coefficients, eps, absorption)


def _polynomial(p: tuple[float, ...]) -> str:
    """Return p0, p1, p2 and n of p0 + p1 T + p2 T^n."""
    p0, p1, p2 = (*p, 0.0, 0.0)[:3]
    return "  ".join([nine_digits(p0), nine_digits(p1), nine_digits(p2), "2" if p2 else "0"])


def _block(
    name: str,
    state: str,
    density: tuple[float, ...],
    c: tuple[float, ...],
    k: tuple[float, ...],
    eps: float,
    absorption: float,
) -> str:
    transport = NO_TRANSPORT if name in (FOIL, BACK) else SOLID_TRANSPORT
    return (
        f"COMPONENT:       {name}\nSTATE:           {state}\n"
        f"DENSITY:         {_polynomial(density)}\nHEAT CAPACITY:   {_polynomial(c)}\n"
        f"CONDUCTIVITY:    {_polynomial(k)}\nTRANSPORT:       {nine_digits(transport)}  0  0  0\n"
        f"EMISSIVITY & ABSORPTION:  {nine_digits(eps)}  {nine_digits(absorption)}\n"
    )


def _reactions(
    material: Material,
    values: Values,
    rated: dict[str, tuple[tuple[float, float], ...]],
    keys: dict[str, list[str]],
    ids: dict[str, str],
) -> list[str]:
    found = []
    for step in steps_of(material, values, list(rated), R_THERMAKIN):
        several = len(rated[step.reactant]) > 1
        own = 1.0 if several else same_half_time(step.order)
        product = GAS if step.product is None else ids[keys[step.product][0]]
        for key, (_, rate) in zip(keys[step.reactant], rated[step.reactant], strict=True):
            found.append(
                f"REACTION:       {ids[key]} + NOCOMP -> {product} + NOCOMP\n"
                "STOICHIOMETRY:  1    0         1    0\n"
                f"ARRHENIUS:      {nine_digits(step.A_1_s * rate * own)}  "
                f"{nine_digits(step.E_J_mol)}\n"
                f"HEAT:           {nine_digits(-step.heat_J_kg)}  0  0  0\n"
                "TEMP LIMIT:     L  250\n"
            )
    return found
