"""What users get wrong: a small valid study, and a table of ways to break it.

Each case breaks one thing and names the words that the message must hold: file, place, rule, way
out. `test_bad_input.py` gives every case to the command line.
"""

import json
import math
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
import yaml

STUDY = """\
name: small
title: A small study
seed: 3
parameters:
  T_p: {unit: K, lower: 560, upper: 660}
  E_p: {unit: kJ/mol, lower: 100, upper: 300}
  rho: {unit: kg/m3, lower: 900, upper: 1500}
  k: {unit: W/(m K), lower: 0.1, upper: 0.4}
  cp: {unit: kJ/(kg K), value: 2.1}
  eps: {unit: "-", value: 0.9, lower: 0.5, upper: 0.99}
  dh: {unit: kJ/kg, value: 800}
material:
  components:
    wood: {density_kg_m3: rho, conductivity_W_mK: k, specific_heat_J_kgK: cp, emissivity: eps}
    char: {density_kg_m3: 200, conductivity_W_mK: 0.1, specific_heat_J_kgK: 1200, emissivity: 0.9}
  reactions:
    pyrolysis:
      reactant: wood
      products: {char: 0.1}
      reference_temperature_K: T_p
      reference_rate_1_s: 0.001
      E_J_mol: E_p
      heat_of_reaction_J_kg: dh
  composition: {wood: 1.0}
experiments:
  tga_10:
    kind: tga
    heating_rate_K_min: 10
    signals: {mass_fraction: {file: data/tga.csv}}
  slab_25: &slab
    kind: gasification
    sample:
      layers: [{thickness_m: 0.004}]
      foil: {thickness_m: 2.5e-5, density_kg_m3: 8940, specific_heat_J_kgK: 380}
      initial_temperature_K: 293
    front: {flux_W_m2: 25000, h_W_m2K: 8, gas_temperature_K: 330}
    back: {h_W_m2K: 4, wall_temperature_K: 300}
    signals: {mlr: {file: data/mlr.csv}, back_temperature: {file: data/back.csv}}
  slab_50:
    <<: *slab
    front: {flux_W_m2: 50000}
    signals: {mlr: {file: data/mlr.csv}}
accuracy: {cells: 10}
kinetics:
  estimate: [T_p, E_p]
  cost: [{experiment: tga_10, signal: mass_fraction, kind: RMSE}]
  sceua: {complexes: 1, generations: 3}
  least_squares: {starts: 1}
  sets:
    book:
      reactions: {pyrolysis: {A_1_s: 2.5e+13, E_J_mol: 1.9e+5}}
      composition: {wood: 1.0}
imp:
  estimate: [rho, k]
  kinetics: fitted
  repetitions: 1
  sceua: {complexes: 1, generations: 3}
  least_squares: {starts: 1}
  cmaes: {starts: 1, calls: 20}
  costs:
    RMSE: [{experiment: slab_25, signal: mlr, kind: RMSE, normalisation: mean}]
    RANGE: [{experiment: slab_25, signal: mlr, kind: RANGE, options: {r: 0.05}}]
validation: {experiments: [slab_25, slab_50]}
published:
  source: a book
  costs: {RMSE: {rho: [1200, 1210, 5], k: [0.2, 0.21, 0.01]}}
"""


def _tga() -> str:
    mass = [4.5 / (1.0 + math.exp((t - 600.0) / 10.0)) + 0.5 for t in range(450, 760, 10)]
    rows = (f"{6 * (t - 450)},{t},{m:.5f}" for t, m in zip(range(450, 760, 10), mass, strict=True))
    return "\n".join(["Time,Temperature,Mass", "[s],[K],[mg]", *rows, ""])


def _mlr() -> str:
    rows = (
        f"{t},{0.01 * math.exp(-(((t - 150) / 60) ** 2)):.6f},0.0005" for t in range(5, 305, 10)
    )
    return "\n".join(["Time,MLR,MLR_error", "[s],[kg/s/m2],[kg/s/m2]", *rows, ""])


def _back() -> str:
    return "\n".join(
        ["Time,Temperature", "[s],[K]", *(f"{t},{293 + t}" for t in range(0, 300, 10)), ""]
    )


def line_of(text: str) -> int:
    """Return the number of the first line of the study that starts like this."""
    return STUDY[: STUDY.index(f"\n{text}") + 1].count("\n") + 1


FILES = {
    "study.yaml": STUDY,
    "data/tga.csv": _tga(),
    "data/mlr.csv": _mlr(),
    "data/back.csv": _back(),
}
TGA = "experiments.tga_10.signals.mass_fraction"
MLR = "experiments.slab_25.signals.mlr"
POLYMER = "material.components.wood"
GONE = object()
"""Value that takes a key out."""
ABSENT = "PMMA/Calibration_Data/UMET/UMET_TGA_N2_10K_1.csv"
RESULTS = "results/small"
SYNTHETIC = {"truth": {"T_p": 605, "E_p": 190, "rho": 1190, "k": 0.2}}

