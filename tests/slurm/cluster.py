"""A Slurm cluster of virtual nodes on this machine, of Debian's packages, without system services.

    python tests/slurm/cluster.py start FOLDER     # needs root; installs what is not there
    python tests/slurm/cluster.py stop FOLDER

Everything but a link lies in the folder. Each node is a daemon with a port of its own. Nothing is
confined by the kernel: processes are found by their parents, and memory is looked at every second.
"""

import contextlib
import os
import secrets
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

PACKAGES = ("slurmctld", "slurmd", "slurm-client", "munge")
PROGRAMS = ("slurmctld", "slurmd", "squeue", "munged")
NODES = 3
CORES, MEMORY_MB = 4, 4000
"""Of a node: no job of the profile may ask for more."""
PARTITION = "main"
CLUSTER = "pyrofit_test"
LONGEST_WAIT_S = 30.0
LINK = Path("/etc/slurm/slurm.conf")
"""Where jobs look for the configuration: Snakemake's plugin takes SLURM_CONF away from them."""


class NoSlurmError(Exception):
    """Slurm cannot be installed or started here."""


def install() -> None:
    """Install the packages that are missing.

    Raises
    ------
    NoSlurmError
        This is not Debian, the user is not root, or the packages cannot be had.
    """
    if os.getuid() != 0:
        raise NoSlurmError("its daemons need root")
    if LINK.exists() and not LINK.is_symlink():
        raise NoSlurmError(f"{LINK} is that of a real cluster")
    if all(shutil.which(name) for name in PROGRAMS):
        return
    if shutil.which("apt-get") is None:
        raise NoSlurmError("there is no apt-get")
    install = ["install", "-y", "-qq", "--no-install-recommends", *PACKAGES]
    # No service is started: a policy that forbids it, as containers have.
    policy = Path("/usr/sbin/policy-rc.d")
    ours = not policy.exists()
    if ours:
        policy.write_text("#!/bin/sh\nexit 101\n")
        policy.chmod(0o755)
    try:
        for step in (["update", "-qq"], install):
            ran = subprocess.run(
                ["apt-get", "-o", "DPkg::Lock::Timeout=120", *step],
                env={**os.environ, "DEBIAN_FRONTEND": "noninteractive"},
                capture_output=True,
                text=True,
                check=False,
            )
            if ran.returncode:
                raise NoSlurmError(f"apt-get {step[0]}: {ran.stderr.strip().splitlines()[-1]}")
    finally:
        if ours:
            policy.unlink()


def configuration(folder: Path, port: int) -> str:
    """Return the text of slurm.conf."""
    host = socket.gethostname().partition(".")[0]
    keys = {
        "ClusterName": CLUSTER,
        "SlurmctldHost": f"{host}(127.0.0.1)",
        "SlurmctldPort": port,
        "AuthType": "auth/munge",
        "AuthInfo": f"socket={folder}/munge/socket",
        "SlurmUser": "root",
        "SlurmdUser": "root",
        "StateSaveLocation": folder / "state",
        "SlurmdSpoolDir": folder / "spool.%n",
        "SlurmctldPidFile": folder / "slurmctld.pid",
        "SlurmdPidFile": folder / "slurmd.%n.pid",
        "SlurmctldLogFile": folder / "slurmctld.log",
        "SlurmdLogFile": folder / "slurmd.%n.log",
        "ProctrackType": "proctrack/linuxproc",
        "TaskPlugin": "task/none",
        "SwitchType": "switch/none",
        "MpiDefault": "none",
        "SelectType": "select/cons_tres",
        "SelectTypeParameters": "CR_CPU_Memory",
        "SlurmdParameters": "config_overrides",
        "JobAcctGatherType": "jobacct_gather/linux",
        "JobAcctGatherFrequency": 1,
        "JobAcctGatherParams": "OverMemoryKill",
        "AccountingStorageType": "accounting_storage/none",
        "SchedulerParameters": "sched_interval=2,sched_min_interval=200000",
        "ReturnToService": 2,
        "KillWait": 2,
        "MinJobAge": 300,
    }
    lines = [f"{key}={value}" for key, value in keys.items()]
    lines += [
        f"NodeName=n{n} NodeHostname={host} NodeAddr=127.0.0.1 Port={port + n} CPUs={CORES} "
        f"RealMemory={MEMORY_MB} State=UNKNOWN"
        for n in range(1, NODES + 1)
    ]
    lines.append(f"PartitionName={PARTITION} Nodes=ALL Default=YES MaxTime=INFINITE State=UP")
    return "\n".join(lines) + "\n"


