"""What holds for the source as a whole."""

import ast
import re
import subprocess
import sys
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from pyrofit.experiments import KINDS, OF_FILES
from pyrofit.quantities import known_quantities

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "pyrofit"
ORDER = [
    {
        "errors",
        "compiled",
        "constants",
        "numerics",
        "discovery",
        "logs",
        "parallel",
        "provenance",
        "seeds",
        "sources",
        "steps",
    },
    {"quantities"},
    {"data"},
    {"model"},
    {"options of steps"},
    {"effects"},
    {"solver"},
    {"simulate"},
    {"external"},
    {"experiments"},
    {"cost"},
    {"plugins"},
    {"config"},
    {"results"},
    {"results of steps"},
    {"running"},
    {"estimate"},
    {"diagnose", "scheme"},
    {"analysis"},
    {"stages"},
    {"new_study"},
    {"doctor"},
    {"show"},
    {"work of steps"},
    {"api"},
    {
        "archive",
        "archive_crate",
        "archive_software",
        "archive_texts",
        "archive_zip",
    },
    {"cli"},
    {"__main__"},
    {"pyrofit_exchange", "pyrofit_files", "pyrofit_blind_test"},
    {"pyrofit_compare"},
    {"pyrofit_explore"},
]
RANK = {part: rank for rank, parts in enumerate(ORDER) for part in parts}
DISPATCHED = {
    *("arccos", "arccosh", "arcsin", "arcsinh", "arctan", "arctan2", "arctanh", "cbrt", "cos"),
    *("cosh", "exp", "exp2", "expm1", "float_power", "geomspace", "log", "log10", "log1p", "log2"),
    *("logaddexp", "logaddexp2", "logspace", "power", "sin", "sinh", "tan", "tanh"),
    *("convolve", "corrcoef", "correlate", "cov", "dot", "inner", "kron", "linalg", "matmul"),
    *("matvec", "polyfit", "tensordot", "vdot", "vecdot", "vecmat"),
}
"""Names of NumPy whose last bits depend on the processor; `pyrofit.numerics` has others."""
BY_LAPACK = ("integrate", "linalg", "odr", "signal", "sparse", "spatial")
BY_LAPACK_OF_OPTIMIZE = {"curve_fit", "least_squares", "lsq_linear", "minimize", "nnls", "root"}
NUMBERS_TO_A_POWER = {
    "config/yaml_file.py": "bytes",
    "estimate/scan.py": "a length",
    "estimate/bounded_least_squares.py": "a number's damping",
    "estimate/cmaes.py": "numbers of the strategy",
    "estimate/sceua.py": "an integer",
    "pyrofit_exchange/fds/exposure.py": "numbers of a face",
    "pyrofit_exchange/fds/matl_line.py": "a number's rate",
    "pyrofit_exchange/fds/orders.py": "a number's half time",
    "pyrofit_exchange/macfp/curves.py": "a number's temperature",
    "pyrofit_exchange/thermakin/conditions.py": "numbers of the surroundings",
    "seeds.py": "an integer",
    "show/subjects/optimisation/fig5.py": "the margin of an axis",
    "solver/reference/bdf.py": "numbers of a step",
}
"""Files with powers other than 2 of numbers; those of arrays are NumPy's."""
NOT_FOR_COST = {"model", "solver", "simulate", "data"}


@cache
def modules() -> list[Path]:
    return sorted(p for p in SOURCE.parent.rglob("*.py") if p != SOURCE / "__init__.py")


OF_STEPS = {
    "__init__": "steps",
    "options": "options of steps",
    "record": "results of steps",
    "inputs": "results of steps",
}
"""Files of a step that others may use."""


def part_of(path: Path) -> str:
    return part_named(path.relative_to(SOURCE.parent).with_suffix("").parts)


def part_named(names: tuple[str, ...]) -> str:
    """Return the part of the package in which a module stands, from the parts of its name."""
    if names[0] != "pyrofit":
        return names[0]
    _, part, *inside = names
    of_a_step = part == "steps" and len(inside) > 1 and (SOURCE / "steps" / inside[0]).is_dir()
    return part if not of_a_step else OF_STEPS.get(inside[1], "work of steps")


@cache
def parsed(path: Path) -> list[ast.AST]:
    """Return all nodes of the syntax tree of a file."""
    return list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))


@cache
def imported(path: Path) -> set[str]:
    """Return the full names of all modules that a file imports, anywhere in it."""
    names = set()
    for node in parsed(path):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: imports relative to itself"
            assert node.module is not None
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
    return names


def own(path: Path) -> set[str]:
    """Return the parts of the package, and the packages beside it, that a file imports."""
    names = [n for n in imported(path) if n.startswith(("pyrofit.", "pyrofit_"))]
    return {part_named(tuple(name.split("."))) for name in names}


