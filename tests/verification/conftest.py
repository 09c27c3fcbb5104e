"""The ``evidence`` fixture, and the page it writes with ``--page``."""

import inspect
from collections.abc import Iterator
from pathlib import Path

import pytest
import verification_page as page
from evidence import Evidence
from verification_page import Collected

HERE = Path(__file__).parent


SESSION = pytest.StashKey[Collected]()


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--page", type=Path, help="write the verification page into this folder")


def pytest_configure(config: pytest.Config) -> None:
    config.stash[SESSION] = Collected()


def _module(item: pytest.Item) -> str:
    return item.path.stem if HERE in item.path.parents else ""


def _folder(config: pytest.Config) -> Path | None:
    folder: Path | None = config.getoption("--page", default=None)
    return folder


def pytest_deselected(items: list[pytest.Item]) -> None:
    for item in items:
        item.config.stash[SESSION].partial.add(_module(item))


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Let the test of the page come last; leave it out where the page is being written."""
    collected = config.stash[SESSION]
    for argument in config.args:
        if "::" in argument:
            collected.partial.add(Path(argument.split("::")[0]).stem)
    last = [item for item in items if _module(item) == "test_page"]
    items[:] = [item for item in items if item not in last] + ([] if _folder(config) else last)


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Iterator[None]:
    outcome = yield
    report = outcome.get_result()
    collected = item.config.stash[SESSION]
    if report.skipped:
        collected.skipped.add(_module(item))
    elif report.failed:
        collected.partial.add(_module(item))


@pytest.fixture
def evidence(request: pytest.FixtureRequest) -> Evidence:
    """Return the place where a test states what it verifies; see `evidence.Evidence`."""
    collected = request.config.stash[SESSION]
    module = request.module
    collected.texts[module.__name__] = inspect.cleandoc(module.__doc__)
    return Evidence(module.__name__, collected.keep)


@pytest.fixture
def collected(request: pytest.FixtureRequest) -> Collected:
    """Return what the tests before have stated."""
    return request.config.stash[SESSION]


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    folder = _folder(session.config)
    if folder is None:
        return
    collected = session.config.stash[SESSION]
    modules = {_module(item): item.module for item in session.items}
    wanted = {path.stem for path in HERE.rglob("test_*.py")} - {"test_page"}
    lacking = sorted(wanted - set(modules) | wanted & collected.partial)
    if lacking:
        pytest.exit(
            f"the page is not written: {', '.join(lacking)} failed or did not run whole",
            returncode=1,
        )
    stating = {case.section for case in collected.cases}
    left_out = sorted(wanted & collected.skipped - stating, key=page.rank)
    for name in left_out:
        collected.texts[name] = inspect.cleandoc(modules[name].__doc__)
    page.write(folder, collected.cases, collected.texts, left_out)
