"""The example on the page of the Python interface."""

import re
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def test_example_of_the_page_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    page = (ROOT / "docs" / "site" / "api.md").read_text(encoding="utf-8")
    example = re.search(r"```python\n(.*?)```", page, re.S)
    assert example is not None
    script = tmp_path / "example.py"
    script.write_text(example[1], encoding="utf-8")
    monkeypatch.chdir(ROOT)
    runpy.run_path(str(script))
    finished, temperature = capsys.readouterr().out.split()
    assert finished == "True"
    # The back of a slab of 4 mm after 26 min under 25 kW/m2, in kelvin.
    assert 500 < float(temperature) < 1000
