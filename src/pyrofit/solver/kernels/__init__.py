"""Compiled kernels; nothing outside this folder imports numba.

numba keeps compiled code on disk, but notices only edits of the file that holds the compiled
function, not of what it calls. The cache therefore lies in a folder named by all sources.
"""

import hashlib
import logging
import os
from pathlib import Path

# The kernels say themselves what is done side by side: the compiler's search for more of it takes a
# third of the time to compile, and gains nothing. Read when numba is imported.
os.environ.setdefault("NUMBA_OPT", "2")
os.environ.setdefault("NUMBA_LOOP_VECTORIZE", "0")

import numba

_HERE = Path(__file__).parent
_SOURCES = [
    *sorted(_HERE.glob("*.py")),
    _HERE.parent / "arrays.py",
    _HERE.parents[1] / "constants.py",
]


def _cache_folder() -> Path:
    digest = hashlib.sha256(b"".join(path.read_bytes() for path in _SOURCES)).hexdigest()[:12]
    beside = _HERE / "__pycache__"
    if os.access(beside if beside.exists() else _HERE, os.W_OK):
        return beside / digest
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "pyrofit" / digest


if not numba.config.CACHE_DIR:
    numba.config.CACHE_DIR = str(_cache_folder())
if not Path(numba.config.CACHE_DIR).exists():
    logging.getLogger(__name__).warning(
        "Compiling the solver: about half a minute, once, and again when more parameter sets run "
        "side by side."
    )
