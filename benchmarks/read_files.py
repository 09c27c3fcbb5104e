"""How many files of the MaCFP data base `pyrofit init` reads: see docs/own_study.md.

    python benchmarks/read_files.py

Takes each file below ``PYROFIT_DATA_DIR`` whose name tells a TGA, STA, DSC, MCC, cone, FPA or
gasification. A file needs an edit where a number, unit or column of the study is assumed; a number
with its unit in the name of the file counts as told.
"""

import os
import re
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from pyrofit.errors import DataError
from pyrofit.new_study.divisor import divisor_of, is_told
from pyrofit.new_study.draft import MeasuredFile, read_experiment

KINDS = {
    "tga": "TGA|STA",
    "dsc": "DSC",
    "mcc": "MCC",
    "cone": "CONE|FPA",
    "gasification": "CAPA|GASIF",
}
ENDINGS = {".csv", ".txt"}
TOLD = ("record", "file", "unit")


def kind_of(path: Path) -> str:
    """Return the kind of test that the name of a file tells; nothing where it tells none."""
    found = (k for k, words in KINDS.items() if re.search(rf"(_|-|\b)({words})", path.stem.upper()))
    other = path.suffix.lower() not in ENDINGS or "REFLECTIVITY" in path.stem
    return "" if other else next(found, "")


def edits(run: MeasuredFile) -> Iterator[str]:
    """Yield what has to be given or looked at in the study of a file."""
    of = "flux" if run.of.stage == "imp" else "heating rate"
    if run.told not in TOLD:
        yield of
    for found in run.signals:
        yield from (f"column of the {role}" for role in found.missing)
        yield from (f"unit of the {role}" for role in (*found.guessed, *found.unread))
        divisor = divisor_of(found)
        if divisor is not None and not is_told(found, divisor[0]):
            yield divisor[0]


def main() -> None:
    """Print how many files are read, by kind and by the edits that they need."""
    read: Counter[tuple[str, str]] = Counter()
    asked: Counter[str] = Counter()
    for path in sorted(Path(os.environ["PYROFIT_DATA_DIR"]).rglob("*")):
        if not (kind := kind_of(path)):
            continue
        try:
            run = read_experiment(kind, path)
        except DataError as error:
            read[kind, "refused"] += 1
            print(error, file=sys.stderr)
            continue
        needed = set(edits(run))
        whole = all(f.quantity in run.frames for f in run.signals if not f.missing and not f.unread)
        state = f"{min(len(needed), 2)} edits" if whole else "refused at check"
        read[kind, state] += 1
        asked.update(needed if whole else ())
        if not whole:
            print(path, "refused at check", file=sys.stderr)
    for (kind, state), count in sorted(read.items()):
        print(f"{kind:14}{state:18}{count:5}")
    for what, count in asked.most_common():
        print(f"{what:32}{count:5}")


if __name__ == "__main__":
    main()
