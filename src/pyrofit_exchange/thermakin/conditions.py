"""Conditions ``.cnd`` of ThermaKin, one file for each test.

ThermaKin's surfaces emit eps sigma T^4, so that the radiation of the surroundings is part of the
external one: q + sigma T_wall^4.
"""

import numpy as np

from pyrofit.constants import STEFAN_BOLTZMANN
from pyrofit.model.base import value_of
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.material import Material
from pyrofit.model.slab import SlabExperiment
from pyrofit_exchange.fds.exposure import STEP_S, FdsSurroundings, surroundings
from pyrofit_exchange.fds.heated import virgin
from pyrofit_exchange.fds.layers import FdsLayer, own_layers
from pyrofit_exchange.fds.materials import Values
from pyrofit_exchange.fds.namelists import nine_digits
from pyrofit_exchange.fds.predicted import PredictedByPyrofit
from pyrofit_exchange.fds.remarks import Remark, once
from pyrofit_exchange.fds.slab import virgin_emissivity
from pyrofit_exchange.fds.unwritten import unwritten
from pyrofit_exchange.thermakin.components import BACK, FOIL, GAS, Components

THIN_M, FACE_M = 1e-5, 2.5e-5
"""Thickness of a heated sample, and of the face that has the back's emissivity."""
ELEMENT_M = 5e-5
TGA_ENDS_K = 900.0
LONG_S = 1e5


def slab_conditions(
    experiment: SlabExperiment,
    material: Material,
    values: Values,
    components: Components,
    predicted: PredictedByPyrofit,
) -> tuple[str, tuple[Remark, ...]]:
    """Return the conditions of a slab, and the inexact terms."""
    sample = experiment.sample
    layers = own_layers(sample, material, values)
    eps = virgin_emissivity(layers[0], material, values)
    outside = surroundings(experiment, values, predicted, eps, False)
    left = [r for r in unwritten(experiment, values) if "gas_specific_heat" not in r.what]
    remarks = [*left, *outside.remarks]
    if value_of(experiment.front.spread, values) or experiment.front.profile:
        what = "flux spread (front.spread, front.profile)"
        remarks.append(Remark("left out", what, "the mean flux is written"))
    programme, said = _programme(outside)
    remarks += said
    start = value_of(sample.initial_temperature_K, values)
    if sample.foil is not None:
        size = value_of(sample.foil.mass_factor, values) * value_of(sample.foil.thickness_m, values)
        layers.append(FdsLayer({FOIL: 1.0}, size))
        if value_of(sample.foil.contact_m2K_W, values):
            what = "resistance between sample and foil (sample.foil.contact_m2K_W)"
            remarks.append(Remark("left out", what, "the foil touches the sample"))
    if abs(outside.emissivity_back - components.back_emissivity) > 1e-9:
        what = f"emissivity {outside.emissivity_back:.4g} of the back (back.emissivity)"
        how = f"that of the first test, EMISSIVITY of {BACK} in the component file"
        remarks.append(Remark("approximate", what, how))
    layers.append(FdsLayer({BACK: 1.0}, FACE_M))
    parts = "\n".join(_layer(layer, components, start) for layer in layers)
    thinnest = min([ELEMENT_M, *(layer.thickness_m for layer in layers)])
    return (
        f"OBJECT TYPE:  1D\n\nOBJECT STRUCTURE\n****************\n\n{parts}\n"
        f"{_boundaries(outside, programme)}\n{_integration(thinnest, 0.01, predicted.end_s)}",
        once(remarks),
    )


