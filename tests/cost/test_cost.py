"""Every cost on three points, by hand."""

import math
import pickle
import re
from timeit import repeat

import numpy as np
import pytest

from pyrofit.cost import KINDS, Target, WeightedSum, make_term
from pyrofit.cost.distances import (
    bands_differences,
    bands_limits,
    range_differences,
    range_limits_propti,
    rmse_differences,
    to_limit,
    to_target,
)
from pyrofit.cost.normalisation import normaliser
from pyrofit.errors import CostError

TIME = np.array([0.0, 1.0, 2.0])
VALUE = np.array([10.0, 20.0, 60.0])
SPREAD = np.array([1.0, 2.0, 4.0])
TARGET = Target(TIME, VALUE, SPREAD)
MODEL = np.array([10.5, 16.0, 68.0])

# Differences of MODEL from TARGET: RMSE 0.5, -4, 8; RANGE with r = 0.1, limits 9..11, 18..22,
# 54..66: 0, -2, 2; coded: 0, -4, 8; BANDS, limits 9..11, 18..22, 56..64: 0, -2, 4.
SQUARES = {
    "RMSE": 0.25 + 16.0 + 64.0,
    "RANGE": 0.0 + 4.0 + 4.0,
    "RANGE_PROPTI": 0.0 + 16.0 + 64.0,
    "BANDS": 0.0 + 4.0 + 16.0,
    "BANDS_PROPTI": 0.0 + 4.0 + 16.0,
}
OPTIONS = {"RANGE": {"r": 0.1}, "RANGE_PROPTI": {"r": 0.1}}
# y = 10, 20, 60: quartiles 15 and 40. The lower limits 9, 18, 56: quartiles 13.5 and 37.
Y_N = {"none": 1.0, "range": 50.0, "mean": 30.0, "iqr": 25.0}
Y_N_LOWER = {"none": 1.0, "range": 47.0, "mean": 83.0 / 3.0, "iqr": 23.5}


def thr(kind, model, time_s=2.0, time=(0.0, 1.0, 2.0, 3.0, 5.0), value=(0.0, 1.0, 2.0, 3.0, 5.0)):
    return make_term(kind, Target(time, value), time_s=time_s)(np.array(model, dtype=float))


@pytest.mark.parametrize("normalisation", Y_N)
@pytest.mark.parametrize("kind", SQUARES)
def test_eq_4_by_hand(kind, normalisation):
    y_N = (Y_N_LOWER if kind == "BANDS_PROPTI" else Y_N)[normalisation]
    term = make_term(kind, TARGET, normalisation=normalisation, **OPTIONS.get(kind, {}))
    assert term(MODEL) == pytest.approx(math.sqrt(SQUARES[kind] / 3.0) / y_N, rel=1e-14)


@pytest.mark.parametrize(
    ("kind", "y_N"),
    [("RMSE", 1), ("RANGE", 1), ("BANDS", 1), ("RANGE_PROPTI", 30), ("BANDS_PROPTI", 83 / 3)],
)
def test_default_normalisation_is_none_as_printed_and_mean_as_coded(kind, y_N):
    term = make_term(kind, TARGET, **OPTIONS.get(kind, {}))
    assert term(MODEL) == pytest.approx(math.sqrt(SQUARES[kind] / 3.0) / y_N, rel=1e-14)


def test_table_2_differences_by_hand():
    assert rmse_differences(TARGET, MODEL).tolist() == [0.5, -4.0, 8.0]
    assert range_differences(TARGET, MODEL, 0.1) == pytest.approx([0.0, -2.0, 2.0])
    coded = to_target(MODEL, TARGET.value, *range_limits_propti(TARGET, 0.1))
    assert coded == pytest.approx([0.0, -4.0, 8.0])
    assert bands_differences(TARGET, MODEL).tolist() == [0.0, -2.0, 4.0]
    assert to_limit(MODEL, *bands_limits(TARGET, n_sigma=2.0)).tolist() == [0.0, 0.0, 0.0]