Break = Callable[[pytest.MonkeyPatch], None]
"""Breaks something in the working folder, which holds `FILES` and the results of a run of them."""


@dataclass(frozen=True)
class Case:
    """One thing that is wrong, the command that meets it, and the words of its message."""

    name: str
    command: str
    broken: Break
    words: tuple[str, ...]


# --- ways to break things -------------------------------------------------------------------


def put(**changes: Any) -> Break:
    """Change values of the study; ``a__b=1`` sets a.b to 1."""

    def change(patch: pytest.MonkeyPatch) -> None:
        study = json.loads(json.dumps(yaml.safe_load(STUDY)))
        for place, value in changes.items():
            *above, last = place.split("__")
            part = study
            for key in above:
                part = part[int(key)] if isinstance(part, list) else part[key]
            if value is GONE:
                del part[last]
            else:
                part[int(last) if isinstance(part, list) else last] = value
        Path("study.yaml").write_text(yaml.safe_dump(study, sort_keys=False))

    return change


def write(path: str, content: str | bytes) -> Break:
    def change(patch: pytest.MonkeyPatch) -> None:
        Path(path).write_bytes(content.encode() if isinstance(content, str) else content)

    return change


def edit(path: str, old: str, new: str) -> Break:
    def change(patch: pytest.MonkeyPatch) -> None:
        text = Path(path).read_text()
        assert old in text
        Path(path).write_text(text.replace(old, new, 1))

    return change


def study(old: str, new: str) -> Break:
    return edit("study.yaml", old, new)


def tga(old: str, new: str) -> Break:
    return edit("data/tga.csv", old, new)


def mlr(old: str, new: str) -> Break:
    return edit("data/mlr.csv", old, new)


def delete(path: str) -> Break:
    return lambda patch: Path(path).unlink()


def folder(path: str) -> Break:
    """Put a folder in the place of a file."""

    def change(patch: pytest.MonkeyPatch) -> None:
        Path(path).unlink()
        Path(path).mkdir()

    return change


def cut(path: str) -> Break:
    """Lose the second half of a file."""

    def change(patch: pytest.MonkeyPatch) -> None:
        content = Path(path).read_bytes()
        Path(path).write_bytes(content[: len(content) // 2])

    return change


def result(path: str, place: str, value: object) -> Break:
    """Change a JSON file of results at a dotted place, or take the place out."""

    def change(patch: pytest.MonkeyPatch) -> None:
        content = json.loads(Path(RESULTS, path).read_text())
        *above, last = place.split(".")
        part = content
        for key in above:
            part = part[int(key)] if isinstance(part, list) else part[key]
        if value is GONE:
            del part[last]
        else:
            part[last] = value
        Path(RESULTS, path).write_text(json.dumps(content))

    return change


def table(path: str, change: Callable[[pd.DataFrame], pd.DataFrame]) -> Break:
    """Change a table of results."""

    def write_changed(patch: pytest.MonkeyPatch) -> None:
        change(pd.read_csv(Path(RESULTS, path))).to_csv(Path(RESULTS, path), index=False)

    return write_changed


def variable(name: str, value: str) -> Break:
    """Set an environment variable, and let the TGA be read from the MaCFP data base."""

    def change(patch: pytest.MonkeyPatch) -> None:
        patch.setenv(name, value)
        put(experiments__tga_10__signals__mass_fraction={"file": f"macfp:{ABSENT}"})(patch)

    return change


def altered_file(patch: pytest.MonkeyPatch) -> None:
    """Let a folder hold the published file, one figure changed."""
    path = Path("macfp", ABSENT)
    path.parent.mkdir(parents=True)
    path.write_text(_tga())
    variable("PYROFIT_DATA_DIR", "macfp")(patch)


def full_disk(patch: pytest.MonkeyPatch) -> None:
    def no_room(self: Path, content: bytes) -> int:
        raise OSError(28, os.strerror(28))

    patch.setattr(Path, "write_bytes", no_room)


def read_only(patch: pytest.MonkeyPatch) -> None:
    def refuse(self: Path, **options: Any) -> None:
        raise OSError(30, os.strerror(30))

    patch.setattr(Path, "mkdir", refuse)


def results_in_a_file(patch: pytest.MonkeyPatch) -> None:
    Path("taken").write_text("not a folder")


def nothing(patch: pytest.MonkeyPatch) -> None:
    """Leave all as it is: the command is wrong."""


def both(*broken: Break) -> Break:
    def change(patch: pytest.MonkeyPatch) -> None:
        for one in broken:
            one(patch)

    return change


CHECK = "check study.yaml"
Row = tuple[str, Break, tuple[str, ...]]


def rows_of(command: str, always: tuple[str, ...], rows: list[Row]) -> list[Case]:
    return [Case(name, command, broken, (*always, *words)) for name, broken, words in rows]
