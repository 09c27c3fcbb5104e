"""The target that scores stored sets again under other costs."""

import json
import shutil

from tiny import Project


def test_rescore_is_a_target_of_its_own_that_leaves_figures(project: Project) -> None:
    folder = project.root / "results/tiny/rescore"
    assert not folder.exists()
    run = project.snakemake("--cores", "2", "rescore")
    assert run.code == 0, run.said
    assert run.jobs == {"Stored sets scored again under other costs"}
    assert "rank correlation" in run.said
    assert json.loads((folder / "rescore.json").read_text())["drift"] < 1e-4
    for name in ("agreement", "agreement_best", "regret", "valleys"):
        assert (folder / f"{name}.svg").stat().st_size > 0
    # The report shows it from now on; the other tests share the project as it was.
    assert project.plan() == {"Report: results/tiny/report.html"}
    shutil.rmtree(folder)