def outside(path: Path) -> set[str]:
    return {name.split(".")[0] for name in imported(path)}


def names_of(paths: list[Path]) -> list[str]:
    return [name_of(p) for p in paths]


def name_of(path: Path) -> str:
    """Return the place of a file in pyrofit, or in the folder of another package."""
    return path.relative_to(SOURCE if SOURCE in path.parents else SOURCE.parent).as_posix()


def tracked() -> list[Path]:
    """Return the files of the repository, those not yet committed included."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    if listed.returncode:
        pytest.skip("not a git repository")
    return [p for name in listed.stdout.splitlines() if (p := ROOT / name).is_file()]


@pytest.mark.parametrize("path", modules(), ids=names_of(modules()))
def test_module_imports_only_from_its_left(path: Path) -> None:
    part = part_of(path)
    assert part in RANK, f"{part} has no place in the order of the package"
    right = {other for other in own(path) - {part, "__version__"} if RANK[other] > RANK[part]}
    assert not right


def test_the_package_names_none_beside_it() -> None:
    beside = {path.parent.name for path in SOURCE.parent.glob("pyrofit_*/__init__.py")}
    assert beside == {name for name in RANK if name.startswith("pyrofit_")}
    for path in SOURCE.rglob("*"):
        if path.suffix in (".py", ".smk", ".j2", ".html"):
            words = set(re.findall(r"\w+", path.read_text(encoding="utf-8")))
            assert not words & beside, path


def modules_imported(path: Path) -> set[str]:
    """Return the modules of the package that a file imports, by their full names."""
    known = module_names()
    found = {name if name in known else name.rpartition(".")[0] for name in imported(path)}
    return found & known - {module_name(path)}


@cache
def module_names() -> frozenset[str]:
    return frozenset(map(module_name, modules()))


def module_name(path: Path) -> str:
    parts = path.relative_to(SOURCE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def test_no_modules_import_each_other_in_a_circle() -> None:
    # Imports for type checks alone are counted: they join two files as much as any other.
    TopologicalSorter({module_name(p): modules_imported(p) for p in modules()}).prepare()


MOST_NAMES_TWICE = 70
"""Public names that stand in two modules or more: of interfaces, or the same in kernels."""


def test_few_public_names_have_two_meanings() -> None:
    homes: dict[str, set[str]] = {}
    for path in modules():
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
                homes.setdefault(node.name, set()).add(name_of(path))
    twice = sorted(name for name, places in homes.items() if len(places) > 1)
    assert len(twice) <= MOST_NAMES_TWICE, f"give the new one a name of its own: {twice}"


def test_no_step_knows_another() -> None:
    for path in (SOURCE / "steps").glob("*/*.py"):
        steps = {n.split(".")[2] for n in imported(path) if n.startswith("pyrofit.steps.")}
        assert steps <= {"base", path.parent.name}, f"{path}: {steps}"


def test_no_effect_is_known_by_name_outside_its_file() -> None:
    effects = {p.stem for p in (SOURCE / "effects").glob("*.py") if "EFFECT = " in p.read_text()}
    assert len(effects) > 20
    for path in modules():
        if part_of(path) not in ("config", "estimate", "diagnose"):
            continue
        for node in parsed(path):
            literal = isinstance(node, ast.Constant) and isinstance(node.value, str)
            assert not (literal and node.value in effects), f"{path}: '{node.value}'"


def test_config_knows_no_solver() -> None:
    for path in (SOURCE / "config").rglob("*.py"):
        assert not own(path) & {"solver", "simulate", "estimate"}, path.name


def test_floors_of_config_import_downwards() -> None:
    floors = ("keys", "expand", "check")
    for rank, floor in enumerate(floors):
        for path in (SOURCE / "config" / floor).glob("*.py"):
            above = (f"pyrofit.config.{other}" for other in (*floors[rank + 1 :], "read"))
            text = path.read_text()
            assert not [name for name in above if name in text], path


def test_no_quantity_is_known_by_name_outside_its_home() -> None:
    quantities = set(known_quantities()) - {"mass"}  # which is a word and a kind of unit, too
    assert len(quantities) > 2
    home = ("quantities/", "experiments/", "solver/outputs.py")
    for path in modules():
        name = name_of(path)
        if name.startswith(home):
            continue
        for node in parsed(path):
            literal = isinstance(node, ast.Constant) and isinstance(node.value, str)
            assert not (literal and node.value in quantities), f"{name}: '{node.value}'"


def test_no_kind_of_experiment_is_asked_for_outside_its_home() -> None:
    classes = {kind.description.__name__ for kind in KINDS.values()}
    for path in modules():
        name = name_of(path)
        if name.startswith("experiments/"):
            continue
        for node in parsed(path):
            if isinstance(node, ast.Call) and ast.unparse(node.func) == "isinstance":
                asked = {n.id for n in ast.walk(node.args[1]) if isinstance(n, ast.Name)}
                assert not asked & classes, f"{name}: {ast.unparse(node)}"
            if isinstance(node, ast.Compare):
                sides = [node.left, *node.comparators]
                of_kind = any(isinstance(s, ast.Attribute) and s.attr == "kind" for s in sides)
                given = {s.value for s in sides if isinstance(s, ast.Constant)}
                assert not (of_kind and given & set(KINDS)), f"{name}: {ast.unparse(node)}"


def test_a_new_study_names_no_kind_and_no_quantity() -> None:
    # The kinds bring their options, numbers and lines of the study themselves.
    names = {*KINDS, *known_quantities()} - {"mass"}
    folder = SOURCE / "new_study"
    for path in folder.glob("*.py"):
        for node in parsed(path):
            literal = isinstance(node, ast.Constant) and isinstance(node.value, str)
            assert not (literal and node.value in names), f"{path.name}: '{node.value}'"
    words = set(re.findall(r"\w+", (folder / "study.yaml.j2").read_text(encoding="utf-8")))
    assert not words & names
    for name in OF_FILES:
        assert (SOURCE / "experiments" / name / "new.yaml.j2").is_file(), name


def test_costs_know_nothing_of_models() -> None:
    for path in (SOURCE / "cost").glob("*.py"):
        assert not own(path) & NOT_FOR_COST, path.name


def test_only_kernels_import_numba() -> None:
    found = [p for p in modules() if "numba" in outside(p)]
    assert found
    assert all(is_compiled(name) for name in names_of(found))


def is_compiled(name: str) -> bool:
    """Tell whether a file holds compiled functions, or compiles them."""
    return name.startswith(("compiled/", "numerics/kernels/", "solver/kernels/"))


def test_planning_the_workflow_loads_no_optimiser_and_draws_nothing() -> None:
    planned = "pyrofit.show.sections, pyrofit.results.dependencies, pyrofit.stages.reading"
    slow = ("spotpy", "matplotlib", "scipy.optimize", "scipy.stats", "scipy.linalg")
    assert loaded(planned, *slow) == "[]"


def test_one_repetition_loads_no_integrator() -> None:
    assert loaded("pyrofit.stages.fit", "scipy.integrate", "scipy.optimize", "scipy.stats") == "[]"


def test_commands_load_nothing_to_serve_pages() -> None:
    assert loaded("pyrofit.cli.command", "http.server", "pyrofit_explore.server") == "[]"


def loaded(modules: str, *names: str) -> str:
    """Return which of the named modules a process holds that has imported others."""
    code = f"import sys, {modules}; print([n for n in {names} if n in sys.modules])"
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout.strip()


def test_only_the_lanes_are_compiled_by_hand() -> None:
    # The cache asks for the version only.
    found = [p for p in modules() if "llvmlite" in outside(p) and p.name != "cache.py"]
    names = ("functions", "lane_types", "lanes")
    assert names_of(found) == [f"solver/kernels/{name}.py" for name in names]


def test_kernels_import_nothing_but_arrays() -> None:
    for path in (SOURCE / "numerics" / "kernels").glob("*.py"):
        assert own(path) <= {"compiled"}, path.name
        assert outside(path) <= {"pyrofit", "numpy"}, path.name
    for path in (SOURCE / "solver" / "kernels").glob("*.py"):
        assert own(path) <= {"compiled", "solver", "constants"}, path.name
        allowed = {"pyrofit", "numpy", "numba", "math", "typing"}
        if path.name in ("functions.py", "lane_types.py", "lanes.py"):
            allowed |= {"collections", "llvmlite", "operator"}
        assert outside(path) <= allowed, path.name


def test_reference_and_production_solver_do_not_know_each_other() -> None:
    folder = SOURCE / "solver"
    reference = set((folder / "reference").glob("*.py"))
    assert reference
    for path in {*folder.rglob("*.py"), SOURCE / "simulate.py"}:
        inside = {n.split(".")[2] for n in imported(path) if n.startswith("pyrofit.solver.")}
        if path in reference:
            # `observe` only averages, shifts and lifts finished curves: no equation of a slab.
            assert inside <= {"arrays", "curves", "observe", "outputs", "reference"}, path.name
            assert "simulate" not in own(path), path.name
        else:
            assert "reference" not in inside, path.name


def test_only_config_reads_yaml() -> None:
    assert names_of([p for p in modules() if "yaml" in outside(p)]) == ["config/yaml_file.py"]


def test_only_pose_poses_problems_and_their_likelihood() -> None:
    posing = {
        "pyrofit.estimate.problem.make_problem",
        "pyrofit.estimate.likelihood.likelihood_of",
        "pyrofit.estimate.prior.within_known",
    }
    found = names_of([p for p in modules() if imported(p) & posing])
    limits = ["steps/rescore/valleys.py", "steps/sensitivity/varied.py"]
    assert found == ["estimate/pose.py", "estimate/pose_likelihood.py", *limits]


def test_only_the_sce_ua_module_imports_spotpy() -> None:
    assert names_of([p for p in modules() if "spotpy" in outside(p)]) == ["estimate/sceua.py"]


def depends_on_the_processor(node: ast.AST) -> bool:
    """Tell whether the last bits of an operation are those of NumPy's or BLAS's dispatch."""
    if isinstance(node, ast.BinOp | ast.AugAssign):
        return isinstance(node.op, ast.MatMult)
    if isinstance(node, ast.Attribute) and ast.unparse(node.value) == "np":
        return node.attr in DISPATCHED
    if isinstance(node, ast.ImportFrom) and str(node.module).startswith("scipy"):
        part = str(node.module).removeprefix("scipy").split(".")[-1]
        names = {alias.name for alias in node.names}
        asked = {part, *names} if part in ("", "optimize") else {part}
        return bool(asked & {*BY_LAPACK, *BY_LAPACK_OF_OPTIMIZE})
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
        stable = any(k.arg == "kind" and "stable" in ast.unparse(k.value) for k in node.keywords)
        if node.func.attr == "argsort":
            return not stable
        if node.func.attr == "sort_values":  # by several columns it is stable anyway
            several = bool(node.args) and isinstance(node.args[0], ast.List)
            return not (stable or several)
        return node.func.attr == "dot" and ast.unparse(node.func.value) != "linear"
    return False


def test_results_do_not_depend_on_the_processor() -> None:
    for path in modules():
        name = name_of(path)
        if is_compiled(name):
            continue  # compiled, in the order that they state
        for node in parsed(path):
            text = ast.unparse(node) if depends_on_the_processor(node) else ""
            assert not text or text == "np.linalg", f"{name}: {text}"
            if text == "np.linalg":
                used = ast.unparse(ast.parse(path.read_text(encoding="utf-8")))
                errors = used.count("np.linalg.LinAlgError")
                assert used.count("np.linalg") == errors, f"{name}: np.linalg"


def test_powers_of_arrays_are_products_or_of_numerics() -> None:
    found = set()
    for path in modules():
        name = name_of(path)
        for node in parsed(path):
            if isinstance(node, ast.BinOp | ast.AugAssign) and isinstance(node.op, ast.Pow):
                right = node.right if isinstance(node, ast.BinOp) else node.value
                if not (isinstance(right, ast.Constant) and right.value in (2, 0.5)):
                    found.add(name)
    assert {n for n in found if not is_compiled(n)} <= set(NUMBERS_TO_A_POWER)


def test_tests_import_no_other_test_and_no_private_name() -> None:
    for path in (ROOT / "tests").rglob("*.py"):
        for name in imported(path):
            assert not name.startswith(("test_", "conftest.")), f"{path}: {name}"
            private = name.startswith("pyrofit") and re.search(r"\._[^_]", name)
            assert not private, f"{path}: {name}"


def test_library_never_prints_or_exits() -> None:
    # Progress of the searches goes to standard error, where the command line keeps its log.
    for path in modules():
        if part_of(path) == "cli" or path.name.endswith("commands.py"):
            continue
        for node in parsed(path):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                assert node.func.id not in ("exit", "quit"), path
                if node.func.id == "print":
                    assert "file" in {k.arg for k in node.keywords}, path


def test_lock_pins_every_requirement_by_hash_and_names_no_address() -> None:
    text = (ROOT / "requirements.lock").read_text(encoding="utf-8")
    assert "://" not in text
    blocks = re.split(r"\n(?=\S)", text.strip())
    requirements = [b for b in blocks if not b.startswith("#")]
    assert len(requirements) > 30
    for block in requirements:
        assert re.match(r"[A-Za-z0-9._-]+==\S+", block), block[:60]
        assert "--hash=sha256:" in block, block[:60]


def test_lock_holds_every_requirement_of_the_package() -> None:
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    lock = (ROOT / "requirements.lock").read_text(encoding="utf-8")
    locked = {m.lower().replace("_", "-") for m in re.findall(r"^([\w.-]+)==", lock, re.M)}
    wanted = re.findall(r'^ {4}"([A-Za-z0-9_.-]+)[><=]', project, re.M)
    assert len(wanted) > 15
    assert {w.lower().replace("_", "-") for w in wanted} <= locked


def test_no_file_holds_the_path_of_a_home_or_work_folder() -> None:
    folders = re.compile(rb"(?<![\w.$}/-])/(home|root|Users|work|tmp)/[\w.-]")
    found = [p for p in tracked() if folders.search(p.read_bytes())]
    assert [p.relative_to(ROOT).as_posix() for p in found] == []
