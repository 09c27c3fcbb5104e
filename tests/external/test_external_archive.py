"""An archive has what a campaign needs to be run again elsewhere, but for the program itself."""

import json
import shutil
import zipfile
from pathlib import Path
from typing import Any

import pytest
import yaml
from decay import study, write

from pyrofit.archive import write_archive
from pyrofit.config import Study, digest, read_study
from pyrofit.config.expand.programs import externals, keeping_runs
from pyrofit.external.runs import outcomes
from pyrofit.provenance import STUDY, source_fingerprint
from pyrofit.quantities import known_quantities
from pyrofit.results.code_digests import code
from pyrofit.results.files import Results

ROOT = Path(__file__).parents[2]
SETS = [{"height": 12.0, "fall": 0.03}, {"height": 7.123456789, "fall": 0.0456}]


def described(folder: Path, **program: Any) -> Study:
    """Write study, template and program into a folder; return the study."""
    write(folder)
    (folder / "study.yaml").write_text(yaml.safe_dump(study(**program)))
    return read_study(folder / "study.yaml")


def unpacked(found: Study, folder: Path) -> Path:
    """Archive a study as if it had been run; return the folder with what the archive holds."""
    results = Results(folder / "results")
    results.root.mkdir(parents=True)
    origin = {
        "config_digest": digest(found.model_dump(mode="json")),
        "source_fingerprint": source_fingerprint(*STUDY),
        "code": code(found),
        "macfp_commit": "",
        "data": {},
    }
    (results.root / "provenance.json").write_text(json.dumps(origin))
    with zipfile.ZipFile(write_archive(found, results, [], ROOT)) as archive:
        archive.extractall(folder / "elsewhere")
    return folder / "elsewhere"


def rates(found: Study, store: Path) -> list[bytes]:
    """Return the bytes of the curves that the program makes."""
    program = externals(keeping_runs(found, store))["plate"].program
    quantities = {"mlr": known_quantities()["mlr"]}
    made = outcomes(program, quantities, {"mlr": 98.0}, SETS)
    assert [run.why for run in made] == ["", ""]
    return [part.tobytes() for run in made for part in run.records["mlr"]]


def test_the_program_makes_the_same_bits_where_the_archive_is_unpacked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYROFIT_SCRATCH", str(tmp_path / "scratch"))
    mine = tmp_path / "my study"
    found = described(mine)
    before = rates(found, tmp_path / "first")
    there = unpacked(found, tmp_path)
    shutil.rmtree(mine)
    monkeypatch.chdir(there)
    again = read_study(there / "study.yaml")
    for path in externals(again)["plate"].program.own_files:
        assert Path(path).resolve().is_relative_to(there.resolve())
    assert rates(again, tmp_path / "second") == before


def test_files_of_one_name_keep_the_name_by_which_the_program_finds_them(tmp_path: Path) -> None:
    for n, text in enumerate(("first", "second")):
        (tmp_path / "my study" / str(n)).mkdir(parents=True)
        (tmp_path / "my study" / str(n) / "constants.txt").write_text(text)
    keys = study()
    plate = keys["experiments"]["plate"]
    other = json.loads(json.dumps(plate))
    plate["program"]["files"] = ["decay.py", "0/constants.txt"]
    other["program"]["files"] = ["decay.py", "1/constants.txt"]
    keys["experiments"]["other"] = other
    mine = tmp_path / "my study"
    write(mine)
    (mine / "study.yaml").write_text(yaml.safe_dump(keys))
    there = unpacked(read_study(mine / "study.yaml"), tmp_path)
    again = externals(read_study(there / "study.yaml"))
    held = [Path(again[name].program.own_files[-1]) for name in ("plate", "other")]
    assert [path.name for path in held] == ["constants.txt"] * 2
    assert [path.read_text() for path in held] == ["first", "second"]
