"""A study with an effect, a quantity and a cost of its own, run by the workflow."""

import copy
import json
from pathlib import Path
from typing import Any

import pytest
from tiny import ROOT, TERM, TINY, Project, Run

EFFECT, QUANTITY, COST, *_ = (
    part.split("```")[0]
    for part in (ROOT / "docs" / "adding.md").read_text(encoding="utf-8").split("```python\n")[1:]
)
SEARCH = "results/own/imp/OWN/least_squares.json"
BY_OWN_COST = "Multistart least squares, OWN"


def study() -> dict[str, Any]:
    given = copy.deepcopy(TINY)
    own = {k: v for k, v in TERM.items() if k != "normalisation"}
    given |= {"name": "own", "plugins": ["own"]}
    given["effects"] = {"natural_convection": {"C": 1.31}}
    record = {"file": "synthetic", "every": 10, "noise": 1e-5}
    given["experiments"]["slab_60"]["signals"]["thickness_of_sample"] = record
    given["imp"]["costs"]["OWN"] = [{**own, "kind": "huber", "options": {"bend": 1e-3}}]
    return given


def write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def test_own_effect_and_cost_run_in_every_step_and_an_edit_reruns_what_uses_them(
    finished: tuple[Project, Run],
) -> None:
    project, _ = finished
    effect = project.root / "mine/own/effects/natural_convection.py"
    quantity = project.root / "mine/own/quantities/thickness_of_sample.py"
    cost = project.root / "mine/own/costs/huber.py"
    write(effect, EFFECT)
    write(quantity, QUANTITY)
    write(cost, COST)
    project.write(study())
    run = project.snakemake("--cores", "2", SEARCH)
    assert run.code == 0, run.said
    assert BY_OWN_COST in run.jobs
    thickness = project.read("results/own/measurements/slab_60_thickness_of_sample.csv").decode()
    assert float(thickness.splitlines()[1].split(",")[1]) == pytest.approx(0.002, abs=1e-4)
    # Residuals of the mass loss rate, of some 0.01 kg/(m2 s), above 1e-3 count less than squares.
    assert 0.0 < json.loads(project.read(SEARCH))["starts"][0]["cost"] < 0.1
    assert not project.plan(SEARCH)

    write(cost, COST + "EDITED = True\n")
    assert project.plan(SEARCH) == {BY_OWN_COST}
    write(cost, COST)
    for path, text in ((effect, EFFECT), (quantity, QUANTITY)):
        write(path, text + "EDITED = True\n")
        planned = project.plan(SEARCH)
        assert BY_OWN_COST in planned
        assert "Measured series into tidy tables, mass closure checked" in planned
        write(path, text)
    assert not project.plan(SEARCH)

    write(effect, "EFFECT = (\n")
    broken = project.snakemake("--dry-run", SEARCH)
    assert broken.code != 0
    assert "natural_convection.py, line 1" in broken.said
    assert "Traceback" not in broken.said
