"""The step that finds what the data determine, on a coarse study, and its part of the study."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from imp_truth import TRUTH
from stage_studies import by_hand, given, study_with

from pyrofit.config import as_study
from pyrofit.errors import DataError, StudyError
from pyrofit.results import dependencies
from pyrofit.results.files import Results, read_csv, read_json
from pyrofit.stages import fit, identify, measurements

FILES = ("estimate", "sensitivities", "singular_values", "correlation", "profiles", "sets")
BOTH = {"slab_60": ["mlr", "back_temperature"]}


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Results:
    """Return the results of the step, after searches made by hand."""
    results = Results(tmp_path_factory.mktemp("results"))
    study = study_with(imp__identification=BOTH)
    measurements.prepare(study, results)
    fit.fit_kinetics(study, results)
    by_hand(study, results)
    fit.collect(study, results)
    identify.identify_kinetics(study, results)
    identify.identify_imp(study, results)
    return results


def read(results: Results, name: str) -> pd.DataFrame:
    return read_csv(results.identification(f"{name}.csv"))


def test_intervals_lie_within_the_limits_about_the_estimate(results: Results) -> None:
    table = read(results, "estimate").set_index("parameter")
    assert list(table.index) == list(TRUTH)
    study = study_with()
    for name, row in table.iterrows():
        lower, upper = study.parameters[str(name)].bounds_si
        assert lower - 1e-9 * upper <= row["low"] <= row["estimate"] <= row["high"]
        assert row["high"] <= upper * (1 + 1e-12)
        assert row["width"] == pytest.approx((row["high"] - row["low"]) / (upper - lower))
        assert row["noise_width"] <= row["width"] * (1 + 1e-9)


def test_kinetics_have_intervals_about_their_truth(results: Results) -> None:
    table = read_csv(results.identification("estimate.csv", "kinetics")).set_index("parameter")
    for name, truth in {"T_p": 605.0, "E_p": 190e3}.items():
        row = table.loc[name]
        assert row["low"] < truth < row["high"]
        assert row["verdict"] == "determined"


def test_density_is_determined_by_the_released_mass(results: Results) -> None:
    row = read(results, "estimate").set_index("parameter").loc["rho"]
    assert row["verdict"] == "determined"
    assert row["estimate"] == pytest.approx(TRUTH["rho"], rel=0.01)


def test_sensitivities_are_given_for_each_channel_point_and_parameter(results: Results) -> None:
    table = read(results, "sensitivities")
    counts = table.groupby(["experiment", "signal", "parameter"]).size()
    assert len(counts) == 2 * len(TRUTH)
    for (name, signal, _), count in counts.items():
        assert count == len(read_csv(results.measurement(name, signal)))


def test_singular_values_are_those_of_the_whitened_sensitivities(results: Results) -> None:
    table = read(results, "sensitivities")
    columns = [table[table["parameter"] == name]["whitened"].to_numpy() for name in TRUTH]
    values = np.linalg.svd(np.column_stack(columns), compute_uv=False)
    modes = read(results, "singular_values")
    assert modes["singular_value"].to_numpy() == pytest.approx(values, rel=1e-9)
    directions = modes[list(TRUTH)].to_numpy()
    assert directions @ directions.T == pytest.approx(np.eye(len(TRUTH)), abs=1e-9)


def test_no_set_of_the_optimisers_is_below_the_optimum(results: Results) -> None:
    sets = read(results, "sets")
    noise = read_json(results.identification("noise.json"))
    assert len(sets) == 3 * 4
    assert sets["chi2"].min() >= noise["chi2"] - 1e-6
    assert noise["chi2"] == pytest.approx(sum(c["chi2"] for c in noise["channels"]))
    # Good data use up a degree of freedom for each parameter, less next to nothing for its limits.
    points = sum(c["points"] for c in noise["channels"])
    assert noise["freedom"] == pytest.approx(points - len(TRUTH), abs=0.05)


def test_profiles_start_from_the_estimate(results: Results) -> None:
    estimates = read(results, "estimate").set_index("parameter")
    profiles = read(results, "profiles")
    profiled = estimates[estimates["method"] == "profile"].index
    assert set(profiles["parameter"]) == set(profiled)
    for name in profiled:
        curve = profiles[profiles["parameter"] == name]
        assert curve["value"].is_monotonic_increasing
        assert estimates.loc[name, "estimate"] in curve["value"].to_numpy()


def test_equal_inputs_give_equal_bits(results: Results) -> None:
    before = {n: results.identification(f"{n}.csv").read_bytes() for n in FILES}
    identify.identify_imp(study_with(imp__identification=BOTH), results)
    assert {n: results.identification(f"{n}.csv").read_bytes() for n in FILES} == before


def test_missing_result_is_named(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"\.csv: this result is missing"):
        identify.identify_imp(study_with(), Results(tmp_path))


# --- its part of the study ------------------------------------------------------------------


def terms(*windows: list[float] | None, **more: Any) -> list[dict[str, Any]]:
    term = {"experiment": "slab_25", "signal": "mlr", "kind": "RMSE", "points": 50, **more}
    return [{**term, "window_s": window} for window in windows]


def test_channels_are_those_of_the_costs_each_once_at_all_points() -> None:
    costs = {
        "A": terms(None),
        "B": [*terms(None), *terms(None, signal="back_temperature", weight=0.0)],
    }
    (channel,) = study_with(imp__costs=costs).imp.channels
    assert (channel.experiment, channel.signal) == ("slab_25", "mlr")
    assert channel.points is None


def test_channel_runs_from_the_first_to_the_last_time_compared() -> None:
    (channel,) = study_with(imp__costs={"A": terms([0, 100], [50, 250])}).imp.channels
    assert channel.window_s == (0.0, 250.0)
    (channel,) = study_with(imp__costs={"A": terms([0, 100], None)}).imp.channels
    assert channel.window_s is None


def test_named_channels_replace_those_of_the_costs() -> None:
    found = study_with(imp__identification=BOTH).imp.channels
    assert [(c.experiment, c.signal) for c in found] == [
        ("slab_60", "mlr"),
        ("slab_60", "back_temperature"),
    ]


def test_slice_knows_channels_and_limits_and_not_the_repetitions() -> None:
    base = dependencies.identify_slice(study_with())
    assert dependencies.identify_slice(study_with(imp__repetitions=7)) == base
    assert dependencies.identify_slice(study_with(imp__identification=BOTH)) != base
    assert dependencies.identify_slice(study_with(parameters__rho__upper=2000)) != base
    json.dumps(base["channels"])


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ({"slab25": ["mlr"]}, "unknown experiment 'slab25'. Did you mean 'slab_25'?"),
        ({"slab_25": ["mrl"]}, "has no signal 'mrl'. Did you mean 'mlr'?"),
        ({"slab_25": []}, "imp.identification.slab_25: name at least one signal"),
        ({"slab_25": ["mlr", "mlr"]}, "imp.identification.slab_25: a signal stands twice"),
        (
            {"tga_5K": ["mass_fraction"]},
            "'tga_5K' is no cone calorimeter, gasification or external experiment",
        ),
    ],
)
def test_wrong_channels_are_told(value: object, words: str) -> None:
    with pytest.raises(StudyError) as error:
        as_study(given(imp__identification=value), "smoke.yaml")
    assert words in str(error.value)
