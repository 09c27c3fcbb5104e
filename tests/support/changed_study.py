"""A study file with changes."""

import json
from pathlib import Path
from typing import Any

import yaml

CONFIG = Path(__file__).parents[2] / "config"


SMOKE = json.dumps(yaml.safe_load((CONFIG / "smoke.yaml").read_text(encoding="utf-8")))


GONE = object()


def smoke() -> dict[str, Any]:
    """Return the smoke study as it stands in its file, free of shared parts."""
    given: dict[str, Any] = json.loads(SMOKE)
    return given


def changed(path: str, value: object, study: dict[str, Any] | None = None) -> dict[str, Any]:
    """Return the smoke study with one value at a dotted path set, or taken out."""
    given = smoke() if study is None else study
    *above, last = path.split(".")
    part: Any = given
    for key in above:
        part = part[int(key)] if isinstance(part, list) else part[key]
    key = int(last) if isinstance(part, list) else last
    if value is GONE:
        del part[key]
    else:
        part[key] = value
    return given