def test_range_orders_the_limits_of_negative_targets():
    target = Target(TIME, [-10.0, -10.0, -10.0])
    model = np.array([-10.5, -12.0, 0.0])  # limits -11 .. -9
    assert range_differences(target, model, 0.1) == pytest.approx([0.0, -1.0, 9.0])


def test_range_as_coded_always_counts_negative_targets():
    target = Target(TIME, [-10.0, -10.0, 10.0])
    model = np.array([-10.5, -10.0, 10.5])
    coded = to_target(model, target.value, *range_limits_propti(target, 0.1))
    assert coded == pytest.approx([-0.5, 0.0, 0.0])
    assert range_differences(target, model, 0.1).tolist() == [0.0, 0.0, 0.0]


def test_limits_belong_to_the_band():
    lower, upper = [9.0, 18.0, 56.0], [11.0, 22.0, 64.0]
    for edge in (lower, upper):
        assert make_term("BANDS", TARGET)(np.array(edge)) == 0.0
        assert make_term("BANDS", TARGET, lower=lower, upper=upper)(np.array(edge)) == 0.0


def test_limits_given_as_series_need_no_uncertainty():
    term = make_term("BANDS", Target(TIME, VALUE), lower=[0.0, 0.0, 0.0], upper=[9.0, 16.0, 68.0])
    assert term.residuals(MODEL) * math.sqrt(3.0) == pytest.approx([1.5, 0.0, 0.0])


def test_coded_bands_are_normalised_by_the_magnitude_of_the_mean_lower_limit():
    target = Target(TIME, [1.0, 1.0, 1.0], [3.0, 3.0, 3.0])  # lower limit -2
    assert make_term("BANDS_PROPTI", target)(np.full(3, 8.0)) == pytest.approx(4.0 / 2.0)


def test_smoothing_averages_the_limits_over_its_width():
    target = Target([0.0, 1.0, 2.0, 4.0], [2.0, 4.0, 9.0, 5.0], [1.0, 1.0, 1.0, 1.0])
    lower, upper = bands_limits(target, smooth_s=2.0)
    assert lower == pytest.approx([2.0, 4.0, 5.5, 4.0])
    assert upper == pytest.approx([4.0, 6.0, 7.5, 6.0])
    assert bands_limits(target, smooth_s=0.5)[0].tolist() == [1.0, 3.0, 8.0, 4.0]


def test_normalisation_by_the_mean_is_positive_for_a_negative_mean():
    assert normaliser("mean", np.array([-1.0, -3.0])) == 2.0


@pytest.mark.parametrize(
    ("time_s", "expected"),
    [(1.0, 4.0 / 20.0), (2.0, 8.0 / 60.0), (0.0, 0.5 / 10.0), (1.5, (42.0 - 40.0) / 40.0)],
)
def test_eq_1_by_hand(time_s, expected):
    assert make_term("NRSE", TARGET, time_s=time_s)(MODEL) == pytest.approx(expected, rel=1e-14)


def test_eq_1_is_positive_for_a_negative_target_and_its_residual_keeps_the_sign():
    term = make_term("NRSE", Target(TIME, -VALUE), time_s=1.0)
    assert term(-MODEL) == pytest.approx(0.2)
    assert term.residuals(-MODEL) == pytest.approx([0.2])
    assert term.residuals(np.full(3, -25.0)) == pytest.approx([-0.25])


def test_eq_1_looks_at_its_time_alone():
    term = make_term("NRSE", TARGET, time_s=1.0)
    assert term(np.array([-99.0, 16.0, 99.0])) == term(MODEL)


