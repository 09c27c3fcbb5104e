"""Options of the steps that run apart: written once, and part of what a result depends on.

A result made by hand replaces that of the workflow. It says which options it was made with.
"""

from argparse import ArgumentParser
from collections.abc import Callable
from inspect import signature
from pathlib import Path
from typing import Any

import pytest

from pyrofit.cli import main, planning
from pyrofit.config import digest, read_study
from pyrofit.results import worth
from pyrofit.stages.worth import worth_of_tests

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"
OTHER: dict[str, tuple[Any, Callable[..., Any], list[str], tuple[Any, ...]]] = {
    "worth": (planning, worth.slice_of, ["--draws", "0"], (0,)),
}


def defaults(command: str) -> dict[str, Any]:
    """Return what a command takes for the options that are not given."""
    parser = ArgumentParser()
    OTHER[command][0].add(parser.add_subparsers(dest="command"))
    return vars(parser.parse_args([command, str(SMOKE)]))


@pytest.mark.parametrize(
    ("command", "step", "names"),
    [
        ("worth", worth_of_tests, {"draws": "draws", "apparatus": "apparatus"}),
    ],
)
def test_command_and_step_have_the_same_options_unless_told_otherwise(
    command: str, step: Callable[..., Any], names: dict[str, str]
) -> None:
    given, of_step = defaults(command), signature(step).parameters
    assert {n: given[n] for n in names} == {n: of_step[p].default for n, p in names.items()}


@pytest.mark.parametrize("command", OTHER)
def test_options_are_part_of_what_a_step_depends_on(command: str) -> None:
    _, slice_of, _, options = OTHER[command]
    study = read_study(SMOKE)
    assert digest(slice_of(study, *options)) != digest(slice_of(study))


@pytest.mark.parametrize("command", OTHER)
def test_other_options_than_those_of_the_workflow_are_refused_in_its_name(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _, slice_of, given, _ = OTHER[command]
    planned = digest(slice_of(read_study(SMOKE)))
    results = ["--results", str(tmp_path / "smoke")]
    assert main([command, str(SMOKE), "--digest", planned, *results, *given]) == 2
    assert f"'{command}' depends on the change" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("record", "options"),
    [
        (worth.Worth, {"draws", "apparatus"}),
    ],
)
def test_result_says_its_options(record: Any, options: set[str]) -> None:
    assert options <= set(record.model_fields)
