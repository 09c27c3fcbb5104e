"""Effects and costs of a user's own, from the folders that a study names."""

import copy
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from pyrofit import cli
from pyrofit.config import Study, as_study, candidate_effects, digest, read_mapping, read_study
from pyrofit.cost import KINDS, Target, known_costs, make_term
from pyrofit.effects import known_effects
from pyrofit.errors import StudyError
from pyrofit.parallel import parallel_map
from pyrofit.plugins import use_plugins
from pyrofit.quantities import known_quantities
from pyrofit.results import dependencies
from pyrofit.stages.measurements import computed

ROOT = Path(__file__).parents[2]
EFFECT, QUANTITY, COST, *_ = (
    part.split("```")[0]
    for part in (ROOT / "docs" / "adding.md").read_text(encoding="utf-8").split("```python\n")[1:]
)
"""The examples of the documentation."""
HUBER = {"kind": "huber", "options": {"bend": 1e-3}}


@pytest.fixture(autouse=True)
def _nothing_stays_known() -> Iterator[None]:
    yield
    use_plugins([])


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a study's folder with an effect and a cost of its own."""
    write(tmp_path / "own" / "effects" / "natural_convection.py", EFFECT)
    write(tmp_path / "own" / "quantities" / "thickness_of_sample.py", QUANTITY)
    write(tmp_path / "own" / "costs" / "huber.py", COST)
    return tmp_path


def write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def given(**changes: Any) -> dict[str, Any]:
    """Return the keys of the smoke study with plugins."""
    return {**read_mapping(ROOT / "config" / "smoke.yaml"), "plugins": ["own"], **changes}


def with_own_cost() -> dict[str, Any]:
    keys = copy.deepcopy(given())
    cost = next(iter(keys["imp"]["costs"].values()))
    term = {k: v for k, v in cost[0].items() if k not in ("normalisation", "options")}
    keys["imp"]["costs"] = {**keys["imp"]["costs"], "OWN": [{**term, **HUBER}]}
    return keys


def read(folder: Path, keys: dict[str, Any]) -> Study:
    return as_study(keys, str(folder / "study.yaml"))


def refused(folder: Path) -> str:
    with pytest.raises(StudyError) as error:
        read(folder, given())
    assert "natural_convection" not in known_effects()
    assert "huber" not in known_costs()
    return str(error.value)


def test_own_quantity_is_simulated_and_read(folder: Path) -> None:
    keys = copy.deepcopy(given())
    (name, *_) = (n for n, e in keys["experiments"].items() if e["kind"] == "gasification")
    signals = keys["experiments"][name]["signals"]
    signals["thickness_of_sample"] = {"file": "synthetic", "every": 20, "noise": 1e-5}
    study = read(folder, keys)
    frame = computed(study)[name, "thickness_of_sample"]
    thickness = frame["thickness_m"].to_numpy()
    layers = sum(layer.thickness_m for layer in study.experiments[name].sample.layers)
    assert thickness[0] == pytest.approx(layers, rel=0.01)
    assert thickness[-1] < 0.2 * layers
    use_plugins([])
    assert "thickness_of_sample" not in known_quantities()


def test_own_effect_is_put_into_the_model_and_is_a_candidate(folder: Path) -> None:
    assert "natural_convection" in candidate_effects(read(folder, given()))
    study = read(folder, given(effects={"natural_convection": {"C": 1.31}}))
    (slab, *_) = (e for e in study.experiments.values() if e.kind == "gasification")
    assert slab.front.h_cube_root_W_m2K43 == 1.31
    assert "natural_convection" not in candidate_effects(study)


def test_processes_of_a_diagnosis_know_own_names(folder: Path) -> None:
    read(folder, given())
    known = parallel_map(lambda i: "natural_convection" in known_effects(), 2, processes=2)
    assert known == [True, True]


