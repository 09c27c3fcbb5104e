"""The speed classes of the tests: which compile the solver, draw for long, or run the workflow.

A folder `slow`, `solver` or `long` has the tests of its class. The rest are the fast ones, `make
test-fast`; none of them compiles a kernel.
"""

import os
import signal
import sys
from argparse import ArgumentTypeError
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

HERE = Path(__file__).parent
# A shell starts background processes with Ctrl-C ignored; processes that a test interrupts heed it.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
CLASSES = ("fast", "slow", "solver", "long")
FOLDERS = {
    "compare": "solver",
    "diagnose": "solver",
    "effects": "solver",
    "exchange": "solver",
    "explore": "solver",
    "blind_test": "solver",
    "recovery": "solver",
    "scheme": "solver",
    "slurm": "long",
    "verification": "solver",
    "workflow": "long",
}
"""Classes of folders whose tests are not fast; the name of a folder in them goes before."""
_LONGEST_FIRST = {"test_blind_test_short": 0, "test_kills": 1}


# Helpers of several folders explain what they assert as the tests do.
pytest.register_assert_rewrite(*(path.stem for path in (HERE / "support").glob("*.py")))
KERNELS = [f"pyrofit.solver.kernels.{name}" for name in ("grid", "slab", "tga", "trace")]
"""Compiled modules that the solver imports when it runs."""


@pytest.fixture(scope="module", autouse=True)
def _no_run_is_left() -> Iterator[None]:
    """Forget the run that a module began in this process: later ones would be jobs of it."""
    before = {name: value for name, value in os.environ.items() if name.startswith("PYROFIT_")}
    yield
    for name in [name for name in os.environ if name.startswith("PYROFIT_")]:
        if name not in before:
            del os.environ[name]
    os.environ.update(before)


def part_of(text: str) -> tuple[int, int]:
    """Return k and n of the text ``k/n``: the k-th of n parts."""
    k, _, n = text.partition("/")
    if not (k.isdigit() and n.isdigit() and 1 <= int(k) <= int(n)):
        raise ArgumentTypeError(f"--part {text}: write K/N with K from 1 to N, such as 1/3")
    return int(k), int(n)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Let tests repeat faults at random moments more often, and start a Slurm."""
    parser.addoption("--thorough", action="store_true", help="repeat faults often, for an hour")
    parser.addoption(
        "--part",
        type=part_of,
        default=(1, 1),
        metavar="K/N",
        help="of the files of long tests, every N-th from the K-th on",
    )
    parser.addoption("--slurm", action="store_true", help="start a Slurm on this machine, as root")


def class_of(path: Path) -> str | None:
    """Return the speed class of a file's tests; none where they are fast, or examples."""
    if HERE not in path.parents:
        return None
    package, *inside = path.relative_to(HERE).parts
    name = inside[0] if inside and inside[0] in CLASSES else FOLDERS.get(package)
    return None if name == "fast" else name


def in_part(items: list[pytest.Item], part: tuple[int, int]) -> list[pytest.Item]:
    """Return items without the long ones whose file is not in a part."""
    k, n = part
    long = [i for i in items if class_of(i.path) == "long" or i.get_closest_marker("long")]
    files = sorted({item.path for item in long})
    others = {path for i, path in enumerate(files) if i % n != k - 1}
    dropped = {item for item in long if item.path in others}
    return [item for item in items if item not in dropped]


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark tests with the speed class of their folder or file; skip those that lack their data."""
    no_data = pytest.mark.skip(reason="PYROFIT_DATA_DIR is not set")
    for item in items:
        if item.get_closest_marker("measured") and not os.environ.get("PYROFIT_DATA_DIR"):
            item.add_marker(no_data)
        if item.path.parent == HERE / "slurm" and not item.config.getoption("--slurm"):
            item.add_marker(pytest.mark.skip(reason="make test-slurm runs it"))
        if name := class_of(item.path):
            item.add_marker(name)
    kept = in_part(items, config.getoption("--part"))
    # The longest first, so that no process waits for another one at the end.
    items[:] = sorted(kept, key=lambda item: _LONGEST_FIRST.get(item.path.stem, 2))


def pytest_sessionstart() -> None:
    """Refuse a class of what is not there."""
    lacking = sorted({*FOLDERS} - {path.name for path in HERE.iterdir()})
    if lacking:
        pytest.exit(f"tests/conftest.py: there is no {', '.join(lacking)}; correct it", 1)


class Refused(ModuleType):
    """Stands for a compiled module in a fast test."""

    def __getattr__(self, name: str) -> object:
        if name.startswith("__"):
            raise AttributeError(name)
        raise AssertionError("a fast test runs the solver; move its file into a folder `solver`")


@pytest.fixture(autouse=True)
def _fast_tests_run_no_solver(
    request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not {mark.name for mark in request.node.iter_markers()} & {"slow", "solver", "long"}:
        for name in KERNELS:
            monkeypatch.setitem(sys.modules, name, Refused(name))
