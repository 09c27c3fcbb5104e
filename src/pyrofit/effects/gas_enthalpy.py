"""The gas takes up heat in the hot layers that it passes on its way to the front."""

from pyrofit.effects.base import Effect, Quantity, on

EFFECT = Effect(
    title="enthalpy of the gas",
    family="material",
    group="heat of the gas",
    equation="rho c dT/dt = ... + c_g G dT/dz, G(z) = gas released behind z per area and time",
    strength={
        "specific_heat_J_kgK": Quantity(
            symbol="c_g",
            label="specific heat of the gas",
            unit="J/(kg K)",
            lower=0.0,
            upper=4000.0,
            value=0.0,
            typical=1800.0,
            source="assumed range; ThermaKin and Gpyro count this heat. Hydrocarbons of 1 to 8 "
            "carbon atoms have about 1880 J/(kg K) at 400 to 500 K",
        )
    },
    experiment=on("sample", {"gas_specific_heat_J_kgK": "specific_heat_J_kgK"}),
    of_sample=True,
)