def test_own_cost_is_checked_and_computed_like_any_other(folder: Path) -> None:
    assert read(folder, with_own_cost()).imp.costs["OWN"][0].kind == "huber"
    term = make_term("huber", Target([0, 1], [0, 0]), bend=1.0)
    # 0.5 counts as its square, 3 as 2 * 1 * 3 - 1: sqrt((0.25 + 5) / 2)
    assert term(np.array([0.5, -3.0])) == pytest.approx(2.625**0.5)
    keys = with_own_cost()
    del keys["imp"]["costs"]["OWN"][0]["options"]
    with pytest.raises(StudyError, match="huber: the option `bend` is absent"):
        read(folder, keys)


def test_own_names_are_unknown_to_the_next_study(folder: Path) -> None:
    read(folder, given())
    assert {"natural_convection", "huber"} <= {*known_effects(), *known_costs()}
    read(folder, given(plugins=[]))
    assert "natural_convection" not in known_effects()
    assert list(known_costs()) == list(KINDS)
    assert "pyrofit.effects.natural_convection" not in sys.modules


def test_two_studies_may_each_have_an_effect_of_one_name(folder: Path) -> None:
    write(folder / "other/effects/natural_convection.py", EFFECT.replace("upper=3.0", "upper=4.0"))
    limits = []
    for name in ("own", "other", "own"):
        read(folder, given(plugins=[name]))
        limits.append(known_effects()["natural_convection"].strength["C"].upper)
    assert limits == [3.0, 4.0, 3.0]


def test_study_as_the_workflow_writes_it_finds_its_plugins(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    keys = with_own_cost() | {"effects": {"natural_convection": {"C": 1.31}}}
    write(folder / "mine" / "study.yaml", yaml.safe_dump(keys | {"plugins": ["../own"]}))
    monkeypatch.chdir(folder)
    study = read_study(Path("mine/study.yaml"))
    assert study.plugins == ("mine/../own",)
    write(folder / "results" / "study.json", json.dumps(study.model_dump(mode="json")))
    use_plugins([])
    assert read_study(Path("results/study.json")) == study
    assert "natural_convection" in known_effects()


def test_helper_of_own_effects_is_imported_and_counts_as_part_of_them(folder: Path) -> None:
    text = EFFECT.replace("upper=3.0", "upper=MOST")
    text = text.replace('"""\n', '"""\n\nfrom pyrofit.effects._mine import MOST\n', 1)
    digests = set()
    for most in (3.5, 4.5):
        use_plugins([])
        write(folder / "own" / "effects" / "natural_convection.py", text)
        write(folder / "own" / "effects" / "_mine.py", f"MOST = {most}\n")
        digests.add(digest(dependencies.diagnose_slice(read(folder, given()))))
    assert len(digests) == 2


def test_edit_of_an_own_effect_changes_what_uses_it_and_no_more(folder: Path) -> None:
    used = given(effects={"natural_convection": {"C": 1.31}})
    for keys, changes in ((given(), {"diagnose"}), (used, {"diagnose", "imp", "identify", "data"})):
        write(folder / "own" / "effects" / "natural_convection.py", EFFECT)
        before = digests_of(read(folder, keys))
        write(folder / "own" / "effects" / "natural_convection.py", EFFECT + "ANOTHER = True\n")
        after = digests_of(read(folder, keys))
        assert {name for name in before if after[name] != before[name]} == changes


def test_edit_of_an_own_quantity_changes_what_measures_it_and_the_diagnosis(folder: Path) -> None:
    used = given()
    record = {"file": "synthetic", "every": 10, "noise": 1e-5}
    used["experiments"]["slab_25"]["signals"]["thickness_of_sample"] = record
    everything = {"data", "imp", "identify", "diagnose"}
    for keys, changes in ((given(), {"diagnose"}), (used, everything)):
        write(folder / "own" / "quantities" / "thickness_of_sample.py", QUANTITY)
        before = digests_of(read(folder, keys))
        write(folder / "own" / "quantities" / "thickness_of_sample.py", QUANTITY + "A = 1\n")
        after = digests_of(read(folder, keys))
        assert {name for name in before if after[name] != before[name]} == changes


def test_edit_of_an_own_cost_changes_its_own_searches_and_no_others(folder: Path) -> None:
    study = read(folder, with_own_cost())
    (other, *_) = study.imp.costs
    before = [digest(dependencies.imp(study, cost, "sceua")) for cost in ("OWN", other)]
    write(folder / "own" / "costs" / "huber.py", COST + "ANOTHER = True\n")
    after = [digest(dependencies.imp(study, cost, "sceua")) for cost in ("OWN", other)]
    assert [a == b for a, b in zip(after, before, strict=True)] == [False, True]


def digests_of(study: Study) -> dict[str, str]:
    cost = next(iter(study.imp.costs))
    parts = {
        "data": dependencies.data_slice(study),
        "imp": dependencies.imp(study, cost, "sceua"),
        "identify": dependencies.identify_slice(study),
        "diagnose": dependencies.diagnose_slice(study),
        "collect": dependencies.collect_slice(study),
    }
    return {name: digest(part) for name, part in parts.items()}


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("own/effects/broken.py", "EFFECT = (\n", ("broken.py, line 1", "correct it")),
        (
            "own/effects/fails.py",
            "EFFECT = 1 / 0\n",
            ("fails.py: cannot be imported, ZeroDivisionError: division by zero",),
        ),
        (
            "own/effects/empty.py",
            "",
            ("empty.py: it does not define `EFFECT`; write EFFECT = Effect(", "begin its name"),
        ),
        ("own/effects/number.py", "EFFECT = 3\n", ("number.py: `EFFECT` is of another kind",)),
        ("own/effects/back_loss.py", EFFECT, ("back_loss.py: pyrofit has 'back_loss' already",)),
        ("own/effects/base.py", EFFECT, ("pyrofit has 'base' already; rename the file",)),
        ("own/effects/my-effect.py", EFFECT, ("'my-effect' is no name; rename the file",)),
        ("own/costs/RMSE.py", COST, ("RMSE.py: pyrofit has 'RMSE' already; rename",)),
        ("own/costs/empty.py", "", ("it does not define `cost`; write def cost(target, *,",)),
        (
            "own/costs/loose.py",
            "def cost(target, bend=1.0):\n    return None\n",
            ("`cost` is of another kind; write def cost(target, *, option)",),
        ),
    ],
)
def test_broken_file_of_a_plugin_is_refused_with_its_place(
    folder: Path, name: str, text: str, words: tuple[str, ...]
) -> None:
    write(folder / name, text)
    said = refused(folder)
    assert all(part in said for part in ("plugins: ", *words)), said


