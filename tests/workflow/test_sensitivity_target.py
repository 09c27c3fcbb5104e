"""The target that shares out the variance of signals and costs."""

import json
import shutil

from tiny import Project


def test_sensitivity_is_a_target_of_its_own_that_leaves_figures(project: Project) -> None:
    folder = project.root / "results/tiny/sensitivity"
    assert not folder.exists()
    run = project.snakemake("--cores", "2", "sensitivity")
    assert run.code == 0, run.said
    assert run.jobs == {"Sensitivity of signals over time and of costs"}
    assert "depends most on" in run.said
    assert json.loads((folder / "sensitivity.json").read_text())["within"] == "limits"
    for name in ("total", "apparatus", "first", "costs"):
        assert (folder / f"{name}.svg").stat().st_size > 0
    # The report shows it from now on; the other tests share the project as it was.
    assert project.plan() == {"Report: results/tiny/report.html"}
    shutil.rmtree(folder)
