"""How costs rank stored sets: sample, rank correlation, regret, valleys, by hand."""

import numpy as np
import pandas as pd
import pytest
from scipy.stats import spearmanr

from pyrofit.analysis import rescoring
from pyrofit.cost import Target
from pyrofit.estimate.measures import fall, peak, rise
from pyrofit.steps.rescore.sentences import alike_costs, own_costs, regret_of

SCORES = pd.DataFrame(
    {"a": [1.0, 2.0, 3.0, 4.0], "b": [10.0, 20.0, 40.0, 30.0], "c": [4.0, 3.0, 2.0, 1.0]}
)


def test_sample_is_the_lowest_of_each_part_of_the_sorted_sets() -> None:
    costs = np.random.default_rng(1).permutation(np.arange(100.0))
    chosen = costs[rescoring.strata(costs, 10)]
    assert chosen.tolist() == [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0]


def test_sample_keeps_the_order_of_ties_and_all_sets_where_they_are_few() -> None:
    assert rescoring.strata(np.array([2.0, 1.0, 1.0, 2.0]), 2).tolist() == [1, 0]
    assert rescoring.strata(np.array([2.0, 1.0]), 5).tolist() == [1, 0]


@pytest.mark.parametrize(
    ("sizes", "total", "taken"),
    [
        ([10, 10], 4, [2, 2]),
        ([10, 10], 5, [3, 2]),
        ([1, 10, 10], 9, [1, 4, 4]),
        ([0, 2, 10], 100, [0, 2, 10]),
    ],
)
def test_histories_share_the_sample(sizes: list[int], total: int, taken: list[int]) -> None:
    assert rescoring.shares_of_histories(sizes, total) == taken


def test_rank_correlation_by_hand_and_as_scipy_computes_it() -> None:
    found = rescoring.spearman(SCORES)
    # Ranks 1 2 3 4 and 1 2 4 3: 1 - 6 (0 + 0 + 1 + 1) / (4 (16 - 1)) = 0.8.
    assert found.loc["a", "b"] == pytest.approx(0.8, rel=1e-14)
    assert found.loc["a", "c"] == pytest.approx(-1.0, rel=1e-14)
    tied = pd.DataFrame(np.random.default_rng(2).integers(0, 5, (50, 3)), columns=list("xyz"))
    expected = spearmanr(tied.to_numpy()).statistic
    assert rescoring.spearman(tied).to_numpy() == pytest.approx(expected, abs=1e-14)


def test_correlation_over_the_best_sets_leaves_the_others_out() -> None:
    rng = np.random.default_rng(3)
    scores = pd.DataFrame(rng.random((200, 3)), columns=list("abc")).assign(mute=0.0)
    scores.loc[:9, "mute"] = 1.0
    found = rescoring.spearman_among_best(scores, 0.2)
    best = scores.sort_values("a").head(40)
    assert found.loc["a", "b"] == pytest.approx(spearmanr(best["a"], best["b"]).statistic)
    assert found.loc["a", "b"] != found.loc["b", "a"]
    # All 190 sets tie as the best of `mute`, which does not tell them apart.
    assert found.loc["mute"].tolist() == [0.0, 0.0, 0.0, 1.0]


def test_cost_that_tells_no_sets_apart_has_no_rank() -> None:
    assert rescoring.telling(SCORES.assign(mute=0.0)) == ["a", "b", "c"]


def matrix(**pairs: float) -> pd.DataFrame:
    names = sorted({name for pair in pairs for name in pair})
    found = pd.DataFrame(np.eye(len(names)), index=names, columns=names)
    for (one, other), value in pairs.items():
        found.loc[one, other] = found.loc[other, one] = value
    return found


def test_groups_hold_only_costs_that_agree_with_each_other() -> None:
    # a-b and b-c agree, a-c do not: no chain.
    found = rescoring.grouped(matrix(ab=0.99, bc=0.97, ac=0.9), 0.95)
    assert found == [["a", "b"], ["c"]]
    assert rescoring.grouped(matrix(ab=0.99, bc=0.97, ac=0.96), 0.95) == [["a", "b", "c"]]
    assert rescoring.grouped(matrix(ab=0.1, bc=0.2, ac=0.3), 0.95) == [["a"], ["b"], ["c"]]


