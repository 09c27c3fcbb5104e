"""Fingerprints of the source change with an edit of all that a step depends on, and of no more."""

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import pytest

import pyrofit
from pyrofit import sources
from pyrofit.config import Study, digest, read_study
from pyrofit.effects import known_effects
from pyrofit.plugins import code_digest
from pyrofit.provenance import BY_USE, STUDY, imported_files, source_fingerprint
from pyrofit.results import dependencies
from pyrofit.results.step import slice_of
from pyrofit.sources import analysed

SOURCE = Path(pyrofit.__file__).parent
SMOKE = SOURCE.parents[1] / "config" / "smoke.yaml"
STEPS = {
    "data": "pyrofit.stages.measurements",
    "fits": "pyrofit.stages.fit",
    "prediction": "pyrofit.stages.predict",
    "robustness": "pyrofit.steps.robustness.compute",
    "diagnosis": "pyrofit.stages.diagnose",
    "figures": "pyrofit.show.subjects.validation.fig3",
    "report": "pyrofit.show.report",
    "blind test": "pyrofit_blind_test.run",
    "page of the blind test": "pyrofit_blind_test.page",
    "export for FDS": "pyrofit_exchange.fds.export",
}
EVERYTHING = set(STEPS)
EDITS = {
    "data/registry.txt": EVERYTHING,
    "quantities/mlr.py": EVERYTHING,
    "cost/__init__.py": EVERYTHING,
    "solver/kernels/heat.py": EVERYTHING,
    "estimate/sceua.py": {"fits", "prediction", "export for FDS"},
    "steps/robustness/compute.py": {"robustness"},
    "show/subjects/validation/validation.py": {"figures", "report"},
    "show/subjects/costs/spread.py": {"report"},
    "diagnose/search/score_test.py": {"diagnosis"},
    "show/style.py": {"figures", "report", "page of the blind test"},
    "show/html/report.html.j2": {"report"},
    "../pyrofit_blind_test/twin.py": {"blind test"},
    "../pyrofit_blind_test/rates.py": {"page of the blind test"},
    "../pyrofit_exchange/fds/orders.py": {"export for FDS"},
    "../pyrofit_exchange/fds_page.py": set(),
    "new_study/write.py": set(),
    "config/reference.py": set(),
    "effects/melting.py": set(),
}


EDITED = "EDITED = True\n"


