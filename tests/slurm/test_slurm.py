"""The study `smoke` on a real Slurm through the shipped profile, with faults: `make test-slurm`."""

import contextlib
import hashlib
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import psutil
import pytest
import yaml
from cluster import MEMORY_MB, PARTITION, said

ROOT = Path(__file__).parents[2]
SMOKE = ("--configfile", "config/smoke.yaml")
OF_THE_RUN = ("logs", "benchmarks", "running")
"""Folders whose files may differ between two runs."""
CALCULATED = (
    *("compare", "predict", "identify", "identify_kinetics"),
    *(f"results/smoke/imp/{cost}/descent.json" for cost in ("RMSE", "RANGE", "BANDS")),
)
"""Rules and results that need all calculations."""
SHOWN = tuple(f"results/smoke/tables/{name}.csv" for name in ("table3", "validation"))
"""Two of the tables, which a group makes; all of them take longer than a test may."""
HANGS = "imp_BANDS_00"
"""The job whose calculation is stopped."""
GROUPS = ("shown", "descents", "searches")
LITTLE_MB = 120
"""Less memory than a job of Snakemake needs."""


@pytest.fixture(scope="module")
def slurm(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Run a cluster of some nodes; skip where that cannot be."""
    folder = tmp_path_factory.mktemp("slurm")
    # Users of the daemons reach their sockets.
    for place in (folder, *folder.parents[:2]):
        place.chmod(place.stat().st_mode | 0o055)
    script = Path(__file__).with_name("cluster.py")
    try:
        ran = subprocess.run(
            [sys.executable, script, "start", folder], capture_output=True, text=True, check=False
        )
        if ran.returncode:
            pytest.skip(ran.stderr.strip())
        yield
    finally:
        subprocess.run([sys.executable, script, "stop", folder], check=True)


@dataclass
class Project:
    """A folder in which a study runs, with the source of this project."""

    root: Path

    def __post_init__(self) -> None:
        for folder in ("workflow", "profiles", "config"):
            shutil.copytree(ROOT / folder, self.root / folder)
        shutil.copy2(ROOT / "Snakefile", self.root)

    def change_profile(self, changes: dict[str, Any]) -> None:
        """Change keys of the profile; of default-resources and set-resources, entries."""
        path = self.root / "profiles" / "slurm" / "config.yaml"
        profile = yaml.safe_load(path.read_text(encoding="utf-8"))
        for key, value in changes.items():
            profile[key] = profile[key] | value if isinstance(value, dict) else value
        path.write_text(yaml.safe_dump(profile), encoding="utf-8")

    def start(self, *arguments: str) -> "subprocess.Popen[str]":
        """Start Snakemake on the study."""
        programs = Path(sys.executable).parent
        paths = (str(ROOT / "src"), os.environ.get("PYTHONPATH", ""))
        with (self.root / "said").open("w") as output:
            return subprocess.Popen(
                ["snakemake", "--nocolor", *arguments, *SMOKE],
                cwd=self.root,
                env={
                    **os.environ,
                    "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
                    "PYTHONPATH": os.pathsep.join(path for path in paths if path),
                },
                stdout=output,
                stderr=output,
                text=True,
                start_new_session=True,
            )

    @property
    def said(self) -> str:
        """What Snakemake said so far."""
        return (self.root / "said").read_text(encoding="utf-8")

    def bits(self) -> dict[str, str]:
        """Return the digests of all results."""
        root = self.root / "results" / "smoke"
        return {
            path.relative_to(root).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in root.rglob("*")
            if path.is_file() and path.relative_to(root).parts[0] not in OF_THE_RUN
        }


@dataclass
class Watch:
    """Looks at the queue, notes what jobs ask for, and does something to some that run."""

    faults: dict[str, Callable[[str, str], bool]]
    """In order, by the start of a rule's name; called with a job's number and node until True."""
    asked: dict[str, tuple[int, int, str]] = field(default_factory=dict)
    """Cores, memory [MB] and time of each job."""
    done: list[str] = field(default_factory=list)
    """Rules to which something was done."""

    def look(self, process: "subprocess.Popen[str]", longest_s: float) -> None:
        """Look until a process ends, which is killed after some time."""
        give_up = time.monotonic() + longest_s
        while process.poll() is None:
            if time.monotonic() > give_up:
                os.killpg(process.pid, signal.SIGKILL)
            for line in said("squeue", "-h", "-o", "%A|%T|%C|%m|%l|%N|%k").splitlines():
                job, state, cores, memory, limit, node, comment = line.split("|")
                rule = comment.removeprefix("rule_")
                self.asked[rule] = int(cores), int(memory.removesuffix("M")), limit
                wanted = next(iter(self.faults), "none")
                here = state == "RUNNING" and rule.startswith(wanted)
                if here and self.faults[wanted](job, node):
                    del self.faults[wanted]
                    self.done.append(rule)
            time.sleep(0.5)


def cancel(job: str, node: str) -> bool:
    """Cancel a job, as its user might."""
    said("scancel", job)
    return True


def lose_node(job: str, node: str) -> bool:
    """Put the node of a job down, and up again a bit later; not that of the job that hangs."""
    if HANGS in said("squeue", "-h", "-w", node, "-o", "%k"):
        return False
    said("scontrol", "update", f"nodename={node}", "state=down", "reason=test")
    again = ("scontrol", "update", f"nodename={node}", "state=resume")
    threading.Timer(5.0, said, again).start()
    return True


def let_hang(job: str, node: str) -> bool:
    """Stop the calculation of a job, which then lasts longer than it may: a minute."""
    for process in psutil.process_iter():
        with contextlib.suppress(psutil.Error):
            if process.environ().get("SLURM_JOB_ID") == job and "-m pyrofit" in " ".join(
                process.cmdline()[:4]
            ):
                process.suspend()
                said("scontrol", "update", f"jobid={job}", "TimeLimit=1")
                return True
    return False


@pytest.fixture(scope="module")
def starved(
    slurm: None, tmp_path_factory: pytest.TempPathFactory
) -> "tuple[Project, subprocess.Popen[str]]":
    """Start a run with too little memory, which goes on beside the other one."""
    project = Project(tmp_path_factory.mktemp("starved") / "project")
    project.change_profile(
        {
            "default-resources": {"slurm_partition": PARTITION, "mem_mb": LITTLE_MB},
            "set-resources": {},
            "slurm-init-seconds-before-status-checks": 2,
            "retries": 0,
        }
    )
    return project, project.start("--workflow-profile", "profiles/slurm", "kinetics")


def test_profile_finishes_with_the_bits_of_a_local_run_whatever_happens_to_jobs(
    starved: "tuple[Project, subprocess.Popen[str]]", tmp_path: Path
) -> None:
    """Jobs are cancelled, lose their node, hang, and have too little memory at first."""
    here, there = Project(tmp_path / "here"), Project(tmp_path / "there")
    there.change_profile(
        {
            "default-resources": {"slurm_partition": PARTITION},
            "set-resources": {"kinetics": {"mem_mb": f"{LITTLE_MB} if attempt == 1 else 1300"}},
            "slurm-init-seconds-before-status-checks": 2,
            "latency-wait": 10,
        }
    )
    targets = (*CALCULATED, *SHOWN)
    begun = time.monotonic()
    on_slurm = there.start("--workflow-profile", "profiles/slurm", *targets)
    locally = here.start("--cores", "1", *targets)
    watch = Watch({"imp_RMSE_00": cancel, HANGS: let_hang, "imp_RANGE": lose_node})
    watch.look(on_slurm, 600.0)
    assert locally.wait() == 0, here.said
    print(f"on Slurm, with faults in {', '.join(watch.done)}: {time.monotonic() - begun:.0f} s")
    text = there.said
    assert on_slurm.returncode == 0, text
    assert len(watch.done) == 3, watch
    for state in ("CANCELLED", "NODE_FAIL", "TIMEOUT", "FAILED"):
        assert f"SLURM status is: '{state}'" in text
    assert "Traceback" not in text
    assert there.bits() == here.bits()
    assert len(here.bits()) > 60
    groups = {name: asked for name, asked in watch.asked.items() if name.split("_")[0] in GROUPS}
    assert len(groups) == len(GROUPS)
    for cores, memory, limit in groups.values():
        assert cores == 1
        assert memory <= MEMORY_MB
        assert limit in ("10:00", "30:00", "1:00:00")


def test_job_that_always_needs_more_memory_than_it_may_have_stops_the_run_with_the_cause(
    starved: "tuple[Project, subprocess.Popen[str]]",
) -> None:
    project, run = starved
    assert run.wait(timeout=300) != 0
    assert "kinetics (Slurm job " in project.said
    assert "needed more memory than it had asked for; raise its mem_mb" in project.said
    assert "Traceback" not in project.said