@pytest.mark.parametrize(
    ("model", "first", "literal"),
    [
        ([0.0, 1.0, 2.0, 3.0, 5.0], 0.0, 0.0),  # the target itself: crosses exactly at t0
        ([0.0, 0.0, 1.0, 3.0, 3.0], 0.25, 0.25),  # crosses at 2.5
        ([0.0, 4.0, 4.0, 4.0, 4.0], 0.75, 0.0),  # crosses at 0.5, above at t0
        ([9.0, 9.0, 9.0, 9.0, 9.0], 1.0, 0.0),  # above throughout: since t_min
        ([0.0, 4.0, 0.0, 0.0, 3.0], 0.75, 0.25),  # first 0.5 to 1.5, then from 3 + 4/3 on
        ([0.0, 1.0, 1.0, 1.0, 1.0], 1.5, 1.5),  # never: max(2, 3) / 2
        ([0.0, 2.0, 2.0, 2.0, 2.0], 1.5, 1.5),  # touches without rising above
        ([0.0, 1.0, 2.0, 2.0, 4.0], 0.5, 0.5),  # touches at t0, rises above from 3 on
        ([3.0, 1.0, 1.0, 1.0, 3.0], 1.0, 0.75),  # above at first until 0.5; passes at 4
    ],
)
def test_eq_2_by_hand(model, first, literal):
    assert thr("THR_above", model) == pytest.approx(first, rel=1e-14)
    assert thr("THR_above_literal", model) == pytest.approx(literal, rel=1e-14)


@pytest.mark.parametrize(
    ("model", "first", "literal"),
    [
        ([5.0, 4.0, 3.0, 2.0, 0.0], 0.0, 0.0),  # the target itself: falls below 3 from t0 on
        ([5.0, 5.0, 4.0, 2.0, 0.0], 0.25, 0.25),
        ([0.0, 6.0, 6.0, 0.0, 0.0], 0.25, 0.25),  # below at first, passes at 2.5
        ([0.0, 0.0, 0.0, 0.0, 0.0], 1.0, 0.0),  # below throughout: since t_min
        ([4.0, 4.0, 4.0, 4.0, 4.0], 1.5, 1.5),  # never
        ([0.0, 5.0, 5.0, 5.0, 5.0], 1.0, 0.7),  # below until 0.6 and never again
    ],
)
def test_eq_3_by_hand(model, first, literal):
    value = (5.0, 4.0, 3.0, 2.0, 0.0)
    assert thr("THR_below", model, value=value) == pytest.approx(first, rel=1e-14)
    assert thr("THR_below_literal", model, value=value) == pytest.approx(literal, rel=1e-14)


def test_thresholds_take_the_interpolated_level_between_points():
    # y(1.5) = 1.5; the model rises above it at 1.75
    assert thr("THR_above", [0.0, 0.0, 2.0, 3.0, 5.0], 1.5) == pytest.approx(0.25 / 1.5)
    assert thr("THR_above_literal", [0.0, 0.0, 2.0, 3.0, 5.0], 1.5) == pytest.approx(0.25 / 1.5)
    # above at t0 = 1.5 between a point below and a point above
    assert thr("THR_above_literal", [0.0, 0.0, 4.0, 0.0, 0.0], 1.5) == 0.0


def test_a_threshold_never_met_costs_the_farther_end():
    assert thr("THR_above", [0.0] * 5, time_s=1.0) == 4.0  # max(|0 - 1|, |5 - 1|) / 1
    assert thr("THR_above", [0.0] * 5, time_s=4.0) == 1.0  # max(|0 - 4|, |5 - 4|) / 4


def test_threshold_residuals_tell_early_from_late():
    term = make_term("THR_above", Target([0.0, 2.0, 4.0], [0.0, 1.0, 2.0]), time_s=2.0)
    assert term.residuals(np.array([0.0, 2.0, 2.0])).tolist() == [-0.5]
    assert term.residuals(np.array([0.0, 0.0, 2.0])).tolist() == [0.5]


