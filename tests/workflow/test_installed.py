"""The package as users get it: the wheel in an environment of its own, and an empty folder."""

import json
import os
import re
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from dataclasses import dataclass
from email.parser import Parser
from pathlib import Path

import pytest
from golden import GOLDEN, checksums
from tiny import KERNELS, ROOT

BUILD = "import sys; from hatchling import build; print(build.{}(sys.argv[1]))"
"""What `python -m build` calls, without its environment, which would come from the network."""
WORKFLOW = {"Snakefile", "study.smk", "rules/imp.smk", "profiles/slurm/config.yaml"}


def built(what: str, source: Path, to: Path) -> Path:
    """Build a wheel or an sdist of a source, and return its file."""
    made = subprocess.run(
        [sys.executable, "-c", BUILD.format(f"build_{what}"), to],
        cwd=source,
        capture_output=True,
        text=True,
        check=True,
    )
    return to / made.stdout.strip()


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return built("wheel", ROOT, tmp_path_factory.mktemp("wheel"))


def names(wheel: Path) -> set[str]:
    with zipfile.ZipFile(wheel) as file:
        return set(file.namelist())


def test_wheel_has_the_files_of_the_package_and_no_others(wheel: Path) -> None:
    package = ROOT / "src"
    tracked = {
        path.relative_to(package).as_posix()
        for path in package.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert {f"pyrofit/workflow/{name}" for name in WORKFLOW} <= tracked
    assert {name for name in names(wheel) if ".dist-info/" not in name} == tracked


def test_metadata_of_the_wheel_are_complete(wheel: Path) -> None:
    (place,) = [name for name in names(wheel) if name.endswith("/METADATA")]
    with zipfile.ZipFile(wheel) as file:
        about = Parser().parsestr(file.read(place).decode())
    assert about["Name"] == "pyrofit"
    for key in ("Version", "Summary", "Requires-Python", "License-Expression", "Keywords"):
        assert about[key], key
    assert about["Description-Content-Type"] == "text/markdown"
    page = str(about.get_payload()).rstrip()
    assert page == (ROOT / "README.md").read_text(encoding="utf-8").rstrip()
    assert any(line.startswith("snakemake") for line in about.get_all("Requires-Dist"))


def test_sdist_builds_the_same_wheel(wheel: Path, tmp_path: Path) -> None:
    with tarfile.open(built("sdist", ROOT, tmp_path)) as file:
        file.extractall(tmp_path, filter="data")
    (source,) = [path for path in tmp_path.iterdir() if path.is_dir()]
    again = built("wheel", source, tmp_path)
    assert again.name == wheel.name
    assert names(again) == names(wheel)


@dataclass(frozen=True)
class Installed:
    """An environment with the wheel, and a folder that has nothing of the project."""

    programs: Path
    folder: Path

    def pyrofit(self, *arguments: str) -> str:
        """Run the command, and return what it said."""
        ran = subprocess.run(
            [self.programs / "pyrofit", *arguments],
            cwd=self.folder,
            # Nothing of this environment is on the way.
            env={"PATH": os.defpath, "HOME": str(self.folder), "TMPDIR": str(self.folder)},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )
        assert ran.returncode == 0, ran.stdout
        return ran.stdout


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Installed:
    """Install the wheel in a fresh environment, with the packages of this one."""
    root = tmp_path_factory.mktemp("installed")
    folder, environment = root / "empty", root / "environment"
    folder.mkdir()
    pip = [sys.executable, "-m", "pip", "--python", environment / "bin" / "python"]
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", environment], check=True)
    options = ["--quiet", "--no-deps", "--no-index", "--disable-pip-version-check"]
    subprocess.run([*pip, "install", *options, wheel], check=True)
    (site,) = environment.glob("lib/python*/site-packages")
    (site / "of_the_tests.pth").write_text(f"{sysconfig.get_path('purelib')}\n")
    # Compiled kernels are named by content.
    own = site / KERNELS.relative_to("src")
    own.mkdir(exist_ok=True)
    for path in (ROOT / KERNELS).glob("*"):
        if path.is_dir():
            (own / path.name).symlink_to(path.resolve())
    return Installed(environment / "bin", folder)


MOST_WORDS = 1600
"""Words of the report of smoke that a reader sees before opening anything."""


def visible_words(page: str) -> int:
    """Count the words of a page outside of what is folded, the lines to open it included."""
    text = re.sub(r"<(style|script)>.*?</\1>", "", page, flags=re.S)
    kept, depth = [], 0
    for piece in re.split(r"(<details[^>]*>|</details>)", text):
        depth += piece.startswith("<details") - (piece == "</details>")
        summary = re.match(r"\s*<summary>.*?</summary>", piece, re.S)
        if depth == 0:
            kept.append(piece)
        elif depth == 1 and summary:
            kept.append(summary[0])
    return len(re.sub(r"<[^>]*>", " ", "".join(kept)).split())


def test_smoke_runs_in_an_empty_folder(installed: Installed) -> None:
    given = installed.folder / "smoke.yaml"
    given.write_bytes((ROOT / "config" / "smoke.yaml").read_bytes())
    said = installed.pyrofit("run", "smoke.yaml")
    results = installed.folder / "results" / "smoke"
    assert "results/smoke/report.html" in said
    page = (results / "report.html").read_text(encoding="utf-8")
    assert visible_words(page) < MOST_WORDS
    assert (results / "report.html").is_file()
    known = json.loads((GOLDEN / "smoke.json").read_text(encoding="utf-8"))
    found = checksums(results)
    both = found.keys() & known.keys()
    assert len(both) > 50
    assert {place: found[place] for place in both} == {place: known[place] for place in both}
    assert "nothing to do" in installed.pyrofit("run", "smoke.yaml", "--dry-run")
    installed.pyrofit("run", "smoke.yaml", "archive")
    with zipfile.ZipFile(results / "smoke.zip") as file:
        assert "software/requirements.txt" in file.namelist()


def test_explorer_without_a_study_opens_the_twin(installed: Installed) -> None:
    installed.pyrofit("explore", "--static", "page.html", "--sliders", "dh")
    page = (installed.folder / "page.html").read_text(encoding="utf-8")
    assert '"name": "twin"' in page


def test_new_study_is_planned_and_targets_are_listed(installed: Installed) -> None:
    listed = installed.pyrofit("run", "--list")
    assert {"diagnose", "archive", "posterior"} <= {line.split()[0] for line in listed.splitlines()}
    installed.pyrofit("init", "mywood")
    planned = installed.pyrofit("run", "mywood/mywood.yaml", "diagnose", "--dry-run")
    assert "Which effect the model lacks" in planned
