"""A diagnosis on poor or wrong input, from the command line: what is said, and what is kept."""

import hashlib
import shlex
import shutil
from pathlib import Path
from typing import Any

import pytest
import yaml
from hidden_effects import HIDDEN, SEED
from small import CHANNELS, SD, given, measured

from pyrofit.cli import main
from pyrofit.quantities import known_quantities
from pyrofit.results.files import read_json, write_csv

FOUND = Path("results/small/diagnosis/diagnosis.json")
FEW = {"effects": ["k_T", "heater_ramp", "front_convection"]}
"""Candidates that are enough here, for speed."""

Said = tuple[int, str]


def write(keys: dict[str, Any]) -> None:
    Path("study.yaml").write_text(yaml.safe_dump(keys, sort_keys=False), encoding="utf-8")


def series(hidden: str, stated: bool = True, every: int = 1) -> None:
    """Write the files of a twin."""
    for (name, quantity), frame in measured(HIDDEN[hidden], SEED).items():
        kept = (
            frame if stated else frame.drop(columns=known_quantities()[quantity].uncertainty_column)
        )
        write_csv(Path(f"{name}_{quantity}.csv"), kept.iloc[every // 2 :: every])


def without_uncertainty(keys: dict[str, Any]) -> dict[str, Any]:
    for name, quantity in CHANNELS:
        signal = keys["experiments"][name]["signals"][quantity]
        del signal["columns"]["uncertainty"], signal["units"]["uncertainty"]
    return keys


@pytest.fixture
def working(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder of its own as the working folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("PYROFIT_DATA_DIR", raising=False)
    return tmp_path


@pytest.fixture
def diagnose(working: Path, capsys: pytest.CaptureFixture[str]) -> Any:
    """Return what runs the command and returns its exit code and what it said."""

    def run() -> Said:
        try:
            code = main(shlex.split("diagnose --study study.yaml"))
        except SystemExit as ended:
            code = int(ended.code or 0)
        return code, capsys.readouterr().err

    return run


def contents() -> dict[str, str]:
    return {
        path.as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in Path("results").rglob("*")
        if path.is_file()
    }


@pytest.fixture
def without_page(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave out the page, which takes longer than the diagnosis."""
    monkeypatch.setattr("pyrofit.cli.diagnosing._diagnosis_page", lambda given: None)


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the results of an earlier diagnosis."""
    folder = tmp_path_factory.mktemp("diagnosed")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        write(given(**FEW))
        series("k_T")
        assert main(shlex.split("diagnose --study study.yaml")) == 0
    return folder


# --- poor input -----------------------------------------------------------------------------


def test_diagnosis_by_hand_leaves_results_page_and_a_study_that_is_valid(
    finished: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(finished)
    found = read_json(FOUND)
    assert found["verdict"]["kind"] == "named"
    assert found["extended_study"] == "extended.yaml"
    page = FOUND.with_name("report.html").read_text(encoding="utf-8")
    assert "slope of the conductivity" in page
    assert main(["check", str(FOUND.with_name("extended.yaml"))]) == 0


def test_noise_that_is_not_stated_is_estimated_and_said(diagnose: Any, without_page: None) -> None:
    write(without_uncertainty(given(**FEW)))
    series("k_T", stated=False)
    code, said = diagnose()
    assert code == 0, said
    found = read_json(FOUND)
    for row in found["noise"]:
        assert "from the scatter" in row["words"], row
        assert 0.5 * SD[row["signal"]] < row["sd_median"] < 2.0 * SD[row["signal"]], row
    assert found["verdict"]["effects"] == ["k_T"]


def test_rate_at_one_flux_alone_is_ambiguous_at_most(diagnose: Any, without_page: None) -> None:
    keys = given(calibrate={"slab_25": ["mlr"]}, effects=["k_T", "volatile"])
    del (
        keys["experiments"]["slab_60"],
        keys["experiments"]["slab_25"]["signals"]["back_temperature"],
    )
    write(keys)
    series("volatile")
    code, said = diagnose()
    assert code == 0, said
    verdict = read_json(FOUND)["verdict"]
    assert verdict["kind"] == "ambiguous"
    assert verdict["sets"] == [["volatile"]]
    assert "only the mass loss rate at one flux is calibrated" in verdict["reasons"]
    assert not verdict["confirmed"]


def test_diagnosis_that_finds_nothing_any_more_forgets_what_it_had_found(
    finished: Path, working: Path, diagnose: Any, without_page: None
) -> None:
    shutil.copytree(finished, working, dirs_exist_ok=True)
    series("nothing")
    code, said = diagnose()
    assert code == 0, said
    found = read_json(FOUND)
    assert found["verdict"]["kind"] == "none"
    assert found["verdict"]["words"] in said
    assert found["extended_study"] == ""


# --- wrong input ----------------------------------------------------------------------------


def few_points(keys: dict[str, Any]) -> None:
    without_uncertainty(keys)
    series("nothing", stated=False, every=10)  # 6 points at 60 kW/m2


def overlapping(keys: dict[str, Any]) -> None:
    keys["diagnosis"]["hold_out"] = {"slab_60": ["mlr"]}


def without_foil(keys: dict[str, Any]) -> None:
    for name in ("slab_25", "slab_60"):
        del keys["experiments"][name]["sample"]["foil"]
    keys["diagnosis"]["effects"] = ["foil_mass"]


def misspelt(keys: dict[str, Any]) -> None:
    keys["diagnosis"]["effects"] = ["k_T", "heater_rampp"]


def missing_file(keys: dict[str, Any]) -> None:
    Path("slab_60_mlr.csv").unlink()


def text_for_a_number(keys: dict[str, Any]) -> None:
    path = Path("slab_60_mlr.csv")
    path.write_text(path.read_text().replace("\n12.5,", "\ntwelve,"))


def beyond_known(keys: dict[str, Any]) -> None:
    keys["known"] = {"cp": {"value": 9.0, "sd": 0.1}}


WRONG = {
    "too few points": (
        few_points,
        ("6 points tell nothing of their noise, at least 8 do; give an uncertainty",),
    ),
    "held out what is calibrated": (
        overlapping,
        ("diagnosis.hold_out.slab_60: 'mlr' is calibrated, too; leave it out",),
    ),
    "effect of a foil that is not there": (
        without_foil,
        ("'foil_mass' cannot be a candidate: no calibrated signal", "it needs a foil on the back"),
    ),
    "unknown effect": (
        misspelt,
        ("unknown effect 'heater_rampp'. Did you mean 'heater_ramp'?",),
    ),
    "file that is not there": (missing_file, ("slab_60_mlr.csv",)),
    "text for a number": (text_for_a_number, ("slab_60_mlr.csv", "twelve")),
    "knowledge beyond the limits": (
        beyond_known,
        ("known.cp.value: 9 lies outside the limits 1 to 3",),
    ),
}


@pytest.mark.parametrize(("break_it", "words"), WRONG.values(), ids=WRONG)
def test_mistake_is_told_with_exit_code_2_and_earlier_results_are_kept(
    break_it: Any, words: tuple[str, ...], finished: Path, working: Path, diagnose: Any
) -> None:
    shutil.copytree(finished, working, dirs_exist_ok=True)
    keys = given(**FEW)
    break_it(keys)
    write(keys)
    before = contents()
    assert FOUND.as_posix() in before
    code, said = diagnose()
    assert code == 2, said
    assert "error: " in said
    assert "Traceback" not in said
    for word in words:
        assert word in said
    diagnosis = {name: value for name, value in before.items() if "/diagnosis/" in name}
    after = contents()
    assert {name: after.get(name) for name in diagnosis} == diagnosis
