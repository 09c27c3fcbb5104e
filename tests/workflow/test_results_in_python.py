"""The finished study as the Python interface opens it."""

import pytest
from tiny import Project

import pyrofit as pf
from pyrofit.results.files import Results
from pyrofit.results.kinetics import fixed_for_imp
from pyrofit_exchange.sets import parameter_set


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


def test_every_parameter_has_one_value_wherever_it_is_used(untouched: Project) -> None:
    folder = untouched.root / "results" / "tiny"
    campaign = pf.read_results(folder)
    study, results = campaign.study, Results(folder)
    values, estimates = campaign.values, campaign.estimates["estimate"]
    assert study.imp.kinetics == "fitted"
    assert set(estimates.index) <= set(values)
    assert [values[n] for n in estimates.index] == pytest.approx(estimates.tolist(), rel=1e-12)
    exported = parameter_set(study, results, "", folder)
    assert exported.label == "estimates"
    factors = {n: study.parameters[n].factor for n in values}
    assert {n: v / factors[n] for n, v in exported.values.items()} == values
    table = campaign["table3"].set_index(["quantity", "unit"])
    assert float(table.loc[("E", "kJ/mol"), "fitted"]) == pytest.approx(values["E_p"])
    assert fixed_for_imp(study, results)["E_p"] == values["E_p"] * factors["E_p"]
    # The curves of the validation are those of these values.
    scores = campaign.predict().scores.set_index(["experiment", "signal"])
    shown = campaign["validation"].query("found_by == 'estimates'")
    assert len(shown) == len(scores)
    rates = scores["cv_rmse"].dropna()
    assert sorted(shown["cv_rmse"].dropna()) == pytest.approx(sorted(rates), rel=1e-6)