def start(folder: Path) -> None:
    """Start the daemons and wait until all nodes are idle.

    Raises
    ------
    NoSlurmError
        One of them does not start.
    """
    for name in ("munge", "state", *(f"spool.n{n}" for n in range(1, NODES + 1))):
        (folder / name).mkdir(parents=True)
    for open_to_all in (folder, folder / "munge"):
        open_to_all.chmod(0o755)
    key = folder / "munge" / "key"
    key.write_bytes(secrets.token_bytes(128))
    key.chmod(0o400)
    (folder / "slurm.conf").write_text(configuration(folder, _free_ports()))
    LINK.parent.mkdir(exist_ok=True)
    LINK.unlink(missing_ok=True)
    LINK.symlink_to(folder / "slurm.conf")
    munge = {"key-file": key, "socket": folder / "munge" / "socket"}
    munge |= {f"{name}-file": folder / "munge" / name for name in ("pid", "log", "seed")}
    _daemon(folder, "munged", "--force", "--foreground", *(f"--{k}={v}" for k, v in munge.items()))
    _wait("munged", (folder / "munge" / "socket").exists)
    _daemon(folder, "slurmctld", "-D")
    for n in range(1, NODES + 1):
        _daemon(folder, "slurmd", "-D", "-N", f"n{n}")
    _wait("slurmctld", lambda: "UP" in said("scontrol", "ping"))
    _wait("slurmd", lambda: len(said("sinfo", "-h", "-N", "-t", "idle").splitlines()) == NODES)


def stop(folder: Path) -> None:
    """End all jobs and the daemons that were started in a folder, by their numbers."""
    for job in said("squeue", "-h", "-o", "%A").split():
        said("scancel", job)
    with contextlib.suppress(NoSlurmError):
        _wait("jobs", lambda: not said("squeue", "-h"))
    for path in sorted(folder.glob("*.number"), reverse=True):
        number, name = int(path.read_text()), path.name.partition(".")[2].partition(".")[0]
        for kind in (signal.SIGTERM, signal.SIGKILL):
            if not _is(number, name):
                break
            os.kill(number, kind)
            with contextlib.suppress(NoSlurmError):
                _wait(name, lambda number=number, name=name: not _is(number, name), 10.0)
        path.unlink()
    for number in _left_of_jobs():
        with contextlib.suppress(ProcessLookupError):
            os.kill(number, signal.SIGKILL)
    if LINK.is_symlink() and LINK.readlink() == folder / "slurm.conf":
        LINK.unlink()


def said(*command: str) -> str:
    """Return the output of a command of Slurm; nothing if it fails."""
    try:
        ran = subprocess.run(command, capture_output=True, text=True, check=False, timeout=20)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return ran.stdout if ran.returncode == 0 else ""


def _daemon(folder: Path, name: str, *options: str) -> None:
    """Start a daemon in a session of its own; keep its number and its output."""
    n = len(list(folder.glob("*.number")))
    with (folder / f"{n}.{name}.said").open("w") as output:
        process = subprocess.Popen(
            [name, *options], stdout=output, stderr=output, start_new_session=True
        )
    (folder / f"{n}.{name}.number").write_text(str(process.pid))


def _is(number: int, name: str) -> bool:
    """Return whether a number still is that of a running daemon."""
    try:
        text = Path(f"/proc/{number}/stat").read_text()
    except OSError:
        return False
    inside, _, after = text.partition("(")[2].rpartition(")")
    return inside == name and after.split()[0] != "Z"


def _left_of_jobs() -> list[int]:
    """Return the processes of jobs whose node was put down: nobody ends them."""
    mine = f"SLURM_CLUSTER_NAME={CLUSTER}".encode()
    found = []
    for path in Path("/proc").glob("[0-9]*/environ"):
        with contextlib.suppress(OSError):
            if mine in path.read_bytes().split(b"\0"):
                found.append(int(path.parent.name))
    return found


def _wait(what: str, ready: Callable[[], bool], longest_s: float = LONGEST_WAIT_S) -> None:
    give_up = time.monotonic() + longest_s
    while not ready():
        if time.monotonic() > give_up:
            raise NoSlurmError(f"{what} is not ready after {longest_s:g} s")
        time.sleep(0.1)


def _free_ports() -> int:
    """Return the first of as many free ports in a row as the daemons need."""
    for first in range(16817, 30000, 10):
        with contextlib.suppress(OSError), contextlib.ExitStack() as stack:
            for port in range(first, first + NODES + 1):
                stack.enter_context(socket.socket()).bind(("127.0.0.1", port))
            return first
    raise NoSlurmError("no port is free")


if __name__ == "__main__":
    command, place = sys.argv[1], Path(sys.argv[2]).resolve()
    try:
        if command == "start":
            install()
            start(place)
        else:
            stop(place)
    except NoSlurmError as reason:
        sys.exit(f"no Slurm here: {reason}")
