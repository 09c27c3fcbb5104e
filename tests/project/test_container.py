"""The recipe of the container, which is built nowhere here, follows the Makefile."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
PROJECT = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
VENV = ".venv"


def groups_in(pattern: str, text: str) -> tuple[str, ...]:
    """Return the groups of a pattern, which the text must have."""
    found = re.search(pattern, text, re.M)
    assert found is not None, pattern
    return found.groups()


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
    assert groups_in(r"^VENV := (.*)$", MAKEFILE) == (VENV,)
    assert target == f"{VENV}/installed"
    assert re.search(r"^\$\(VENV\)/installed:", MAKEFILE, re.M)
    # No package is installed beside it.
    assert not [rest for name, rest in steps() if name == "RUN" and re.search(r"\bpip3?\b", rest)]


def test_all_that_the_target_needs_is_copied_before() -> None:
    (needed,) = groups_in(r"^\$\(VENV\)/installed:(.*)$", MAKEFILE)
    (readme,) = groups_in(r'^readme = "(.+)"', PROJECT)
    assert {*needed.split(), readme, "Makefile", "LICENSE", "src"} <= copied_before(install())


def test_all_that_is_copied_is_there_and_the_workflow_among_it() -> None:
    copied = copied_before(steps()[-1])
    assert [name for name in sorted(copied) if not (ROOT / name).exists()] == []
    assert {"Snakefile", "workflow", "profiles", "config"} <= copied
    assert not copied & {"results", ".", ".git", VENV}


def test_programs_are_found_and_python_is_new_enough() -> None:
    places = dict(steps())
    assert places["ENV"].startswith(f"PATH={places['WORKDIR']}/{VENV}/bin:")
    taken = groups_in(r"^python:(\d+)\.(\d+)", places["FROM"])
    least = groups_in(r'requires-python = ">=(\d+)\.(\d+)"', PROJECT)
    assert tuple(map(int, taken)) >= tuple(map(int, least))


@pytest.mark.parametrize("name", ["docs/cluster.md", "docs/doctor.md"])
def test_commands_of_the_pages_name_profiles_that_are_there(name: str) -> None:
    text = (ROOT / name).read_text(encoding="utf-8")
    named = re.findall(r"--(?:workflow-)?profile (\S+?)[\s`)]", text)
    assert named
    for profile in named:
        assert (ROOT / profile / "config.yaml").is_file(), profile