def test_gpyros_objective_by_hand():
    # y = 10, 20, 60; differences 0.5, -4, 8; eps = 0.1: 1/1.5, 2/6 and 6/14, squared.
    lost = 3.0 - (2 / 3) ** 2 - (1 / 3) ** 2 - (3 / 7) ** 2
    term = make_term("GPYRO", TARGET)
    assert term(MODEL) == pytest.approx(lost / 3.0, rel=1e-14)
    assert term(VALUE) == 0.0
    # Gpyro's own fitness of the same model: |y| / (|model - y| + eps |y|), squared, mean.
    fitness = ((10 / 1.5) ** 2 + (20 / 6) ** 2 + (60 / 14) ** 2) / 3.0
    assert term(MODEL) == pytest.approx(1.0 - 0.1**2 * fitness, rel=1e-14)


def test_gpyros_objective_by_hand_with_its_options():
    # Counted from 8 on: 2, 12, 52; eps = 0.5: 1/1.5, 6/10, 26/34.
    lost = 3.0 - 2 / 3 - 0.6 - 26 / 34
    term = make_term("GPYRO", TARGET, eps=0.5, zeta=1.0, reference=8.0)
    assert term(MODEL) == pytest.approx(lost / 3.0, rel=1e-14)


def test_gpyros_objective_takes_a_measured_zero_as_met_or_missed():
    term = make_term("GPYRO", Target(TIME, [0.0, 20.0, 0.0]))
    assert term(np.array([0.0, 20.0, 1e-9])) == pytest.approx(1.0 / 3.0, rel=1e-14)


def test_residuals_of_gpyros_objective_have_the_sign_of_the_difference():
    residuals = make_term("GPYRO", TARGET).residuals(MODEL)
    assert np.sign(residuals).tolist() == [1.0, -1.0, 1.0]


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("kind", KINDS)
def test_a_model_that_is_not_finite_costs_infinity(kind, bad):
    options = {} if signature_of(kind) else {"time_s": 1.0}
    assert make_term(kind, TARGET, **options)(np.array([10.0, bad, 60.0])) == math.inf


def signature_of(kind):
    return KINDS[kind].__kwdefaults__ or {}


@pytest.mark.parametrize(
    ("kind", "options", "message"),
    [
        ("RNAGE", {}, "unknown cost 'RNAGE'. Did you mean 'RANGE'?"),
        ("RMSE", {"normalization": "mean"}, "RMSE: unknown option 'normalization'. Did you mean"),
        ("RMSE", {"normalisation": "men"}, "unknown normalisation 'men'. Did you mean 'mean'?"),
        ("RANGE", {"r": 0.0}, "r = 0.0; it must be a finite number above 0"),
        ("RANGE", {"r": -0.1}, "r = -0.1; it must be"),
        ("RANGE", {"r": "wide"}, "r = 'wide'; it must be"),
        ("RANGE_PROPTI", {"r": math.nan}, "r = nan; it must be"),
        ("GPYRO", {"eps": 0.0}, "eps = 0.0; it must be a finite number above 0"),
        ("GPYRO", {"zeta": -2.0}, "zeta = -2.0; it must be"),
        ("GPYRO", {"reference": math.nan}, "reference = nan; it must be a finite number"),
        ("BANDS", {"n_sigma": 0.0}, "n_sigma = 0.0; it must be"),
        ("BANDS", {"smooth_s": -1.0}, "smooth_s = -1.0; it must be"),
        ("BANDS", {"lower": VALUE}, "give both `lower` and `upper`"),
        ("BANDS", {"lower": VALUE, "upper": VALUE, "n_sigma": 1.0}, "or `n_sigma` alone"),
        ("BANDS", {"lower": [1.0], "upper": VALUE}, "lower has 1 points and the target has 3"),
        ("BANDS", {"lower": VALUE, "upper": VALUE - 1}, "lower[0] lies above upper[0]"),
        ("BANDS", {"lower": VALUE, "upper": [1, 2, math.inf]}, "upper[2] = inf; every number"),
        ("NRSE", {}, "NRSE: the option `time_s` is absent"),
        ("NRSE", {"time_s": 2.1}, "time_s = 2.1; it must lie within the target's times, 0 to 2 s"),
        ("NRSE", {"time_s": -0.1}, "it must lie within"),
        ("THR_above", {"time_s": 0.0}, "time_s = 0.0; it must be a finite number above 0"),
        ("THR_below", {"time_s": 2.1}, "it must lie within"),
        ("THR_below_literal", {"time_s": math.nan}, "time_s = nan; it must be"),
    ],
)
def test_setup_refuses(kind, options, message):
    with pytest.raises(CostError, match=re.escape(message)):
        make_term(kind, TARGET, **options)


