"""Stored activation energies over conversion."""

from collections.abc import Sequence

import pandas as pd

from pyrofit.results.files import Results, read_csv, read_json, write_csv, write_json

ENERGIES = "energies.csv"
FINDINGS = "findings.json"


def write(
    results: Results,
    energies: pd.DataFrame,
    findings: Sequence[str],
    temperature_sd_K: float | None,
) -> None:
    """Write energies over conversion, and what they show, in sentences."""
    write_csv(results.isoconversional(ENERGIES), energies)
    content = {"findings": list(findings), "temperature_sd_K": temperature_sd_K}
    write_json(results.isoconversional(FINDINGS), content)


def energies(results: Results) -> pd.DataFrame:
    """Return the energies over conversion [kJ/mol]; nan where too few records tell one."""
    return read_csv(results.isoconversional(ENERGIES), {"conversion": float})


def findings(results: Results) -> list[str]:
    """Return what they show, in sentences; none where the study has no such analysis."""
    path = results.isoconversional(FINDINGS)
    if not path.exists():
        return []
    found: list[str] = read_json(path, {("findings",): list})["findings"]
    return found
