"""The gas around a sample: SPEC lines, and the reactions that its oxygen lets run."""

from typing import NamedTuple

from pyrofit.model.base import value_of
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.material import Material
from pyrofit.model.slab import SlabExperiment
from pyrofit_exchange.fds.materials import Values
from pyrofit_exchange.fds.namelists import Namelist
from pyrofit_exchange.fds.remarks import Remark

OXYGEN_G_MOL, NITROGEN_G_MOL = 31.9988, 28.0134


class Around(NamedTuple):
    """The gas around a sample as its deck has it.

    Parameters
    ----------
    material
        The material with the reactions that run in this gas.
    species
        SPEC lines.
    remarks
        The terms that are not written exactly.
    """

    material: Material
    species: tuple[Namelist, ...]
    remarks: tuple[Remark, ...] = ()


def gas_around(
    experiment: HeatedExperiment | SlabExperiment, material: Material, values: Values
) -> Around:
    """Return the gas of an experiment, of X oxygen by volume in nitrogen.

    Where FDS knows no species OXYGEN it leaves the factor X^N_O2 out, and the reaction runs as in
    pure oxygen. So reactions with oxygen are left out of the decks of tests without it.
    """
    fuel = Namelist("SPEC", {"ID": "METHANE"})
    oxygen = value_of(experiment.oxygen, values)
    if not material.oxidises:
        return Around(material, (fuel,))
    if oxygen == 0.0:
        return Around(without_oxidation(material, values), (fuel,))
    if isinstance(experiment, SlabExperiment) and experiment.burning() is not None:
        how = "the flame keeps oxygen away for a time, which FDS's solid phase alone does not know"
        remark = Remark("left out", "oxidation before ignition and after flame-out (oxygen)", how)
        return Around(without_oxidation(material, values), (fuel,), (remark,))
    mass = OXYGEN_G_MOL * oxygen / (OXYGEN_G_MOL * oxygen + NITROGEN_G_MOL * (1.0 - oxygen))
    species = (
        Namelist("SPEC", {"ID": "NITROGEN", "BACKGROUND": True}),
        Namelist("SPEC", {"ID": "OXYGEN", "MASS_FRACTION_0": round(mass, 9)}),
        fuel,
    )
    how = "FDS takes that of its gas at the surface, and later versions count no depth in ash"
    return Around(material, species, (Remark("approximate", "oxygen of reactions (oxygen)", how),))


def without_oxidation(material: Material, values: Values) -> Material:
    """Return the material without the reactions that need oxygen."""
    kept = {n: r for n, r in material.reactions.items() if not value_of(r.oxygen_order, values)}
    return material.model_copy(update={"reactions": kept})
