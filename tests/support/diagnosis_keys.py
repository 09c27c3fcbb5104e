"""Studies with keys of the diagnosis."""

import json
from pathlib import Path
from typing import Any

import yaml

from pyrofit.config import (
    Study,
    as_study,
)

CONFIG = Path(__file__).parents[2] / "config"


def given(**changes: Any) -> dict[str, Any]:
    """Return the smoke study changed; ``a__b=1`` sets a.b to 1."""
    study = json.loads(json.dumps(yaml.safe_load((CONFIG / "smoke.yaml").read_text())))
    for place, value in changes.items():
        *above, last = place.split("__")
        part = study
        for key in above:
            part = part[key]
        part[last] = value
    return study


def study_with(**changes: Any) -> Study:
    return as_study(given(**changes), "smoke.yaml")
