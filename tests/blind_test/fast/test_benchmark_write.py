"""The data sets of the benchmark: files that need no pyrofit, the truth apart."""

import json
from pathlib import Path

import pandas as pd
import pytest
import yaml

from pyrofit.config import Study, as_study, candidate_effects, read_study
from pyrofit.effects import known_effects
from pyrofit.errors import DataError
from pyrofit.experiments import kind_of
from pyrofit.model.material import Material
from pyrofit_blind_test.benchmark import score
from pyrofit_blind_test.benchmark import write as writing
from pyrofit_blind_test.benchmark.plain import catalogue_table, model_keys
from pyrofit_blind_test.benchmark.write import answer_rows, write_benchmark
from pyrofit_blind_test.places import Places, folder_of
from pyrofit_blind_test.plan import TwinPlan, cases_of
from pyrofit_blind_test.setting import Setting, read_setting
from pyrofit_blind_test.twin import describe_twin

CONFIG = Path(__file__).parents[3] / "config"
FDS = CONFIG / "foreign_truth.yaml"
PLAN = "part"


def size(setting: Setting, case: TwinPlan, places: Places) -> float:
    return 12.5 if case.hidden else 0.0


@pytest.fixture(scope="module")
def few() -> tuple[TwinPlan, ...]:
    """A set of each kind: no effect, one, two."""
    cases = cases_of(read_setting(FDS), PLAN)
    return tuple({case.kind: case for case in cases}.values())


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, few: tuple[TwinPlan, ...]) -> Path:
    """The benchmark of these sets, of which one has been diagnosed."""
    root = tmp_path_factory.mktemp("benchmark")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(root)
        patch.setattr(writing, "cases_of", lambda setting, plan: few)
        diagnosed = Places(folder_of(FDS, PLAN)).case(few[0].id)
        diagnosed.parent.mkdir(parents=True)
        diagnosed.write_text(json.dumps(finding(few[0].id) | {"detectability": 7.0}))
        write_benchmark(root / "all", [FDS], PLAN, size=size)
        write_benchmark(root / "again", [FDS], PLAN, size=size)
        write_benchmark(root / "few", [FDS], PLAN, so_far=True, size=size)
        diagnosed.unlink()
        with pytest.raises(DataError, match="has been diagnosed; leave out --so-far"):
            write_benchmark(root / "none", [FDS], PLAN, so_far=True, size=size)
    return root


def finding(name: str) -> dict[str, object]:
    """Return a diagnosis that is sure of one effect."""
    values = {"value": 3e-4, "low": 2e-4, "high": 4e-4, "low_wide": 1e-4, "high_wide": 5e-4}
    return {
        "id": name,
        "verdict": {"kind": "named", "effects": ["in_depth"], "confirmed": True},
        "candidates": [
            {"effects": ["in_depth"], "rejected": "", "parameters": {"in_depth_length_m": values}}
        ],
    }


def test_sets_hold_what_their_model_names(folder: Path, few: tuple[TwinPlan, ...]) -> None:
    for case in few:
        of = folder / "all" / "sets" / case.id
        model = yaml.safe_load((of / "model.yaml").read_text(encoding="utf-8"))
        for experiment in model["experiments"].values():
            for signal in experiment["signals"].values():
                curve = pd.read_csv(of / signal["file"])
                assert {"time_s", signal["column"]} <= set(curve)
                assert curve.filter(like="uncertainty").gt(0.0).all(axis=None)
        assert set(case.hidden) <= set(model["candidates"])


def test_only_the_file_of_the_truth_tells_it(folder: Path, few: tuple[TwinPlan, ...]) -> None:
    truth = score.read_rows(folder / "all" / "truth.csv", writing.TRUTH)
    for case in few:
        of = truth[truth["set"] == case.id]
        assert set(of["effect"]) == set(case.hidden or {""})
        assert set(of["kind"]) == {case.kind}
        assert of["source"].str.startswith("FDS").all()
        values = {v for quantities in case.hidden.values() for v in quantities.values()}
        assert set(of["strength"].dropna()) <= values
    sizes = dict(zip(truth["set"], truth["size_sd"], strict=True))
    assert sizes[few[0].id] == 7.0
    assert {sizes[case.id] for case in few[1:] if case.hidden} == {12.5}
    for path in (folder / "all" / "sets").rglob("*.yaml"):
        text = path.read_text(encoding="utf-8")
        assert "hidden" not in text
        assert "synthetic" not in text


