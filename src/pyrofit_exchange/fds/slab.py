"""A deck of one gasification experiment, of the solid alone."""

from typing import NamedTuple

import numpy as np

from pyrofit.model.base import value_of
from pyrofit.model.material import Material
from pyrofit.model.slab import EmissivityDepth, SlabExperiment
from pyrofit.quantities.units import ICE_POINT_K
from pyrofit_exchange.fds.depth import absorption
from pyrofit_exchange.fds.exposure import FdsSurroundings, Flux, surroundings
from pyrofit_exchange.fds.gases import gas_around
from pyrofit_exchange.fds.layers import FdsLayer, foil_layers, layer_keys, own_layers
from pyrofit_exchange.fds.materials import MaterialLines, Options, Values, write_materials
from pyrofit_exchange.fds.namelists import Item, Namelist
from pyrofit_exchange.fds.predicted import PredictedByPyrofit
from pyrofit_exchange.fds.records import CELL_M, closing
from pyrofit_exchange.fds.remarks import Remark, once
from pyrofit_exchange.fds.spots import spots_of
from pyrofit_exchange.fds.unwritten import unwritten
from pyrofit_exchange.fds.versions import Version

STRONG_W_M2 = 40e3
"""Flux from which on the time step is halved."""
WEAK_STEP_S = 0.02
FINE, FINER = 0.2, 0.1
"""CELL_SIZE_FACTOR of uniform cells; the smaller one where residue collects."""
MUCH_RESIDUE = 0.02
LEAST_EMISSIVITY = 1e-6


class Deck(NamedTuple):
    """An input file.

    Parameters
    ----------
    name
        Identifier of the run.
    title
        Its description.
    namelists
        Its lines.
    remarks
        The terms that are not written exactly.
    weights
        Weights of the spots of the surface under different fluxes.
    step_s
        Time step; 0 = FDS's own.
    """

    name: str
    title: str
    namelists: tuple[Namelist, ...]
    remarks: tuple[Remark, ...]
    weights: tuple[float, ...] = (1.0,)
    step_s: float = 0.0


def slab_deck(
    name: str,
    experiment: SlabExperiment,
    material: Material,
    values: Values,
    version: Version,
    predicted: PredictedByPyrofit,
) -> Deck:
    """Return the deck of a slab: uniform cells, a fixed time step, everything else given.

    Parameters
    ----------
    name
        Identifier of the run.
    experiment, material, values
        The description and its numbers, SI units.
    version
        Version of FDS.
    predicted
        pyrofit's curves, which tell how long the test is.
    """
    sample = experiment.sample
    around = gas_around(experiment, material, values)
    material = around.material
    kappa, remarks = absorption(sample, material, values)
    layers = own_layers(sample, material, values)
    names = [n for layer in layers for n in layer.shares]
    lines = write_materials(material, values, names, Options(version, absorption_1_m=kappa))
    emissivity = virgin_emissivity(layers[0], material, values)
    outside = surroundings(experiment, values, predicted, emissivity, version.cube_root)
    foil, more = foil_layers(sample.foil, values, outside.emissivity_back, bool(kappa))
    factor, of_cells = _cells(experiment, material, values, lines)
    spots = spots_of(experiment, values)
    weak = float(outside.flux.value_W_m2.max()) < STRONG_W_M2
    step = WEAK_STEP_S if weak else 0.5 * WEAK_STEP_S
    surfaces = _surfaces(layers + foil, lines, experiment, values, outside, version, factor, spots)
    found = [*around.remarks, *remarks, *lines.remarks, *outside.remarks, *of_cells]
    found += unwritten(experiment, values)
    return Deck(
        name,
        experiment.title or name,
        (
            *_head(name, experiment.title, outside, predicted, version, step, len(spots)),
            *around.species,
            *lines.namelists,
            *more,
            *surfaces,
            *closing(len(spots)),
        ),
        once(found),
        tuple(w for _, w in spots),
        step,
    )


def virgin_emissivity(layer: FdsLayer, material: Material, values: Values) -> float:
    """Return the emissivity of the virgin front, by volume as pyrofit mixes it."""
    parts = [(material.components[n], w) for n, w in layer.shares.items()]
    volumes = [w / value_of(c.density_kg_m3, values) for c, w in parts]
    own = [value_of(c.emissivity, values) for c, _ in parts]
    return float(np.average(own, weights=volumes))


def _cells(
    experiment: SlabExperiment, material: Material, values: Values, lines: MaterialLines
) -> tuple[float, list[Remark]]:
    """Return CELL_SIZE_FACTOR; where emissivities differ, the surface cell counts."""
    written = [material.components[n] for n in lines.parts if n in material.own]
    emissivities = {round(value_of(c.emissivity, values), 9) for c in written}
    yields = [
        value_of(nu, values)
        for r in material.reactions.values()
        if r.reactant in lines.parts
        for nu in r.products.values()
    ]
    factor = FINER if max(yields, default=0.0) > MUCH_RESIDUE else FINE
    if len(emissivities) < 2:
        return factor, []
    depth = experiment.sample.emissivity_depth
    if isinstance(depth, EmissivityDepth):
        return value_of(depth.cell_size_factor, values), []
    how = "FDS takes that of its surface cell; `emissivity_depth: {cell_size_factor: 0.2}` is alike"
    what = "depth over which the emissivity is averaged (sample.emissivity_depth)"
    return factor, [Remark("approximate", what, how)]


