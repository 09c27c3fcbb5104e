"""The recipe of the container, which is built nowhere here, follows the Makefile."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
VENV = ".venv"


def steps() -> list[tuple[str, str]]:
    """Return instruction and arguments of each step, lines joined."""
    text = (ROOT / "Dockerfile").read_text(encoding="utf-8").replace("\\\n", " ")
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    pairs = [line.partition(" ")[::2] for line in lines]
    return [(name, " ".join(rest.split())) for name, rest in pairs]


def copied_before(step: tuple[str, str]) -> set[str]:
    ahead = steps()[: steps().index(step)]
    return {name for what, rest in ahead if what == "COPY" for name in rest.split()[:-1]}


def install() -> tuple[str, str]:
    (found,) = [step for step in steps() if step[0] == "RUN" and "make " in f"{step[1]} "[:5]]
    return found


def test_instructions_are_known_and_in_order() -> None:
    names = [name for name, _ in steps()]
    assert set(names) <= {"FROM", "RUN", "WORKDIR", "COPY", "ENV", "CMD"}
    assert (names[0], names[-1], names.count("FROM"), names.count("CMD")) == ("FROM", "CMD", 1, 1)
    assert names.index("WORKDIR") < names.index("COPY")


def test_environment_is_made_by_the_target_of_the_makefile() -> None:
    target = install()[1].removeprefix("make ")
    assert re.search(r"^VENV := (.*)$", MAKEFILE, re.M)[1] == VENV  # type: ignore[index]
    assert target == f"{VENV}/installed"
    assert re.search(r"^\$\(VENV\)/installed:", MAKEFILE, re.M)
    # No package is installed beside it.
    assert not [rest for name, rest in steps() if name == "RUN" and re.search(r"\bpip3?\b", rest)]


def test_all_that_the_target_needs_is_copied_before() -> None:
    needed = set(re.search(r"^\$\(VENV\)/installed:(.*)$", MAKEFILE, re.M)[1].split())  # type: ignore[index]
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    readme = re.search(r'^readme = "(.+)"', project, re.M)
    assert readme is not None
    assert {*needed, readme[1], "Makefile", "LICENSE", "src"} <= copied_before(install())


def test_all_that_is_copied_is_there_and_the_workflow_among_it() -> None:
    copied = copied_before(steps()[-1])
    assert [name for name in sorted(copied) if not (ROOT / name).exists()] == []
    assert {"Snakefile", "workflow", "profiles", "config"} <= copied
    assert not copied & {"results", ".", ".git", VENV}


def test_programs_are_found_and_python_is_new_enough() -> None:
    places = dict(steps())
    assert places["ENV"].startswith(f"PATH={places['WORKDIR']}/{VENV}/bin:")
    major, minor = re.match(r"python:(\d+)\.(\d+)", places["FROM"]).groups()  # type: ignore[union-attr]
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    least = re.search(r'requires-python = ">=(\d+)\.(\d+)"', project)
    assert least is not None
    assert (int(major), int(minor)) >= (int(least[1]), int(least[2]))


@pytest.mark.parametrize("name", ["docs/cluster.md", "docs/doctor.md"])
def test_commands_of_the_pages_name_profiles_that_are_there(name: str) -> None:
    text = (ROOT / name).read_text(encoding="utf-8")
    named = re.findall(r"--(?:workflow-)?profile (\S+?)[\s`)]", text)
    assert named
    for profile in named:
        assert (ROOT / profile / "config.yaml").is_file(), profile
