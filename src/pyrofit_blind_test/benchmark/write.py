"""Write the benchmark: data sets of plans of the blind test, the truth apart."""

import shutil
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from pyrofit.config import as_yaml
from pyrofit.effects import known_effects
from pyrofit.errors import DataError
from pyrofit.logs import Tell
from pyrofit.results.files import read_json, write_csv, write_text
from pyrofit_blind_test import foreign
from pyrofit_blind_test.benchmark.plain import catalogue_table, model_keys
from pyrofit_blind_test.benchmark.score import ANSWER
from pyrofit_blind_test.detectability import detectability
from pyrofit_blind_test.places import Places, folder_of
from pyrofit_blind_test.plan import TwinPlan, cases_of
from pyrofit_blind_test.recovery import fitted_strengths
from pyrofit_blind_test.setting import Setting, read_setting
from pyrofit_blind_test.table import leading_effects
from pyrofit_blind_test.twin import describe_twin, make_twin, read_twin, write_twin

Row = dict[str, Any]
Size = Callable[[Setting, TwinPlan, Places], float]
HERE = Path(__file__).parent
TRUTH = ("set", "source", "kind", "effect", "strength", "size_sd", "also_right")
_MODEL = "The model of this data set, SI units. See README.md of the benchmark."


def data_sets(folder: Path) -> Path:
    """Return the folder of the data sets."""
    return folder / "sets"


def answer_of(folder: Path, name: str) -> Path:
    """Return the file of an answer."""
    return folder / "answers" / f"{name}.csv"


def hidden_size(setting: Setting, case: TwinPlan, places: Places) -> float:
    """Return by how many standard deviations of the noise the best base model misses the truth."""
    _, truth = describe_twin(setting, case)
    study, series = read_twin(places, case.id)
    return detectability(truth, series, {n: prior.sd for n, prior in study.known.items()}).size


def write_benchmark(
    folder: Path,
    settings: Sequence[Path],
    plan: str,
    so_far: bool = False,
    tell: Tell = lambda text: None,
    size: Size = hidden_size,
) -> None:
    """Write the data sets of a plan of some settings, catalogue, scorer, and the truth.

    Data sets are those in the results of the blind test; missing ones are computed and kept there.
    What the blind test has diagnosed becomes the answer ``pyrofit``.

    Parameters
    ----------
    folder
        Folder of the benchmark.
    settings, plan
        Files of settings of the blind test, and the plan of each.
    so_far
        Only write data sets that the blind test has diagnosed.
    tell
        Is told the progress.
    size
        Size of the hidden effects, where the blind test has not found it.

    Raises
    ------
    StudyError
        A setting breaks a rule, or has no such plan.
    DataError
        No data set is left, one cannot be computed, or a file is missing or cannot be written.
    """
    truths: list[Row] = []
    answers: list[Row] = []
    for path in settings:
        setting, places = read_setting(path), Places(folder_of(path, plan))
        source = foreign.read_manifest(Path(setting.curves)).code if setting.curves else "pyrofit"
        for case in cases_of(setting, plan):
            diagnosed = places.case(case.id).is_file()
            if so_far and not diagnosed:
                continue
            tell(f"{case.id} of {path.stem}")
            _write_set(folder, setting, case, places)
            found = read_json(places.case(case.id)) if diagnosed else None
            sd = found["detectability"] if found else size(setting, case, places)
            truths += [{**row, "source": source, "size_sd": sd} for row in _truth(case)]
            answers += answer_rows(found) if found else []
    if not truths:
        raise DataError(f"no data set of plan '{plan}' has been diagnosed; leave out --so-far")
    _write_table(folder / "truth.csv", truths, TRUTH)
    write_csv(folder / "catalogue.csv", catalogue_table())
    for name in ("README.md", "score.py"):
        write_text(folder / name, (HERE / name).read_text(encoding="utf-8"))
    if answers:
        _write_table(answer_of(folder, "pyrofit"), answers, ANSWER)


def _write_table(path: Path, rows: Sequence[Row], columns: Sequence[str]) -> None:
    table = pd.DataFrame(rows, columns=list(columns))
    write_csv(path, table.sort_values("set", kind="stable"))


def _write_set(folder: Path, setting: Setting, case: TwinPlan, places: Places) -> None:
    """Write study, measurements and plain model of a data set, which is computed if missing."""
    if not (places.twin(case.id) / "study.yaml").is_file():
        write_twin(places, make_twin(setting, case))
    target = data_sets(folder) / case.id
    shutil.copytree(places.twin(case.id), target, dirs_exist_ok=True)
    study, _ = read_twin(places, case.id)
    write_text(target / "model.yaml", as_yaml(model_keys(study), _MODEL))


def _truth(case: TwinPlan) -> Iterator[Row]:
    """Yield a row for each hidden effect, or one without.

    An effect that another code computes in another form has no true strength.
    """
    about: Row = {"set": case.id, "kind": case.kind, "also_right": " ".join(case.same)}
    for effect, values in case.hidden.items():
        (parameter,) = known_effects()[effect].strength
        other_form = bool(case.curves) and case.kind == "form"
        yield {**about, "effect": effect, "strength": None if other_form else values[parameter]}
    if not case.hidden:
        yield {**about, "effect": "", "strength": None}


def answer_rows(found: Row) -> list[Row]:
    """Return the answer that a diagnosis gives: the leading effect of each set, sure if confirmed.

    Intervals are the wide ones, where there are some.
    """
    rows = []
    for effect in leading_effects(found["verdict"]):
        (parameter,) = known_effects()[effect].strength
        given = fitted_strengths(found).get(f"{effect}_{parameter}", {})
        wide = "_wide" if given.get("low_wide") is not None else ""
        rows.append(
            {
                "effect": effect,
                "strength": given.get("value"),
                "low": given.get(f"low{wide}"),
                "high": given.get(f"high{wide}"),
                "sure": int(found["verdict"]["confirmed"]),
            }
        )
    return [{"set": found["id"], **row} for row in rows or [{"effect": "", "sure": 0}]]
