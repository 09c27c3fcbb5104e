"""Kinetics are taken from the small samples first: the slab cannot move them at will."""

from typing import Any

import numpy as np
import pytest

from pyrofit.config import Study, as_study, calibration_channels
from pyrofit.diagnose.base.model import Base
from pyrofit.diagnose.base.plausible import plausible_ranges
from pyrofit.diagnose.search.kinetics_first import kinetics_first
from pyrofit.estimate.pose import of_diagnosis
from pyrofit.estimate.pose_likelihood import pose_likelihood
from pyrofit.stages.measurements import computed

TRUTH = {"T": 610.0, "E": 180.0}
TGA = {"kind": "tga", "start_temperature_K": 450, "end_temperature_K": 750}
MASS = {"mass_fraction": {"file": "synthetic", "every": 2, "noise": 0.003}}
SLAB = {
    "kind": "gasification",
    "duration_s": 600,
    "sample": {"layers": [{"thickness_m": 0.004}], "initial_temperature_K": 295},
    "front": {"flux_W_m2": 40000, "h_W_m2K": 8, "gas_temperature_K": 330},
    "back": {"h_W_m2K": 4, "emissivity": 0.95, "gas_temperature_K": 300},
    "signals": {"mlr": {"file": "synthetic", "every": 10, "noise": 3e-4}},
}
OTHERS = {"specific_heat_J_kgK": 1500, "emissivity": 0.9}


def study(effects: dict[str, Any]) -> Study:
    """Return a study of TGA at three rates and a slab, computed with effects it does not know."""
    tests = {f"tga_{r}": {**TGA, "heating_rate_K_min": r, "signals": MASS} for r in (2, 10, 50)}
    mass = [{"experiment": name, "signal": "mass_fraction", "kind": "RMSE"} for name in tests]
    mlr = [{"experiment": "slab", "signal": "mlr", "kind": "RMSE"}]
    given = {
        "name": "first",
        "title": "Kinetics first",
        "description": "One reaction of first order.",
        "seed": 3,
        "parameters": {
            "T": {"unit": "K", "lower": 540, "upper": 680, "label": "reference temperature"},
            "E": {"unit": "kJ/mol", "lower": 80, "upper": 320, "label": "activation energy"},
            "k": {"unit": "W/(m K)", "lower": 0.1, "upper": 0.4, "label": "conductivity"},
        },
        "material": {
            "components": {
                name: {"density_kg_m3": 1200, "conductivity_W_mK": "k", **OTHERS}
                for name in ("solid", "rest_")
            },
            "reactions": {
                "pyrolysis": {
                    "reactant": "solid",
                    "products": {"rest_": 0.01},
                    "reference_temperature_K": "T",
                    "reference_rate_1_s": 0.001,
                    "E_J_mol": "E",
                    "heat_of_reaction_J_kg": 900e3,
                }
            },
            "composition": {"solid": 1.0},
        },
        "experiments": {**tests, "slab": SLAB},
        "kinetics": {"estimate": ["T", "E"], "cost": mass},
        "imp": {"estimate": ["k"], "kinetics": "fitted", "costs": {"RMSE": mlr}},
        "validation": {"experiments": ["slab"]},
        "synthetic": {"truth": {**TRUTH, "k": 0.2}, "effects": effects},
    }
    return as_study(given, "first.yaml")


def limits(hidden: dict[str, Any], candidates: tuple[str, ...]) -> dict[str, tuple[float, float]]:
    """Return the limits in units of the study, after the small samples were looked at."""
    described = study(hidden)
    channels = calibration_channels(described)
    asked, series = of_diagnosis(described, channels), computed(described)
    likelihood = pose_likelihood(described, asked, series, described.fixed_values(), tolerant=True)
    base = Base(likelihood, tuple(range(len(channels))), plausible_ranges({}))
    problem = kinetics_first(base, ("T", "E"), candidates, 1).likelihood.problem
    factors = [described.parameters[name].factor for name in problem.names]
    ends = zip(problem.lower / factors, problem.upper / factors, strict=True)
    return dict(zip(problem.names, ends, strict=True))


CANDIDATES = ("reaction_order", "tga_lag", "tga_offset", "third_reaction", "k_T")


@pytest.mark.solver
@pytest.mark.parametrize(
    "hidden",
    [{}, {"reaction_order": {"order": 1.8}}, {"tga_offset": {"offset_K": 5.0}}],
    ids=["nothing", "order", "offset"],
)
def test_limits_are_narrow_and_hold_the_truth(hidden: dict[str, Any]) -> None:
    found = limits(hidden, CANDIDATES)
    for name, true in TRUTH.items():
        low, high = found[name]
        assert low < true < high, (name, low, high)
    whole = study({}).parameters
    assert found["T"][1] - found["T"][0] < 0.45 * (whole["T"].upper - whole["T"].lower)
    assert found["E"][1] - found["E"][0] < 0.45 * (whole["E"].upper - whole["E"].lower)
    # The conductivity is none of the kinetics.
    assert found["k"] == pytest.approx((0.1, 0.4))


@pytest.mark.solver
def test_limits_stay_where_there_is_no_small_sample_or_no_kinetics() -> None:
    described = study({})
    channels = [c for c in calibration_channels(described) if c.experiment == "slab"]
    asked, series = of_diagnosis(described, channels), computed(described)
    fixed = described.fixed_values()
    base = Base(pose_likelihood(described, asked, series, fixed, tolerant=True), (0,))
    assert kinetics_first(base, ("T", "E"), CANDIDATES, 1) is base
    assert np.all(base.likelihood.problem.span > 0.0)