def test_the_same_plan_gives_the_same_bytes(folder: Path) -> None:
    files = [p for p in (folder / "all").rglob("*") if p.is_file()]
    assert len(files) > 15
    for path in files:
        assert (
            path.read_bytes() == (folder / "again" / path.relative_to(folder / "all")).read_bytes()
        )


def test_diagnosed_sets_alone_have_the_answer_of_pyrofit(
    folder: Path, few: tuple[TwinPlan, ...]
) -> None:
    assert [p.name for p in (folder / "few" / "sets").iterdir()] == [few[0].id]
    answer = score.read_rows(folder / "few" / "answers" / "pyrofit.csv", score.ANSWER)
    assert answer.to_dict("records") == answer_rows(finding(few[0].id))
    assert "| sets | 1 of 1 |" in score.table(folder / "few")


def test_an_answer_has_the_wide_interval_and_is_sure_if_confirmed() -> None:
    (row,) = answer_rows(finding("a"))
    assert row == {
        **{"set": "a", "effect": "in_depth", "strength": 3e-4, "low": 1e-4, "high": 5e-4},
        "sure": 1,
    }
    nothing = {"id": "b", "verdict": {"kind": "unknown", "effects": []}, "candidates": []}
    assert answer_rows(nothing) == [{"set": "b", "effect": "", "sure": 0}]


def study_of(signals: str) -> Study:
    setting = read_setting(CONFIG / "blind_test.yaml")
    case = next(c for c in cases_of(setting, "full") if c.signals == signals)
    keys, _ = describe_twin(setting, case)
    return as_study(keys, "study.yaml")


@pytest.mark.parametrize("signals", ["mlr+back", "mlr+back+tga"])
def test_keys_that_are_left_out_change_nothing(signals: str) -> None:
    study = study_of(signals)
    model = yaml.safe_load(yaml.safe_dump(model_keys(study)))
    assert Material(**model["material"]) == study.material
    assert model["candidates"] == list(candidate_effects(study))
    for name, experiment in study.experiments.items():
        keys = model["experiments"][name]
        kept = {key: value for key, value in keys.items() if key not in ("use", "signals")}
        left = experiment.model_dump(include={"laboratory", "program"})
        again = type(experiment)(**kept, **left, signals=experiment.signals)
        assert again == experiment
        assert keys["use"] == ("predict" if name == "capa_90" else "fit")
    assert {kind_of(e).stage for e in study.experiments.values()} == (
        {"imp", "kinetics"} if "tga" in signals else {"imp"}
    )


def test_parameters_are_in_si_units() -> None:
    study = study_of("mlr+back")
    for name, keys in model_keys(study)["parameters"].items():
        assert (keys["lower"], keys["upper"]) == study.parameters[name].bounds_si
        assert not keys["unit"].startswith("k") or keys["unit"].startswith("kg")
        if name in study.known:
            assert keys["lower"] < keys["known"] < keys["upper"]


def test_catalogue_has_every_effect_and_each_of_its_parameters() -> None:
    table = catalogue_table()
    for name, effect in known_effects().items():
        rows = table[table["effect"] == name]
        assert list(rows["parameter"]) == list(effect.quantities)
        assert list(rows["role"]) == ["strength", *["form"] * len(effect.form)]
        assert set(rows["equation"]) == {effect.equation}
    assert table["same_as"].isin(table["effect"]).all()


def test_readme_tells_every_key_of_the_files(folder: Path) -> None:
    text = (folder / "all" / "README.md").read_text(encoding="utf-8")
    for word in (*score.ANSWER, "model.yaml", "catalogue.csv", "candidates", "known_sd", "use"):
        assert f"`{word}`" in text or word in text.split("\n## Files")[1]


def test_study_of_a_set_is_one_of_pyrofit(folder: Path, few: tuple[TwinPlan, ...]) -> None:
    study = read_study(folder / "all" / "sets" / few[0].id / "study.yaml")
    assert study.synthetic is None
