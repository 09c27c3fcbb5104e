"""Commands that compare a study with further tests, other predictions, published materials."""

import argparse
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pyrofit.cli.common import study_with_results

if TYPE_CHECKING:
    import pandas as pd

    from pyrofit_compare.published import PublishedSet


def add(commands: Any) -> None:
    """Add these commands."""
    _add_compare_with(commands)
    words = "list published materials, print one, or predict the tests of a study with them"
    command = commands.add_parser("materials", help=words, description=words)
    command.add_argument(
        "names", nargs="*", metavar="NAME", help="parts of the names of sets; default: all"
    )
    command.add_argument("--study", type=Path, help="study whose tests they predict")
    command.add_argument(
        "--csv", type=Path, metavar="FILE", help="write the table there, with each test"
    )
    command.add_argument(
        "--show", action="store_true", help="print the `material` of a study instead of the list"
    )
    command.add_argument(
        "--folder",
        type=Path,
        help="copy of the MaCFP data base, or folder of sets and files of FDS; "
        "default: those that come with pyrofit, and PYROFIT_DATA_DIR",
    )
    command.set_defaults(step=_materials)


def _add_compare_with(commands: Any) -> None:
    words = "compare predictions of a study with further tests, and with those of others"
    command = commands.add_parser("compare-with", help=words, description=words)
    command.add_argument("study", type=Path, help="study file (YAML or JSON), also extended.yaml")
    command.add_argument("tests", type=Path, help="YAML file of the further tests")
    command.add_argument(
        "--predictions",
        type=Path,
        nargs="+",
        default=[],
        metavar="PATH",
        help="predictions of others in MaCFP's form: files, or folders of them",
    )
    command.add_argument(
        "--set", default="", help="estimates (default), a cost's, truth, diagnosis, or a JSON"
    )
    command.add_argument("--results", type=Path, help="results folder; default results/<name>")
    command.add_argument("--out", type=Path, help="default results/<name>/compare_with")
    command.set_defaults(step=_compare)


def _compare(given: argparse.Namespace) -> None:
    from pyrofit_compare.compute import compute_comparison
    from pyrofit_compare.page import mean_errors, write

    study, results = study_with_results(given)
    found = compute_comparison(
        study, results, given.tests, given.predictions, given.set, given.study.parent
    )
    print(mean_errors(found.scores).round(3).to_string(index=False))
    print(write(found, given.out or results.root / "compare_with"))


def _materials(given: argparse.Namespace) -> None:
    from pyrofit_compare import published

    sets, left = published.published(given.folder)
    sets = published.chosen_sets(sets, given.names)
    if given.show:
        _show(sets.values())
        return
    if given.study is None:
        frame = published.overview_of_sets(sets)
        remarks = left
    else:
        from pyrofit.config import read_study

        errors, remarks = published.errors_of_published(read_study(given.study), sets)
        frame = published.means_by_signal(errors).reset_index()
        print("root mean square error over the range of the measured mean")
    print(frame.round(3).to_string(index=False, na_rep="-"))
    for remark in remarks:
        print(remark)
    if given.csv is not None:
        whole = frame if given.study is None else _long(errors)
        whole.to_csv(given.csv, index=False)


def _long(errors: "pd.DataFrame") -> "pd.DataFrame":
    """Return errors with a row for each set, test and signal."""
    long = errors.stack(["test", "signal"], future_stack=True).reset_index()
    return long.rename(columns={0: "error"})


def _show(sets: Iterable["PublishedSet"]) -> None:
    import json

    from pyrofit_exchange.macfp.material import material_of

    for one in sets:
        print(f"# {one.name}: {one.strict.material}, {one.strict.laboratory}")
        for remark in one.remarks:
            print(f"# {remark}")
        print(json.dumps({"material": material_of(one.strict)}, indent=2, ensure_ascii=False))
