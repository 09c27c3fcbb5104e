"""A copy of the project, so that tests may edit its source, with a tiny study run in it."""

import contextlib
import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import psutil
import yaml

ROOT = Path(__file__).parents[2]
KERNELS = Path("src/pyrofit/compiled/__pycache__")
SCORES = "results/tiny/validation/scores.csv"
FIT = "results/tiny/kinetics/fit.json"
COSTS = ("RMSE", "RANGE")

TERM = {"experiment": "slab_60", "signal": "mlr", "normalisation": "mean"}
SLAB = {
    "kind": "gasification",
    "duration_s": 200,
    "sample": {"layers": [{"thickness_m": 0.002}]},
    "front": {"flux_W_m2": 60000, "h_W_m2K": 8},
    "signals": {"mlr": {"file": "synthetic", "every": 10, "average_s": 10, "noise": 2e-4}},
}
TINY: dict[str, Any] = {
    "name": "tiny",
    "title": "A study as small as it can be",
    "seed": 3,
    "parameters": {
        "T_p": {"unit": "K", "lower": 560, "upper": 660},
        "E_p": {"unit": "kJ/mol", "lower": 100, "upper": 300},
        "rho": {"unit": "kg/m3", "lower": 900, "upper": 1500},
        "k": {"unit": "W/(m K)", "lower": 0.1, "upper": 0.4},
    },
    "material": {
        "components": {
            "polymer": {
                "density_kg_m3": "rho",
                "conductivity_W_mK": "k",
                "specific_heat_J_kgK": 2100,
            }
        },
        "reactions": {
            "pyrolysis": {
                "reactant": "polymer",
                "reference_temperature_K": "T_p",
                "reference_rate_1_s": 0.001,
                "E_J_mol": "E_p",
                "heat_of_reaction_J_kg": 800e3,
            }
        },
        "composition": {"polymer": 1.0},
    },
    "experiments": {
        "tga_20K": {
            "kind": "tga",
            "heating_rate_K_min": 20,
            "start_temperature_K": 450,
            "end_temperature_K": 750,
            "signals": {"mass_fraction": {"file": "synthetic", "every": 5, "noise": 0.003}},
        },
        "tga_own": {
            "kind": "tga",
            "heating_rate_K_min": 10,
            "signals": {"mass_fraction": {"file": "data/run.csv"}},
        },
        "slab_60": SLAB,
        "slab_80": {**SLAB, "front": {"flux_W_m2": 80000, "h_W_m2K": 8}},
    },
    "accuracy": {"cells": 10},
    "synthetic": {
        "truth": {"T_p": 605, "E_p": 190, "rho": 1190, "k": 0.2},
        "accuracy": {"elements": 40, "tolerance": 1e-4},
    },
    "kinetics": {
        "estimate": ["T_p", "E_p"],
        "cost": [{"experiment": "tga_20K", "signal": "mass_fraction", "kind": "RMSE"}],
        "compare": ["tga_own"],
        "sceua": {"complexes": 2, "generations": 3},
        "least_squares": {"starts": 1},
        "sets": {
            "known": {
                "reactions": {"pyrolysis": {"A_1_s": 2.5e13, "E_J_mol": 190e3}},
                "composition": {"polymer": 1.0},
            }
        },
    },
    "imp": {
        "estimate": ["rho", "k"],
        "kinetics": "fitted",
        "repetitions": 2,
        "sceua": {"complexes": 2, "generations": 3},
        "least_squares": {"starts": 1},
        "cmaes": {"starts": 1, "calls": 30},
        "costs": {
            "RMSE": [{**TERM, "kind": "RMSE"}],
            "RANGE": [{**TERM, "kind": "RANGE", "options": {"r": 0.05}}],
        },
    },
    "validation": {"experiments": ["slab_60", "slab_80"]},
    "steps": {"robustness": {"noise": [1], "outliers": [0.1], "draws": 1, "starts": 1}},
}
OWN_FILE = "Time,Temperature,Mass\n[s],[K],[mg]\n" + "".join(
    f"{60 * i},{500 + 10 * i},{5.0 if i < 10 else 1.0}\n" for i in range(20)
)


