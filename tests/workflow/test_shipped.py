"""The workflow as others have it: by another interpreter, in another workflow, installed."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from tiny import FIT, OWN_FILE, ROOT, TINY

from pyrofit.running.terminal import SAME_COMMAND

SUMMARY = "results/tiny/measurements/summary.json"
OUTER = f"""
configfile: "config.yaml"

rule own:
    input: {SUMMARY!r}
    output: "own.txt"
    shell: "cp {{input}} {{output}}"

module pyrofit:
    snakefile: {str(ROOT / "workflow" / "Snakefile")!r}
    config: config["pyrofit"]

use rule * from pyrofit as pyrofit_*
"""


def snakemake(folder: Path, *arguments: str, path: str = os.defpath) -> str:
    """Run Snakemake in a folder, and return what it said; programs are found along ``path``."""
    ran = subprocess.run(
        [Path(sys.executable).parent / "snakemake", "--nocolor", "--cores", "1", *arguments],
        cwd=folder,
        env={**os.environ, "PATH": path, "PYTHONPATH": str(ROOT / "src")},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    assert ran.returncode == 0, ran.stdout
    return ran.stdout


def test_jobs_run_by_the_interpreter_that_runs_snakemake(tmp_path: Path) -> None:
    # Neither the pyrofit of PATH nor modules of the working folder are taken.
    other = tmp_path / "bin" / "pyrofit"
    other.parent.mkdir()
    other.write_text("#!/bin/sh\nexit 1\n")
    other.chmod(0o755)
    (tmp_path / "pyrofit.py").write_text("raise SystemExit(1)\n")
    write_study(tmp_path)
    path = f"{other.parent}{os.pathsep}{os.defpath}"
    study = ("--snakefile", str(ROOT / "Snakefile"), "--configfile", "tiny.yaml")
    snakemake(tmp_path, SUMMARY, *study, path=path)
    assert (tmp_path / SUMMARY).is_file()


@pytest.mark.parametrize("inline", [True, False], ids=["keys", "file"])
def test_workflow_is_a_module_of_another_one(tmp_path: Path, inline: bool) -> None:
    write_study(tmp_path)
    # To Snakemake, 1e-3 is text.
    text = yaml.safe_dump(TINY).replace("0.001", "1e-3") if inline else "study: tiny.yaml\n"
    assert ("1e-3" in text) == inline
    lines = "".join(f"  {line}\n" for line in text.splitlines())
    (tmp_path / "config.yaml").write_text(f"pyrofit:\n{lines}")
    (tmp_path / "Snakefile").write_text(OUTER)
    planned = snakemake(tmp_path, "--dry-run", "pyrofit_all")
    assert "pyrofit_imp_RMSE_00" in planned
    assert [path.name for path in tmp_path.glob("results/tiny/*")] == ["inputs"]
    snakemake(tmp_path)
    assert (tmp_path / "own.txt").read_bytes() == (tmp_path / SUMMARY).read_bytes()
    assert "Nothing to be done" in snakemake(tmp_path)


def test_run_tells_its_steps_and_where_it_stops_the_reason_and_the_way_out(tmp_path: Path) -> None:
    write_study(tmp_path)

    def run(target: str) -> tuple[int, list[str]]:
        ran = subprocess.run(
            [Path(sys.executable).parent / "pyrofit", "run", "tiny.yaml", target],
            cwd=tmp_path,
            env={**os.environ, "PATH": os.defpath, "PYTHONPATH": str(ROOT / "src")},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )
        return ran.returncode, ran.stdout.splitlines()

    code, lines = run(SUMMARY)
    assert code == 0, lines
    title = "Measured series into tidy tables, mass closure checked"
    assert lines[:2] == ["1 step", f"1/1  {title}"]
    assert re.fullmatch(r"1/1  done in \d+ s", lines[-1])
    assert run(SUMMARY) == (0, ["Everything is made already: nothing to do."])

    broken = "results/tiny/measurements/tga_20K_mass_fraction.csv"
    (tmp_path / broken).write_text("broken\n")
    code, lines = run(FIT)
    assert code == 1
    assert lines[:3] == ["1 step", "1/1  Kinetics fitted to heated samples", "1/1  failed"]
    assert lines[4].startswith(f"Kinetics fitted to heated samples: {broken}: ")
    assert lines[-2:] == ["Log: results/tiny/logs/kinetics.log", SAME_COMMAND]
    assert "Traceback" not in "".join(lines)

    code, lines = run("postrior")
    assert (code, len(lines)) == (1, 1)
    assert "there is no target 'postrior'" in lines[0]


def write_study(folder: Path) -> None:
    (folder / "data").mkdir()
    (folder / "data" / "run.csv").write_text(OWN_FILE)
    (folder / "tiny.yaml").write_text(yaml.safe_dump(TINY, sort_keys=False))
