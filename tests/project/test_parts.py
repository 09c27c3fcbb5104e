"""The parts into which `--part` splits the files of the long tests."""

import importlib.util
from argparse import ArgumentTypeError
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest

TESTS = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def classes() -> ModuleType:
    spec = importlib.util.spec_from_file_location("speed_classes", TESTS / "conftest.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_parts_hold_each_long_file_once_and_all_others_each(classes: ModuleType) -> None:
    items = [SimpleNamespace(path=path) for path in sorted(TESTS.rglob("test_*.py"))]
    long = {item.path for item in items if classes.class_of(item.path) == "long"}
    parts = [{item.path for item in classes.in_part(items, (k, 3))} for k in (1, 2, 3)]
    assert len(long) > 20
    assert sorted(path for part in parts for path in part & long) == sorted(long)
    assert all(part >= {item.path for item in items} - long for part in parts)


@pytest.mark.parametrize("text", ["0/3", "4/3", "1", "a/b", "1/0", ""])
def test_bad_part_is_refused(classes: ModuleType, text: str) -> None:
    with pytest.raises(ArgumentTypeError, match="K/N"):
        classes.part_of(text)