def test_setup_refuses_what_does_not_fit_the_target():
    with pytest.raises(CostError, match="the target has no uncertainty"):
        make_term("BANDS", Target(TIME, VALUE))
    with pytest.raises(CostError, match="the target is 0 at time_s = 1"):
        make_term("NRSE", Target(TIME, [-1.0, 0.0, 1.0]), time_s=1.0)
    with pytest.raises(CostError, match=re.escape("is 0 at time_s = 0.5")):
        make_term("NRSE", Target(TIME, [-1.0, 1.0, 1.0]), time_s=0.5)
    for normalisation, value in (("mean", [-1, 0, 1]), ("range", [2, 2, 2]), ("iqr", [2, 2, 2])):
        with pytest.raises(CostError, match=f"normalisation '{normalisation}' is 0"):
            make_term("RMSE", Target(TIME, value), normalisation=normalisation)
    with pytest.raises(CostError, match="normalisation 'mean' is 0"):
        make_term("BANDS_PROPTI", Target(TIME, [1, 1, 1], [1, 1, 1]))


@pytest.mark.parametrize(
    ("time", "value", "uncertainty", "message"),
    [
        ([0.0], [1.0], None, "given 1 points; a target needs at least 2"),
        ([0.0, 1.0, 1.0], VALUE, None, "time_s[2] = 1 follows 1; times must increase"),
        (TIME, [1.0, 2.0], None, "value has 2 points and time_s has 3"),
        (TIME, VALUE, [1.0], "uncertainty has 1 points and time_s has 3"),
        (TIME, [1.0, math.nan, 2.0], None, "value[1] = nan; every number must be finite"),
        (TIME, VALUE, [1.0, -1.0, 1.0], "the smallest uncertainty is -1"),
        (TIME, [[1.0, 2.0, 3.0]], None, "value: given 2 dimensions"),
        (TIME, ["a", "b", "c"], None, "it must be a list of numbers"),
    ],
)
def test_target_refuses(time, value, uncertainty, message):
    with pytest.raises(CostError, match=re.escape(message)):
        Target(time, value, uncertainty)


def test_target_keeps_its_own_read_only_copy():
    value = VALUE.copy()
    target = Target(TIME, value)
    value[0] = 99.0
    assert target.value[0] == 10.0
    with pytest.raises(ValueError, match="read-only"):
        target.value[0] = 1.0


def test_window_includes_both_ends_and_refuses_too_few_points():
    window = TARGET.window(1.0, 2.0)
    assert window.time_s.tolist() == [1.0, 2.0]
    assert window.value.tolist() == [20.0, 60.0]
    assert window.uncertainty.tolist() == [2.0, 4.0]
    for start_s, end_s, count in ((5.0, 9.0, 0), (2.0, 1.0, 0), (0.5, 1.5, 1)):
        with pytest.raises(CostError, match=f"{count} points lie inside; at least 2 must"):
            TARGET.window(start_s, end_s)


def test_resampling_interpolates_value_and_uncertainty():
    target = Target([0.0, 1.0, 4.0], [0.0, 3.0, 0.0], [1.0, 2.0, 5.0]).resampled(5)
    assert target.time_s.tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert target.value == pytest.approx([0.0, 3.0, 2.0, 1.0, 0.0])
    assert target.uncertainty == pytest.approx([1.0, 2.0, 3.0, 4.0, 5.0])
    for n in (1, 2.5):
        with pytest.raises(CostError, match="at least 2"):
            TARGET.resampled(n)


