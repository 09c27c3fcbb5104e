"""Fingerprints of the source change with an edit of all that a step depends on, and of no more."""

import shutil
from pathlib import Path

import pytest

import pyrofit
from pyrofit.provenance import SHOWING, source_fingerprint

SOURCE = Path(pyrofit.__file__).parent
EDITS = {
    "solver/run.py": {"study", "study page", "blind test", "blind test page"},
    "figures/style.py": {"study page", "blind test page"},
    "config/reference.py": {"study page", "blind test page"},
    "new_study/write.py": {"study page", "blind test page"},
    "blind_test/twin.py": {"blind test", "blind test page"},
    "blind_test/rates.py": {"blind test page"},
}


def fingerprints() -> dict[str, str]:
    return {
        "study": source_fingerprint(),
        "study page": source_fingerprint(showing=True),
        "blind test": source_fingerprint(blind_test=True),
        "blind test page": source_fingerprint(showing=True, blind_test=True),
    }


@pytest.fixture
def copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the source, of which fingerprints are taken."""
    root = tmp_path / "pyrofit"
    shutil.copytree(SOURCE, root, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr("pyrofit.provenance.__file__", str(root / "provenance.py"))
    return root


@pytest.mark.parametrize("edited", EDITS)
def test_edit_changes_the_fingerprints_of_what_depends_on_it(edited: str, copy: Path) -> None:
    before = fingerprints()
    assert before == fingerprints()
    with (copy / edited).open("a") as file:
        file.write("# edited\n")
    after = fingerprints()
    assert {name for name in before if before[name] != after[name]} == EDITS[edited]


def test_parts_that_only_show_exist() -> None:
    assert [part for part in SHOWING if not (SOURCE / part).exists()] == []
