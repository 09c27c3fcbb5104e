from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from shown_studies import _starts, described, fake, made, repeats, synthetic

from pyrofit.analysis import optimisers, uses
from pyrofit.analysis.estimates import Estimated
from pyrofit.analysis.recovery import recovery_row
from pyrofit.analysis.repetitions import OverRepetitions
from pyrofit.config import as_study
from pyrofit.errors import StudyError
from pyrofit.results.files import read_csv, write_csv
from pyrofit.results.kinetics import LOWEST
from pyrofit.show.facts import facts_of
from pyrofit.show.names import data_name, flag
from pyrofit.show.sections import TABLES, make_named
from pyrofit.show.subjects.costs.table5 import table5
from pyrofit.show.subjects.fit.table4 import flags
from pyrofit.show.subjects.identification.sentences import sentences
from pyrofit.show.table import readable
from pyrofit.show.text import number


@pytest.mark.parametrize("name", [name for name in TABLES if name != "heat_scores"])
def test_every_table_is_written_twice_and_alike_each_time(name: str, tmp_path: Path) -> None:
    needs = {
        "truth": synthetic,
        "known_values": lambda: described(known={"k": {"value": 0.2, "sd": 0.01}}),
        "repeats": repeats,
    }
    study, results = fake(tmp_path, needs.get(name, described)())
    make_named(name, study, results)
    files = [tmp_path / "tables" / f"{name}.{kind}" for kind in ("csv", "md")]
    first = [path.read_bytes() for path in files]
    make_named(name, study, results)
    assert [path.read_bytes() for path in files] == first
    assert b"nan" not in first[1].lower()
    assert b"None" not in first[1]


def test_table3_gives_both_units_of_E_and_marks_the_fitted_rates(tmp_path: Path) -> None:
    table = made("table3", *fake(tmp_path)).set_index(["quantity", "of", "unit"])
    assert table.loc[("E", "reaction pyrolysis", "kJ/mol"), "fitted"] == 190.0
    assert table.loc[("E", "reaction pyrolysis", "kJ/kmol"), "fitted"] == 190000.0
    assert table.loc[("cost", "fit", "-"), LOWEST] == 0.0125
    scores = table.loc["RMSE of mass fraction"]
    # Slowest first; 'slow' alone was fitted; its scores are 0.02 and, for the book, 2 more;
    # a run that is neither fitted nor compared has no score.
    assert scores["used_in_fit"].tolist() == ["yes", "no"]
    assert scores["fitted"].tolist() == [0.02, 0.01]
    assert scores["book"].tolist() == [2.02, 2.01]


def test_table4_by_hand(tmp_path: Path) -> None:
    table = made("table4", *fake(tmp_path)).set_index(["cost_function", "quantity"])
    fit = table.loc[("RMSE", "fit")]
    assert fit["best"] == 0.10
    assert fit["mean"] == pytest.approx(0.11, rel=1e-14)
    # Deviations -0.01, 0.01, 0: sqrt(2e-4 / (3 - 1)).
    assert fit["sigma"] == pytest.approx(0.01, rel=1e-12)
    assert fit["published_sigma"] == 0.3
    # J/(kg K) become kJ/(kg K); the best is that of the best cost, not the mean's neighbour.
    cp = table.loc[("RMSE", "cp")]
    assert [cp["best"], cp["mean"], cp["sigma"]] == pytest.approx([1.0, 2.0, 1.0], rel=1e-14)
    assert cp["flags"].startswith("spread > 20 % of search range; undetermined")
    # 0.4985 is 0.0015 below 0.5, and 0.5 % of 0.4 is 0.002; sigma = sqrt(0.004852/2) < 0.08.
    k = table.loc[("BANDS", "k")]
    assert k["flags"] == "at limit (upper)"
    assert np.isnan(k["published_best"])


