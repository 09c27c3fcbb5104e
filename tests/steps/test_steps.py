"""Steps that a study may go without: complete, found by themselves, with options written once."""

import contextlib
import json
import re
from pathlib import Path
from typing import Any

import pytest

from pyrofit.cli import main
from pyrofit.cli.command import whole_parser
from pyrofit.cli.page import commands_page
from pyrofit.config import Study, as_study, digest, read_study
from pyrofit.config.reference import reference_page
from pyrofit.errors import DataError
from pyrofit.provenance import STUDY as MODULES
from pyrofit.provenance import imported_files
from pyrofit.results.files import Results
from pyrofit.results.step import check_options, inputs_of, slice_of, write_options
from pyrofit.running.targets import targets
from pyrofit.show.page import Page
from pyrofit.steps import known_steps

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "pyrofit"
SMOKE = ROOT / "config" / "smoke.yaml"
STEPS = list(known_steps())
WITH_OPTIONS = [name for name, step in known_steps().items() if step.options is not None]
OTHER: dict[str, dict[str, Any]] = {
    "rescore": {"sets": 60, "costs": ["RMSE"]},
    "posterior": {"sets": 7},
    "sensitivity": {"samples": 8},
    "worth": {"draws": 0},
    "robustness": {"starts": 5},
    "stability": {"draws": 3},
    "ignition": {"emissivity": 0.8},
}
"""Options other than those of smoke."""


def smoke(**options: Any) -> Study:
    """Return the study smoke with options of steps."""
    given = read_study(SMOKE).model_dump(mode="json", exclude_defaults=True)
    return as_study({**given, "steps": options}, "smoke.json")


def given(step: str) -> list[str]:
    """Return the other options of a step as arguments of its command."""
    arguments: list[str] = []
    for name, value in OTHER[step].items():
        values = value if isinstance(value, list) else [value]
        arguments += [f"--{name.replace('_', '-')}", *map(str, values)]
    return arguments


def test_folders_are_steps_and_steps_are_folders() -> None:
    folders = {path.parent.name for path in (ROOT / "src/pyrofit/steps").glob("*/__init__.py")}
    assert set(STEPS) == folders
    assert len({step.place for step in known_steps().values()}) == len(STEPS)


@pytest.mark.parametrize("name", STEPS)
def test_step_has_all_that_workflow_command_and_report_ask_for(name: str) -> None:
    step, inputs = known_steps()[name], inputs_of(name)
    page = step.load("page").PAGE
    assert isinstance(page, Page)
    assert page.folders == (page.name, page.name) == (name, name)
    assert callable(step.load("compute").run)
    made = {f"{figure}.{kind}" for figure in page.figures for kind in ("svg", "png")}
    made |= {f"{page.prefix}{table}.{kind}" for table in page.tables for kind in ("csv", "md")}
    # Snakemake deletes them before a step, and the report waits for the last.
    assert {file for file in inputs.files if Path(file).suffix in (".svg", ".png", ".md")} <= made
    assert bool(step.part) == bool(inputs.parts(smoke())) == bool(inputs.part_file)
    assert step.page in ("report", "diagnosis", "")
    assert hasattr(step.load("compute"), "write") == bool(step.write)


@pytest.mark.parametrize("name", STEPS)
def test_step_counts_in_the_fingerprint_of_a_study(name: str) -> None:
    folder = ROOT / "src/pyrofit/steps" / name
    assert set(folder.glob("*.py")) <= imported_files(ROOT / "src/pyrofit", MODULES)


@pytest.mark.parametrize("name", STEPS)
def test_step_is_a_target_and_stands_on_the_page_of_commands(name: str) -> None:
    assert name in targets()
    assert f"## `pyrofit {name}`\n" in commands_page(whole_parser())


@pytest.mark.parametrize("name", STEPS)
def test_step_reads_what_the_workflow_knows(name: str) -> None:
    rules = (SOURCE / "workflow/rules/steps.smk").read_text(encoding="utf-8")
    known = set(re.findall(r'^    "(\w+)": ', rules, re.MULTILINE))
    inputs = inputs_of(name)
    assert {*inputs.reads, *inputs.gathers} <= known


