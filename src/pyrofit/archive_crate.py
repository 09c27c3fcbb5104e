"""The metadata that make an archive a Workflow Run RO-Crate, profile 0.5, of RO-Crate 1.1.

They tell other programs the workflow, its input, its results, and the run that made them. The
checksums of all files are in SHA256SUMS.
"""

import os
from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from typing import Any

from pyrofit import __version__
from pyrofit.config import Study
from pyrofit.errors import DataError

METADATA = "ro-crate-metadata.json"
WORKFLOW = "software/src/pyrofit/workflow/Snakefile"
PROFILES = (
    ("https://w3id.org/ro/wfrun/process/0.5", "Process Run Crate", "0.5"),
    ("https://w3id.org/ro/wfrun/workflow/0.5", "Workflow Run Crate", "0.5"),
    ("https://w3id.org/workflowhub/workflow-ro-crate/1.0", "Workflow RO-Crate", "1.0"),
)
LICENSE = "software/: MIT; study, measured files and results: as their authors say"
FOLDERS = {
    "as_given/": "study files as the user wrote them",
    "data/": "measured files of the study",
    "programs/": "files of external programs",
    "plugins/": "effects, quantities and costs of the study",
    "results/": "results of the run",
    "software/": "pyrofit as it made the results, its workflow, and the versions of all packages",
}
"""All folders that an archive may have."""
LISTED = ("README.txt", "study.yaml", "results/study.json", "results/provenance.json")
REPORT = "results/report.html"
NO_DATE = 315532800
"""1980-01-01, as all entries of the archive, so that equal results give equal bytes."""


def metadata(study: Study, origin: Mapping[str, Any], names: Iterable[str]) -> bytes:
    """Return the content of ``ro-crate-metadata.json``.

    Parameters
    ----------
    study
        The study.
    origin
        Its provenance.
    names
        Names of all entries of the archive.

    Raises
    ------
    DataError
        SOURCE_DATE_EPOCH is no number of seconds.
    """
    from rocrate.model.contextentity import ContextEntity
    from rocrate.rocrate import ROCrate

    there = sorted(names)
    crate = ROCrate(version="1.1")
    crate.name = study.title or study.name
    crate.description = study.description or f"Study {study.name} of pyrofit, with its results"
    crate.license = LICENSE
    crate.datePublished = _date()
    for address, name, version in PROFILES:
        about = {"@type": "CreativeWork", "name": name, "version": version}
        crate.root_dataset.append_to(
            "conformsTo", crate.add(ContextEntity(crate, address, properties=about))
        )
    snakemake = origin.get("packages", {}).get("snakemake")
    workflow = crate.add_workflow(
        dest_path=WORKFLOW,
        main=True,
        lang="snakemake",
        lang_version=snakemake,
        properties={"name": "pyrofit", "version": __version__},
    )
    for folder, text in FOLDERS.items():
        if any(name.startswith(folder) for name in there):
            crate.add_dataset(dest_path=folder, properties={"name": folder, "description": text})
    listed = [n for n in there if n in (*LISTED, REPORT) or n.startswith("data/")]
    files = {n: crate.add_file(dest_path=n, properties={"name": n}) for n in listed}
    given = [files[n] for n in listed if n == "study.yaml" or n.startswith("data/")]
    made = [crate.get("results/"), *(files[n] for n in (REPORT,) if n in files)]
    crate.add_action(
        workflow,
        identifier="#run",
        object=given,
        result=made,
        properties={"@type": "CreateAction", "name": f"Run of the study {study.name}"},
    )
    _, content = next(iter(crate.metadata.stream()))
    return bytes(content) + b"\n"


def _date() -> str:
    """Return SOURCE_DATE_EPOCH as a date; without it, that of all entries."""
    given = os.environ.get("SOURCE_DATE_EPOCH") or str(NO_DATE)
    try:
        return datetime.fromtimestamp(int(given), UTC).date().isoformat()
    except (ValueError, OverflowError, OSError):
        raise DataError(
            f"SOURCE_DATE_EPOCH is '{given}', not a whole number of seconds since 1970; "
            "correct or unset it"
        ) from None