def test_table5_has_the_papers_symbols_with_its_misprints_corrected(tmp_path: Path) -> None:
    table = made("table5", *fake(tmp_path)).set_index("symbol")
    assert len(table) == 12
    assert table["paper_unit"].to_dict() == {
        "E": "kJ/kmol",
        "ρ": "kg/m3",
        "ε": "-",
        "Δh": "kJ/kg",
        "MLR": "kg/(s m2)",
        "A": "1/s",
        "T": "°C",
        "k": "W/(m K)",
        "t": "s",
        "c_p": "kJ/(kg K)",
        "σ": "as the data",
        "n": "-",
    }
    here = table["parameters"].dropna().to_dict()
    assert here == {"T": "T_p [K]", "k": "k [W/(m K)]", "c_p": "cp [kJ/(kg K)]"}
    assert table.loc["c_p", "si_unit"] == "J/(kg K)"


def test_table5_gives_parameters_that_are_none_of_its_symbols_a_row_of_their_own() -> None:
    given = described()
    given["parameters"]["slope"] = {"unit": "1/K", "value": 0.0, "label": "slope of k"}
    given["parameters"]["d"] = {"unit": "mm", "value": 4.0}
    polymer = given["material"]["components"]["polymer"]
    polymer["conductivity_W_mK"] = {"value": "k", "slope_1_K": "slope"}
    given["experiments"]["slab_25"]["sample"] = {"layers": [{"thickness_m": "d"}]}
    table = table5(as_study(given, "fake.json"), None).set_index("symbol")
    assert table.loc["k", "parameters"] == "k [W/(m K)]"
    assert table.index[12:].tolist() == ["slope", "d"]
    assert table.loc["slope", ["quantity", "parameters"]].tolist() == ["slope of k", "slope [1/K]"]


def test_table6_by_hand(tmp_path: Path) -> None:
    given = described()
    given["published"]["costs"]["BANDS"] = {"k": [0.35, 0.3, 0.1]}
    given["published"]["limits"] = {"k": [0.09, 0.55]}
    table = made("table6", *fake(tmp_path, given)).set_index(["stage", "parameter"])
    assert table.index.tolist() == [
        ("kinetics", "T_p"),
        ("inverse modelling", "k"),
        ("inverse modelling", "cp"),
    ]
    limits = table[["lower_limit", "upper_limit"]].to_numpy().tolist()
    assert limits == [[560, 660], [0.1, 0.5], [0.5, 3.5]]
    theirs = table[["published_lower", "published_upper"]]
    assert theirs.loc[("inverse modelling", "k")].tolist() == [0.09, 0.55]
    assert theirs.drop(("inverse modelling", "k")).isna().all(axis=None)
    best = ["published_lowest", "published_highest"]
    assert table.loc[("inverse modelling", "k"), best].tolist() == [0.2, 0.35]
    assert table.loc[("inverse modelling", "cp"), best].tolist() == [2.0, 2.0]
    assert table.loc[("kinetics", "T_p"), best].isna().all()


def test_table6_of_a_study_without_published_numbers_shows_its_own_limits_alone(
    tmp_path: Path,
) -> None:
    table = made("table6", *fake(tmp_path, synthetic()))
    assert not [column for column in table if column.startswith("published")]


def test_determined_by_hand(tmp_path: Path) -> None:
    table = made("determined", *fake(tmp_path)).set_index("parameter")
    k, cp = table.loc["k"], table.loc["cp"]
    assert k[["low", "high", "noise_low", "width_percent"]].tolist() == [0.28, 0.32, 0.29, 10.0]
    # J/(kg K) become kJ/(kg K).
    assert cp[["estimate", "low", "high"]].tolist() == [3.5, 1.4, 3.5]
    assert cp["ends"] == "upper"
    assert [k["method"], cp["method"]] == ["linear", "profile"]
    assert k["strongest_correlation"] == "cp −0.80"


