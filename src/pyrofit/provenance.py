"""What made a result: fingerprints of the source, versions, checksums."""

import hashlib
import importlib.metadata
import platform
from pathlib import Path
from typing import Any

PACKAGES = (
    "cma",
    "jinja2",
    "matplotlib",
    "numba",
    "numpy",
    "pandas",
    "pydantic",
    "scipy",
    "snakemake",
    "spotpy",
)
NUMERIC = ("cma", "numba", "numpy", "pandas", "scipy", "spotpy")
"""Packages whose version may change a number."""
SHOWING = (
    "archive.py",
    *(f"blind_test/{name}.py" for name in ("figures", "page", "rates", "reference", "table")),
    "cli",
    "config/reference.py",
    "figures",
    "new_study",
    "report",
    "tables",
)
"""Parts of the source that show results and do not change a number."""
BLIND_TEST = "blind_test"
"""Part of the source on which no study depends."""


def source_fingerprint(showing: bool = False, blind_test: bool = False) -> str:
    """Return a hash of source, data registry and numeric packages.

    Snakemake does not notice an edit to an imported package: rules carry this as a parameter.

    Parameters
    ----------
    showing
        Whether the source of tables, figures and pages counts as well.
    blind_test
        Whether the source of the blind test counts as well.
    """
    left_out = (() if showing else SHOWING) + (() if blind_test else (BLIND_TEST,))
    root = Path(__file__).parent
    total = hashlib.sha256((root / "data" / "registry.txt").read_bytes())
    for package in NUMERIC:
        total.update(f"{package} {importlib.metadata.version(package)}".encode())
    for path in sorted((*root.rglob("*.py"), *root.rglob("*.j2"))):
        name = path.relative_to(root)
        if not any(name.is_relative_to(part) for part in left_out):
            total.update(name.as_posix().encode())
            total.update(path.read_bytes())
    return total.hexdigest()[:16]


def environment() -> dict[str, Any]:
    """Return the versions that a result depends on."""
    versions = {name: importlib.metadata.version(name) for name in ("pyrofit", *PACKAGES)}
    return {
        "python": platform.python_version(),
        "machine": platform.machine(),
        "packages": versions,
        "source_fingerprint": source_fingerprint(showing=True),
    }