@dataclass(frozen=True)
class Run:
    """How a call of Snakemake ended."""

    code: int
    said: str

    @property
    def jobs(self) -> set[str]:
        """Messages of the jobs that ran, or that a dry run lists."""
        planned = re.findall(r"^Job \d+: (.*)$", self.said, re.M)
        begun = re.findall(r"^ *\d+/\d+  (?!done in|failed$)(.*)$", self.said, re.M)
        return {*planned, *begun}


@dataclass(frozen=True)
class Project:
    """A copy of the project, with a study of its own in ``mine/``."""

    root: Path

    @classmethod
    def copy(cls, source: Path, to: Path) -> "Project":
        """Copy what a run needs; copies share the compiled kernels, which are named by content."""
        compiled = [path for path in (source / KERNELS).glob("*") if path.is_dir()]
        own = {path.resolve() for path in compiled}
        for folder in ("src", "workflow", "profiles", "config"):
            shutil.copytree(
                source / folder,
                to / folder,
                ignore=lambda at, names: [n for n in names if (Path(at) / n).resolve() in own],
            )
        for path in compiled:
            (to / KERNELS / path.name).symlink_to(path.resolve())
        for name in ("Snakefile", "pyproject.toml"):
            shutil.copy2(source / name, to)
        project = cls(to)
        (to / "mine" / "data").mkdir(parents=True)
        (to / "mine" / "data" / "run.csv").write_text(OWN_FILE)
        project.write(TINY)
        return project

    def write(self, study: object) -> None:
        """Write the study file."""
        (self.root / "mine" / "tiny.yaml").write_text(yaml.safe_dump(study, sort_keys=False))

    def change(self, place: str, value: object) -> None:
        """Write the tiny study with one value changed."""
        study = json.loads(json.dumps(TINY))
        *above, last = place.split(".")
        part = study
        for key in above:
            part = part[int(key)] if isinstance(part, list) else part[key]
        part[last] = value
        self.write(study)

    @property
    def environment(self) -> dict[str, str]:
        """The environment in which the copy's source is imported."""
        programs = Path(sys.executable).parent
        return {
            **os.environ,
            "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
            "PYTHONPATH": str(self.root / "src"),
            "XDG_CACHE_HOME": str(self.root / "cache"),
        }

    def start(self, *arguments: str) -> "subprocess.Popen[str]":
        """Start Snakemake on the tiny study."""
        return subprocess.Popen(
            ["snakemake", "--nocolor", "--configfile", "mine/tiny.yaml", *arguments],
            cwd=self.root,
            env=self.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )

    def snakemake(self, *arguments: str) -> Run:
        """Run Snakemake on the tiny study."""
        with self.start(*arguments) as process:
            said, _ = process.communicate()
        return Run(process.returncode, said)

    def plan(self, *arguments: str) -> set[str]:
        """Return the messages of the jobs that a run would start."""
        run = self.snakemake("--dry-run", *arguments)
        assert run.code == 0, run.said
        return run.jobs

    def read(self, name: str) -> bytes:
        return (self.root / name).read_bytes()


def kill(process: "subprocess.Popen[str]") -> None:
    """Kill a run and all it started, as a loss of power would.

    Jobs may have lost their parent, and external programs have sessions of their own.
    """
    started: list[psutil.Process] = []
    with contextlib.suppress(psutil.NoSuchProcess):
        run = psutil.Process(process.pid)
        started = [run, *run.children(recursive=True)]
    for one in [*started, *psutil.process_iter()]:
        with contextlib.suppress(OSError, psutil.NoSuchProcess):
            if one in started or os.getsid(one.pid) == process.pid:
                one.kill()
