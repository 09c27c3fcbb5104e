"""The target that compares the cost functions on twins of known truth."""

import shutil

from tiny import COSTS, Project


def test_robustness_is_a_target_of_its_own_that_leaves_table_and_figure(project: Project) -> None:
    assert not (project.root / "results/tiny/robustness").exists()
    run = project.snakemake("--cores", "2", "robustness")
    assert run.code == 0, run.said
    assert run.jobs == {
        *(f"Robustness, {cost}" for cost in COSTS),
        "Robustness of the cost functions: table and figure",
    }
    assert "Median error of the parameters in per cent of their limits" in run.said
    for name in ("table.csv", "table.md", "robustness.svg", "robustness.png"):
        assert (project.root / "results/tiny/robustness" / name).stat().st_size > 0
    # The report shows it from now on; the other tests share the project as it was.
    shutil.rmtree(project.root / "results/tiny/robustness")
