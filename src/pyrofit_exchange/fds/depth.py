"""Radiation absorbed in depth, in FDS's two-flux model."""

from pyrofit.model.base import value_of
from pyrofit.model.material import Material
from pyrofit.model.slab import Sample
from pyrofit_exchange.fds.materials import Values
from pyrofit_exchange.fds.remarks import Remark

TWO_FLUX = 0.4
"""FDS's absorption coefficient over 1/l. Its two fluxes lose 2 kappa; radiation emitted inside
conducts heat, and the conductivity is lowered by that."""


def absorption(
    sample: Sample, material: Material, values: Values
) -> tuple[dict[str, float], list[Remark]]:
    """Return the absorption coefficients of FDS [1/m] by component; empty where opaque."""
    length = value_of(sample.absorption_length_m, values)
    given = {
        name: 1.0 / length if length > 0.0 else value_of(component.absorption_1_m or 0.0, values)
        for name, component in material.components.items()
        if name in material.own
    }
    kappa = {name: TWO_FLUX * of for name, of in given.items() if of > 0.0}
    if not kappa:
        return {}, []
    remarks = [
        Remark(
            "approximate",
            "in-depth absorption (sample.absorption_length_m, absorption_1_m)",
            "two-flux model with 0.4/l, conductivity less 4 sigma T^3/kappa; 2 to 4 % of the rate",
        )
    ]
    share = value_of(sample.surface_share, values)
    if share >= 1.0:
        return {}, []
    if share > 0.0:
        how = f"one band with the same mean depth, {1.0 - share:.3g} of the length"
        what = "in-depth absorption of one band only (sample.surface_share)"
        remarks.append(Remark("approximate", what, how))
        kappa = {name: of / (1.0 - share) for name, of in kappa.items()}
    if not sample.back_absorbs:
        how = "the back face or foil of FDS absorbs it"
        what = "in-depth absorption with transmission lost (sample.transmitted)"
        remarks.append(Remark("left out", what, how))
    return kappa, remarks
