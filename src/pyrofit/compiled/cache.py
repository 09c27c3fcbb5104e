"""Compiled code on disk, safe for any number of processes, users, machines and kinds of processor.

numba keeps an index file per function and saves it without a lock. Two processes that compile
different signatures can leave the index of one with the code of the other. Here each signature has
a file of its own, in a folder named by all that its code depends on. A file holds its own checksum
and replaces an older one in one step, so that right code does not depend on a lock. The lock saves
time: one process compiles a signature, the others wait for its file.
"""

import contextlib
import functools
import hashlib
import logging
import os
import pickle
import platform
import sys
import tempfile
import time
from pathlib import Path

import llvmlite
import numba
import numpy as np
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps
from numba.core.sigutils import normalize_signature

try:
    import fcntl
except ImportError:  # no locks on this system: each process compiles for itself
    fcntl = None

LONGEST_WAIT_S = 900.0
"""A process that waits longer for another one compiles for itself."""
LOOK_AGAIN_S = 0.1
_HERE = Path(__file__).parent
_OPTIONS = ("OPT", "LOOP_VECTORIZE", "SLP_VECTORIZE", "BOUNDSCHECK", "DEBUGINFO_DEFAULT")
"""Settings of numba that change the compiled code."""
_LOG = logging.getLogger(__name__)


class CompiledFiles:
    """The cache of one compiled function, as numba's dispatcher asks for it."""

    def __init__(self, function, told=True):
        self._name = function.__name__
        self._told = told
        self._folders = folders(Path(function.__code__.co_filename).parent)
        self._lock = None

    @property
    def cache_path(self):
        """The first folder in which files are looked for."""
        return str(self._folders[0])

    def enable(self):
        """Stay enabled."""

    def disable(self):
        """Stay enabled."""

    def flush(self):
        """Keep all files."""

    def load_overload(self, sig, target_context):
        """Return the compiled signature; None means that this process is to compile it."""
        target_context.refresh()
        self._unlock()
        name, kind = self._file_name(sig), _of_processor(target_context)
        found = _load(self._folders, name, kind, sig, target_context)
        if found is None and self._wait_for_lock(name, kind):
            # Another process may have been faster.
            found = _load(self._folders, name, kind, sig, target_context)
            if found is not None:
                self._unlock()
        if found is None and self._told:
            _LOG.warning("Compiling %s, once: up to a minute.", self._name)
        return found

    def save_overload(self, sig, compiled):
        """Keep a compiled signature, where it can be kept."""
        try:
            name, kind = self._file_name(sig), _of_processor(compiled.target_context)
            if not compiled.library.has_dynamic_globals:
                _save(self._folders, name, kind, dumps(compiled._reduce()))
        finally:
            self._unlock()

    def _file_name(self, sig):
        return f"{self._name}-{hashlib.sha256(str(sig).encode()).hexdigest()[:20]}"

    def _wait_for_lock(self, name, kind):
        """Return whether this process now may compile alone; False where locks do not work."""
        for folder in self._folders:
            with contextlib.suppress(OSError):
                (folder / kind).mkdir(parents=True, exist_ok=True)
                self._lock = os.open(folder / kind / f"{name}.lock", os.O_RDWR | os.O_CREAT, 0o666)
                if not _locked(self._lock, self._name):
                    return False
                for left in (folder / kind).glob(f".{name}.code.*"):  # by a process that was killed
                    left.unlink(missing_ok=True)
                return True
        return False

    def _unlock(self):
        if self._lock is not None:
            if fcntl is not None:  # a fork may hold the file open
                with contextlib.suppress(OSError):
                    fcntl.flock(self._lock, fcntl.LOCK_UN)
            os.close(self._lock)
            self._lock = None


def _locked(file, name):
    """Return whether a lock was had before patience ended."""
    give_up, told = time.monotonic() + LONGEST_WAIT_S, False
    while fcntl is not None and time.monotonic() < give_up:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return True
        except BlockingIOError:
            if not told:
                _LOG.warning("Another process compiles %s; waiting for it.", name)
            told = True
            time.sleep(LOOK_AGAIN_S)
    return False


def _load(folders, name, kind, sig, target_context):
    """Return a compiled signature from the first folder that holds a whole file of it."""
    for folder in folders:
        try:
            content = (folder / kind / f"{name}.code").read_bytes()
        except OSError:
            continue
        checksum, code = content[:32], content[32:]
        if hashlib.sha256(code).digest() != checksum:
            continue  # damaged; it will be written anew
        compiled = CompileResult._rebuild(target_context, *pickle.loads(code))
        if tuple(compiled.signature.args) == tuple(normalize_signature(sig)[0]):
            return compiled
    return None


def _save(folders, name, kind, code):
    """Write a file in the first folder that can be written, whole or not at all."""
    told = ""
    for folder in folders:
        try:
            (folder / kind).mkdir(parents=True, exist_ok=True)
            _write(folder / kind / f"{name}.code", hashlib.sha256(code).digest() + code)
        except OSError as error:
            told = told or f"{folder}: {error.strerror}"
        else:
            return
    _LOG.warning(
        "Compiled code cannot be kept (%s); every process will compile it anew. "
        "Make room, or set NUMBA_CACHE_DIR to a folder that can be written.",
        told,
    )


def _write(path, content):
    file, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    try:
        with os.fdopen(file, "wb") as stream:
            stream.write(content)
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(temporary)
        raise


@functools.cache
def folders(package=_HERE):
    """Return where compiled code of a package may lie, in order of preference.

    The folders serve every processor. They are named by all sources that the code depends on, the
    versions of the compiling software, and its settings.
    """
    beside = [package.parent / "arrays.py", _HERE.parent / "constants.py", _HERE / "jit.py"]
    sources = [path for path in (*sorted(package.glob("*.py")), *beside) if path.exists()]
    total = hashlib.sha256(b"".join(path.read_bytes() for path in sources))
    versions = (
        numba.__version__,
        llvmlite.__version__,
        np.__version__,
        platform.python_version(),
    )
    options = [getattr(numba.config, name, None) for name in _OPTIONS]
    total.update(repr((versions, sys.implementation.name, options)).encode())
    digest = total.hexdigest()[:12]
    if numba.config.CACHE_DIR:
        return [Path(numba.config.CACHE_DIR) / "pyrofit" / digest]
    usual = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return [_HERE / "__pycache__" / digest, usual / "pyrofit" / digest]


@functools.cache
def _of_processor(target_context):
    """Return a name of the processor that the code is compiled for, with all its features."""
    described = repr(target_context.codegen().magic_tuple())
    return hashlib.sha256(described.encode()).hexdigest()[:12]
