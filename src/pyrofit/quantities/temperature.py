"""Shared parts of all temperatures of a sample; no quantity by itself."""

from pyrofit.quantities.base import Quantity, Shown
from pyrofit.quantities.units import ICE_POINT_K


def temperature(
    place: str,
    headers: tuple[str, ...],
    pattern: str,
    kinds: tuple[str, ...] = ("gasification",),
    uncertainty_headers: tuple[str, ...] = (),
) -> Quantity:
    """Return the temperature of a place in or on the sample."""
    name = f"{place.replace(' ', '_').replace('-', '_')}_temperature"
    return Quantity(
        kinds=kinds,
        title=f"{place} temperature",
        symbol=f"T_{place.split()[0]}",
        unit="K",
        column=f"{name}_K",
        uncertainty_column=f"{name}_uncertainty_K",
        shown=Shown("°C", 1.0, -ICE_POINT_K),
        scales=("temperature",),
        headers=headers,
        uncertainty_headers=uncertainty_headers,
        pattern=pattern,
        guess=lambda first, largest: "degC" if first < 200.0 else "K",
        largest=(200.0, 2500.0),
        all_within=True,
        solver_error=1e-3,
        # ASSUME: thermocouples of class 1 have an error of 1.5 K or 0.4 % (IEC 60584-1).
        drift=2.0,
        usual_sd=2.0,
    )
