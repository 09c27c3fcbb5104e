"""A deck of one heating rate: TGA_ANALYSIS."""

from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.material import Material
from pyrofit.quantities.units import ICE_POINT_K
from pyrofit.solver.lower import fractions
from pyrofit_exchange.fds.gases import gas_around
from pyrofit_exchange.fds.layers import FdsLayer, layer_keys
from pyrofit_exchange.fds.materials import Options, Values, write_materials
from pyrofit_exchange.fds.namelists import Namelist
from pyrofit_exchange.fds.remarks import once
from pyrofit_exchange.fds.slab import Deck
from pyrofit_exchange.fds.unwritten import unwritten_heated
from pyrofit_exchange.fds.versions import Version

THICKNESS_M = 1e-3
"""FDS replaces it."""


def heated_deck(
    name: str,
    experiment: HeatedExperiment,
    material: Material,
    values: Values,
    version: Version,
    last_K: float,
) -> Deck:
    """Return the deck of a sample that is heated at a constant rate.

    Parameters
    ----------
    name
        Identifier of the run.
    experiment, material, values
        The description and its numbers, SI units.
    version
        Version of FDS.
    last_K
        Temperature at which it ends.
    """
    around = gas_around(experiment, material, values)
    material = around.material
    layer = virgin(material, values)
    lines = write_materials(material, values, list(layer.shares), Options(version))
    start = experiment.start_temperature_K - ICE_POINT_K
    title = f"{experiment.heating_rate_K_min:g} K per min"
    surface = {
        "ID": "SAMPLE",
        "TGA_ANALYSIS": True,
        "TGA_HEATING_RATE": experiment.heating_rate_K_min,
        "TGA_FINAL_TEMPERATURE": round(last_K - ICE_POINT_K, 6),
        "COLOR": "RED",
        **{k: v for k, v in layer_keys([layer], lines).items() if "STRETCH" not in k},
    }
    namelists = (
        Namelist("HEAD", {"CHID": name, "TITLE": title}),
        Namelist("MESH", {"IJK": [3, 3, 4], "XB": [-2.0, 2.0, -2.0, 2.0, 0.0, 1.0]}),
        Namelist("TIME", {"T_END": 1.0}),
        Namelist("MISC", {"TMPA": round(start, 6)}),
        *around.species,
        *lines.namelists,
        Namelist("SURF", surface),
        Namelist("VENT", {"XB": [-1.0, 1.0, -1.0, 1.0, 0.0, 0.0], "SURF_ID": "SAMPLE"}),
        Namelist("TAIL", {}),
    )
    remarks = once([*around.remarks, *lines.remarks, *unwritten_heated(experiment, values)])
    return Deck(name, experiment.title or title, namelists, remarks)


def virgin(material: Material, values: Values) -> FdsLayer:
    """Return a thin layer of the virgin material."""
    names = list(material.components)
    share = fractions(material.composition, names, values)[:, 0]
    return FdsLayer(
        {n: float(w) for n, w in zip(names, share, strict=True) if w > 0.0}, THICKNESS_M
    )
