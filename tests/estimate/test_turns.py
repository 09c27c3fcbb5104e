"""Searches side by side: what they ask, draw and raise, and that none is left behind."""

from collections.abc import Callable
from functools import partial

import pytest

from pyrofit.estimate.turns import RANDOM, in_turns

Ask = Callable[[int], int]


def adds(times: int, step: int, ask: Ask) -> int:
    """Ask so many times, each question one step above the last answer."""
    found = 0
    for _ in range(times):
        found = ask(found + step)
    return found


def adds_until_ended(ended: list[int], ask: Ask) -> int:
    """Ask nine times, and note the end, however it comes."""
    try:
        return adds(9, 1, ask)
    finally:
        ended.append(1)


def draws(seed: int, ask: Ask) -> list[float]:
    RANDOM.seed(seed)
    return [RANDOM.random() + ask(0) for _ in range(5)]


def test_what_all_ask_is_answered_together_until_all_have_ended() -> None:
    asked = []

    def answer(questions: list[int]) -> list[int]:
        asked.append(questions)
        return [10 * q for q in questions]

    assert in_turns([partial(adds, 1, 1), partial(adds, 3, 2), partial(adds, 0, 3)], answer) == [
        10,
        2220,
        0,
    ]
    assert asked == [[1, 2], [22], [222]]


@pytest.mark.parametrize("searches", [1, 3, 4, 5, 7, 8, 9, 13])
def test_whole_fours_are_answered_until_fewer_searches_are_left(searches: int) -> None:
    asked: list[int] = []

    def answer(questions: list[int]) -> list[int]:
        asked.append(len(questions))
        return questions

    found = in_turns([partial(adds, 12, n) for n in range(searches)], answer, 4)
    assert found == [12 * n for n in range(searches)]
    assert sum(asked) == 12 * searches
    ends = [count for count in asked if count % 4]
    assert asked[len(asked) - len(ends) :] == ends
    assert max(ends, default=0) < 4


def test_those_that_have_waited_longest_are_answered_first() -> None:
    asked = []

    def answer(questions: list[int]) -> list[int]:
        asked.append(questions)
        return questions

    in_turns([partial(adds, 2, step) for step in (1, 10, 100)], answer, 2)
    assert asked == [[1, 10], [100, 2], [20, 200]]


def test_each_draws_what_it_draws_alone() -> None:
    def zeros(questions: list[int]) -> list[int]:
        return [0 for _ in questions]

    together = in_turns([partial(draws, seed) for seed in (1, 2, 1)], zeros)
    assert together == [in_turns([partial(draws, seed)], zeros)[0] for seed in (1, 2, 1)]


def test_the_generator_of_the_caller_is_as_it_was() -> None:
    RANDOM.seed(5)
    expected = RANDOM.random(2)[1]
    RANDOM.seed(5)
    RANDOM.random()
    in_turns([partial(draws, 1)], lambda questions: questions)
    assert RANDOM.random() == expected


def fails(ask: Ask) -> int:
    ask(1)
    raise ValueError("no cost")


def test_error_of_a_search_ends_all() -> None:
    generator = RANDOM.get_bit_generator()
    ended: list[int] = []
    go_on = partial(adds_until_ended, ended)
    with pytest.raises(ValueError, match="no cost"):
        in_turns([go_on, fails, go_on], lambda questions: questions)
    assert len(ended) == 2
    assert RANDOM.get_bit_generator() is generator


@pytest.mark.parametrize("kind", [RuntimeError, KeyboardInterrupt])
def test_error_of_the_answer_ends_all(kind: type[BaseException]) -> None:
    ended: list[int] = []

    def answer(questions: list[int]) -> list[int]:
        raise kind

    with pytest.raises(kind):
        in_turns([partial(adds_until_ended, ended)] * 2, answer)
    assert len(ended) == 2


def test_nothing_to_search_is_nothing_found() -> None:
    assert in_turns([], lambda questions: questions) == []
