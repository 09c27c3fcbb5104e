"""Stored activation energies over conversion."""

from collections.abc import Sequence
from typing import Any

import pandas as pd

from pyrofit.results.files import Results, read_csv, read_json, write_csv, write_json

ENERGIES = "energies.csv"
FINDINGS = "findings.json"


def write(
    results: Results,
    energies: pd.DataFrame,
    findings: Sequence[str],
    temperature_sd_K: float | None,
    offers: Sequence[str] = (),
) -> None:
    """Write energies over conversion, and in sentences what they show and what follows."""
    write_csv(results.isoconversional(ENERGIES), energies)
    content = {"findings": list(findings), "temperature_sd_K": temperature_sd_K}
    content |= {"offers": list(offers)} if offers else {}
    write_json(results.isoconversional(FINDINGS), content)


def energies(results: Results) -> pd.DataFrame:
    """Return the energies over conversion [kJ/mol]; nan where too few records tell one."""
    return read_csv(results.isoconversional(ENERGIES), {"conversion": float})


def findings(results: Results) -> list[str]:
    """Return what they show, in sentences; none where the study has no such analysis."""
    return list(_read(results).get("findings", ()))


def offers(results: Results) -> list[str]:
    """Return which reactions would describe the masses better, in sentences."""
    return list(_read(results).get("offers", ()))


def _read(results: Results) -> dict[str, Any]:
    path = results.isoconversional(FINDINGS)
    return read_json(path, {("findings",): list}) if path.exists() else {}
