"""Commands for the parameter sets of the MaCFP data base."""

import argparse
from pathlib import Path
from typing import Any

from pyrofit.cli.common import study_with_results
from pyrofit.errors import DataError


def add(commands: Any) -> None:
    """Add these commands."""
    macfp = commands.add_parser("macfp", help="parameter sets and submissions of MaCFP")
    actions = macfp.add_subparsers(dest="action", required=True, metavar="ACTION")
    lint = actions.add_parser("lint", help="check parameter sets and report errors")
    lint.add_argument("files", type=Path, nargs="+", metavar="FILE", help="JSON files")
    lint.add_argument("--strict", action="store_true", help="exit 2 unless all are strict")
    lint.add_argument("--write", type=Path, metavar="FOLDER", help="write the strict form there")
    lint.set_defaults(step=_lint)
    schema = actions.add_parser("schema", help="print the JSON Schema of the strict form")
    schema.set_defaults(step=_schema)
    material = actions.add_parser("material", help="print a set as the material of a study")
    material.add_argument("file", type=Path, help="JSON file")
    material.set_defaults(step=_material)
    predict = actions.add_parser("predict", help="simulate the ideal cases for sets")
    predict.add_argument("files", type=Path, nargs="+", metavar="FILE", help="JSON files")
    predict.add_argument("--cases", choices=("pmma", "wood"), default="pmma", help="MaCFP-2 or -4")
    predict.add_argument("--out", type=Path, metavar="FOLDER", help="write the curves there")
    predict.set_defaults(step=_predict)
    submit = actions.add_parser("submit", help="write a complete submission of a fitted study")
    submit.add_argument("study", type=Path, help="study file (YAML or JSON)")
    submit.add_argument("--institute", required=True, metavar="NAME", help="your laboratory")
    submit.add_argument("--material", default="PMMA", metavar="NAME", help="default: PMMA")
    submit.add_argument("--form", choices=("3", "4", "both"), default="both", help="workshop")
    submit.add_argument("--set", default="", help="set of the report, 'truth', 'diagnosis', a JSON")
    submit.add_argument("--like", default="", metavar="EXPERIMENT", help="apparatus of MaCFP-3")
    submit.add_argument("--results", type=Path, help="results folder; default results/<name>")
    submit.add_argument("--out", type=Path, help="default results/<name>/macfp")
    submit.set_defaults(step=_submit)


def _lint(given: argparse.Namespace) -> None:
    from pyrofit_exchange.macfp.lint import lint
    from pyrofit_exchange.macfp.read import read_set

    strict = True
    for line, fits in lint(given.files):
        print(line)
        strict = strict and fits
    if given.write is not None:
        given.write.mkdir(parents=True, exist_ok=True)
        for path in given.files:
            text = read_set(path).strict.text()
            (given.write / path.name).write_text(text, encoding="utf-8")
    if given.strict and not strict:
        raise DataError(
            "not all sets are in the strict form; write it with `pyrofit macfp lint --write FOLDER`"
        )


def _schema(given: argparse.Namespace) -> None:
    import json

    from pyrofit_exchange.macfp.schema import schema

    print(json.dumps(schema(), indent=1, ensure_ascii=False))


def _material(given: argparse.Namespace) -> None:
    import json

    from pyrofit_exchange.macfp.material import material_of
    from pyrofit_exchange.macfp.read import read_set

    found = read_set(given.file)
    for note in (*found.mended, *found.notes):
        print(f"# {note}")
    print(json.dumps({"material": material_of(found.strict)}, indent=2, ensure_ascii=False))


def _predict(given: argparse.Namespace) -> None:
    from pyrofit_exchange.macfp.compare import comparison_tables

    for line in comparison_tables(given.files, given.cases, given.out):
        print(line)


def _submit(given: argparse.Namespace) -> None:
    from pyrofit_exchange.macfp.asked import Submission
    from pyrofit_exchange.macfp.submit import submit
    from pyrofit_exchange.sets import parameter_set

    study, results = study_with_results(given)
    chosen = parameter_set(study, results, given.set, given.study.parent)
    forms = (3, 4) if given.form == "both" else (int(given.form),)
    folder = given.out or results.root / "macfp"
    asked = Submission(given.institute, given.material, forms, given.like)
    for line in submit(study, chosen, asked, folder):
        print(line)
    print(f"{folder}: set '{chosen.label}' of study '{study.name}'")
