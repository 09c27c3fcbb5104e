"""The speed classes of the tests: which compile the solver, draw for long, or run the workflow.

The rest are the fast ones, `make test-fast`; none of them compiles a kernel.
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
FOLDERS = {
    "blind_test": "solver",
    "diagnose": "solver",
    "effects": "solver",
    "exchange": "solver",
    "explore": "solver",
    "recovery": "solver",
    "scheme": "solver",
    "slurm": "long",
    "verification": "solver",
    "workflow": "long",
}
FILES = {
    "test_archive": "slow",
    "test_archive_crate": "slow",
    "test_bad_input": "solver",
    "test_blind_test_parts": "long",
    "test_blind_test_short": "long",
    "test_char_in_air": "long",
    "test_compare_models": "solver",
    "test_comparison": "solver",
    "test_compiled_cache": "long",
    "test_config_diagnosis": "solver",
    "test_cost_properties": "slow",
    "test_diagnosis_shown": "slow",
    "test_ensemble": "solver",
    "test_estimate": "solver",
    "test_explore_browser": "long",
    "test_external_runs": "slow",
    "test_figures": "slow",
    "test_grid": "solver",
    "test_identify_stage": "solver",
    "test_input_properties": "slow",
    "test_interface_fits": "solver",
    "test_interface_json": "solver",
    "test_interface_weights": "solver",
    "test_isoconversional_stage": "solver",
    "test_lanes": "solver",
    "test_macfp_predictions": "solver",
    "test_macfp_submission": "solver",
    "test_noise": "slow",
    "test_objectives": "solver",
    "test_notebooks": "solver",
    "test_reaction_order": "solver",
    "test_python_page": "solver",
    "test_random_sets": "long",
    "test_ready_timing": "solver",
    "test_posterior_draws": "slow",
    "test_preview": "solver",
    "test_preview_errors": "long",
    "test_posterior_stage": "solver",
    "test_repeats_measured": "slow",
    "test_report": "slow",
    "test_report_steps": "slow",
    "test_rescore_stage": "solver",
    "test_robustness": "solver",
    "test_running": "slow",
    "test_sensitivity_stage": "solver",
    "test_slab_quantities": "solver",
    "test_sobol": "slow",
    "test_stages": "solver",
    "test_unmeasured": "solver",
    "test_worth_stage": "solver",
}
"""Files of another class than the others of their folder, which are fast unless it has a class."""
_LONGEST_FIRST = {"test_blind_test_short": 0, "test_kills": 1}


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
    return FILES.get(path.stem) or FOLDERS.get(path.relative_to(HERE).parts[0])


def in_part(items: list[pytest.Item], part: tuple[int, int]) -> list[pytest.Item]:
    """Return items without those of the class `long` whose file is not in a part."""
    k, n = part
    files = sorted({item.path for item in items if class_of(item.path) == "long"})
    others = {path for i, path in enumerate(files) if i % n != k - 1}
    return [item for item in items if item.path not in others]


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
    there = {path.stem for path in HERE.rglob("test_*.py")} | {path.name for path in HERE.iterdir()}
    lacking = sorted({*FOLDERS, *FILES} - there)
    if lacking:
        pytest.exit(f"tests/conftest.py: there is no {', '.join(lacking)}; correct it", 1)


class Refused(ModuleType):
    """Stands for a compiled module in a fast test."""

    def __getattr__(self, name: str) -> object:
        if name.startswith("__"):
            raise AttributeError(name)
        raise AssertionError(
            "a fast test runs the solver; give its file the class `solver` in tests/conftest.py"
        )


@pytest.fixture(autouse=True)
def _fast_tests_run_no_solver(
    request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not {mark.name for mark in request.node.iter_markers()} & {"slow", "solver", "long"}:
        for name in KERNELS:
            monkeypatch.setitem(sys.modules, name, Refused(name))
