"""What holds for the costs whatever the curves."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from pyrofit.cost import NORMALISATIONS, Target, WeightedSum, make_term
from pyrofit.cost.distances import bands_limits

N = 7
EQ_4 = ["RMSE", "RANGE", "BANDS", "RANGE_PROPTI", "BANDS_PROPTI"]
SINGLE = ["NRSE", "THR_above", "THR_below", "THR_above_literal", "THR_below_literal"]

fixed = settings(derandomize=True, deadline=None, max_examples=200, database=None)


def curves(low, high):
    number = st.floats(low, high).map(lambda x: round(x, 3))
    return st.lists(number, min_size=N, max_size=N).map(np.array)


values, models, spreads = curves(-10.0, 10.0), curves(-20.0, 20.0), curves(0.0, 5.0)
shares = st.floats(0.01, 0.9)
steps = curves(0.1, 3.0)


def target_of(value, spread=None, step=None):
    time = np.arange(float(N)) if step is None else np.cumsum(step)
    return Target(time, value, spread)


def options_of(kind, r):
    return {"r": r} if kind.startswith("RANGE") else {}


@fixed
@given(values, spreads, models, shares)
def test_a_tolerance_never_raises_the_cost(value, spread, model, r):
    target = target_of(value, spread)
    rmse = make_term("RMSE", target)(model)
    for kind in EQ_4[1:4]:
        term = make_term(kind, target, normalisation="none", **options_of(kind, r))
        assert term(model) <= rmse * (1.0 + 1e-12)
    # to_limit can only shorten to_target, and counts no more points
    assert make_term("RANGE", target, r=r)(model) <= (
        make_term("RANGE_PROPTI", target, r=r, normalisation="none")(model) * (1.0 + 1e-12)
    )


@fixed
@given(values, spreads, shares, curves(-1.0, 1.0))
def test_a_model_inside_the_band_costs_nothing(value, spread, r, place):
    target = target_of(value, spread)
    inside = 0.999 * place
    assert make_term("RANGE", target, r=r)(value + inside * r * np.abs(value)) == 0.0
    assert make_term("BANDS", target)(value + inside * spread) == pytest.approx(0.0, abs=1e-14)
    positive = target_of(np.abs(value) + 1.0)
    model = positive.value * (1.0 + inside * r)
    assert make_term("RANGE_PROPTI", positive, r=r)(model) == 0.0


@fixed
@given(values, spreads, models, shares, st.floats(1.0, 5.0))
def test_widening_the_band_never_raises_the_cost(value, spread, model, r, factor):
    target = target_of(value, spread)
    for kind, name, width in (("RANGE", "r", r), ("BANDS", "n_sigma", 1.0)):
        narrow = make_term(kind, target, **{name: width})(model)
        wide = make_term(kind, target, **{name: width * factor})(model)
        assert wide <= narrow + 1e-12


@fixed
@given(values, spreads, models, st.sampled_from(EQ_4), st.floats(1e-3, 1e3))
def test_normalised_costs_do_not_depend_on_the_unit(value, spread, model, kind, unit):
    for normalisation in sorted(set(NORMALISATIONS) - {"none"}):
        y_N = NORMALISATIONS[normalisation](value - spread if kind == "BANDS_PROPTI" else value)
        if y_N < 1e-2:
            continue
        one = make_term(kind, target_of(value, spread), normalisation=normalisation)(model)
        scaled = target_of(unit * value, unit * spread)
        other = make_term(kind, scaled, normalisation=normalisation)(unit * model)
        assert other == pytest.approx(one, rel=1e-9, abs=1e-9)
    one = make_term(kind, target_of(value, spread), normalisation="none")(model)
    scaled = target_of(unit * value, unit * spread)
    other = make_term(kind, scaled, normalisation="none")(unit * model)
    assert other == pytest.approx(unit * one, rel=1e-9, abs=1e-9 * unit)


@fixed
@given(values, models, steps, st.sampled_from(SINGLE), st.integers(0, N - 1))
def test_single_point_costs_are_the_magnitude_of_their_residual(value, model, step, kind, i):
    assume(kind != "NRSE" or value[i] != 0.0)
    target = target_of(value, step=step)
    term = make_term(kind, target, time_s=target.time_s[i])
    residuals = term.residuals(model)
    assert residuals.shape == (1,)
    assert term(model) == pytest.approx(abs(residuals[0]), rel=1e-14)


@fixed
@given(values, models, steps, st.sampled_from(["THR_above", "THR_below"]), st.integers(0, N - 1))
def test_the_literal_threshold_is_never_dearer_and_none_exceeds_the_farther_end(
    value, model, step, kind, i
):
    target = target_of(value, step=step)
    t0 = target.time_s[i]
    first = make_term(kind, target, time_s=t0)(model)
    literal = make_term(f"{kind}_literal", target, time_s=t0)(model)
    ends = np.abs(target.time_s[[0, -1]] - t0).max() / t0
    assert 0.0 <= literal <= first * (1.0 + 1e-12) <= ends * (1.0 + 2e-12)


@fixed
@given(values, models, steps, st.integers(0, N - 1))
def test_falling_below_is_rising_above_upside_down(value, model, step, i):
    up, down = target_of(value, step=step), target_of(-value, step=step)
    for suffix in ("", "_literal"):
        above = make_term(f"THR_above{suffix}", up, time_s=up.time_s[i])
        below = make_term(f"THR_below{suffix}", down, time_s=up.time_s[i])
        assert above.residuals(model).tolist() == below.residuals(-model).tolist()


@fixed
@given(values, spreads, models, st.sampled_from(EQ_4), shares)
def test_the_norm_of_the_residuals_is_the_cost(value, spread, model, kind, r):
    target = target_of(value, spread)
    term = make_term(kind, target, normalisation="none", **options_of(kind, r))
    residuals = term.residuals(model)
    assert residuals.shape == (N,)
    assert np.linalg.norm(residuals) == pytest.approx(term(model), rel=1e-13, abs=1e-150)


@fixed
@given(values, spreads, models, models, st.floats(0.0, 9.0), st.floats(0.1, 9.0), st.floats(0.1, 9))
def test_weights_act_linearly(value, spread, first, second, w_one, w_two, factor):
    target = target_of(value, spread)
    terms = make_term("RMSE", target), make_term("BANDS", target)
    pair = [first, second]
    total = WeightedSum(list(zip((w_one, w_two), terms, strict=True)))
    scaled = WeightedSum(list(zip((factor * w_one, factor * w_two), terms, strict=True)))
    expected = w_one * terms[0](first) + w_two * terms[1](second)
    assert total.value(pair) == pytest.approx(expected, rel=1e-12)
    assert total.value(pair) == pytest.approx(sum(total.parts(pair)), rel=1e-12)
    assert scaled.value(pair) == pytest.approx(factor * expected, rel=1e-12)


@fixed
@given(values, spreads, steps, st.floats(0.1, 20.0))
def test_smoothed_limits_stay_in_order(value, spread, step, width):
    target = target_of(value, spread, step)
    lower, upper = bands_limits(target, smooth_s=width)
    assert (lower <= upper).all()
    assert lower.min() >= (value - spread).min() - 1e-12
    assert upper.max() <= (value + spread).max() + 1e-12


@fixed
@given(values, spreads, st.sampled_from(EQ_4), shares)
def test_a_perfect_fit_costs_nothing(value, spread, kind, r):
    positive = np.abs(value) + 1.0
    term = make_term(kind, target_of(positive, spread), **options_of(kind, r))
    assert term(positive) == 0.0
    assert term.residuals(positive).tolist() == [0.0] * N


@fixed
@given(values, steps, st.integers(0, N - 1))
def test_a_perfect_fit_of_one_point_costs_nothing(value, step, i):
    assume(value[i] != 0.0)
    target = target_of(value, step=step)
    assert make_term("NRSE", target, time_s=target.time_s[i])(value) == pytest.approx(
        0.0, abs=1e-14
    )


@fixed
@given(values, spreads, models, st.sampled_from(EQ_4), shares, st.floats(0.0, 1.0))
def test_going_farther_from_the_target_never_lowers_the_cost(value, spread, away, kind, r, part):
    target = target_of(value, spread)
    term = make_term(kind, target, normalisation="none", **options_of(kind, r))
    near, far = term(value + part * away), term(value + away)
    assert 0.0 <= near <= far + 1e-12


@fixed
@given(values, spreads, models, st.sampled_from(["RMSE", "BANDS", "RANGE"]), shares)
def test_too_high_costs_as_much_as_too_low(value, spread, away, kind, r):
    term = make_term(kind, target_of(value, spread), normalisation="none", **options_of(kind, r))
    assert term(value + away) == pytest.approx(term(value - away), rel=1e-12, abs=1e-12)


@fixed
@given(values, models)
def test_rmse_does_not_tell_target_from_model(value, model):
    there = make_term("RMSE", target_of(value))(model)
    assert make_term("RMSE", target_of(model))(value) == there


@fixed
@given(values, spreads, models, st.sampled_from(EQ_4), shares, st.permutations(range(N)))
def test_order_of_the_points_does_not_matter(value, spread, model, kind, r, order):
    def cost(index):
        target = target_of(value[index], spread[index])
        return make_term(kind, target, normalisation="none", **options_of(kind, r))(model[index])

    assert cost(np.array(order)) == pytest.approx(cost(np.arange(N)), rel=1e-12, abs=1e-150)


@fixed
@given(values, models, models, st.floats(0.1, 9.0), st.floats(0.0, 9.0), st.floats(0.0, 9.0))
def test_cost_rises_with_a_weight_and_order_of_terms_does_not_matter(
    value, first, second, w_one, w_two, more
):
    term = make_term("RMSE", target_of(value))
    total = WeightedSum([(w_one, term), (w_two, term)]).value([first, second])
    assert WeightedSum([(w_one + more, term), (w_two, term)]).value([first, second]) >= total
    turned = WeightedSum([(w_two, term), (w_one, term)]).value([second, first])
    assert turned == pytest.approx(total, rel=1e-14)


@fixed
@given(
    values, models, st.sampled_from(["RMSE", "RANGE"]), st.floats(-1e3, 1e3), st.floats(0.1, 9.0)
)
def test_cost_of_a_whole_curve_does_not_depend_on_the_clock(value, model, kind, shift, pace):
    time = np.arange(float(N))
    one = make_term(kind, Target(time, value), normalisation="none")(model)
    assert make_term(kind, Target(shift + pace * time, value), normalisation="none")(model) == one