def test_trade_offs_by_hand(tmp_path: Path) -> None:
    (row,) = made("trade_offs", *fake(tmp_path)).to_dict("records")
    assert (row["parameter"], row["partner"]) == ("k", "cp")
    # k by its sd of 0.01; cp by -0.8 times 800 J/(kg K).
    assert row["rise"] == 0.01
    assert (row["shift"], row["partner_unit"]) == (pytest.approx(-0.64), "kJ/(kg K)")
    assert row["correlation"] == -0.8


def test_report_names_strongly_correlated_pairs(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    facts = facts_of(study, results, {})
    words = (
        "These changes compensate each other in the inverse modelling, the strongest first: "
        "k +0.01 W/(m K) and cp −0.64 kJ/(kg K)."
    )
    assert words in sentences(study, facts)
    weak = [replace(pair, correlation=-0.69) for pair in facts.trade_offs]
    assert words not in sentences(study, replace(facts, trade_offs=weak))


def test_noise_gives_chi_square_per_point(tmp_path: Path) -> None:
    kinetics, row = made("noise", *fake(tmp_path)).to_dict("records")
    assert kinetics["signal"] == "mass fraction"
    assert (row["experiment"], row["signal"]) == ("Slab 25 kW/m²", "mass loss rate")
    assert row["chi2_per_point"] == 3.6


def test_distances_by_hand(tmp_path: Path) -> None:
    table = made("distances", *fake(tmp_path))
    rows = table[table["cost_function"] == "RMSE"]
    assert rows["chi2_per_freedom"].tolist() == [5.0, 10.0, 15.0, 20.0]
    # k is 0.5, 1, 1.5, 2 and cp 1, 2, 3, 4 standard deviations off; 1.96 bound the interval.
    assert rows["within"].tolist() == [2, 1, 1, 0]
    assert rows["farthest"].tolist() == ["cp"] * 4
    assert rows["distance_sd"].tolist() == [1.0, 2.0, 3.0, 4.0]


def test_verdicts_are_flags_of_table4(tmp_path: Path) -> None:
    table = made("table4", *fake(tmp_path)).set_index(["cost_function", "quantity"])
    words = "undetermined by the data; estimate at its upper limit"
    assert table.loc[("RMSE", "cp"), "flags"] == f"spread > 20 % of search range; {words}"
    assert table.loc[("RMSE", "k"), "flags"] == "at limit (upper)"


def test_flag_of_a_parameter_at_its_bound() -> None:
    words = {
        "unit": "-",
        "most": "flux",
        "method": "linear",
        "partner": "",
        "verdict": "at its lower limit",
    }
    numbers = dict.fromkeys(("value", "low", "high", "width", "apparatus"), 0.1)
    none = dict.fromkeys(("cut_off", "noise_low", "noise_high", "correlation"))
    low = Estimated(stage="imp", name="k", bound="lower", **words, **numbers, **none)
    assert low.grade == "at a limit"
    assert flag(low) == "estimate at its lower limit"


def test_flags_at_their_limits() -> None:
    def said(best: float, sigma: float) -> str:
        return flags(OverRepetitions("RMSE", "k", best, best, sigma, 0.0, 2.0))

    assert said(0.009, 0.0) == "at limit (lower)"
    assert said(0.011, 0.0) == ""
    assert said(1.0, 0.41) == "spread > 20 % of search range"
    assert said(1.0, float("nan")) == ""
    assert said(1.999, 0.5) == "at limit (upper); spread > 20 % of search range"


def test_table4_of_synthetic_data_shows_nothing_published(tmp_path: Path) -> None:
    table = made("table4", *fake(tmp_path, synthetic()))
    assert not [column for column in table if column.startswith("published")]


def test_truth_by_hand(tmp_path: Path) -> None:
    table = made("truth", *fake(tmp_path, synthetic())).set_index(["fit", "parameter"])
    assert list(table.index) == [
        ("kinetics", "T_p"),
        *((cost, name) for cost in ("RMSE", "BANDS") for name in ("k", "cp")),
    ]
    # The best call of the search is the first of two equal ones, 605 K; the limits are 100 K apart.
    kinetics = table.loc[("kinetics", "T_p")]
    assert kinetics.tolist()[:8] == ["K", 600.0, 605.0, 100 * 5 / 600, 5.0, 601.0, 100 / 600, 1.0]
    assert kinetics[8:].isna().all()  # CMA-ES does not fit them
    # J/(kg K) become kJ/(kg K); the limits are 3 kJ/(kg K) apart.
    cp = table.loc[("BANDS", "cp")]
    found = [1.5, 1.0, 100 * -0.5 / 1.5, 100 * -0.5 / 3.0, 1.5, 0.0, 0.0, 1.5, 0.0, 0.0]
    assert cp["unit"] == "kJ/(kg K)"
    assert cp.tolist()[1:] == pytest.approx(found, rel=1e-14)


def test_truth_of_zero_has_no_relative_error() -> None:
    given = synthetic()
    given["imp"]["estimate"] = ["k", "cp", "slope"]
    given["parameters"]["slope"] = {"unit": "1/K", "lower": -0.01, "upper": 0.01}
    given["material"]["components"]["polymer"]["conductivity_W_mK"] = {
        "value": "k",
        "slope_1_K": "slope",
    }
    given["synthetic"]["truth"]["slope"] = 0.0
    study = as_study(given, "fake.json")
    row = recovery_row(study, "RMSE", "slope", {"sceua": 0.002})
    assert row["sceua_error_truth_percent"] is None
    assert row["sceua_error_limits_percent"] == pytest.approx(10.0, rel=1e-14)


def test_truth_is_shown_only_of_what_was_fitted_to_computed_signals(tmp_path: Path) -> None:
    given = synthetic()
    given["experiments"]["slow"]["signals"]["mass_fraction"]["file"] = "tga.csv"
    study, results = fake(tmp_path, given)
    assert set(made("truth", study, results)["fit"]) == {"RMSE", "BANDS"}
    given["experiments"]["slab_25"]["signals"]["mlr"]["file"] = "slab.csv"
    assert not TABLES["truth"].applies(as_study(given, "fake.json"))


def test_data_are_called_what_they_are() -> None:
    given = synthetic()
    given["experiments"]["slab_60"]["signals"]["mlr"]["file"] = "slab.csv"
    study = as_study(given, "fake.json")
    assert data_name(study, [("slab_25", "mlr")]) == "synthetic data"
    assert data_name(study, [("slab_60", "mlr")]) == "measured"
    both = [("slab_25", "mlr"), ("slab_60", "mlr")]
    assert data_name(study, both) == "measured or synthetic data"


def test_one_repetition_has_no_sigma(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    summary = read_csv(results.imp("summary.csv"))
    write_csv(results.imp("summary.csv"), summary[summary["repetition"] == 0])
    table = made("table4", study, results)
    assert table["sigma"].isna().all()


def test_costs_by_hand(tmp_path: Path) -> None:
    table = made("costs", *fake(tmp_path)).set_index("cost_function")
    row = table.loc["RMSE"]
    assert [row["sceua_best"], row["least_squares_best"]] == [0.10, 0.08]
    assert row["ratio"] == pytest.approx(0.8, rel=1e-14)
    assert [row["sceua_calls"], row["sceua_failed_calls"]] == [303, 3]
    assert row["least_squares_calls"] == 50
    assert row["least_squares_at_bound"] == "k"
    assert row["least_squares_from_sceua"] == 0.0995
    assert [row["least_squares_starts"], row["least_squares_starts_at_best"]] == [2, 1]
    assert [row["cmaes_best"], row["cmaes_calls"], row["cmaes_starts_at_best"]] == [0.085, 1000, 1]
    assert row["lowest_by"] == "least squares"
    assert row["sceua_at_lowest"] == 0
    assert table["remark"].tolist() == [optimisers.LOCAL_OPTIMUM, optimisers.NOT_A_MINIMUM]


def test_lowest_cost_may_be_that_of_cmaes(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    end = {"cost": 0.05, "calls": 7, "at_bound": [], "parameters": {"k": 0.2, "cp": 1500.0}}
    _starts(results, "RMSE", "cmaes", [end])
    row = made("costs", study, results).set_index("cost_function").loc["RMSE"]
    assert row["lowest_by"] == "CMA-ES"
    assert row["ratio"] == pytest.approx(0.5, rel=1e-14)


def test_optimisers_within_one_percent_agree() -> None:
    assert optimisers.who_is_ahead(1.0, 0.991, 1.0) == optimisers.AGREE
    assert optimisers.who_is_ahead(1.0, 0.989, 1.0) == optimisers.LOCAL_OPTIMUM
    assert optimisers.who_is_ahead(1.0, 0.9, 0.989) == optimisers.NOT_A_MINIMUM
    assert optimisers.who_is_ahead(0.989, 1.0, 0.989) == optimisers.SCEUA_AHEAD
    assert optimisers.who_is_ahead(0.0, 0.0, 0.0) == optimisers.AGREE


def test_validation_marks_fitted_and_held_out_data(tmp_path: Path) -> None:
    table = made("validation", *fake(tmp_path))
    assert set(table[table["experiment"] == "Slab 25 kW/m²"]["data"]) == {"fitted"}
    assert set(table[table["experiment"] == "slab_60"]["data"]) == {"held out"}
    temperature = table[table["signal"] == "back temperature"]
    assert temperature["rmse_K"].tolist() == [7.2, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0]
    assert temperature["cv_rmse"].isna().all()
    assert table["rmse_K"].notna().sum() == 8


def test_measures_in_other_units_are_headed_in_words() -> None:
    frame = pd.DataFrame({"rmse_K": [1.0], "rmse [kg/m²]": [2.0], "solver_rmse [kg/m²]": [0.1]})
    ((_, shown),) = readable(replace(TABLES["validation"], group_by=None), frame)
    assert list(shown) == ["RMSE [K]", "RMSE [kg/m²]", "solver, RMSE [kg/m²]"]


def test_other_signal_of_a_fitted_experiment_is_a_held_out_signal(tmp_path: Path) -> None:
    study = as_study(described(), "fake.json")
    assert uses.use_of(study, "RMSE", "slab_25", "back_temperature") == "held-out signal"
    assert uses.use_of(study, "unknown", "slab_25", "mlr") == "not known"


def test_labels_are_those_of_the_prediction() -> None:
    labels = [chosen.label for chosen in uses.predicted_sets(as_study(described(), "fake.json"))]
    assert labels == [
        "estimates",
        "RMSE",
        "BANDS",
        "RMSE least squares",
        "BANDS least squares",
        "RMSE CMA-ES",
        "BANDS CMA-ES",
        "RMSE published",
    ]


def test_unknown_table_names_the_nearest(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    with pytest.raises(StudyError, match="Did you mean 'table4'"):
        make_named("tabel4", study, results)


def test_study_without_kinetics_has_no_table3(tmp_path: Path) -> None:
    given = described(kinetics=None)
    given["imp"]["kinetics"] = "described"
    given["parameters"]["T_p"]["value"] = 600
    study, results = fake(tmp_path, given)
    assert not TABLES["table3"].applies(study)
    with pytest.raises(StudyError, match="has no table3"):
        make_named("table3", study, results)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (600.0, "600"),
        (1201.3, "1201.3"),
        (0.0892, "0.0892"),
        (1 / 3, "0.3333"),
        (-1 / 3, "-0.3333"),
        (123456, "123456"),
        (9.98e4, "99800"),
        (2e16, "2.000e+16"),
        (None, ""),
    ],
)
def test_numbers_have_four_digits(value: float | None, text: str) -> None:
    assert number(value) == text
