"""Stored activation energies over conversion."""

from collections.abc import Sequence

import pandas as pd
from pydantic import Field

from pyrofit.results.files import Results, read_csv, write_csv, write_json
from pyrofit.results.record import Record, read_record

ENERGIES = "energies.csv"
FINDINGS = "findings.json"


class Findings(Record):
    """Sentences on the energies and on better reactions, and the error of the temperatures [K]."""

    findings: list[str]
    temperature_sd_K: float | None
    offers: list[str] = Field(default_factory=list)


def write(
    results: Results,
    energies: pd.DataFrame,
    findings: Sequence[str],
    temperature_sd_K: float | None,
    offers: Sequence[str] = (),
) -> None:
    """Write energies over conversion, and sentences on them and on better reactions."""
    write_csv(results.isoconversional(ENERGIES), energies)
    content = Findings(
        findings=list(findings), temperature_sd_K=temperature_sd_K, offers=list(offers)
    )
    write_json(results.isoconversional(FINDINGS), content.model_dump(exclude_defaults=True))


def energies(results: Results) -> pd.DataFrame:
    """Return the energies over conversion [kJ/mol]; nan where too few records tell one."""
    return read_csv(results.isoconversional(ENERGIES), {"conversion": float})


def read_findings(results: Results) -> list[str]:
    """Return what they show, in sentences; none where the study has no such analysis."""
    return found.findings if (found := _read(results)) else []


def offers(results: Results) -> list[str]:
    """Return which reactions would describe the masses better, in sentences."""
    return found.offers if (found := _read(results)) else []


def _read(results: Results) -> Findings | None:
    path = results.isoconversional(FINDINGS)
    return read_record(path, Findings) if path.exists() else None
