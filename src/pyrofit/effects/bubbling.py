"""Bubbles grow in the material: it swells, conducts less, and lets less radiation through."""

from pyrofit.effects.base import Effect, Quantity
from pyrofit.effects.substance import properties_changed, together

_FORM = {"step_temperature_K": "temperature_K", "step_width_K": "width_K"}
EFFECT = Effect(
    title="bubbling",
    family="material",
    group="swelling",
    equation="V(T) = V_0 (1 + s S), k(T) = k / (1 + a s S), kappa d = kappa_0 V, "
    "S = 1 / (1 + exp(-(T - T_b)/w))",
    strength={
        "volume": Quantity(
            symbol="s",
            label="volume of the bubbles divided by that of the solid",
            unit="-",
            lower=0.0,
            upper=3.0,
            value=0.0,
            typical=0.3,
            source="assumed range; up to 3 quarters of the volume are bubbles; in PMMA: "
            "Vincent et al. 2024, Fire 7, 117",
        )
    },
    form={
        "temperature_K": Quantity(
            symbol="T_b",
            label="temperature of bubbling",
            unit="K",
            lower=350.0,
            upper=700.0,
            value=550.0,
            typical=500.0,
        ),
        "width_K": Quantity(
            symbol="w",
            label="width of bubbling",
            unit="K",
            lower=5.0,
            upper=60.0,
            value=15.0,
            typical=40.0,
        ),
        "thinning": Quantity(
            symbol="a",
            label="coefficient of the conductivity (0: unchanged, 1: as the share of solid)",
            unit="-",
            lower=0.0,
            upper=1.5,
            value=1.0,
            typical=0.5,
            source="1 = in proportion to the share of solid, 1.5 = few small bubbles (Maxwell), "
            "less = radiation within the bubbles conducts, too",
        ),
    },
    components=together(
        properties_changed("expansion", step="volume", **_FORM),
        properties_changed("conductivity_W_mK", scale="volume", thinning="thinning", **_FORM),
        # ASSUME: bubbles scatter so that a length absorbs as much as before.
        properties_changed("absorption_factor", step="volume", **_FORM),
    ),
)
