"""Few twins of the blind test from the reference solver; with --thorough the plan `short`."""

import subprocess
from pathlib import Path

import pandas as pd
import pytest
from tiny import Project

ROOT = Path(__file__).parents[3]
SNAKEFILE = "workflow/blind_test.smk"
FEWEST = {"sample": (1, 1), "short": (6, 4)}
"""By plan, twins without an effect, and effects that stand out and are named, at least."""


@pytest.fixture(scope="module")
def plan(request: pytest.FixtureRequest) -> str:
    return "short" if request.config.getoption("--thorough") else "sample"


@pytest.fixture(scope="module")
def folder(plan: str) -> str:
    return f"results/blind_test/{plan}"


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory, folder: str) -> Project:
    """A copy of the project in which the plan has been run."""
    made = Project.copy(ROOT, tmp_path_factory.mktemp("blind_test") / "project")
    subprocess.run(
        ["snakemake", "--nocolor", "--snakefile", SNAKEFILE, "--cores", "2", f"{folder}/page.md"],
        cwd=made.root,
        env=made.environment,
        check=True,
    )
    return made


@pytest.fixture(scope="module")
def twins(project: Project, folder: str) -> pd.DataFrame:
    return pd.read_csv(project.root / folder / "tables" / "twins.csv", keep_default_na=False)


def test_nothing_is_found_where_nothing_is_hidden(twins: pd.DataFrame, plan: str) -> None:
    nulls = twins[twins["kind"] == "null"]
    assert len(nulls) >= FEWEST[plan][0]
    assert set(nulls["verdict"]) == {"none"}


def test_effects_that_stand_out_are_named(twins: pd.DataFrame, plan: str) -> None:
    seen = twins[(twins["kind"] == "effect") & (twins["detectability"] >= 10.0)]
    assert seen["claim"].all()
    # Of two that fit alike an ambiguous verdict names none: that its set holds the truth is asked
    # for below.
    named = seen[seen["verdict"] != "ambiguous"]
    assert len(named) >= FEWEST[plan][1]
    assert named["right"].all()


def test_names_are_better_than_those_of_the_largest_score(twins: pd.DataFrame, plan: str) -> None:
    if plan == "sample":
        pytest.skip("too few twins; --thorough has more")
    seen = twins[(twins["kind"] == "effect") & (twins["detectability"] >= 10.0)]
    assert seen["right"].sum() > seen["score_only_right"].sum()


def test_other_form_is_never_taken_for_another_group(twins: pd.DataFrame) -> None:
    forms = twins[twins["kind"] == "form"]
    assert len(forms) >= 1
    assert forms[forms["claim"]]["group_right"].all()


def test_claims_hold_the_truth(twins: pd.DataFrame) -> None:
    claimed = twins[twins["claim"] & (twins["kind"] != "form")]
    assert claimed["in_set"].all()
    assert pd.to_numeric(claimed["set_size"]).mean() <= 2.0


def test_both_effects_of_a_pair_are_found(twins: pd.DataFrame) -> None:
    pairs = twins[twins["kind"] == "pair"]
    assert len(pairs) >= 1
    assert pairs["in_set"].all()


def test_effect_that_is_no_candidate_is_not_replaced_by_another(
    twins: pd.DataFrame, plan: str
) -> None:
    if plan == "sample":
        pytest.skip("too few twins; --thorough has more")
    again = twins[twins["left_out"] != ""]
    assert len(again) >= 1
    assert not again["left_out_wrong"].astype(bool).any()


def test_gap_shrinks_on_what_was_held_out(twins: pd.DataFrame) -> None:
    found = twins[(twins["kind"] == "effect") & twins["right"]]
    gained = pd.to_numeric(found["held_out_gain"])
    assert (gained > 0.0).mean() >= 0.9


def test_page_shows_rates_and_figures(project: Project, folder: str) -> None:
    page = (project.root / folder / "page.md").read_text()
    assert "no hidden effect: claimed" in page
    for name in ("confusion", "accuracy", "false_alarms"):
        assert list((project.root / folder / "figures").glob(f"*{name}*.png"))
