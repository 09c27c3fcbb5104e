"""The whole of config/paper.yaml on two cores, and where its time goes."""

import re
import shutil
import subprocess
import tempfile
import time
from collections import defaultdict
from pathlib import Path

import startup
from page import filed

ROOT = Path(__file__).parents[1]
STUDY = Path("config") / "paper.yaml"
CORES = 2
NOTE = (
    f"`snakemake --cores {CORES} --configfile {STUDY}` in an empty folder, compiled code on disk: "
)
SIXTEEN = ("--cost", "RMSE", "--repetition", *map(str, range(16)))


def campaign() -> str:
    """Return wall times of the study and its jobs, and of sixteen repetitions in parts."""
    with tempfile.TemporaryDirectory() as folder:
        for name in ("workflow", "config", "profiles"):
            shutil.copytree(ROOT / name, Path(folder, name))
        shutil.copy(ROOT / "Snakefile", folder)
        took = run(folder)
        results = Path(folder, "results", STUDY.stem)
        jobs = of_jobs(results / "benchmarks")
        parts = startup.parts(results, ROOT / STUDY, SIXTEEN)
    return (
        f"{NOTE}**{took:.0f} s**. Wall times of its jobs, {CORES} at a time; the rest is planning, "
        f"reading, tables, figures and the page. {jobs}.\n\n"
        f"Sixteen repetitions side by side, nothing beside them:\n\n{parts}"
    )


def run(folder: str) -> float:
    """Run the study in a folder; return the time it takes [s]."""
    start = time.perf_counter()
    subprocess.run(
        ["snakemake", "--cores", str(CORES), "--configfile", str(STUDY)],
        cwd=folder,
        check=True,
        stdout=subprocess.DEVNULL,
    )
    return time.perf_counter() - start


def of_jobs(folder: Path) -> str:
    """File a table of the jobs of each kind, from the times measured by the workflow."""
    seconds = defaultdict(list)
    for path in folder.glob("*.tsv"):
        kind = re.sub(r"_[A-Z]+(_\d+)?$", "", path.stem)
        seconds[kind].append(
            float(path.read_text(encoding="utf-8").splitlines()[-1].split("\t")[0])
        )
    rows = sorted(seconds.items(), key=lambda row: -sum(row[1]))
    counted = [(kind, len(found), f"{sum(found):.0f}") for kind, found in rows]
    return filed("campaign_jobs", "Jobs and their times", ("jobs", "number", "s, in all"), counted)
