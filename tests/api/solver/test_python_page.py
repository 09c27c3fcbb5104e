"""The examples on the pages of the Python interface."""

import re
import runpy
from functools import partial
from pathlib import Path

import matplotlib
import pytest

from pyrofit.stages.measurements import computed

matplotlib.use("agg")
ROOT = Path(__file__).parents[3]


def examples(page: str) -> list[str]:
    """Return the examples of a page that need no files of the reader."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    found = re.findall(r"```python\n(.*?)```", text, re.S)
    return [code for code in found if not code.startswith("# your files")]


def run(code: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, object]:
    script = folder / "example.py"
    script.write_text(code, encoding="utf-8")
    monkeypatch.chdir(ROOT)
    return runpy.run_path(str(script))


def test_example_of_the_reference_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (example,) = examples("site/api.md")
    run(example, tmp_path, monkeypatch)
    finished, temperature = capsys.readouterr().out.split()
    assert finished == "True"
    # The back of a slab of 4 mm after 26 min under 25 kW/m2, in kelvin.
    assert 500 < float(temperature) < 1000


def test_report_on_the_page_is_that_of_its_examples(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The reference solver would take most of the time.
    monkeypatch.setattr("pyrofit.api.measurements.computed", partial(computed, fast=True))
    names = run("\n".join(examples("python.md")), tmp_path, monkeypatch)
    page = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    shown = re.findall(r"```text\n(.*?)```", page, re.S)[0]
    # The last digits differ between kinds of machine.
    assert words(shown) == words(str(names["fit"]))


def words(report: str) -> list[str]:
    """Return what is no number."""
    return re.findall(r"[A-Za-z_]{2,}", report)