def test_a_model_of_another_shape_is_refused():
    with pytest.raises(CostError, match=re.escape("shape (1,) and the target (3,)")):
        make_term("RMSE", TARGET)(np.array([1.0]))


@pytest.mark.parametrize("kind", KINDS)
def test_a_term_survives_pickling(kind):
    options = {} if signature_of(kind) else {"time_s": 1.0}
    term = make_term(kind, TARGET, **options)
    assert pickle.loads(pickle.dumps(term))(MODEL) == term(MODEL)


@pytest.mark.parametrize("kind", ["RMSE", "RANGE_PROPTI", "BANDS", "THR_above", "GPYRO"])
def test_a_call_costs_a_few_operations_on_the_curve(kind):
    time = np.linspace(0.0, 10.0, 100)
    target = Target(time, np.sin(time) + 2.0, np.full(100, 0.1))
    term = make_term(kind, target, **({"time_s": 5.0} if kind == "THR_above" else {}))
    model = np.cos(time) + 2.0

    def seconds(call):
        return min(repeat(call, number=50, repeat=5))

    def plain():
        return np.sqrt(np.mean((model - target.value) ** 2))

    # Measured in turns, so that a busy machine slows both.
    ratios = [seconds(lambda: term(model)) / seconds(plain) for _ in range(10)]
    assert min(ratios) < 4.0


def test_eq_5_by_hand():
    rmse, nrse = make_term("RMSE", TARGET), make_term("NRSE", TARGET, time_s=1.0)
    total = WeightedSum([(2.0, rmse), (10.0, nrse)])
    expected = [2.0 * math.sqrt(80.25 / 3.0), 10.0 * 0.2]
    assert total.parts([MODEL, MODEL]) == pytest.approx(expected, rel=1e-14)
    assert total.value([MODEL, MODEL]) == pytest.approx(sum(expected), rel=1e-14)


def test_eq_5_residuals_of_one_term_have_its_value_as_norm():
    total = WeightedSum([(3.0, make_term("RMSE", TARGET))])
    assert np.linalg.norm(total.residuals([MODEL])) == pytest.approx(total.value([MODEL]))


def test_eq_5_residuals_of_two_terms_square_to_the_weighted_squares():
    rmse, nrse = make_term("RMSE", TARGET), make_term("NRSE", TARGET, time_s=1.0)
    residuals = WeightedSum([(2.0, rmse), (10.0, nrse)]).residuals([MODEL, MODEL])
    assert residuals.shape == (4,)
    assert residuals @ residuals == pytest.approx(2.0 * 80.25 / 3.0 + 10.0 * 0.2**2)


def test_a_weight_of_zero_leaves_a_term_out():
    total = WeightedSum([(0.0, make_term("RMSE", TARGET)), (1.0, make_term("BANDS", TARGET))])
    lost = np.full(3, math.nan)
    assert total.parts([lost, MODEL]) == [0.0, make_term("BANDS", TARGET)(MODEL)]
    assert total.residuals([lost, MODEL]).shape == (3,)
    assert total.value([MODEL, lost]) == math.inf


def test_eq_5_refuses_weights_and_counts():
    term = make_term("RMSE", TARGET)
    for weights in ([], [0.0], [0.0, 0.0]):
        with pytest.raises(CostError, match="no term has a weight above 0"):
            WeightedSum([(weight, term) for weight in weights])
    for weight in (-1.0, math.nan, math.inf):
        with pytest.raises(CostError, match="must be finite and not negative"):
            WeightedSum([(1.0, term), (weight, term)])
    for call in ("value", "parts", "residuals"):
        with pytest.raises(CostError, match="given 2 models for 1 terms"):
            getattr(WeightedSum([(1.0, term)]), call)([MODEL, MODEL])
