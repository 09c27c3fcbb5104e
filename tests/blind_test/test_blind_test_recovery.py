"""What the blind test counts beside names: strengths, base parameters, windows, power."""

from typing import Any

import numpy as np
import pandas as pd
import pytest

from pyrofit.results.diagnosis_schema import OfWindow
from pyrofit_blind_test.detectability import Shortfall, located
from pyrofit_blind_test.power import power_of_diagnosis, thresholds
from pyrofit_blind_test.rates import bias, coverage, cpu_times, rate_interval, window_rates
from pyrofit_blind_test.recovery import parameter_rows, strength_rows

SLOPE = {"value": -1.1e-3, "low": -1.2e-3, "high": -1.05e-3, "low_wide": None, "high_wide": None}


def density(value: float, low: float, high: float) -> dict[str, Any]:
    fitted = {"value": value, "low": low, "high": high, "unit": "kg/m3", "at_limit": False}
    return {"parameters": {"rho_a": fitted}}


def found(**changes: Any) -> dict[str, Any]:
    """Return the result of a twin whose k(T) is named."""
    fitted = {"effects": ["k_T"], "rejected": "", "parameters": {"k_T_slope_1_K": SLOPE}}
    result: dict[str, Any] = {
        "id": "twin",
        "case": {
            "kind": "effect",
            "hidden": {"k_T": {"slope_1_K": -1e-3}},
            "signals": "mlr",
            "noise": "white",
            "curves": "",
        },
        "truth": {"rho_a": 1000.0},
        "verdict": {"kind": "named", "effects": ["k_T"], "sets": [["k_T"]]},
        "candidates": [{"effects": ["c_T"], "rejected": "", "parameters": {}}, fitted],
        "base": density(1100.0, 1080.0, 1120.0),
        "extended": density(990.0, 980.0, 1001.0),
    }
    return result | changes


def test_strength_is_compared_in_the_model_of_the_verdict() -> None:
    (row,) = strength_rows(found())
    assert (row["effect"], row["parameter"]) == ("k_T", "slope_1_K")
    assert (row["truth"], row["value"]) == (-1e-3, -1.1e-3)
    assert row["right"]
    assert not row["covered"]
    assert not row["covered_wide"]
    assert np.isnan(row["low_wide"])


def test_wide_interval_counts_where_there_is_one() -> None:
    wide = SLOPE | {"low_wide": -1.3e-3, "high_wide": -0.9e-3}
    fitted = {"effects": ["k_T"], "rejected": "", "parameters": {"k_T_slope_1_K": wide}}
    (row,) = strength_rows(found(candidates=[fitted]))
    assert not row["covered"]
    assert row["covered_wide"]


@pytest.mark.parametrize("kind", ["unknown", "none"])
def test_strength_without_a_claim_does_not_count(kind: str) -> None:
    verdict = {"kind": kind, "effects": ["k_T"], "sets": [["k_T"]]}
    assert list(strength_rows(found(verdict=verdict))) == []


def test_effect_of_the_same_signature_has_no_true_strength() -> None:
    late = {"kind": "named", "effects": ["heater_ramp"], "sets": [["heater_ramp"]]}
    hidden = found()["case"] | {"hidden": {"time_offset": {"delay_s": 5.0}}}
    assert list(strength_rows(found(verdict=late, case=hidden))) == []


def test_other_form_of_another_code_has_no_true_strength() -> None:
    case = found()["case"]
    assert list(strength_rows(found(case={**case, "kind": "form"})))
    assert not list(strength_rows(found(case={**case, "kind": "form", "curves": "g22"})))


def test_base_parameter_is_compared_before_and_after() -> None:
    (row,) = parameter_rows(found())
    assert row["before_off"] == pytest.approx(0.1)
    assert row["after_off"] == pytest.approx(-0.01)
    assert (row["before_covered"], row["after_covered"]) == (False, True)
    nothing = found()["case"] | {"hidden": {}}
    assert list(parameter_rows(found(case=nothing))) == []


def test_coverage_is_counted_with_its_interval() -> None:
    covered = SLOPE | {"high": -0.9e-3}
    fitted = {"effects": ["k_T"], "rejected": "", "parameters": {"k_T_slope_1_K": covered}}
    results = [found(), *(found(candidates=[fitted]) for _ in range(3))]
    table = coverage(pd.DataFrame([row for one in results for row in strength_rows(one)]))
    first = table.iloc[0]
    assert (first["interval"], first["by"], first["hits"], first["twins"]) == (
        "fitted model",
        "all",
        3,
        4,
    )
    assert (first["low"], first["high"]) == rate_interval(3, 4)


