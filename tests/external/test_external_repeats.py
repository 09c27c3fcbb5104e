"""Repeats of a test that a program simulates, and what may be uncertain of it."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from decay import study, write

from pyrofit.config import as_study
from pyrofit.errors import StudyError
from pyrofit.estimate.problem import make_problem
from pyrofit.stages.reading import read_all


def measured(folder: Path, **keys: Any) -> dict[str, Any]:
    """Return the keys of a study with two measured repeats."""
    mine = write(folder).parent
    t = np.arange(0.0, 98.0, 2.0)
    for n, height in enumerate((0.011, 0.013), 1):
        rows = (f"{a:g},{height * np.exp(-0.03 * a):.8g}\n" for a in t)
        text = "time_s,mass_loss_rate_kg_m2_s\n" + "".join(rows)
        (mine / f"r{n}.csv").write_text(text)
    given = study()
    del given["synthetic"]
    plate = given["experiments"]["plate"]
    columns = {"time": "time_s", "value": "mass_loss_rate_kg_m2_s"}
    plate["signals"] = {"mlr": {"columns": columns, "units": {"time": "s", "value": "kg/m2/s"}}}
    tests = [{"signals": {"mlr": f"r{n}.csv"}} for n in (1, 2)]
    plate["repeats"] = {"tests": tests, **keys}
    return given


def test_repeats_share_the_runs_of_the_program(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYROFIT_SCRATCH", str(tmp_path / "scratch"))
    monkeypatch.setenv("RUNS", str(tmp_path / "runs.txt"))
    given = measured(tmp_path / "mine")
    found = as_study(given, str(tmp_path / "mine" / "study.yaml"))
    specs = found.imp.costs["RMSE"]
    assert [spec.experiment for spec in specs] == ["plate_1", "plate_2"]
    series = {key: frame for key, (frame, _) in read_all(found).items()}
    problem = make_problem(found, found.imp.estimate, specs, series, found.material, {})
    between, at_the_first = problem.evaluate_all(np.array([[12.0, 0.03], [11.0, 0.03]]))
    assert 0.0 < between.cost < at_the_first.cost
    assert len((tmp_path / "runs.txt").read_text().splitlines()) == 2


@pytest.mark.parametrize("key", ["thickness_sd", "flux_sd", "clock_sd_s", "temperature_sd_K"])
@pytest.mark.parametrize("of_repeats", [True, False])
def test_what_a_program_cannot_vary_is_refused_with_the_way_out(
    key: str, of_repeats: bool, tmp_path: Path
) -> None:
    if of_repeats:
        given, place = measured(tmp_path, **{key: 0.02}), f"experiments.plate.repeats.plate_1.{key}"
    else:
        write(tmp_path)
        given, place = study(), f"experiments.plate.uncertain.{key}"
        given["experiments"]["plate"]["uncertain"] = {key: 0.02}
    with pytest.raises(StudyError) as error:
        as_study(given, str(tmp_path / "study.yaml"))
    assert place in str(error.value)
    assert "make it one of the `parameters`, with a value under `known`" in str(error.value)
