"""Parameter sets made for the tests, in the dialects of the data base."""

import json
from pathlib import Path
from typing import Any

OLD: dict[str, Any] = {
    "Material": "Own",
    "Lab": "Own lab",
    "Calibration": [
        {"Model": "Own", "Method": "Fit", "Scope": "Kinetics", "Data": {"Type": "TGA"}}
    ],
    "Kinetics": {
        "Number of Reactions": 2,
        "Reaction Network": "Series",
        "Pre-exponential": [1e12, 1e13],
        "Activation Energy": [1.5e5, 1.9e5],
        "Reaction Order": [1, 1],
        "Initial Mass Fraction": [1, 0],
        "Solid Yield": [0.9, 0.02],
    },
    "Thermodynamics": {
        "Heat Capacity": {
            "Form": "Piecewise Linear",
            "Boundary": 390,
            "Slope": [4.0, 2.0],
            "Intercept": [200, 1100],
        },
        "Heat of Pyrolysis": {"Form": "Reaction Specific", "Value": [1e4, 9e5]},
        "Density": {"Form": "Linear", "Slope": -0.6, "Intercept": 1380},
    },
    "Transport": {
        "Conductivity": {
            "Form": "Gpyro Power Law",
            "Base Value": 0.2,
            "Exponent": -0.5,
            "Reference Temperature": 300,
        },
        "Absorption": {"Form": "Single Value", "Value": 2500},
        "Emissivity": {"Form": "Component Specific", "Value": [0.95, 0.9]},
    },
}

ZERO_BASED: dict[str, Any] = {
    **OLD,
    "Composition": {
        "Number of Components": 3,
        "Component Names": ["A", "B", "Char"],
        "Initial Mass Fraction": [0.7, 0.3, 0.0],
    },
    "Kinetics": {
        "Reactants": [[0], [1]],
        "Products": [[2], [2]],
        "Pre-exponential": [1e12, 1e13],
        "Activation Energy": [1.5e5, 1.9e5],
        "Reaction Order": [1, 2],
        "Solid Yield": [0.2, 0.3],
    },
    "Transport": {
        "Conductivity": {
            "Form": "Component Specific, Anisotropic",
            "Value": {
                name: {"parallel": 0.3, "perpendicular": value}
                for name, value in (("A", 0.1), ("B", 0.12), ("Char", 0.2))
            },
        },
        "Emissivity": {"Form": "Component Specific", "Value": {"A": 0.8, "B": 0.8, "Char": 0.9}},
    },
}


def write(path: Path, given: dict[str, Any]) -> Path:
    path.write_text(json.dumps(given, indent=1), encoding="utf-8")
    return path