@pytest.mark.parametrize("name", STEPS)
def test_no_list_names_a_step(name: str) -> None:
    lists = ("workflow/study.smk", "cli/command.py", "cli/stepping.py", "provenance.py")
    for file in (*lists, "show/report.py", "results/files.py", "config/keys/steps.py"):
        text = (SOURCE / file).read_text(encoding="utf-8")
        assert not re.search(rf"\b{name}\b", text), file
    assert not (SOURCE / f"workflow/rules/{name}.smk").exists()


@pytest.mark.parametrize("name", STEPS)
def test_step_is_a_command_with_its_options(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        whole_parser().parse_args([name, "--help"])
    said = capsys.readouterr().out
    options = known_steps()[name].options
    for option in [] if options is None else options.model_fields:
        assert f"--{option.replace('_', '-')} " in said
    assert ("--write FILE" in said) == bool(known_steps()[name].write)


@pytest.mark.parametrize("name", WITH_OPTIONS)
def test_options_are_keys_of_a_study_with_their_meaning_on_the_reference_page(name: str) -> None:
    page = reference_page()
    for option, field in known_steps()[name].options.model_fields.items():
        words = re.sub(r" \[.*\]$", "", field.description)  # units have a place of their own
        assert re.search(rf"^- `{option}`: {re.escape(words)}\.", page, re.MULTILINE)
    study = smoke(**{name: OTHER[name]})
    for option, value in OTHER[name].items():
        kept = dict(study.steps)[name].model_dump(mode="json")[option]
        assert kept == value != dict(smoke().steps)[name].model_dump(mode="json")[option]


@pytest.mark.parametrize("name", WITH_OPTIONS)
def test_options_are_part_of_what_a_step_depends_on(name: str) -> None:
    for part in ([], *([part] for part in inputs_of(name).parts(smoke())[:1])):
        if not part and known_steps()[name].part:
            continue
        of_study = slice_of(smoke(), name, *part)
        other = slice_of(smoke(**{name: OTHER[name]}), name, *part)
        parts_only = part and set(OTHER[name]) <= {*inputs_of(name).of_parts}
        assert (digest(other) == digest(of_study)) == bool(parts_only)


@pytest.mark.parametrize("name", WITH_OPTIONS)
def test_results_made_with_other_options_are_refused(name: str, tmp_path: Path) -> None:
    results = Results(tmp_path)
    study, other = smoke(), smoke(**{name: OTHER[name]})
    for part in [[part] for part in inputs_of(name).parts(study)] or [[]]:
        write_options(study, results, name, *part)
    check_options(study, results, name)
    if {*OTHER[name]} <= {*inputs_of(name).of_parts}:
        return
    with pytest.raises(DataError, match=rf"options.*other options.*snakemake {name}"):
        check_options(other, results, name)


@pytest.mark.parametrize("name", WITH_OPTIONS)
def test_wrong_option_names_it_and_the_rule(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    option = next(iter(OTHER[name]))
    command = [name, str(SMOKE), "--results", str(tmp_path), f"--{option}", "x y"]
    with contextlib.suppress(SystemExit):  # of the parser, which lists the words it knows
        assert main(command) == 2
    assert f"--{option}: 'x y'" in capsys.readouterr().err


def test_results_by_hand_with_other_options_stand_apart(tmp_path: Path) -> None:
    results = Results(tmp_path, by_hand="worth")
    assert results.of_step("worth", "a.csv") == tmp_path / "by_hand" / "worth" / "a.csv"
    assert results.of_step("posterior", "a.csv") == tmp_path / "posterior" / "a.csv"
    assert results.measurement("slab", "mlr").is_relative_to(tmp_path / "measurements")


def test_unknown_option_in_a_study_names_the_nearest(tmp_path: Path) -> None:
    path = tmp_path / "study.json"
    described = read_study(SMOKE).model_dump(mode="json", exclude_defaults=True)
    path.write_text(json.dumps({**described, "steps": {"stability": {"drawz": 3}}}))
    with pytest.raises(Exception, match=r"unknown key 'drawz'\. Did you mean 'draws'"):
        read_study(path)
