"""Published materials for the explorer."""

from collections.abc import Callable
from typing import Any

from pyrofit_compare.published import PublishedSet
from pyrofit_exchange.macfp.schema import StrictSet

Change = Callable[[dict[str, Any]], object]


def single(value: float) -> dict[str, object]:
    return {"Form": "Single Value", "Value": value}


def published(*changes: Change) -> PublishedSet:
    """Return a polymer of one reaction, changed."""
    residue = {"density": 1000.0, "conductivity": 0.2, "heat": 1000.0, "emissivity": 0.9}
    polymer = {"density": 1190.0, "conductivity": 0.21, "heat": 2100.0, "emissivity": 0.88}

    def each(key: str) -> dict[str, object]:
        values = [single(polymer[key]), single(residue[key])]
        return {"Form": "Component Specific", "Value": values}

    given: dict[str, Any] = {
        "Material": "polymer",
        "Lab": "A",
        "Calibration": [],
        "Composition": {
            "Number of Components": 2,
            "Component Names": ["P", "R"],
            "Initial Mass Fraction": [1.0, 0.0],
        },
        "Kinetics": {
            "Reactants": [[1]],
            "Products": [[2]],
            "Pre-exponential": [1e13],
            "Activation Energy": [190e3],
            "Reaction Order": [1.0],
            "Solid Yield": [0.01],
        },
        "Thermodynamics": {
            "Heat Capacity": each("heat"),
            "Heat of Pyrolysis": single(800e3),
            "Density": each("density"),
        },
        "Transport": {
            "Conductivity": each("conductivity"),
            "Absorption": {"Form": "None"},
            "Emissivity": each("emissivity"),
        },
    }
    for change in changes:
        change(given)
    return PublishedSet("Polymer", StrictSet.model_validate(given))


def of_thermal(key: str, form: dict[str, object]) -> Change:
    return lambda given: given["Transport"].update({key: form})


def second_reaction(given: dict[str, Any]) -> None:
    """Let the polymer become another component first, which then becomes residue."""
    given["Composition"] = {
        "Number of Components": 3,
        "Component Names": ["P", "Q", "R"],
        "Initial Mass Fraction": [1.0, 0.0, 0.0],
    }
    given["Kinetics"].update(
        Reactants=[[1], [2]],
        Products=[[2], [3]],
        **{key: 2 * given["Kinetics"][key] for key in ("Pre-exponential", "Activation Energy")},
        **{"Reaction Order": [1.0, 1.0], "Solid Yield": [0.5, 0.02]},
    )
    for part in (given["Thermodynamics"], given["Transport"]):
        for form in part.values():
            if form["Form"] == "Component Specific":
                form["Value"] = [form["Value"][0], *form["Value"]]


def kinetics_alone(given: dict[str, Any]) -> None:
    del given["Thermodynamics"], given["Transport"]


VARYING = {"Form": "Linear", "Slope": 1e-4, "Intercept": 0.2}
