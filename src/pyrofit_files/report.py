"""Examine all files of a folder, and report the kind and the findings of each."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from pyrofit.errors import DataError
from pyrofit_files.checks import run_checks
from pyrofit_files.classify import examine_file
from pyrofit_files.examined import Examined

ENDINGS = {".csv", ".txt", ".tsv", ".dat", ".asc"}
TEXTS = ENDINGS - {".csv", ".tsv"}
"""Endings of files that may be no tables: those without a table are left out."""
BINARY = {".xls", ".xlsx", ".xlsm", ".ods", ".ngb-ss3", ".ngb-sd3", ".tri"}
"""Endings of files that hold measurements, and that are to be exported as text."""
_NOT_MEASURED = ("results", "verification", "predictions")
"""Words in names of folders that hold computed data."""
_WEIGHTS = "fault", "doubt", "note"


def examine_folder(folder: Path) -> list[Examined]:
    """Examine each measured file below a folder, and return them sorted by path.

    Raises
    ------
    DataError
        There is no such folder, or no file in it.
    """
    if not folder.is_dir():
        raise DataError(f"{folder}: there is no such folder; give the folder of measured files.")
    paths = sorted(measured_files(folder))
    if not paths:
        endings = ", ".join(sorted(ENDINGS))
        raise DataError(f"{folder}: it holds no measured files ({endings}); give another folder.")
    files = [seen for path in paths if _is_measured(seen := examine_file(path))]
    if not files:
        raise DataError(
            f"{folder}: it holds no measured files (no table in text files such as "
            f"{paths[0].name}); give another folder."
        )
    run_checks(files)
    return files


def _is_measured(seen: Examined) -> bool:
    """Tell whether a file holds a table, or has an ending or a name that promise one."""
    text = seen.path.suffix.casefold() in TEXTS
    return seen.table is not None or bool(seen.label.kind) or not text


def measured_files(folder: Path) -> Iterator[Path]:
    """Yield the measured files below a folder: no hidden ones, none of a folder of results."""
    for path in folder.rglob("*"):
        inside = [part.casefold() for part in path.relative_to(folder).parts[:-1]]
        computed = any(word in part for part in inside for word in _NOT_MEASURED)
        hidden = any(part.startswith(".") for part in (*inside, path.name))
        known = path.suffix.casefold() in ENDINGS | BINARY
        if known and path.is_file() and not (computed or hidden):
            yield path


def report_lines(files: Sequence[Examined], folder: Path, notes: bool) -> Iterator[str]:
    """Yield the report: each file, the findings, and the counts."""
    for seen in files:
        signals = seen.signals_in_words or "nothing recognised"
        kind = seen.kind or "unknown"
        parts = [seen.label.laboratory, kind, seen.label.conditions, signals]
        yield f"{seen.path.relative_to(folder)}: {'; '.join(part for part in parts if part)}"
    for weight in _WEIGHTS if notes else _WEIGHTS[:2]:
        found = [(s, f) for s in files for f in s.findings if f.weight == weight]
        if found:
            yield f"\n{weight.capitalize()}s ({len(found)})"
        for seen, finding in found:
            column = f", column '{finding.column}'" if finding.column else ""
            where = f"{seen.path.relative_to(folder)}{column}"
            yield f"  {where}: {finding.check}: {finding.text}"
    yield ""
    yield from counts(files)


def counts(files: Sequence[Examined]) -> list[str]:
    """Return the counts of files, kinds and findings."""
    known = sum(seen.classified for seen in files)
    share = 100.0 * known / len(files)
    kinds = Counter(seen.kind for seen in files if seen.classified)
    counts = [f"{n} {kind}" for kind, n in kinds.most_common()]
    lines = [f"{known} of {len(files)} files classified ({share:.1f} %): {', '.join(counts)}"]
    for weight in _WEIGHTS:
        found = Counter(f.check for s in files for f in s.findings if f.weight == weight)
        where = sum(any(f.weight == weight for f in s.findings) for s in files)
        words = ", ".join(f"{n} {check}" for check, n in found.most_common())
        lines.append(f"{found.total()} {weight}s in {where} files{': ' if words else ''}{words}")
    return lines


def report_as_json(files: Iterable[Examined], folder: Path) -> dict[str, Any]:
    """Return the report as data for JSON."""
    return {"folder": folder.name, "files": [_file_as_json(seen, folder) for seen in files]}


def _file_as_json(seen: Examined, folder: Path) -> dict[str, Any]:
    label, facts = seen.label, seen.facts
    return {
        "file": seen.path.relative_to(folder).as_posix(),
        "classified": seen.classified,
        "kind": seen.kind,
        "laboratory": label.laboratory,
        "gas": label.gas,
        "heating_K_min": label.heating_K_min,
        "flux_kW_m2": label.flux_kW_m2,
        "other": list(label.other),
        "repeat": label.repeat,
        "readme": {
            "mass_kg": facts.mass_kg,
            "thickness_m": facts.thickness_m,
            "area_m2": facts.area_m2,
        },
        "signals": [
            {
                "signal": name,
                "quantity": signal.quantity,
                "column": signal.header,
                "unit": signal.unit,
                "points": signal.y.size,
            }
            for name, signal in seen.signals.items()
        ],
        "not_used": dict(seen.left),
        "findings": [
            {"check": f.check, "weight": f.weight, "column": f.column, "text": f.text}
            for f in seen.findings
        ],
    }
