"""Packages beside pyrofit add commands, steps and names by entry points."""

import importlib
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from pyrofit import discovery, plugins
from pyrofit.cli.command import whole_parser
from pyrofit.discovery import added, entries_beside, loaded
from pyrofit.errors import PyrofitError

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "pyrofit"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
OWN = PROJECT["entry-points"]
GROUPS = (
    "commands",
    "costs",
    "effects",
    "interface",
    "pages",
    "quantities",
    "reference",
    "rules",
    "steps",
)
OTHERS = """
[project]
name = "{name}"
[project.entry-points."pyrofit.commands"]
{line}
"""


@pytest.fixture(autouse=True)
def _asked_anew() -> Iterator[None]:
    entries_beside.cache_clear()
    yield
    entries_beside.cache_clear()


def test_groups_are_those_that_the_package_asks_for_and_the_page_explains() -> None:
    files = [p for p in SOURCE.rglob("*") if p.suffix in (".py", ".smk")]
    texts = [path.read_text(encoding="utf-8") for path in files]
    asked = {name for text in texts for name in re.findall(r"added\(\"(\w+)\"\)", text)}
    assert sorted({*asked, *plugins.CATALOGUES}) == sorted(GROUPS)
    page = (ROOT / "docs" / "adding.md").read_text(encoding="utf-8")
    assert [name for name in GROUPS if f"`pyrofit.{name}`" not in page] == []
    assert {group.removeprefix("pyrofit.") for group in OWN} < set(GROUPS)


@pytest.mark.parametrize("group", OWN)
def test_every_entry_of_the_project_is_found_and_can_be_imported(group: str) -> None:
    found, own = added(group.removeprefix("pyrofit.")), OWN[group]
    assert {name: found[name].value for name in own} == own
    for name in own:
        assert loaded(found[name]) is not None


def test_installation_of_a_clone_that_is_older_than_the_project_lacks_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(discovery, "_installed", list)
    assert set(added("commands")) == set(OWN["pyrofit.commands"])


def package(folder: Path, name: str) -> None:
    (folder / name).mkdir(parents=True)
    (folder / name / "__init__.py").write_text("")


def test_package_that_the_installation_does_not_know_is_an_error(tmp_path: Path) -> None:
    package(tmp_path, "pyrofit_wood")
    with pytest.raises(PyrofitError, match=r"pyrofit_wood: .* install pyrofit again"):
        entries_beside(tmp_path)


def test_project_of_another_name_is_not_read(tmp_path: Path) -> None:
    text = OTHERS.format(name="wood", line='wood = "wood:add"')
    (tmp_path / "pyproject.toml").write_text(text)
    assert "wood" not in entries_beside(tmp_path / "src").get("pyrofit.commands", {})
    (tmp_path / "pyproject.toml").write_text(text.replace('"wood"\n', '"pyrofit"\n', 1))
    entries_beside.cache_clear()
    assert entries_beside(tmp_path / "src")["pyrofit.commands"]["wood"].module == "wood"


def installed(folder: Path, name: str, *lines: str) -> None:
    """Write what an installer leaves of a package."""
    about = folder / f"{name}-1.0.dist-info"
    about.mkdir(parents=True)
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text("\n".join(lines) + "\n")


def test_two_packages_that_add_one_name_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("birch", "spruce"):
        installed(tmp_path, name, "[pyrofit.commands]", f"dry = {name}:add")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(PyrofitError, match=r"'dry' of pyrofit\.commands is both .*uninstall one"):
        entries_beside(SOURCE.parent)


def test_package_that_cannot_be_imported_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    installed(tmp_path, "birch", "[pyrofit.commands]", "dry = no_such_birch:add")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(PyrofitError, match="no_such_birch:add, which adds 'dry' to"):
        whole_parser()


STEP = """
from pyrofit.steps.base import Step

STEP = Step(place=75, words="count the rings of a stem", message="Rings of the stem")
"""
COMMANDS = """
def add(commands):
    parser = commands.add_parser("dry", help="dry a sample")
    parser.set_defaults(step=lambda given: print("dried"))
"""
SAID = """
import pyrofit as pf
from pyrofit.cli import main
from pyrofit.provenance import STUDY
from pyrofit.steps import known_steps
from pyrofit.running.targets import targets
main(["dry"])
step = known_steps()["rings"]
print(step.package, step.modules, targets()["rings"], "birch.rings.inputs" in STUDY, pf.bark)
"""


