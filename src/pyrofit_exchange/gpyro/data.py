"""Input files of Gpyro, one for each slab and one for all heating rates."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from pyrofit.model.base import value_of
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.material import Material
from pyrofit.model.slab import Foil, SlabExperiment
from pyrofit_exchange.fds.exposure import FdsSurroundings, surroundings
from pyrofit_exchange.fds.heated import virgin
from pyrofit_exchange.fds.layers import COPPER_W_MK, FdsLayer, own_layers
from pyrofit_exchange.fds.materials import Values, reached_components
from pyrofit_exchange.fds.namelists import Namelist
from pyrofit_exchange.fds.predicted import PredictedByPyrofit
from pyrofit_exchange.fds.properties import tabulated
from pyrofit_exchange.fds.remarks import Remark, once
from pyrofit_exchange.fds.slab import virgin_emissivity
from pyrofit_exchange.fds.unwritten import unwritten
from pyrofit_exchange.fitted_forms import power_law, remark_on
from pyrofit_exchange.gpyro.grid import CLOSE, MOST, Grid, grid_of
from pyrofit_exchange.gpyro.groups import (
    T_REF_K,
    Items,
    boundaries,
    general,
    geometry,
    initial,
    numbered_keys,
    output,
    reactions,
    species,
    unused,
)
from pyrofit_exchange.steps import StepReaction, left_out, steps_of

R_GPYRO = 8.314
OPAQUE_1_M = 9e9
FOIL, COPPER_J_KGK = "foil", 380.0
COLDER_K = 0.1
"""By which the gas behind is colder than the sample at its start."""
TGA_ENDS_K = 900.0


class Data(NamedTuple):
    """A file of Gpyro: its lines, and the inexact terms."""

    namelists: tuple[Namelist, ...]
    remarks: tuple[Remark, ...]


def slab_data(
    name: str,
    experiment: SlabExperiment,
    material: Material,
    values: Values,
    predicted: PredictedByPyrofit,
) -> Data:
    """Return the file of a slab.

    The foil is the half cell at the back, with its heat capacity. Gas and walls of the front are
    one temperature, the rest is part of QE, as for FDS.
    """
    sample = experiment.sample
    layers, remarks = _thick_enough(own_layers(sample, material, values))
    foil = _foil_heat(sample.foil, values)
    grid = grid_of(layers, foil > 0.0)
    present = reached_components(material, [n for layer in layers for n in layer.shares])
    eps = virgin_emissivity(layers[0], material, values)
    start = value_of(sample.initial_temperature_K, values)
    outside = _not_warmer_behind(surroundings(experiment, values, predicted, eps, False), start)
    length = value_of(sample.absorption_length_m, values)
    bodies, inexact = all_species(material, values, present, length)
    remarks += [*inexact, *_unwritten(experiment, values), *outside.remarks]
    remarks += _left_out(experiment, values, outside, eps)
    remarks += _moved(grid)
    steps = steps_of(material, values, present, R_GPYRO)
    remarks += [*_orders(steps, layers), *left_out(material, values)]
    gas_heat = value_of(sample.gas_specific_heat_J_kgK, values)
    if foil > 0.0:
        bodies.append(_foil(foil, grid.foil_m, outside.emissivity_back or eps))
        layers, present = [*layers, FdsLayer({FOIL: 1.0}, grid.foil_m)], [*present, FOIL]
    end: Items = {"TSTOP(1)": predicted.end_s, "ZEROD(1)": False, "BETA(1)": 0}
    namelists = (
        general(0.02, outside.gas_K, bodies),
        output(name, ["MLR", "TEMPERATURE", "TEMPERATURE"], [0.0, 0.0, grid.depth_m]),
        Namelist("GPYRO_SPROPS", numbered_keys("NSSPEC", bodies)),
        *reactions(steps, gas_heat),
        Namelist("GPYRO_CASES", {"NCASES": 1, "IMESH(1)": 1, **end}),
        *unused(),
        initial(layers, present, start),
        Namelist("GPYRO_ALLBC", numbered_keys("NSURF_IDX", boundaries(outside))),
        Namelist("GPYRO_GEOM", geometry(grid, (0, 0, 0, 0, 1, 2))),
    )
    return Data(namelists, once(remarks))


def heated_data(
    name: str, experiments: Sequence[HeatedExperiment], material: Material, values: Values
) -> Data:
    """Return the file of all heating rates: one case of no dimension for each."""
    layer = virgin(material, values)._replace(thickness_m=1.0)
    present = reached_components(material, list(layer.shares))
    bodies, remarks = all_species(material, values, present, 0.0)
    remarks += left_out(material, values)
    steps = steps_of(material, values, present, R_GPYRO)
    rates = sorted({e.heating_rate_K_min for e in experiments})
    start = experiments[0].start_temperature_K
    cases: Items = {"NCASES": len(rates)}
    for n, rate in enumerate(rates, 1):
        stop = round(60.0 * (TGA_ENDS_K - start) / rate, 3)
        cases |= {f"IMESH({n})": 1, f"TSTOP({n})": stop, f"ZEROD({n})": True, f"BETA({n})": rate}
    mesh = geometry(Grid(1, 1.0, (0.0,), 0.0), (1,) * 6)
    namelists = (
        general(0.1, start, bodies),
        output(name, ["MLR", "M/M0"], [0.0, 0.0]),
        Namelist("GPYRO_SPROPS", numbered_keys("NSSPEC", bodies)),
        *reactions(steps, 0.0),
        Namelist("GPYRO_CASES", cases),
        *unused(),
        initial([layer], present, start),
        Namelist(
            "GPYRO_ALLBC", numbered_keys("NSURF_IDX", boundaries(FdsSurroundings.still(start)))
        ),
        Namelist("GPYRO_GEOM", mesh),
    )
    return Data(namelists, once([*remarks, *_orders(steps, [layer])]))


def _not_warmer_behind(outside: FdsSurroundings, start_K: float) -> FdsSurroundings:
    """Return surroundings whose back is colder than the sample at its start.

    Gpyro 0.82 sets the flux of the front to zero while net radiation enters the back, be it by
    rounding of equal temperatures.
    """
    if outside.is_insulated or outside.back_K <= start_K - COLDER_K:
        return outside
    what = f"gas behind at {outside.back_K:g} K (back.gas_temperature_K, back.wall_temperature_K)"
    how = (
        f"{start_K - COLDER_K:g} K, colder than the sample; Gpyro 0.82 drops the front's flux else"
    )
    remarks = (*outside.remarks, Remark("approximate", what, how))
    return outside._replace(back_K=start_K - COLDER_K, remarks=remarks)


def _left_out(
    experiment: SlabExperiment, values: Values, outside: FdsSurroundings, eps: float
) -> Iterator[Remark]:
    """Yield the parts of a slab that Gpyro lacks or treats otherwise."""
    sample = experiment.sample
    if value_of(experiment.front.spread, values) > 0.0 or experiment.front.profile:
        what = "flux spread (front.spread, front.profile)"
        yield Remark("left out", what, "the mean flux is written")
    if value_of(sample.surface_share, values):
        what = "in-depth absorption of one band only (sample.surface_share)"
        yield Remark("left out", what, "all radiation is absorbed in depth")
    if sample.foil is not None and value_of(sample.foil.contact_m2K_W, values) > 0.0:
        what = "resistance between sample and foil (sample.foil.contact_m2K_W)"
        yield Remark("left out", what, "the foil touches the sample")
    if (
        sample.foil is None
        and not outside.is_insulated
        and abs(outside.emissivity_back - eps) > 1e-3
    ):
        what = "emissivity of the back (back.emissivity)"
        yield Remark("left out", what, "that of the material in the last cell counts")


def _unwritten(experiment: SlabExperiment, values: Values) -> Iterator[Remark]:
    """Yield the parts that both FDS and Gpyro lack; Gpyro has the enthalpy of the gas."""
    sample = experiment.sample.model_copy(update={"gas_specific_heat_J_kgK": 0.0})
    yield from unwritten(experiment.model_copy(update={"sample": sample}), values)


def _thick_enough(layers: list[FdsLayer]) -> tuple[list[FdsLayer], list[Remark]]:
    """Return the layers that have two cells of the finest grid, and name the others."""
    cell = sum(layer.thickness_m for layer in layers) / MOST
    kept = [layer for layer in layers if layer.thickness_m >= 2.0 * cell]
    return kept, [
        Remark(
            "left out",
            f"layer of {layer.thickness_m:.3g} m of {', '.join(layer.shares)} (sample)",
            f"thinner than two cells of a grid of {MOST} nodes",
        )
        for layer in layers
        if layer not in kept
    ]


def _moved(grid: Grid) -> list[Remark]:
    """Name an error of a thickness: layers end halfway between nodes."""
    if grid.worst <= CLOSE:
        return []
    how = f"to {100.0 * grid.worst:.2g} % of it: layers end halfway between {grid.nodes} nodes"
    return [Remark("approximate", "thickness of a layer (sample)", how)]


def _foil_heat(foil: Foil | None, values: Values) -> float:
    """Return the heat capacity of the foil [J/(m2 K)], 0 without one."""
    if foil is None:
        return 0.0
    mass = value_of(foil.mass_factor, values) * value_of(foil.thickness_m, values)
    mass *= value_of(foil.density_kg_m3, values)
    return mass * value_of(foil.specific_heat_J_kgK, values)


def _foil(heat: float, thickness: float, emissivity: float) -> Items:
    """Return a body of a thickness [m] that has the heat capacity of the foil."""
    k, c = (COPPER_W_MK, 0.0), (COPPER_J_KGK, 0.0)
    density = heat / (COPPER_J_KGK * thickness)
    return species(FOIL, k, density, c, emissivity, OPAQUE_1_M)


def _orders(steps: list[StepReaction], layers: list[FdsLayer]) -> list[Remark]:
    """Name orders of products, whose initial mass is another one in Gpyro."""
    virgin = {n for layer in layers for n in layer.shares}
    return [
        Remark("approximate", f"order {s.order:.4g} of '{s.reactant}'", "Gpyro counts the products")
        for s in steps
        if s.order != 1.0 and s.reactant not in virgin
    ]


def all_species(
    material: Material, values: Values, present: list[str], length: float
) -> tuple[list[Items], list[Remark]]:
    """Return the properties of components, each as phi0 (T/T_ref)^n."""
    found: list[Items] = []
    remarks = []
    for name in present:
        of = material.components[name]
        k, c = (
            power_law(tabulated(p, values), T_REF_K)
            for p in (of.conductivity_W_mK, of.specific_heat_J_kgK)
        )
        power = "phi0 (T/300)^n"
        remarks += remark_on(k, f"conductivity of '{name}' (conductivity_W_mK)", power)
        remarks += remark_on(c, f"specific heat of '{name}' (specific_heat_J_kgK)", power)
        if np.any(np.abs(tabulated(of.expansion, values) - 1.0) > 1e-9):
            what = f"swelling of '{name}' (components.{name}.expansion)"
            remarks.append(Remark("left out", what, "not written"))
        kappa = value_of(of.absorption_1_m or 0.0, values)
        if length > 0.0 and name in material.own:
            kappa = 1.0 / length
        density, eps = value_of(of.density_kg_m3, values), value_of(of.emissivity, values)
        found.append(
            species(name, k.coefficients, density, c.coefficients, eps, kappa or OPAQUE_1_M)
        )
    return found, remarks
