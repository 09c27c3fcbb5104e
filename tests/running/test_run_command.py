"""The command `pyrofit run`, before it starts Snakemake."""

import re
import subprocess
import sys
from argparse import Namespace
from pathlib import Path
from typing import Any

import pytest
import yaml

from pyrofit import cli
from pyrofit.cli import running
from pyrofit.running.targets import WORKFLOW, targets

ROOT = Path(__file__).parents[2]
SMOKE = ROOT / "config" / "smoke.yaml"
CHANGE = "change the values marked CHANGE, and run again"


def test_targets_of_the_page_are_those_that_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    page = (ROOT / "docs" / "running.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (`\w+`(?:, `\w+`)*) \|", page, re.M)
    told = {name for row in rows for name in re.findall(r"\w+", row)}
    assert told == set(targets()) - {"report"}
    assert cli.main(["run", "--list"]) == 0
    listed = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in listed] == sorted(targets())


def given(**options: Any) -> Namespace:
    usual = {"study": SMOKE, "target": [], "cores": None, "profile": None, "dry_run": False}
    return Namespace(**usual | {"snakemake": []} | options)


def test_cores_are_two_unless_given_and_those_of_a_profile_there() -> None:
    def cores(**options: Any) -> str:
        words = running._arguments(given(**options))
        return words[words.index("--cores") + 1] if "--cores" in words else ""

    slurm = str(WORKFLOW / "profiles" / "slurm")
    assert (cores(), cores(cores=5)) == ("2", "5")
    assert (cores(profile=slurm), cores(profile=slurm, cores=5)) == ("", "5")


def test_targets_and_options_of_snakemake_reach_it() -> None:
    words = running._arguments(given(target=["diagnose"], snakemake=["--forceall"], dry_run=True))
    assert words[-4:] == ["--dry-run", "--forceall", "--", "diagnose"]


def test_shipped_profile_is_written_for_the_user_to_change(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert cli.main(["run", str(SMOKE), "--profile", "slurm"]) == 2
    assert f"error: profiles/slurm/config.yaml: written; {CHANGE}" in capsys.readouterr().err
    written = tmp_path / "profiles" / "slurm" / "config.yaml"
    assert "# CHANGE" in written.read_text(encoding="utf-8")
    assert yaml.safe_load(written.read_text(encoding="utf-8"))["executor"] == "slurm"
    written.write_text("executor: mine\n")
    for name in ("slurm", "profiles/slurm"):
        words = running._arguments(given(profile=name))
        assert words[words.index("--workflow-profile") + 1] == "profiles/slurm"
    assert written.read_text() == "executor: mine\n"


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ([], "no study is given: pyrofit run STUDY; `pyrofit init NAME` writes one"),
        (["none.yaml"], "none.yaml: there is no such study file"),
        ([str(SMOKE), "--profile", "mine"], "mine/config.yaml: there is no such profile; name a"),
    ],
)
def test_what_is_not_there_is_told_with_the_way_out(
    words: list[str],
    says: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert cli.main(["run", *words]) == 2
    assert says in capsys.readouterr().err


def refused(words: list[str]) -> tuple[int, str]:
    """Return exit code and line of a process that checks the studies given to Snakemake."""
    code = f"from pyrofit.running.given import check_files; check_files({words!r})"
    ended = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False
    )
    return ended.returncode, ended.stderr


BAD = {
    "name: x\nvalue: !!python/object/apply:os.system [id]\n": "s.yaml: not valid yaml, line 2: ",
    "__use_yte__: true\n": "s.yaml: __use_yte__: it lets Snakemake run programs",
}


@pytest.mark.parametrize(("text", "says"), BAD.items())
def test_a_study_that_snakemake_cannot_take_is_named(text: str, says: str, tmp_path: Path) -> None:
    study = tmp_path / "s.yaml"
    study.write_text(text, encoding="utf-8")
    code, line = refused(["snakemake", "--cores", "1", "--configfile", str(study), "-n"])
    assert (code, says in line) == (2, True)
    assert cli.main(["run", str(study)]) == 2


def test_a_study_that_is_not_there_is_named_with_the_nearest(tmp_path: Path) -> None:
    (tmp_path / "mywood.yaml").write_text("name: x\n", encoding="utf-8")
    code, line = refused([f"--configfile={tmp_path / 'mywod.yaml'}"])
    assert code == 2
    assert "there is no such study file. Did you mean 'mywood.yaml'?" in line


def test_a_study_in_a_folder_below_is_named_and_a_hidden_file_is_not(tmp_path: Path) -> None:
    (tmp_path / "config").mkdir()
    (tmp_path / "config" / "pine.yaml").write_text("name: x\n", encoding="utf-8")
    (tmp_path / ".hidden.yml").write_text("a: b\n", encoding="utf-8")
    code, line = refused([f"--configfile={tmp_path / 'pine.yml'}"])
    assert code == 2
    assert "Did you mean 'config/pine.yaml'? Known: config/pine.yaml." in line


def test_the_default_profile_checks_the_studies_that_snakemake_is_given() -> None:
    text = (ROOT / "profiles" / "default" / "config.yaml").read_text(encoding="utf-8")
    assert "check_files(sys.argv)" in text