def test_least_alike_are_the_two_of_the_lowest_correlation() -> None:
    assert rescoring.least_alike(matrix(ab=0.5, bc=-0.2, ac=0.3)) == ("b", "c", -0.2)


def test_valley_is_the_range_of_the_best_sets_with_ties() -> None:
    sets = np.column_stack([np.arange(10.0), np.arange(10.0)[::-1]])
    scores = np.array([3.0, 1.0, 2.0, 2.0, 9.0, 9.0, 9.0, 9.0, 9.0, 9.0])
    found = rescoring.valley(scores, sets, 0.2)
    # Two sets of ten; the second ties with a third.
    assert (found.best, found.value, found.sets) == (1, 1.0, 3)
    assert found.low.tolist() == [1.0, 6.0]
    assert found.high.tolist() == [3.0, 8.0]


def test_valley_holds_the_best_set_at_least() -> None:
    found = rescoring.valley(np.array([2.0, 1.0]), np.array([[0.0], [1.0]]), 0.01)
    assert (found.sets, found.low.tolist(), found.high.tolist()) == (1, [1.0], [1.0])


def test_regret_by_hand() -> None:
    # a and b are lowest for the first set, c for the last.
    found = rescoring.excess(SCORES)
    assert found.loc["a"].tolist() == [0.0, 0.0, 3.0]
    assert found.loc["c"].tolist() == [3.0, 2.0, 0.0]
    better = rescoring.better(SCORES)
    assert better.loc["a"].tolist() == [0.0, 0.0, 0.75]
    assert better.loc["c"].tolist() == [0.75, 0.5, 0.0]


def test_regret_over_a_lowest_cost_of_zero_has_no_number() -> None:
    found = rescoring.excess(SCORES.assign(a=[0.0, 1.0, 2.0, 3.0]))
    assert found["a"].isna().all()
    assert found.loc["c", "b"] == 2.0


def test_moments_of_a_curve() -> None:
    time = np.arange(10.0, 17.0)
    target = Target(time, [1.0, 2.0, 6.0, 9.0, 5.0, 2.0, 1.0])  # half of the range: 5
    assert (peak(target), rise(target), fall(target)) == (13.0, 12.0, 14.0)


def test_sentences_name_who_agrees_and_who_does_not() -> None:
    assert alike_costs(matrix(ab=0.99, bc=0.4, ac=0.5)) == [
        "The sets are ranked alike (rank correlation 0.95 or more) by a and b.",
        "c ranks them unlike any other.",
        "b and c agree least (rank correlation 0.40).",
    ]
    assert alike_costs(matrix(ab=0.3))[0] == "a and b rank them unlike each other."
    assert alike_costs(matrix(ab=0.99)) == [
        "The sets are ranked alike (rank correlation 0.95 or more) by a and b.",
        "a and b agree least (rank correlation 0.99).",
    ]
    assert alike_costs(pd.DataFrame([[1.0]], index=["a"], columns=["a"])) == []


def test_sentences_on_regret_name_row_and_column() -> None:
    table = rescoring.excess(SCORES)
    assert own_costs(table.loc[["a", "c"], ["a", "c"]]) == [
        "The set with the lowest a is 300 % above the lowest c, the largest excess among the cost "
        "functions of the study."
    ]
    assert own_costs(table.loc[["a"], ["a"]]) == []
    assert own_costs(rescoring.excess(SCORES.assign(a=0.0, b=0.0, c=0.0))) == []
    assert regret_of(rescoring.better(SCORES[["b", "c"]])) == [
        "The largest disagreement: c finds 75 % of the sets better than the set with the lowest b."
    ]
    assert regret_of(rescoring.better(SCORES[["a", "b"]])) == []
