"""A study with the options of a sensitivity."""

from typing import Any

from stage_studies import given

SAMPLES = 64


def described(**changes: Any) -> dict[str, Any]:
    """Return the small study with its kinetics as described: no fit comes before the analysis."""
    study = given(steps={"sensitivity": {"samples": SAMPLES}}, **changes)
    study["parameters"]["T_p"] = {"unit": "K", "value": 605}
    study["parameters"]["E_p"] = {"unit": "kJ/mol", "value": 190}
    study["synthetic"]["truth"] = {
        k: v for k, v in study["synthetic"]["truth"].items() if k not in ("T_p", "E_p")
    }
    del study["kinetics"]
    study["imp"]["kinetics"] = "described"
    return study