def _head(
    name: str,
    title: str,
    outside: FdsSurroundings,
    predicted: PredictedByPyrofit,
    version: Version,
    step: float,
    spots: int,
) -> list[Namelist]:
    cells = max(3, spots)
    width = 0.5 * CELL_M * cells
    time: dict[str, Item] = {"T_END": predicted.end_s, "DT": step, "WALL_INCREMENT": 1}
    if version.locks_step:
        time["LOCK_TIME_STEP"] = True
    # Some readers of input files take a slash for the end of a namelist, quoted or not.
    plain = title.replace("/", " per ").replace("²", "2").replace("³", "3")
    ascii_title = plain.encode("ascii", "ignore").decode() or name
    corners = [-width, width, -0.15, 0.15, 0.0, 0.3]
    return [
        Namelist("HEAD", {"CHID": name, "TITLE": ascii_title[:60]}),
        Namelist("MESH", {"IJK": [cells, 3, 3], "XB": corners}),
        Namelist("TIME", time),
        Namelist("MISC", {"SOLID_PHASE_ONLY": True, "TMPA": _celsius(outside.gas_K)}),
    ]


def _celsius(T: float) -> float:
    return round(T - ICE_POINT_K, 9)


def _surfaces(
    layers: list[FdsLayer],
    lines: MaterialLines,
    experiment: SlabExperiment,
    values: Values,
    outside: FdsSurroundings,
    version: Version,
    factor: float,
    spots: list[tuple[float, float]],
) -> list[Namelist]:
    start = _celsius(value_of(experiment.sample.initial_temperature_K, values))
    common = {
        "COLOR": "BLACK",
        **layer_keys(layers, lines),
        **_fineness(layers, lines, factor, version),
        # For every layer: TMP_INNER alone sets the first one only.
        f"TMP_INNER(1:{len(layers)})": [start] * len(layers),
        "HEAT_TRANSFER_COEFFICIENT": outside.h_front,
        **_backing(outside, version),
    }
    found = []
    for n, (multiple, _) in enumerate(spots):
        mark = "" if len(spots) == 1 else f"_{n + 1}"
        flux, ramp = _external(_under(outside, multiple), f"EF{mark}")
        found.append(Namelist("SURF", {"ID": f"SLAB{mark}", **common, **flux}))
        found += ramp
    return found


def _fineness(
    layers: list[FdsLayer], lines: MaterialLines, factor: float, version: Version
) -> dict[str, Item | list[Item]]:
    """Return the fineness of the cells: one number up to 6.7, one for each layer later."""
    described = sum(set(layer.shares) <= set(lines.parts) for layer in layers)
    if version.locks_step and described > 1:
        return {f"CELL_SIZE_FACTOR(1:{len(layers)})": [factor] * len(layers)}
    return {"CELL_SIZE_FACTOR": factor}


def _under(outside: FdsSurroundings, multiple: float) -> Flux:
    """Return the flux at a spot that gets a multiple of the heater's flux."""
    heater = outside.heater_W_m2
    return Flux(outside.flux.time_s, outside.flux.value_W_m2 + (multiple - 1.0) * heater)


def _backing(outside: FdsSurroundings, version: Version) -> dict[str, Item]:
    if outside.is_insulated:
        return {"BACKING": "INSULATED"}
    convection: dict[str, Item] = (
        {"C_VERTICAL": outside.cube_root, "C_HORIZONTAL": outside.cube_root}
        if outside.h_back is None
        else {"HEAT_TRANSFER_COEFFICIENT_BACK": outside.h_back}
    )
    return {
        "BACKING": "VOID",
        version.back_gas: _celsius(outside.back_K),
        "EMISSIVITY_BACK": max(outside.emissivity_back, LEAST_EMISSIVITY),
        **convection,
    }


def _external(flux: Flux, ramp: str) -> tuple[dict[str, Item], list[Namelist]]:
    """Return the keys of the external flux, and its ramp where it changes."""
    q = 1e-3 * flux.value_W_m2
    if np.ptp(q) <= 1e-9 * abs(float(q[0])):
        return {"EXTERNAL_FLUX": float(q[0])}, []
    most = float(np.abs(q).max())
    lines = [
        Namelist("RAMP", {"ID": ramp, "T": float(t), "F": float(x)})
        for t, x in zip(flux.time_s, q / most, strict=True)
    ]
    return {"EXTERNAL_FLUX": most, "RAMP_EF": ramp}, lines
