"""Time the steps that gather and show many repetitions: collect, figures and tables, report.

    python benchmarks/many_repetitions.py results/twin [--repetitions 1000]

The repetitions of a finished study are copied under other numbers until there are as many for each
cost, in a temporary folder. Nothing is fitted anew, and the study itself stays as it is.
"""

import argparse
import json
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

FILES = ("{}.json", "{}.csv.gz", "{}_convergence.csv")


def multiplied(finished: Path, to: Path, repetitions: int) -> Path:
    """Copy the results of a study, with more repetitions; return its description."""
    shutil.copytree(finished, to, ignore=shutil.ignore_patterns("running", "diagnosis"))
    for cost in (path for path in (to / "imp").iterdir() if path.is_dir()):
        known = sorted(path.stem for path in cost.glob("[0-9]*.json"))
        for n in range(len(known), repetitions):
            for name in FILES:
                source = cost / name.format(known[n % len(known)])
                shutil.copyfile(source, cost / name.format(f"{n:02d}"))
            record = json.loads((cost / f"{n:02d}.json").read_text())
            (cost / f"{n:02d}.json").write_text(json.dumps({**record, "repetition": n}))
    study = json.loads((to / "study.json").read_text())
    study["imp"]["repetitions"] = repetitions
    (to / "study.json").write_text(json.dumps(study))
    return to / "study.json"


def timed(study: Path, *step: str) -> None:
    """Run a step and print its wall and processor time."""
    command = [str(Path(sys.executable).with_name("pyrofit")), step[0], "--study", str(study)]
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    subprocess.run([*command, "--results", str(study.parent), *step[1:]], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(f"{' '.join(step):40s} {time.monotonic() - begin:6.1f} s, {cpu:6.1f} CPU s", flush=True)


def main() -> None:
    """Time the steps."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("finished", type=Path, help="results folder of a finished study")
    parser.add_argument("--repetitions", type=int, default=1000, help="for each cost")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        study = multiplied(given.finished, Path(folder) / "results", given.repetitions)
        timed(study, "collect")
        for subject in ("fit", "optimisation", "costs"):
            timed(study, "show", "--subject", subject)
        timed(study, "report")


if __name__ == "__main__":
    main()
