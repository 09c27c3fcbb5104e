"""Run the notebooks of docs/notebooks and store their results in them.

Run: python tools/run_notebooks.py [NAME ...]    default: all of them

Readers without Jupyter see the results on the site and on GitHub. The cells run as in Jupyter: the
last expression of a cell is shown unless a semicolon ends it, and so are the figures it draws.
"""

import ast
import base64
import contextlib
import io
import json
import os
import sys
from pathlib import Path
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
from PIL import Image

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "notebooks"
DPI = 90
COLOURS = 32
Output = dict[str, Any]


def executed(notebook: dict[str, Any]) -> dict[str, Any]:
    """Return a notebook with the results of its cells, run one after the other."""
    plt.close("all")
    names: dict[str, Any] = {"__name__": "__main__"}
    cells, count = [], 0
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            count += 1
            outputs = outputs_of("".join(cell["source"]), names, count)
            cell = {**cell, "execution_count": count, "outputs": outputs}
        cells.append(cell)
    return {**notebook, "cells": cells}


def outputs_of(source: str, names: dict[str, Any], count: int) -> list[Output]:
    """Run a cell; return its printed text, its last value and its figures."""
    *body, last = ast.parse(source).body
    shown = isinstance(last, ast.Expr) and not source.rstrip().endswith(";")
    if not shown:
        body.append(last)
    said = io.StringIO()
    value = None
    with contextlib.redirect_stdout(said):
        exec(compile(ast.Module(body, []), "cell", "exec"), names)
        if isinstance(last, ast.Expr) and shown:
            value = eval(compile(ast.Expression(last.value), "cell", "eval"), names)
    outputs: list[Output] = []
    if said.getvalue():
        outputs.append({"name": "stdout", "output_type": "stream", "text": lines(said.getvalue())})
    if value is not None:
        found = {"data": data_of(value), "execution_count": count, "metadata": {}}
        outputs.append({**found, "output_type": "execute_result"})
    return outputs + figures()


def data_of(value: object) -> dict[str, list[str]]:
    """Return a value as text, and as HTML where it has such a form."""
    data = {"text/plain": lines(repr(value))}
    page = getattr(value, "_repr_html_", None)
    return {"text/html": lines(page()), **data} if page is not None else data


def figures() -> list[Output]:
    """Return the figures that were drawn, and close them."""
    outputs = []
    for number in plt.get_fignums():
        drawn, few = io.BytesIO(), io.BytesIO()
        plt.figure(number).savefig(drawn, format="png", dpi=DPI, metadata={"Software": None})
        image = Image.open(drawn).convert("RGB")
        image.quantize(COLOURS).save(few, format="png", optimize=True)
        picture = base64.b64encode(few.getvalue()).decode()
        data = {"image/png": picture, "text/plain": ["figure"]}
        outputs.append({"data": data, "metadata": {}, "output_type": "display_data"})
    plt.close("all")
    return outputs


def lines(text: str) -> list[str]:
    """Return a text as notebooks hold it."""
    return text.splitlines(keepends=True)


def main(names: list[str]) -> None:
    """Run notebooks, by default all, and write them."""
    matplotlib.use("agg")
    os.chdir(FOLDER)
    for path in sorted(FOLDER.glob("*.ipynb")):
        if names and path.stem not in names:
            continue
        found = executed(json.loads(path.read_text(encoding="utf-8")))
        path.write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        print(f"{path.name}: {path.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main(sys.argv[1:])
