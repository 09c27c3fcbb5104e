"""Notebooks of the documentation: they hold their results, and run as they stand."""

import json
import pickle
import runpy
from functools import partial
from pathlib import Path

import matplotlib
import pytest

import pyrofit as pf
from pyrofit.stages.measurements import computed

matplotlib.use("agg")
FOLDER = Path(__file__).parents[3] / "docs" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


def cells(path: Path) -> list[dict]:
    return json.loads(path.read_text(encoding="utf-8"))["cells"]


def run(path: Path, monkeypatch: pytest.MonkeyPatch) -> dict:
    """Run the code of a notebook in its folder, and return the names that it defines."""
    import matplotlib.pyplot as plt

    monkeypatch.chdir(FOLDER)
    # The reference solver would take most of the time.
    monkeypatch.setattr("pyrofit.api.measurements.computed", partial(computed, fast=True))
    names: dict = {"__name__": "__main__"}
    for cell in cells(path):
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), path.name, "exec"), names)
    plt.close("all")
    return names


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_holds_results_of_one_run(path: Path) -> None:
    code = [cell for cell in cells(path) if cell["cell_type"] == "code"]
    assert [cell["execution_count"] for cell in code] == list(range(1, len(code) + 1))
    kinds = {output["output_type"] for cell in code for output in cell["outputs"]}
    assert kinds >= {"execute_result", "display_data"}
    assert "error" not in kinds
    assert not any(line.startswith(("%", "!")) for cell in code for line in cell["source"])
    text = path.read_text(encoding="utf-8")
    assert len(text) < 200_000
    assert str(Path.home()) not in text
    assert str(FOLDER.parents[1]) not in text


def test_cells_run_as_in_jupyter() -> None:
    tool = runpy.run_path(str(FOLDER.parents[1] / "tools" / "run_notebooks.py"))
    source = [
        "import matplotlib.pyplot as plt\nimport pandas as pd\nprint('said')",
        "pd.DataFrame({'a': [1]})",
        "plt.plot([1, 2]);",
        "b = 2",
    ]
    code = [{"cell_type": "code", "source": [text]} for text in source]
    found = tool["executed"]({"cells": [{"cell_type": "markdown", "source": ["x"]}, *code]})
    said, table, drawn, nothing = (cell["outputs"] for cell in found["cells"][1:])
    assert [(o["output_type"], o["text"]) for o in said] == [("stream", ["said\n"])]
    assert set(table[0]["data"]) == {"text/html", "text/plain"}
    assert [o["output_type"] for o in drawn] == ["display_data"]
    assert nothing == []
    assert found["cells"][-1]["execution_count"] == 4


def test_simulation_is_fitted(monkeypatch: pytest.MonkeyPatch) -> None:
    names = run(FOLDER / "simulate_and_fit.ipynb", monkeypatch)
    assert names["table"]["off [sd]"].abs().max() < 3.5
    assert names["held_out"].scores["r2"].min() > 0.98


def test_own_files_are_fitted(monkeypatch: pytest.MonkeyPatch) -> None:
    names = run(FOLDER / "own_files.ipynb", monkeypatch)
    truth = names["other"].synthetic.truth
    assert abs(names["kinetics"].table.loc["T_p", "value"] - truth["T_p"]) < 1.0
    for name, row in names["fit"].table.iterrows():
        assert abs(row["value"] - truth[name]) < 4.0 * row["sd"], name
    assert names["test"].scores["r2"].min() > 0.98


def test_missing_effect_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    names = run(FOLDER / "diagnosis.ipynb", monkeypatch)
    assert isinstance(names["diagnosis"], pf.Diagnosis)
    assert names["diagnosis"].kind == "named"
    assert names["diagnosis"].effects == ["k_T"]
    assert pickle.loads(pickle.dumps(names["diagnosis"])).content == names["diagnosis"].content
    assert names["fit"].reduced_chi2 > 1.3
    assert names["again"].reduced_chi2 < 1.1


def test_best_sets_of_a_campaign_are_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    names = run(FOLDER / "campaign.ipynb", monkeypatch)
    sets, scores = names["sets"], names["scores"]
    assert list(sets) == ["RMSE", "RANGE", "BANDS", "truth"]
    assert (sets.loc["rho"] - sets.loc["rho", "truth"]).abs().max() < 30
    assert list(scores) == ["RMSE", "RANGE", "BANDS"]
    # The noise is 2e-4 kg/(m2 s); slab_60 is held out.
    assert (scores.loc[("slab_25", "mlr")] < 3e-4).all()
    assert (scores.loc[("slab_60", "mlr")] > scores.loc[("slab_25", "mlr")]).all()
