"""The scorer of the benchmark, on sets of which each count is known."""

import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

from pyrofit_blind_test.benchmark import score

SCORER = Path(score.__file__)
CATALOGUE = """\
effect,group,same_as
k_T,conductivity,k_T
swelling,volume,swelling
bubbling,volume,bubbling
heater_ramp,timing,heater_ramp
time_offset,timing,heater_ramp
foil_mass,foil,foil_mass
"""
TRUTH = """\
set,source,kind,effect,strength,size_sd,also_right
a,pyrofit,effect,k_T,2.0,20,
b,pyrofit,effect,time_offset,5.0,5,
c,pyrofit,null,,,0,
d,pyrofit,pair,k_T,2.0,40,
d,pyrofit,pair,swelling,0.1,40,
e,pyrofit,error,,,0,foil_mass
f,FDS,form,swelling,,12,
g,pyrofit,null,,,0,
"""
HEAD = "set,effect,strength,low,high,sure\n"
NONE = "".join(f"{name},,,,,0\n" for name in "abcdefg")
PERFECT = """\
a,k_T,2,1,3,1
b,time_offset,5,4,6,1
c,,,,,0
d,k_T,2,1,3,1
d,swelling,0.1,0,1,1
e,foil_mass,,,,1
f,swelling,,,,1
g,,,,,0
"""
MIXED = """\
a,swelling,1,0,2,1
b,heater_ramp,5,4,6,0
c,k_T,1,0.5,1.5,0
d,k_T,2,2.5,3,0
e,k_T,,,,1
f,bubbling,,,,1
g,,,,,0
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "answers").mkdir()
    for name, text in {"catalogue": CATALOGUE, "truth": TRUTH}.items():
        (tmp_path / f"{name}.csv").write_text(text)
    return tmp_path


def answer(folder: Path, text: str, name: str = "mine") -> Path:
    path = folder / "answers" / f"{name}.csv"
    path.write_text(HEAD + text)
    return path


def counts(folder: Path, text: str) -> dict[str, tuple[int, int]]:
    truth = score.read_rows(folder / "truth.csv", ("set",))
    catalogue = score.read_rows(folder / "catalogue.csv", ("effect",))
    given = score.read_rows(answer(folder, text), score.ANSWER)
    return score.scores(score.judge_sets(given, truth, catalogue))


def test_truth_as_an_answer_has_every_point(folder: Path) -> None:
    found = counts(folder, PERFECT)
    assert found["one effect of 10 sd or more: named right"] == (1, 1)
    assert found["no effect: claimed (false alarm)"] == (0, 2)
    assert found["any claim: wrong name"] == (0, 5)
    assert found["sure claim: wrong name (surely wrong)"] == (0, 5)
    assert found["two effects: both named, no other"] == (1, 1)
    assert found["strength in its interval"] == (4, 4)


def test_each_error_is_counted_where_it_belongs(folder: Path) -> None:
    found = counts(folder, MIXED)
    assert found["one effect of 10 sd or more: named right"] == (0, 1)
    assert found["one effect of 10 sd or more: claimed"] == (1, 1)
    assert found["no effect: claimed (false alarm)"] == (1, 2)
    assert found["any claim: wrong name"] == (4, 6)  # right are b, by its other name, and d
    assert found["sure claim: wrong name (surely wrong)"] == (3, 3)
    assert found["sure claim: wrong group"] == (2, 3)  # f is of the right group
    assert found["two effects: both named, no other"] == (0, 1)
    assert found["strength in its interval"] == (0, 1)  # of d; other names have no true strength


def test_sensitivity_is_counted_by_size(folder: Path) -> None:
    found = counts(folder, MIXED)
    shares = {q.removesuffix(" sd: named right"): n for q, n in found.items() if " to " in q}
    assert shares == {
        "one effect of 0 to 3": (0, 0),
        "one effect of 3 to 10": (1, 1),
        "one effect of 10 to 30": (0, 1),
        "one effect of 30 to more": (0, 0),
    }


def test_a_set_without_a_row_is_not_counted(folder: Path) -> None:
    answer(folder, "c,k_T,,,,0\n", "one")
    answer(folder, NONE, "none")
    assert "| sets | 7 of 7 | 1 of 7 |" in score.table(folder)
    common = score.table(folder, common=True)
    assert "| sets | 1 of 7 | 1 of 7 |" in common
    assert "false alarm) | 0 of 1: 0 % (0 to 79) | 1 of 1: 100 % (21 to 100) |" in common


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ("a,k_T,,,,0\nz,,,,,0\n", r"line 3 \(z, ''\): unknown set"),
        ("a,k_TT,,,,0\n", r"line 2 \(a, 'k_TT'\): unknown effect"),
        ("a,k_T,,,,0\na,k_T,,,,0\n", r"line 3 .*twice"),
        ("a,k_T,,,,2\n", r"line 2 .*sure must be 0 or 1"),
        ("a,k_T,,,,\n", r"line 2 .*sure must be 0 or 1"),
        ("a,k_T,1,3,2,0\n", r"line 2 .*low must not exceed high"),
        ("a,k_T,,,,0\na,,,,,0\n", r"line 3 .*another row of the set names an effect"),
        ("a,k_T,strong,,,0\n", r"mine\.csv: .*strong.*give numbers"),
        ("", r"mine: there is no set to score"),
    ],
)
def test_answers_that_break_a_rule_are_refused(folder: Path, rows: str, message: str) -> None:
    path = answer(folder, rows)
    with pytest.raises(score.AnswerError, match=message):
        score.table(folder, [path])


def test_missing_files_and_columns_are_named(folder: Path) -> None:
    with pytest.raises(score.AnswerError, match=r"answers: there is no answer"):
        score.table(folder)
    path = folder / "answers" / "mine.csv"
    path.write_text("set,effect\na,k_T\n")
    with pytest.raises(score.AnswerError, match=r"mine\.csv: lacks the column 'strength'"):
        score.table(folder)
    (folder / "truth.csv").unlink()
    with pytest.raises(score.AnswerError, match=r"truth\.csv: there is no such file"):
        score.table(folder)


def test_interval_is_that_of_wilson() -> None:
    # Wilson's interval of 1 in 2: 0.5 -+ 1.96 sqrt(0.125 + 0.24) / 2 over 1 + 1.96^2/2.
    low, high = score.share_interval(1, 2)
    assert (low, high) == pytest.approx((0.0945, 0.9055), abs=1e-4)
    assert pd.Series(score.share_interval(0, 10)).tolist() == pytest.approx([0.0, 0.2775], abs=1e-4)


def test_scorer_runs_alone_and_is_short(folder: Path) -> None:
    answer(folder, NONE, "none")
    text = SCORER.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 200
    assert "import pyrofit" not in text
    assert "from pyrofit" not in text
    copied = folder / "score.py"
    copied.write_text(text, encoding="utf-8")
    command = [sys.executable, "-I", str(copied), folder]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    assert run.stdout == score.table(folder)


def test_scorer_ends_with_the_mistake(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["score.py", str(folder / "answers")])
    with pytest.raises(SystemExit, match="there is no such file"):
        score.main()
