"""A program of the tests: a decaying rate, and whatever may go wrong with a program."""

import stat
import sys
from pathlib import Path
from typing import Any

SCRIPT = """\
import math, os, sys, time
given = {}
for line in open(sys.argv[1]):
    name, _, value = line.partition("=")
    given[name.strip()] = value.strip()
if "RUNS" in os.environ:
    with open(os.environ["RUNS"], "a") as runs:
        runs.write(given["height"] + " " + given["fall"] + "\\n")
height, fall = float(given["height"]), float(given["fall"])
mode = given.get("mode", "well")
time.sleep(float(os.environ.get("SLOW", "0")))
if mode == "fails above 0.04" and fall > 0.04:
    print("the step became too small")
    sys.exit(3)
if mode == "hangs":
    if os.fork() == 0:
        time.sleep(60)
    time.sleep(60)
if mode == "says":
    print("ERROR: no convergence")
if mode == "dies":
    os.kill(os.getpid(), 11)
if mode == "killed" or (mode == "killed once" and not os.path.exists(os.environ["KILLED"])):
    open(os.environ["KILLED"], "w").close()
    os.kill(os.getpid(), 9)
if mode == "ended from outside":
    os.kill(os.getpid(), 15)
rows = [(t, height * math.exp(-fall * t)) for t in range(101)]
if mode == "short":
    rows = rows[:50]
text = "Time,Rate\\n[s],[g/m2/s]\\n" + "".join("%d,%.12g\\n" % row for row in rows)
if mode == "cut":
    text = text[: len(text) // 2]
if mode == "infinite":
    text = text.replace("\\n7,", "\\n7,-Infinity,")
if mode != "silent":
    open("rate.csv", "w").write(text)
print("done")
"""
TEMPLATE = "height = #height#\nfall = #fall#\n"
READS = {"file": "rate.csv", "columns": {"value": "Rate"}, "units": {"value": "g/m2/s"}}


def write(folder: Path, mode: str = "well", template: str = TEMPLATE) -> Path:
    """Write the program and its template into a folder; return the program."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "decay.inp").write_text(template + f"mode = {mode}\n")
    script = folder / "decay.py"
    script.write_text(SCRIPT)
    return script


def fake_fds(folder: Path, mode: str) -> Path:
    """Write a program that behaves as FDS does: always exit status 0, units above names."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "fds"
    path.write_text(FDS.format(python=sys.executable, mode=mode))
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path


FDS = """\
#!{python} -S
import os, re, sys
print(" Revision         : FDS6.7.4-0-gbfaa110-release", file=sys.stderr)
text = open(sys.argv[1]).read()
if os.environ.get("OMP_NUM_THREADS") != "1" or "SECRET" in os.environ:
    sys.exit("the environment is not clean")
if "{mode}" == "error":
    print("ERROR: Problem with SURF number 1, line 30", file=sys.stderr)
    sys.exit(0)
end = float(re.search(r"T_END=([0-9.]+)", text)[1])
k = float(re.search(r"CONDUCTIVITY=([0-9.eE+-]+)", text)[1])
name = re.search(r"CHID='(\\w+)'", text)[1]
with open(name + "_devc.csv", "w") as out:
    out.write("s,kg/m2/s,C\\n\\"Time\\",\\"MLR\\",\\"T_back\\"\\n")
    for t in range(0, int(end if "{mode}" == "well" else end / 3) + 1):
        out.write(" %.7E, %.7E, %.7E\\n" % (t, 0.01 + 0.05 * k, 20 + 0.1 * t))
if "{mode}" != "stopped":
    print("STOP: FDS completed successfully (CHID: x)", file=sys.stderr)
"""


def study(**program: Any) -> dict[str, Any]:
    """Return the keys of a study that this program simulates."""
    return {
        "name": "decay",
        "seed": 3,
        "parameters": {
            "height": {"unit": "-", "lower": 5, "upper": 20},
            "fall": {"unit": "1/s", "lower": 0.01, "upper": 0.06},
        },
        "experiments": {
            "plate": {
                "kind": "external",
                "duration_s": 98,
                "program": {
                    "template": "decay.inp",
                    "files": ["decay.py"],
                    "command": [sys.executable, "-S", "decay.py", "decay.inp"],
                    "time_limit_s": 20,
                    "reads": {"mlr": READS},
                    **program,
                },
                "signals": {"mlr": {"file": "synthetic", "every": 5, "noise": 1e-4}},
            }
        },
        "synthetic": {"truth": {"height": 12, "fall": 0.03}},
        "imp": {
            "estimate": ["height", "fall"],
            "repetitions": 2,
            "sceua": {"complexes": 2, "generations": 4},
            "least_squares": {"starts": 1},
            "cmaes": {"starts": 1, "calls": 20},
            "costs": {"RMSE": [{"experiment": "plate", "signal": "mlr", "kind": "RMSE"}]},
        },
        "validation": {"experiments": ["plate"]},
    }
