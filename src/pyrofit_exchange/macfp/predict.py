"""Predictions of parameter sets in the ideal cases of the data base."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pyrofit.errors import DataError
from pyrofit.experiments import KINDS
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.material import Material
from pyrofit.numerics import linear
from pyrofit.solver import outputs
from pyrofit.solver.curves import Request
from pyrofit_exchange.macfp.material import material_of
from pyrofit_exchange.macfp.schema import StrictSet

FloatArray = NDArray[np.float64]

AREA_M2 = 0.01
BIN_S = 1.0
_ONSET, _END = 1e-3, 1e-4
"""Mass loss rates of onset and end in the data base's comparison [kg/(m2 s)]."""


@dataclass(frozen=True)
class IdealSlab:
    """An ideal slab: one flux, no convection, the back insulated.

    Parameters
    ----------
    flux_W_m2, thickness_m
        Incident flux and thickness.
    duration_s
        Length of the record.
    temperature_K
        Initial temperature, and that of the surroundings.
    """

    flux_W_m2: float
    thickness_m: float
    duration_s: float
    temperature_K: float

    @property
    def name(self) -> str:
        """Short name: `25kW_6mm`.

        >>> IdealSlab(25e3, 6e-3, 1500.0, 293.15).name
        '25kW_6mm'
        """
        return f"{self.flux_W_m2 / 1e3:g}kW_{self.thickness_m * 1e3:g}mm"


PMMA_CASES = tuple(
    IdealSlab(1e3 * q, 1e-3 * d, t, 293.15)
    for q, d, t in (
        (10, 6, 6000.0),
        (10, 12, 12000.0),
        (25, 6, 2000.0),
        (25, 12, 4000.0),
        (65, 6, 800.0),
        (65, 12, 1600.0),
    )
)
"""Cases of the model comparison of 2021 (MaCFP-2)."""
WOOD_CASES = tuple(
    IdealSlab(1e3 * q, 1e-3 * d, t, 300.0)
    for q, d, t in (
        (10, 6, 1500.0),
        (10, 18, 4200.0),
        (30, 6, 800.0),
        (30, 18, 2400.0),
        (60, 6, 600.0),
        (60, 18, 1200.0),
    )
)
"""Cases of the calibration exercise of 2026 (MaCFP-4)."""
WOOD_RATES_K_MIN = 10.0, 100.0


class SlabCurves(NamedTuple):
    """Curves of an ideal slab at 0, 1, 2 ... s.

    Parameters
    ----------
    time_s, mlr_kg_m2_s, mass_kg_m2, back_K, front_K
        Shape (n,) each; the mass loss rate is the mean since the second before.
    """

    time_s: FloatArray
    mlr_kg_m2_s: FloatArray
    mass_kg_m2: FloatArray
    back_K: FloatArray
    front_K: FloatArray


class Metrics(NamedTuple):
    """Numbers by which the data base compares predictions.

    Parameters
    ----------
    peak_kg_m2_s, time_of_peak_s
        Largest mass loss rate of means over 10 s, and its time.
    onset_s, end_s
        First time at 1 g/(m2 s), last time at 0.1 g/(m2 s); NaN where it is not reached.
    half_s
        Time at which half the mass is lost that is lost in all.
    left
        Mass at the end over the initial one.
    back_K
        Largest back temperature.
    """

    peak_kg_m2_s: float
    time_of_peak_s: float
    onset_s: float
    end_s: float
    half_s: float
    left: float
    back_K: float


def material(given: StrictSet) -> Material:
    """Return the material of a set."""
    return Material.model_validate(material_of(given))


def simulate_case(of: Material, case: IdealSlab, accuracy: Accuracy | None = None) -> SlabCurves:
    """Simulate an ideal slab."""
    kind = KINDS["gasification"]
    T = case.temperature_K
    around = {"gas_temperature_K": T, "wall_temperature_K": T}
    described = kind.description.model_validate(
        {
            "kind": "gasification",
            "duration_s": case.duration_s,
            "sample": {
                "layers": [{"thickness_m": case.thickness_m}],
                "initial_temperature_K": T,
                "transmitted": "back",
            },
            "front": {"flux_W_m2": case.flux_W_m2, **around},
            "signals": {outputs.RATE: {"file": "synthetic"}},
        }
    )
    times = np.arange(BIN_S, case.duration_s + 0.5 * BIN_S, BIN_S)
    asked = {
        "rate": Request(times - 0.5 * BIN_S, BIN_S, output=outputs.RATE),
        "left": Request(times, output=outputs.MASS),
        "back": Request(times, output=outputs.BACK),
        "front": Request(times, output=outputs.FRONT),
    }
    curves = kind.simulate([described], of, {}, [asked], accuracy or Accuracy())[0][0]
    if not curves.status.finished:
        raise DataError(f"{case.name}: no prediction: {curves.status.explanation}")
    start = _initial_mass(of, case)
    return SlabCurves(
        np.append(0.0, times),
        np.append(0.0, curves.signals["rate"]),
        np.append(start, curves.signals["left"]),
        np.append(T, curves.signals["back"]),
        np.append(T, curves.signals["front"]),
    )


def _initial_mass(of: Material, case: IdealSlab) -> float:
    """Return the initial mass per area: volumes of the components add up."""
    volume = 0.0
    for name, share in of.composition.items():
        density = of.components[name].density_kg_m3
        assert not isinstance(share, str)
        assert not isinstance(density, str)
        volume += share / density
    return case.thickness_m / volume


def metrics(curves: SlabCurves) -> Metrics:
    """Return the numbers by which the data base compares predictions."""
    t, rate, mass = curves.time_s, curves.mlr_kg_m2_s, curves.mass_kg_m2
    smooth = linear.running_mean(rate, 10)
    peak = int(np.argmax(smooth))
    onset, end = np.flatnonzero(rate >= _ONSET), np.flatnonzero(rate >= _END)
    half = mass[0] - 0.5 * (mass[0] - mass[-1])
    return Metrics(
        float(smooth[peak]),
        float(t[peak]),
        float(t[onset[0]]) if onset.size else float("nan"),
        float(t[end[-1]]) if end.size else float("nan"),
        float(t[np.argmax(mass <= half)]),
        float(mass[-1] / mass[0]),
        float(curves.back_K.max()),
    )


def simulate_program(
    of: Material,
    rate_K_min: float,
    time_s: FloatArray,
    temperature_K: FloatArray,
    output: str = outputs.MASS_FRACTION,
) -> FloatArray:
    """Return the mass fraction, or the heat flow, of a small sample that follows a temperature."""
    described = KINDS["dsc"].description.model_validate(
        {
            "kind": "dsc",
            "heating_rate_K_min": rate_K_min,
            "signals": {outputs.MASS_FRACTION: {"file": "synthetic"}},
        }
    )
    slope = np.gradient(temperature_K, time_s)
    asked = {
        output: Request(time_s, temperature_K=temperature_K, output=output, heating_rate_K_s=slope)
    }
    curves = KINDS["dsc"].simulate([described], of, {}, [asked], Accuracy())[0][0]
    return np.asarray(curves.signals[output], np.float64)
