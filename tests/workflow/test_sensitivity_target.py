"""The targets that tell what signals depend on, and what planned tests are worth."""

import json
import shutil

from tiny import Project


def test_sensitivity_and_worth_are_targets_of_their_own(project: Project) -> None:
    folders = [project.root / "results/tiny" / name for name in ("sensitivity", "worth")]
    assert not any(folder.exists() for folder in folders)
    run = project.snakemake("--cores", "2", "sensitivity", "worth")
    assert run.code == 0, run.said
    assert run.jobs == {"Sensitivity of signals over time and of costs", "Worth of planned tests"}
    assert "depends most on" in run.said
    assert "narrows parameters and predictions most" in run.said
    assert json.loads((folders[0] / "sensitivity.json").read_text())["within"] == "limits"
    found = json.loads((folders[1] / "worth.json").read_text())
    assert set(found["estimate"]) == {"T_p", "E_p", "rho", "k"}
    assert {"tga_20K_again", "slab_60_again"} <= {test["name"] for test in found["tests"]}
    for name in ("total", "apparatus", "first", "costs"):
        assert (folders[0] / f"{name}.svg").stat().st_size > 0
    # The report shows them from now on; the other tests share the project as it was.
    assert project.plan() == {"Report: results/tiny/report.html"}
    for folder in folders:
        shutil.rmtree(folder)
