"""Checksums of what a run leaves, stored in `tests/golden`."""

import gzip
import hashlib
import json
import os
import re
from pathlib import Path

GOLDEN = Path(__file__).parents[1] / "golden"
WRITE = bool(os.environ.get("PYROFIT_WRITE_GOLDEN"))
KINDS = {".csv", ".gz", ".json", ".md", ".svg", ".yaml"}
"""Tables, histories, records and figures; pages and pictures are made of these."""
OF_THE_RUN = {"benchmarks", "inputs", "logs", "running", "provenance.json", "study.json"}
"""They tell when, where and by what code, or are the description."""
BY_CODE = re.compile(rb'"digest": "\w+"')
"""What tells the code of a result, which may change without a number."""
AVX2 = {
    "NPY_DISABLE_CPU_FEATURES": "X86_V4 AVX512_ICL",
    "OPENBLAS_CORETYPE": "Haswell",
    "NUMBA_CPU_NAME": "haswell",
    "NUMBA_CPU_FEATURES": "+avx,+avx2,+fma,+bmi,+bmi2,+sse4.2,+popcnt,+lzcnt,+f16c",
}
"""Make NumPy, OpenBLAS and numba take the code of a processor without AVX-512."""


def checksums(results: Path) -> dict[str, str]:
    """Return a checksum of each file, by its place."""
    found = {}
    for path in sorted(results.rglob("*")):
        place = path.relative_to(results)
        if path.suffix in KINDS and path.is_file() and place.parts[0] not in OF_THE_RUN:
            content = path.read_bytes()
            content = gzip.decompress(content) if path.suffix == ".gz" else content
            content = BY_CODE.sub(b"", content) if path.suffix == ".json" else content
            found[place.as_posix()] = hashlib.sha256(content).hexdigest()[:16]
    return found


def moved(results: Path, name: str) -> list[str]:
    """Return the files that are not as stored; with PYROFIT_WRITE_GOLDEN=1 store them first."""
    stored = GOLDEN / f"{name}.json"
    found = checksums(results)
    assert len(found) > 3
    if WRITE:
        stored.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    known = json.loads(stored.read_text(encoding="utf-8"))
    return sorted(place for place in found.keys() | known if found.get(place) != known.get(place))