def test_bias_is_that_of_right_claims_with_a_repair() -> None:
    wrong = {"kind": "named", "effects": ["c_T"], "sets": [["c_T"]]}
    results = [
        found(),
        found(extended=density(1010.0, 990.0, 1030.0)),
        found(verdict=wrong),
        found(extended={"parameters": {}}),
    ]
    table = bias(pd.DataFrame([row for one in results for row in parameter_rows(one)]))
    (row,) = table.to_dict("records")
    assert (row["parameter"], row["twins"]) == ("rho_a", 2)
    assert row["before_mean_%"] == pytest.approx(10.0)
    assert row["after_mean_%"] == pytest.approx(0.0)
    assert row["after_rms_%"] == pytest.approx(1.0)
    assert (row["before_covered"], row["after_covered"]) == (0.0, 1.0)


def test_points_of_windows_are_counted_against_where_the_base_is_off() -> None:
    time = np.arange(0.0, 10.0)
    off = np.where((time >= 2.0) & (time <= 5.0), -0.9, 0.1)
    misfit = Shortfall(1.0, 1.0, 10, {("a", "mlr"): (time, off)})
    window = OfWindow.model_construct(
        model="base", experiment="a", signal="mlr", start_s=4.0, end_s=8.0
    )
    of_extended = window.model_copy(update={"model": "extended", "start_s": 0.0})
    counts = located([window, of_extended], misfit)
    assert counts == {"in_windows": 5, "off": 4, "both": 2}
    elsewhere = window.model_copy(update={"experiment": "b"})
    assert located([elsewhere], misfit)["both"] == 0


def test_windows_are_averaged_over_detectable_effects() -> None:
    rows = [("effect", 20.0, 0.5), ("effect", 30.0, 1.0), ("effect", 5.0, 0.0), ("null", 0.0, 0.1)]
    twins = pd.DataFrame(rows, columns=["kind", "detectability", "window_f1"])
    twins = twins.assign(window_precision=1.0, window_recall=1.0, signals="mlr", noise="white")
    assert window_rates(twins).loc[0, ["twins", "window_f1"]].tolist() == [2, 0.75]


def test_intervals_of_the_power_hold_the_truth_as_often_as_they_say() -> None:
    hits = dict.fromkeys(("half", "nine_tenths"), 0)
    for seed in range(40):
        rng = np.random.default_rng(seed)
        d = rng.uniform(0.0, 30.0, 200)
        share = 1.0 / (1.0 + (8.0 / np.maximum(d, 1e-9)) ** 4)
        found = thresholds(d, rng.random(200) < share)
        for name, truth in (("half", 8.0), ("nine_tenths", 8.0 * 9 ** (1 / 4))):
            middle, low, high = found[name]
            assert middle == pytest.approx(truth, rel=0.35)
            hits[name] += low < truth < high
    assert min(hits.values()) >= 35


def test_times_are_stated_by_verdict() -> None:
    twins = pd.DataFrame({"verdict": ["named", "named", "unknown"], "seconds": [1.0, 3.0, 40.0]})
    table = cpu_times(twins).set_index("verdict")
    assert table.loc["named"].tolist() == [2, 2.0, 3.0]
    assert table.loc["all", "longest_s"] == 40.0


def test_power_of_few_twins_is_wide_and_exists() -> None:
    found = thresholds(np.array([12.0, 20.0, 30.0, 40.0]), np.array([True] * 4))
    _, low, high = found["half"]
    assert low < 2.0
    assert high < 40.0


def test_power_is_stated_for_effects_with_enough_twins() -> None:
    rows = [("k_T", 20.0, True)] * 4 + [("c_T", 3.0, False)] * 3 + [("time_offset", 9.0, True)] * 2
    rows += [("heater_ramp", 9.0, True)] * 2
    twins = pd.DataFrame(rows, columns=["hidden", "detectability", "right"]).assign(kind="effect")
    table = power_of_diagnosis(twins).set_index("of")
    assert set(table.index) == {"all", "k_T", "heater_ramp"}
    assert table.loc["all", "twins"] == 11
    assert table.loc["all", "named"] == 8
    assert power_of_diagnosis(twins.assign(kind="null")).empty
