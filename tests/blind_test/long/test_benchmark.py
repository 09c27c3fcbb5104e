"""The benchmark from end to end, on two sets from curves of FDS."""

from pathlib import Path

import pandas as pd
import pytest

from pyrofit.cli import main
from pyrofit_blind_test.benchmark import score
from pyrofit_blind_test.benchmark import write as writing
from pyrofit_blind_test.benchmark.baselines import NAMES, answer_all
from pyrofit_blind_test.plan import cases_of
from pyrofit_blind_test.setting import read_setting

FDS = Path(__file__).parents[3] / "config" / "foreign_truth.yaml"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A set without an effect and one with a large one, from the mass loss rate alone."""
    root = tmp_path_factory.mktemp("benchmark")
    cases = [case for case in cases_of(read_setting(FDS), "full") if case.signals == "mlr"]
    null = next(case for case in cases if case.kind == "null" and case.noise == "white")
    large = next(case for case in cases if set(case.hidden) == {"char_layer"})
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(root)
        patch.setattr(writing, "cases_of", lambda setting, plan: (null, large))
        assert main(["benchmark", "write", "data", "--setting", str(FDS), "--plan", "full"]) == 0
    answer_all(root / "data")
    return root / "data"


def answer(folder: Path, name: str) -> pd.DataFrame:
    return score.read_rows(folder / "answers" / f"{name}.csv", score.ANSWER)


def test_size_of_the_effect_is_that_of_its_curves(folder: Path) -> None:
    truth = score.read_rows(folder / "truth.csv", writing.TRUTH).set_index("kind")
    assert truth.loc["null", "size_sd"] < 1e-3
    assert truth.loc["effect", "size_sd"] > 3.0


def test_every_baseline_answers_every_set(folder: Path) -> None:
    for name in NAMES:
        assert answer(folder, name)["set"].nunique() == 2
    assert (answer(folder, "none")["effect"] == "").all()
    # AIC pays less for an effect than BIC.
    assert len(answer(folder, "aic")) >= len(answer(folder, "bic"))


def test_forward_selection_finds_an_effect_where_one_is(folder: Path) -> None:
    truth = score.read_rows(folder / "truth.csv", writing.TRUTH)
    large = truth["set"][truth["kind"] == "effect"].item()
    found = answer(folder, "bic")
    rows = found[found["set"] == large]
    assert (rows["effect"] != "").all()
    assert (rows["low"] <= rows["strength"]).all()
    assert (rows["strength"] <= rows["high"]).all()


def test_answers_that_are_there_are_kept(folder: Path) -> None:
    path = folder / "answers" / "sparse.csv"
    before = path.read_bytes()
    told: list[str] = []
    answer_all(folder, tell=told.append)
    assert told == []
    assert path.read_bytes() == before


def test_command_prints_the_table_of_the_scorer(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["benchmark", "score", str(folder)]) == 0
    assert capsys.readouterr().out == score.table(folder)
    assert main(["benchmark", "score", str(folder / "sets")]) == 2
    assert "there is no such file" in capsys.readouterr().err