def test_installed_package_adds_a_command_a_step_and_a_name(tmp_path: Path) -> None:
    installed(
        tmp_path,
        "birch",
        *("[pyrofit.commands]", "dry = birch.commands:add"),
        *("[pyrofit.steps]", "rings = birch.rings:STEP"),
        *("[pyrofit.interface]", "bark = birch:BARK"),
    )
    package(tmp_path, "birch")
    package(tmp_path / "birch", "rings")
    (tmp_path / "birch" / "__init__.py").write_text("BARK = 'white'\n")
    (tmp_path / "birch" / "commands.py").write_text(COMMANDS)
    (tmp_path / "birch" / "rings" / "__init__.py").write_text(STEP)
    for name in ("inputs", "compute", "page"):
        (tmp_path / "birch" / "rings" / f"{name}.py").write_text("")
    code = f"import sys; sys.path.insert(0, {str(tmp_path)!r})\n{SAID}"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    modules = [f"birch.rings.{name}" for name in ("compute", "inputs", "page")]
    expected = f"birch.rings {modules} Count the rings of a stem. True white"
    assert run.stdout.splitlines() == ["dried", expected]


def test_names_of_other_packages_are_among_those_of_the_interface() -> None:
    pf = importlib.import_module("pyrofit")
    assert set(added("interface")) <= set(pf.__all__) == set(dir(pf))


CATALOGUE = """
from dataclasses import replace
from pyrofit.effects import edge_loss
from pyrofit.quantities import mlr

LOSS = replace(edge_loss.EFFECT, title="loss through bark")
RATE = replace(mlr.QUANTITY, title="rate of bark")


def worst(target, *, share: float = 1.0):
    return lambda model: share * abs(model - target.value)
"""
LISTED = """
from pyrofit.cost import known_costs
from pyrofit.effects import known_effects
from pyrofit.plugins import code_digest
from pyrofit.quantities import known_quantities
found = known_effects()["bark_loss"], known_quantities()["bark_rate"], known_costs()["WORST"]
digests = [code_digest(*one) for one in (("effects", "bark_loss"), ("costs", "WORST"))]
print(found[0].name, found[0].title, found[1].title, found[2].__name__, *digests)
"""


def listed(folder: Path, text: str, *lines: str) -> subprocess.CompletedProcess[str]:
    """Return the run of a session in which a package of this content is installed."""
    installed(folder, "birch", *lines)
    (folder / "birch.py").write_text(text)
    code = f"import sys; sys.path.insert(0, {str(folder)!r})\n{LISTED}"
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)


def test_installed_package_adds_an_effect_a_quantity_and_a_cost(tmp_path: Path) -> None:
    lines = (
        *("[pyrofit.effects]", "bark_loss = birch:LOSS"),
        *("[pyrofit.quantities]", "bark_rate = birch:RATE"),
        *("[pyrofit.costs]", "WORST = birch:worst"),
    )
    run = listed(tmp_path / "first", CATALOGUE, *lines)
    assert run.returncode == 0, run.stderr
    *names, first, second = run.stdout.split()
    assert " ".join(names) == "bark_loss loss through bark rate of bark worst"
    assert first == second != ""
    changed = listed(tmp_path / "second", CATALOGUE.replace("1.0", "2.0"), *lines)
    assert changed.stdout.split()[-1] != second  # so that results of the code before are stale


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("edge_loss = birch:LOSS", "'edge_loss' is among the effects of pyrofit already"),
        ("bark_loss = birch:RATE", "which adds 'bark_loss' to pyrofit.effects, is no Effect"),
    ],
)
def test_effect_of_another_package_that_breaks_a_rule_is_refused(
    line: str, said: str, tmp_path: Path
) -> None:
    run = listed(tmp_path, CATALOGUE, "[pyrofit.effects]", line)
    assert run.returncode == 1
    assert said in run.stderr
