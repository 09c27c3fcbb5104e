"""Commands, options, files and keys on the pages of the tutorials exist."""

import argparse
import contextlib
import io
import re
import shlex
from pathlib import Path
from typing import Any

import pytest
import yaml
from snakemake.cli import get_argument_parser

import pyrofit as pf
from pyrofit.cli import command
from pyrofit.config import read_mapping
from pyrofit.steps import known_steps

ROOT = Path(__file__).parents[2]
PAGES = ("tutorial", "tutorial_explore", "tutorial_diagnosis", "tutorial_fds", "tutorial_cluster")
BLOCK = re.compile(r"^```sh\n(.*?)^```$", re.M | re.S)
HEREDOC = re.compile(r"^cat >>? (\S+) <<'EOF'\n(.*?)^EOF$", re.M | re.S)
OWN = {"tutorial": "mypolymer/", "tutorial_explore": "twin_explored."}
"""Beginning of the names of files that the commands of a page make."""
FROM_FDS = {
    "components": {
        "polymer": {"density_kg_m3": "rho", "conductivity_W_mK": 0.2, "specific_heat_J_kgK": 2000}
    },
    "composition": {"polymer": 1.0},
}
"""Of the kind that the page has imported."""


def read(page: str) -> str:
    return (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")


def written(page: str) -> dict[str, str]:
    """Return the files that the commands of a page write, by name."""
    return dict(HEREDOC.findall(read(page)))


def commands(page: str, program: str) -> list[list[str]]:
    """Return the arguments of each call of a program."""
    text = HEREDOC.sub("", "\n".join(BLOCK.findall(read(page))))
    lines = re.sub(r"\\\n", " ", text).splitlines()
    return [shlex.split(line)[1:] for line in lines if line.startswith(f"{program} ")]


def parsed(parser: argparse.ArgumentParser, words: list[str]) -> argparse.Namespace:
    said = io.StringIO()
    try:
        with contextlib.redirect_stderr(said):
            return parser.parse_args(words)
    except SystemExit:
        pytest.fail(f"{shlex.join(words)}: {said.getvalue()}")


def targets() -> set[str]:
    """Return the names of the rules of the workflow."""
    files = [*(ROOT / "src/pyrofit/workflow").rglob("*.smk")]
    text = "\n".join(path.read_text(encoding="utf-8") for path in files)
    return {*re.findall(r"^ *rule (\w+):", text, re.M), *known_steps()}


def is_there(name: str, page: str) -> bool:
    """Return whether a file is in the project, or the page has made it."""
    own = OWN.get(page, "imported.yaml")
    return (ROOT / name).exists() or name in written(page) or name.startswith(("results/", own))


@pytest.mark.parametrize("page", PAGES)
def test_commands_of_pyrofit_and_their_options_exist(page: str) -> None:
    found = commands(page, "pyrofit")
    assert len(found) >= 1 or page == "tutorial_diagnosis"
    for words in found:
        given = vars(parsed(command.whole_parser(), words))
        for key in ("study", "profile"):
            if given.get(key):
                assert is_there(str(given[key]), page), shlex.join(words)


@pytest.mark.parametrize("page", PAGES)
def test_calls_of_snakemake_name_files_rules_and_options_that_exist(page: str) -> None:
    found = commands(page, "snakemake")
    assert len(found) >= 1 or page == "tutorial_explore"
    for words in found:
        given = parsed(get_argument_parser(), words)
        for path in given.configfile:
            assert is_there(str(path), page), shlex.join(words)
        assert set(given.targets) <= targets(), shlex.join(words)
        if given.workflow_profile is not None:
            assert (ROOT / given.workflow_profile / "config.yaml").is_file()


def test_wrong_command_line_is_found() -> None:
    with pytest.raises(pytest.fail.Exception, match="unrecognized arguments: --sett"):
        parsed(command.whole_parser(), ["export", "fds", "config/smoke.yaml", "--sett", "truth"])
    # A target after --configfile would be read as one more file.
    given = parsed(get_argument_parser(), ["--configfile", "config/smoke.yaml", "archive"])
    assert not all(is_there(str(path), "tutorial_cluster") for path in given.configfile)


def test_keys_of_the_studies_with_a_hidden_effect_are_valid() -> None:
    keys: dict[str, Any] = read_mapping(ROOT / "config" / "smoke.yaml")
    files = written("tutorial_diagnosis")
    for name in ("hidden.yaml", "thick.yaml"):
        study = pf.read_study(keys, **yaml.safe_load(files["hidden.yaml"]))
        if name == "thick.yaml":
            study = pf.read_study(study, **yaml.safe_load(files[name]))
        assert study.synthetic is not None
        assert set(study.synthetic.effects) == {"k_T"}
        assert study.name == ("hidden" if name == "hidden.yaml" else "hidden_thick")


def test_keys_of_the_study_of_an_fds_material_are_valid() -> None:
    keys = yaml.safe_load(written("tutorial_fds")["imported.yaml"])
    study = pf.read_study({"material": FROM_FDS, **keys})
    assert list(study.imp.estimate) == ["rho"]


def test_profile_has_the_keys_that_the_page_shows() -> None:
    (shown,) = re.findall(r"^```yaml\n(.*?)^```$", read("tutorial_cluster"), re.M | re.S)
    told = yaml.safe_load(shown)
    text = (ROOT / "profiles" / "slurm" / "config.yaml").read_text(encoding="utf-8")
    profile = yaml.safe_load(text)
    assert {key: profile[key] for key in told} == told
