"""A program that behaves as FDS does: it replays curves, always with exit status 0."""

import stat
import sys
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit_exchange.fds.export import WrittenDeck

SCRIPT = """\
#!{python} -S
import os, sys, time
here = os.path.dirname(os.path.abspath(__file__))
mode = open(os.path.join(here, "mode")).read()
print(" Fire Dynamics Simulator", file=sys.stderr)
print(" Revision         : FDS{version}-0-gbfaa110-release", file=sys.stderr)
if len(sys.argv) < 2:
    sys.exit(0)
name = sys.argv[1][:-4]
if os.environ.get("OMP_NUM_THREADS") != "1" or "SECRET" in os.environ:
    sys.exit("the environment is not clean")
if mode == "hang":
    if os.fork() == 0:
        time.sleep(60)
    time.sleep(60)
if mode == "error":
    print("ERROR: Problem with SURF number 1, line 30", file=sys.stderr)
    sys.exit(0)
if mode == "stopped":
    print("STOP: FDS improperly set-up", file=sys.stderr)
    sys.exit(0)
kind = "tga" if "TGA_ANALYSIS" in open(sys.argv[1]).read() else "devc"
text = open(os.path.join(here, name + ".curve")).read()
if mode == "truncated":
    text = text[: len(text) // 2]
if mode != "silent":
    open(name + "_" + kind + ".csv", "w").write(text)
end = "TGA analysis only" if kind == "tga" else "FDS completed successfully"
print("STOP: " + end + " (CHID: " + name + ")", file=sys.stderr)
"""


def curve_of(one: WrittenDeck, factor: float) -> str:
    """Return pyrofit's curve as FDS would write it, the rate multiplied."""
    weights = one.deck.weights
    if not one.deck.step_s:
        T = one.curve["temperature_K"].to_numpy() - 273.15
        table = pd.DataFrame({"Time": np.arange(T.size), "Temp": T})
        table["Total Mass"] = one.curve["mass_fraction"].to_numpy()
        return "s,C,g/g\n" + table.to_csv(index=False)
    time = one.curve["time_s"].to_numpy()
    marks = [""] if len(weights) == 1 else [f"_{n + 1}" for n in range(len(weights))]
    columns = {"Time": np.append(0.0, time + 0.5)}
    taken = {"MLR": "mlr_kg_m2s", "T_front": "front_temperature_K"}
    taken |= {"T_back": "back_temperature_K", "mass": "mass_kg_m2"}
    for mark in marks:
        for name, of in taken.items():
            values = one.curve[of].to_numpy() - (273.15 if name.startswith("T_") else 0.0)
            values = values * (factor if name == "MLR" else 1.0)
            columns[f'"{name}{mark}"'] = np.append(values[0], values)
    return "s," * len(taken) + "\n" + pd.DataFrame(columns).to_csv(index=False, quoting=3)


def install(
    folder: Path, written: list[WrittenDeck], mode: str, version: str = "6.7.4", factor: float = 1.0
) -> Path:
    """Write the program and the curves that it replays; return its path."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "mode").write_text(mode)
    for one in written:
        (folder / f"{one.deck.name}.curve").write_text(curve_of(one, factor))
    path = folder / "fds"
    # A space in the path of an interpreter ends its name in the first line of a script.
    path.write_text(SCRIPT.format(python=sys.executable, version=version))
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path
