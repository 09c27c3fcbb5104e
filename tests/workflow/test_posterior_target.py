"""The target that draws from the posterior of a finished study."""

from tiny import Project


def test_posterior_is_a_target_of_its_own_that_needs_what_is_there(untouched: Project) -> None:
    run = untouched.snakemake("--cores", "1", "--dry-run", "posterior")
    assert run.code == 0, run.said
    assert run.jobs == {"Parameters drawn from the posterior, and predictions with bands"}
    assert not (untouched.root / "results/tiny/posterior").exists()
