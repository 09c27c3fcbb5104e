"""The parts into which `--part` splits the files of the long tests."""

import importlib.util
from argparse import ArgumentTypeError
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import pytest

TESTS = Path(__file__).parents[1]


@dataclass(frozen=True)
class Item:
    """A test as far as parts look at it."""

    path: Path
    marked: bool = False

    def get_closest_marker(self, name: str) -> str | None:
        return name if self.marked else None


@pytest.fixture(scope="module")
def classes() -> ModuleType:
    spec = importlib.util.spec_from_file_location("speed_classes", TESTS / "conftest.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_parts_hold_each_long_file_once_and_all_others_each(classes: ModuleType) -> None:
    items = [Item(path) for path in sorted(TESTS.rglob("test_*.py"))]
    long = {item.path for item in items if classes.class_of(item.path) == "long"}
    parts = [{item.path for item in classes.in_part(items, (k, 3))} for k in (1, 2, 3)]
    assert len(long) > 20
    assert sorted(path for part in parts for path in part & long) == sorted(long)
    assert all(part >= {item.path for item in items} - long for part in parts)


def test_long_test_in_a_file_of_another_class_is_in_one_part(classes: ModuleType) -> None:
    path = TESTS / "project" / "test_parts.py"
    items = [Item(path), Item(path, marked=True)]
    parts = [classes.in_part(items, (k, 3)) for k in (1, 2, 3)]
    assert parts == [items, items[:1], items[:1]]


@pytest.mark.parametrize("text", ["0/3", "4/3", "1", "a/b", "1/0", ""])
def test_bad_part_is_refused(classes: ModuleType, text: str) -> None:
    with pytest.raises(ArgumentTypeError, match="K/N"):
        classes.part_of(text)