def _programme(outside: FdsSurroundings) -> tuple[list[tuple[float, float]], list[Remark]]:
    """Return radiation [W/m2] and duration [s] of at most two constant parts."""
    t, q = outside.flux
    ambient = STEFAN_BOLTZMANN * outside.gas_K**4
    if np.ptp(q) <= 1e-6 * float(np.abs(q).max()):
        return [(float(q[0]) + ambient, LONG_S)], []
    step = np.flatnonzero(np.abs(np.diff(q)) > 0.0)
    if step.size == 1 and t[step[0] + 1] - t[step[0]] <= 2.0 * STEP_S:
        before, after = (float(x) + ambient for x in q[[step[0], step[0] + 1]])
        return [(before, float(t[step[0]])), (after, LONG_S)], []
    mean = float(np.trapezoid(q, t)) / float(np.ptp(t))
    remark = Remark("approximate", "flux that changes (front)", "its mean over time")
    return [(mean + ambient, LONG_S)], [remark]


def _layer(layer: FdsLayer, components: Components, start: float) -> str:
    shares = [
        f"{identifier}  {nine_digits(share * of)}\n"
        for name, share in layer.shares.items()
        for identifier, of in components.parts.get(name, ((name, 1.0),))
    ]
    return (
        f"THICKNESS:  {nine_digits(layer.thickness_m)}\nTEMPERATURE:  {nine_digits(start)}\n"
        f"MASS FRACTIONS:\n{''.join(shares)}"
    )


def _side(name: str, mass: str, T: str, h: float, radiation: list[tuple[float, float]]) -> str:
    parts = [*radiation, (0.0, 0.0)][:2]
    shown = "EXTERNAL RADIATION:  NO\n"
    if radiation:
        shown = "EXTERNAL RADIATION:  YES\n"
        for n, (q, duration) in enumerate(parts, 1):
            shown += f"TIME PROG{n}:  {nine_digits(q)}  0  {nine_digits(duration)}\n"
        shown += "REPEAT:  NO\nABSORPTION MODE:  RAND\n"
    return (
        f"{name} BOUNDARY\n\n{mass}\nOUTSIDE TEMP TIME PROG:  {T}\n"
        f"CONVECTION COEFF:  {nine_digits(h)}\n\n{shown}\nFLAME:  NO\n\n"
    )


def _boundaries(outside: FdsSurroundings, front: list[tuple[float, float]]) -> str:
    gas, back = (f"{nine_digits(T)}  0" for T in (outside.gas_K, outside.back_K))
    ambient = [(STEFAN_BOLTZMANN * outside.back_K**4, LONG_S)]
    behind = ambient if outside.emissivity_back else []
    return (
        "OBJECT BOUNDARIES\n*****************\n\n"
        + _side("TOP", f"MASS TRANSPORT:  YES\n{GAS}  LIN  0.05  0\n", gas, outside.h_front, front)
        + _side("BOTTOM", "MASS TRANSPORT:  NO\n", back, outside.h_back or 0.0, behind)
    )


def _integration(element: float, step: float, end: float) -> str:
    return (
        "INTEGRATION PARAMETERS\n**********************\n\n"
        f"ELEMENT SIZE:  {nine_digits(element)}\nTIME STEP:     {nine_digits(step)}\n"
        f"DURATION:      {nine_digits(end)}\n\n"
        "OUTPUT FREQUENCY:\nELEMENTS:    10\nTIME STEPS:  100\n"
    )


def heated_conditions(
    experiment: HeatedExperiment, material: Material, values: Values, components: Components
) -> str:
    """Return the conditions of a heated sample: a film in gas that heats up."""
    start, rate = experiment.start_temperature_K, experiment.heating_rate_K_min / 60.0
    film = _layer(virgin(material, values)._replace(thickness_m=THIN_M), components, start)
    T = f"{nine_digits(start)}  {nine_digits(rate)}"
    sides = _side("TOP", f"MASS TRANSPORT:  YES\n{GAS}  LIN  0.05  0\n", T, 1e5, [])
    sides += _side("BOTTOM", "MASS TRANSPORT:  NO\n", T, 1e5, [])
    step = round(min(0.5, 0.05 / rate), 6)
    return (
        f"OBJECT TYPE:  1D\n\nOBJECT STRUCTURE\n****************\n\n{film}\n"
        f"OBJECT BOUNDARIES\n*****************\n\n{sides}"
        + _integration(THIN_M, step, round((TGA_ENDS_K - start) / rate))
    )