def test_name_that_two_folders_have_is_refused(folder: Path) -> None:
    write(folder / "other" / "costs" / "huber.py", COST)
    with pytest.raises(
        StudyError, match=r"other.costs.huber\.py: .*own.costs.huber\.py has 'huber'"
    ):
        read(folder, given(plugins=["own", "other"]))


def test_missing_folder_is_refused(tmp_path: Path) -> None:
    said = refused(tmp_path)
    assert "own: there is no such folder; correct the path, which is relative to the study" in said


def test_folder_without_effects_or_costs_is_refused(tmp_path: Path) -> None:
    write(tmp_path / "own" / "natural_convection.py", EFFECT)
    assert "own: it has no folder effects or quantities or costs; put" in refused(tmp_path)


@pytest.mark.parametrize("plugins", ["own", 3, [3], {"own": 1}])
def test_plugins_that_are_no_list_of_names_are_refused(folder: Path, plugins: object) -> None:
    with pytest.raises(StudyError, match="plugins"):
        read(folder, given(plugins=plugins))


def test_no_compiled_copy_is_left_beside_a_plugin(folder: Path) -> None:
    read(folder, given())
    assert not list(folder.rglob("__pycache__"))


def test_check_says_that_it_runs_plugins_and_refuses_them_when_asked(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study, trace = folder / "study.yaml", folder / "trace"
    write(folder / "own" / "costs" / "huber.py", f"open({str(trace)!r}, 'w').close()\n{COST}")
    write(study, yaml.safe_dump(given()))
    assert cli.main(["check", str(study), "--no-plugins"]) == 2
    assert "hold programs, which a check would run" in capsys.readouterr().err
    assert not trace.exists()
    assert cli.main(["check", str(study)]) == 0
    assert f"plugins: runs the programs in {folder / 'own'}" in capsys.readouterr().err
    assert trace.exists()
