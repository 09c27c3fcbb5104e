"""The finished study as the Python interface opens it."""

import pytest
from tiny import Project

import pyrofit as pf


def test_results_of_a_campaign_are_simulated_again(untouched: Project) -> None:
    campaign = pf.read_results(untouched.root / "results" / "tiny")
    study = campaign.study
    cost = next(iter(study.imp.costs))
    best = campaign["table4"]
    row = best[(best["cost_function"] == cost) & (best["quantity"] == "fit")]
    specs = study.imp.costs[cost]
    found = campaign.predict(cost, [specs[0].experiment])
    score = found.scores.set_index("signal").loc[specs[0].signal]
    assert specs[0].kind == "RMSE"
    assert score["cv_rmse"] == pytest.approx(float(row["best"].iloc[0]), rel=1e-6)
