"""A charring specimen, and every general term of the description beside its null value."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from pyrofit.experiments import Gasification
from pyrofit.model.material import Material

FOIL = {"thickness_m": 2e-4, "density_kg_m3": 8940.0, "specific_heat_J_kgK": 380.0}
FAST = {"A_1_s": 1e8, "E_J_mol": 1.1e5}
SLOW = {"A_1_s": 1e11, "E_J_mol": 1.6e5}
VIRGIN = {"density_kg_m3": 1200.0, "specific_heat_J_kgK": 2000.0, "emissivity": 0.9}
CHAR = {"density_kg_m3": 300.0, "specific_heat_J_kgK": 1500.0, "emissivity": 0.8}
HEATED = {"heat_of_reaction_J_kg": 6e5}
SIMPLE = {"reactant": "V", "products": {"C": 0.2}, **SLOW, **HEATED}


def charring(
    *reactions: dict[str, Any],
    virgin: Mapping[str, Any] | None = None,
    char: Mapping[str, Any] | None = None,
    kappa: float | None = None,
) -> Material:
    """A virgin material V, an intermediate M and a char C; one reaction if none is given."""
    clear = {} if kappa is None else {"absorption_1_m": kappa}
    thick = {} if kappa is None else {"absorption_1_m": 3.0 * kappa}
    return Material.model_validate(
        {
            "components": {
                "V": {"conductivity_W_mK": 0.2, **VIRGIN, **clear, **(virgin or {})},
                "M": {"conductivity_W_mK": 0.15, **CHAR, "density_kg_m3": 900.0, **thick},
                "C": {"conductivity_W_mK": 0.1, **CHAR, **thick, **(char or {})},
            },
            "reactions": {str(j): r for j, r in enumerate(reactions or (SIMPLE,))},
            "composition": {"V": 1.0},
        }
    )


AROUND = {"h_W_m2K": 8.0, "gas_temperature_K": 340.0, "wall_temperature_K": 290.0}
BEHIND = {"h_W_m2K": 4.0, "emissivity": 0.95, "gas_temperature_K": 310.0}


def specimen(
    flux_kW_m2: float | dict[str, Any] = 40.0,
    back: dict[str, Any] | None = None,
    front: Mapping[str, Any] | None = None,
    layers: tuple[dict[str, Any], ...] = ({"thickness_m": 5e-3},),
    signals: Mapping[str, Any] | None = None,
    **sample: Any,
) -> Gasification:
    flux = flux_kW_m2 if isinstance(flux_kW_m2, dict) else 1e3 * flux_kW_m2
    return Gasification.model_validate(
        {
            "kind": "gasification",
            "sample": {"layers": layers, "initial_temperature_K": 300.0, **sample},
            "front": {"flux_W_m2": flux, **AROUND, **(front or {})},
            "back": BEHIND if back is None else back,
            "signals": {"mlr": {"file": "synthetic"}, **(signals or {})},
        }
    )


@dataclass(frozen=True)
class Term:
    """A term with the parameter x in its place, where it vanishes and where it does not."""

    null: float
    away: float
    front: Mapping[str, Any] = field(default_factory=dict)
    back: Mapping[str, Any] = field(default_factory=dict)
    foil: Mapping[str, Any] = field(default_factory=dict)
    sample: Mapping[str, Any] = field(default_factory=dict)
    signal: Mapping[str, Any] = field(default_factory=dict)
    virgin: Mapping[str, Any] = field(default_factory=dict)
    char: Mapping[str, Any] = field(default_factory=dict)

    @property
    def experiment(self) -> Gasification:
        """The specimen on its foil, with the term."""
        signals = {n: {"file": "synthetic", **self.signal} for n in ("mlr", "back_temperature")}
        return specimen(
            40.0,
            {**BEHIND, **self.back},
            self.front,
            signals=signals,
            foil={**FOIL, **self.foil},
            **self.sample,
        )

    @property
    def material(self) -> Material:
        """The charring material, with the term."""
        return charring(virgin=self.virgin, char=self.char)


def _heat(**changes: Any) -> dict[str, Any]:
    return {"specific_heat_J_kgK": {"of": 2000.0, **changes}}


BASE = Term(0.0, 0.0)
TERMS = {
    "front_h_change": Term(0.0, 6.0, front={"h_change_W_m2K": "x"}),
    "back_h_change": Term(0.0, -3.0, back={"h_change_W_m2K": "x"}),
    "front_gas_rise": Term(0.0, 150.0, front={"gas_rise_K": "x", "gas_rise_time_s": 60.0}),
    "back_gas_rise": Term(0.0, 80.0, back={"gas_rise_K": "x"}),
    "flux_factor": Term(1.0, 1.1, front={"flux_factor": "x"}),
    "rise_time": Term(0.0, 20.0, front={"rise_time_s": "x"}),
    "spread": Term(0.0, 0.2, front={"spread": "x"}),
    "drift": Term(0.0, -5e-4, front={"drift_1_s": "x"}),
    "drift_that_ends": Term(0.0, 2e-3, front={"drift_1_s": "x", "drift_time_s": 100.0}),
    "loss_factor": Term(1.0, 2.0, back={"loss_factor": "x"}),
    "contact": Term(0.0, 5e-3, foil={"contact_m2K_W": "x"}),
    "thickness_factor": Term(1.0, 1.05, sample={"thickness_factor": "x"}),
    "density_factor": Term(1.0, 1.1, sample={"density_factor": "x"}),
    "conductivity_factor": Term(1.0, 2.0, sample={"conductivity_factor": "x"}),
    "emissivity_change": Term(0.0, -0.3, sample={"emissivity_change": "x"}),
    "absorption_length": Term(0.0, 5e-4, sample={"absorption_length_m": "x"}),
    "gas_heat": Term(0.0, 2000.0, sample={"gas_specific_heat_J_kgK": "x"}),
    "edge": Term(0.0, 20.0, sample={"edge": {"h_W_m2K": "x", "perimeter_per_area_1_m": 40.0}}),
    "delay": Term(0.0, 7.0, signal={"delay_s": "x"}),
    "offset": Term(0.0, 1e-3, signal={"offset": "x"}),
    "expansion": Term(1.0, 1.2, char={"expansion": "x"}),
    "expansion_with_temperature": Term(
        0.0,
        1e-3,
        virgin={
            "expansion": {"value": 1.0, "slope_1_K": "x", "reference_temperature_K": 300.0},
        },
    ),
    "slope": Term(0.0, -1e-3, virgin={"conductivity_W_mK": {"of": 0.2, "slope_1_K": "x"}}),
    "bend": Term(
        0.0,
        -3e-3,
        virgin={"conductivity_W_mK": {"of": 0.2, "bend": "x", "step_temperature_K": 400.0}},
    ),
    "thinning": Term(0.0, 1.0, virgin={"conductivity_W_mK": {"of": 0.2, "thinning": "x"}}),
    "scale": Term(
        0.0,
        2.0,
        virgin={"conductivity_W_mK": {"of": 0.2, "slope_1_K": -4e-4, "bend": 1e-3, "scale": "x"}},
    ),
    "step": Term(0.0, 600.0, virgin=_heat(step="x")),
    "peak": Term(0.0, 6e4, virgin=_heat(peak_area="x")),
}
"""Every term on its own."""