def fingerprints() -> dict[str, str]:
    return {name: source_fingerprint(module) for name, module in STEPS.items()}


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A copy of the source, of which fingerprints are taken."""
    root = tmp_path_factory.mktemp("source") / "src" / "pyrofit"
    shutil.copytree(SOURCE.parent, root.parent, ignore=shutil.ignore_patterns("__pycache__"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("pyrofit.provenance.__file__", str(root / "provenance.py"))
        yield root


@pytest.fixture(scope="module")
def before(copy: Path) -> dict[str, str]:
    return fingerprints()


@pytest.mark.parametrize("edited", EDITS)
def test_edit_changes_the_fingerprints_of_what_depends_on_it(
    edited: str, copy: Path, before: dict[str, str]
) -> None:
    text = (copy / edited).read_text(encoding="utf-8")
    (copy / edited).write_text(f"{text}{EDITED}", encoding="utf-8")
    after = fingerprints()
    (copy / edited).write_text(text, encoding="utf-8")
    assert {name for name in before if before[name] != after[name]} == EDITS[edited]


def test_import_inside_a_function_or_for_type_checks_alone_counts(copy: Path) -> None:
    (copy / "stages" / "late.py").write_text("def f():\n    import pyrofit.logs\n")
    (copy / "stages" / "typed.py").write_text(
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from pyrofit import logs\n"
    )
    for name in ("late", "typed"):
        found = imported_files(copy, [f"pyrofit.stages.{name}"])
        assert {p.relative_to(copy).as_posix() for p in found} == {
            "__init__.py",
            "logs.py",
            "stages/__init__.py",
            f"stages/{name}.py",
        }


WRITTEN = '''"""A module."""

LIMIT = 3
"""Largest number."""


def twice(x: float) -> float:
    """Return twice a number."""
    # By addition.
    return x + x
'''
TEXT_EDITS = {
    "a comment": ("# By addition.", "# By a sum, which is exact."),
    "a comment more": ("LIMIT = 3", "LIMIT = 3  # by trial"),
    "the docstring of a function": ("Return twice a number", "Double a number"),
    "the docstring of a module": ("A module.", "Another text."),
    "the docstring of a constant": ("Largest number.", "Upper limit."),
    "an empty line": ("    # By", "\n    # By"),
}
CODE_EDITS = {
    "a number": ("LIMIT = 3", "LIMIT = 4"),
    "an operation": ("x + x", "x * x"),
    "a name": ("(x: float)", "(y: float)"),
    "a text that is used": ("LIMIT = 3", 'LIMIT = "3"'),
    "a type": ("-> float", "-> int"),
}


@pytest.mark.parametrize("place", ["data/cone_exports.py", "cost/__init__.py"])
@pytest.mark.parametrize("edit", [*TEXT_EDITS, *CODE_EDITS])
def test_edit_of_a_text_reruns_nothing_and_one_of_code_does(
    edit: str, place: str, copy: Path
) -> None:
    text = (copy / place).read_text(encoding="utf-8")
    found = []
    try:
        for written in (WRITTEN, WRITTEN.replace(*(TEXT_EDITS | CODE_EDITS)[edit])):
            (copy / place).write_text(f"{text}{written}", encoding="utf-8")
            found.append(source_fingerprint("pyrofit.stages.fit"))
    finally:
        (copy / place).write_text(text, encoding="utf-8")
    assert (found[0] != found[1]) == (edit in CODE_EDITS)


def test_digest_of_code_is_that_of_every_version_of_python() -> None:
    # Python 3.11.7, 3.12.1 and 3.13.0 gave it, whose trees differ in empty fields and texts.
    text = 'def f(x: int) -> str:\n    """Text."""\n    return f"{x:>{3}}"\n\n\n'
    text += "class A:\n    y = [None, 1e-3]\n"
    assert analysed(text.encode()).digest[:16] == "262adf04de99ddd7"


def test_file_with_an_error_counts_by_its_bytes() -> None:
    assert analysed(b"x = (  # one") != analysed(b"x = (  # two")


def test_kept_digests_are_those_of_the_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pyrofit.sources._places", lambda: [tmp_path / "kept.json"])
    content = b"import pyrofit.errors\nx = 1\n"
    for broken in ("", "{", "[]", '{"a": 1}'):
        (tmp_path / "kept.json").write_text(broken)
        kept = sources._Kept()
        assert kept.source("a", content) == analysed(content)
        kept.write()
        assert sources._Kept().source("a", b"not read") == analysed(content)
    assert [path.name for path in tmp_path.iterdir()] == ["kept.json"]


def test_folder_that_cannot_be_written_keeps_nothing_and_says_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setattr("pyrofit.sources._places", lambda: [tmp_path / "file" / "kept.json"])
    kept = sources._Kept()
    assert kept.source("a", b"x = 1") == analysed(b"x = 1")
    kept.write()


def test_fingerprint_of_a_module_that_is_not_there_is_refused() -> None:
    with pytest.raises(ValueError, match=r"there is no module pyrofit\.stages\.fitt"):
        source_fingerprint("pyrofit.stages.fitt")


@pytest.mark.parametrize(
    "module", ["pyrofit.stages.fit", "pyrofit.stages.diagnose", "pyrofit.show.report"]
)
def test_step_loads_no_file_that_its_fingerprint_leaves_out(module: str) -> None:
    code = (
        f"import sys, {module}; from pathlib import Path; from pyrofit.config import read_study;"
        f"read_study(Path({str(SMOKE)!r}));"
        "print(*(m.__file__ for n, m in sys.modules.items() if n.startswith('pyrofit')))"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = {Path(file) for file in said.stdout.split()}
    # What studies use of the catalogue of effects is counted by `dependencies`.
    by_use = {SOURCE / "effects" / f"{name}.py" for name in known_effects()}
    beside = {SOURCE / "effects" / "page.py"}
    # Options of a step are part of its own inputs.
    beside |= {p for n in ("__init__", "options") for p in SOURCE.glob(f"steps/*/{n}.py")}
    assert by_use <= loaded
    assert loaded - imported_files(SOURCE, [module]) <= by_use | beside


def digests(study: Study) -> dict[str, str]:
    cost = next(iter(study.imp.costs))
    parts = {
        "data": dependencies.data_slice(study),
        "kinetics": dependencies.kinetics(study),
        "imp": dependencies.imp(study, cost, "sceua"),
        "identify": dependencies.identify_slice(study),
        "validation": dependencies.validation_slice(study),
        "compare": dependencies.compare_slice(study),
        "robustness": slice_of(study, "robustness", cost),
        "presentation": dependencies.presentation(study),
        "diagnosis": dependencies.diagnose_slice(study),
    }
    return {name: digest(part) for name, part in parts.items()}


def test_new_effect_in_the_package_changes_the_digest_of_the_diagnosis_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = digests(read_study(SMOKE))
    text = (SOURCE / "effects" / "k_T.py").read_text(encoding="utf-8")
    (tmp_path / "k_T_again.py").write_text(text, encoding="utf-8")
    folders = [*import_module("pyrofit.effects").__path__, str(tmp_path)]
    monkeypatch.setattr(import_module("pyrofit.effects"), "__path__", folders)
    # Read before: a study without plugins knows no other folder.
    study = read_study_with_effects_as_they_are(monkeypatch)
    after = digests(study)
    assert {name for name in before if before[name] != after[name]} == {"diagnosis"}


def read_study_with_effects_as_they_are(monkeypatch: pytest.MonkeyPatch) -> Study:
    monkeypatch.setattr("pyrofit.config.read.use_plugins", lambda folders: None)
    return read_study(SMOKE)


def test_edited_effect_changes_the_digests_of_what_a_study_does_with_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def edited(name: str) -> set[str]:
        """Return the digests that change when the file of an effect is another."""
        study = read_study(SMOKE).model_copy(update={"with_effects": {"k_T": {}}})
        before = digests(study)
        with monkeypatch.context() as patch:
            for module in ("code_digests", "dependencies"):
                patch.setattr(
                    f"pyrofit.results.{module}.code_digest",
                    lambda kind, other: "edited" if other == name else known(kind, other),
                )
            after = digests(study)
        return {part for part in before if before[part] != after[part]}

    known = code_digest
    assert edited("c_T") == {"diagnosis"}
    assert edited("k_T") == set(digests(read_study(SMOKE)))


def test_every_module_of_steps_and_pages_counts_in_the_fingerprint_of_a_study() -> None:
    counted = imported_files(SOURCE, STUDY)
    there = {path for part in ("stages", "show") for path in (SOURCE / part).rglob("*.py")}
    # They time external programs before a study and print the end of a run: they make no result.
    assert there - counted == {SOURCE / "stages" / "trial.py", SOURCE / "show" / "headline.py"}


def test_sections_of_other_packages_count_in_the_fingerprint_of_a_study() -> None:
    assert SOURCE.parent / "pyrofit_exchange" / "fds_page.py" in imported_files(SOURCE, STUDY)


def test_packages_that_find_their_files_count_with_all_of_them() -> None:
    finding = {
        ".".join(("pyrofit", *path.parent.relative_to(SOURCE).parts)): path.parent
        for path in SOURCE.rglob("__init__.py")
        if "__path__" in path.read_text(encoding="utf-8")
    }
    assert set(BY_USE) < set(finding)
    for package, folder in finding.items():
        files = {*folder.glob("*.py"), *folder.glob("*/__init__.py")}
        assert (files <= imported_files(SOURCE, [package])) == (package not in BY_USE), package


def test_searches_do_not_rest_on_what_finds_and_reads_measured_files() -> None:
    """What it makes is their input: an edit of it reruns them only if a series changes."""
    found = {p.relative_to(SOURCE).as_posix() for p in imported_files(SOURCE, [STEPS["fits"]])}
    reading = {"stages/reading.py", "stages/measurements.py", "data/series.py", "data/fetch.py"}
    assert not reading & found
    assert reading <= {p.relative_to(SOURCE).as_posix() for p in SOURCE.rglob("*.py")}


def test_fingerprint_does_not_depend_on_the_order_of_sets() -> None:
    """Sets of names have another order in each process, unless it is seeded."""
    ask = "from pyrofit.provenance import source_fingerprint as f; print(f('pyrofit.stages.fit'))"
    found = {
        subprocess.run(
            [sys.executable, "-c", ask],
            env={**os.environ, "PYTHONHASHSEED": str(seed)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in range(6)
    }
    assert len(found) == 1
