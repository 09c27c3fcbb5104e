"""Files of source code as results depend on them: their code, without comments and docstrings.

A syntax tree takes a thousandth of a second per 30 lines, and each start of the workflow needs all
trees. Their digests are therefore kept on disk, by the content of the file.
"""

import ast
import contextlib
import hashlib
import json
import os
import sys
import tempfile
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

MOST_KEPT = 10_000
"""Files that are kept at most, older versions included."""


class Source(NamedTuple):
    """A file of source code.

    Parameters
    ----------
    digest
        Hash of its syntax tree without docstrings; of its bytes, if it is no valid Python.
    imports
        Modules that it imports, anywhere in it, and names in modules; none of Python's own.
    """

    digest: str
    imports: frozenset[str]


def source_of(path: Path) -> Source:
    """Return a file; it is read again only if it was changed."""
    at = path.stat()
    return _read(path, at.st_mtime_ns, at.st_size)


@cache
def _read(path: Path, changed_ns: int, size: int) -> Source:
    content = path.read_bytes()
    key = hashlib.sha256(content).hexdigest()
    if path.suffix != ".py":
        return Source(key, frozenset())
    return _KEPT.source(key, content)


def analysed(content: bytes) -> Source:
    """Return what a text in Python is made of.

    >>> plain, with_comment = analysed(b"x = 1"), analysed(b"x = 1  # the first")
    >>> plain == with_comment, plain == analysed(b"x = 2")
    (True, False)
    """
    try:
        tree = ast.parse(content)
    except (SyntaxError, ValueError):  # who imports it tells the error
        return Source(hashlib.sha256(content).hexdigest(), frozenset())
    names: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
        if isinstance(node, ast.JoinedStr):  # Python 3.12.1 adds empty texts
            node.values = [part for part in node.values if getattr(part, "value", None) != ""]
        if isinstance(body := getattr(node, "body", None), list):
            node.body = [part for part in body if not _is_text(part)]  # type: ignore[attr-defined]
    own = {name for name in names if name.partition(".")[0] not in sys.stdlib_module_names}
    return Source(hashlib.sha256(_written(tree).encode()).hexdigest(), frozenset(own))


def _written(part: object) -> str:
    """Return a syntax tree as text, the same for all versions of Python.

    `ast.dump` writes empty fields or not, and each version adds some.
    """
    if isinstance(part, ast.AST):
        fields = ((name, value) for name, value in ast.iter_fields(part) if value not in (None, []))
        return f"{type(part).__name__}({','.join(f'{n}={_written(v)}' for n, v in fields)})"
    if isinstance(part, list):
        return f"[{','.join(map(_written, part))}]"
    return repr(part)


def _is_text(statement: ast.stmt) -> bool:
    """Tell whether a statement is a text alone: a docstring, or one of a constant."""
    value = statement.value if isinstance(statement, ast.Expr) else None
    return isinstance(value, ast.Constant) and isinstance(value.value, str)


class _Kept:
    """Digests and imports of files by the hash of their content, in a file on disk."""

    def __init__(self) -> None:
        self._known: dict[str, Any] | None = None
        self._is_new = False

    def source(self, key: str, content: bytes) -> Source:
        """Return a file by the hash of its content, analysed if it is not known."""
        if self._known is None:
            self._known = _load()
        try:
            digest, imports = self._known[key]
        except (KeyError, TypeError, ValueError):
            found = analysed(content)
            self._known[key] = [found.digest, sorted(found.imports)]
            self._is_new = True
            return found
        return Source(str(digest), frozenset(imports))

    def write(self) -> None:
        """Keep what is new; without a folder to write in, it is found again the next time."""
        if not self._is_new or self._known is None:
            return
        self._is_new = False
        latest = dict(list((_load() | self._known).items())[-MOST_KEPT:])
        for path in _places():
            with contextlib.suppress(OSError):
                _replace(path, json.dumps(latest))
                return


_KEPT = _Kept()
keep_digests = _KEPT.write


def _places() -> list[Path]:
    """Return where digests are kept: beside the source, or else with the user's other caches.

    Other versions of this file have other digests.
    """
    name = f"sources-{hashlib.sha256(Path(__file__).read_bytes()).hexdigest()[:8]}.json"
    cached = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return [Path(__file__).parent / "__pycache__" / name, Path(cached) / __package__ / name]


def _load() -> dict[str, Any]:
    for path in _places():
        with contextlib.suppress(OSError, ValueError):
            kept = json.loads(path.read_bytes())
            if isinstance(kept, dict):
                return kept
    return {}


def _replace(path: Path, text: str) -> None:
    """Write a file in one step, so that others never read a part of it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile("w", dir=path.parent, delete=False) as file:
        file.write(text)
    try:
        Path(file.name).chmod(0o644)
        Path(file.name).replace(path)
    except OSError:
        Path(file.name).unlink(missing_ok=True)
        raise
