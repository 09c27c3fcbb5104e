"""Share of the solver's lanes that SCE-UA's searches of one cost fill.

    python benchmarks/fill.py config/paper.yaml results/paper RMSE

Needs the kinetics of a finished campaign. All repetitions of the cost run in one job, as in the
workflow, in a temporary folder.
"""

import shutil
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from pyrofit.config import read_study
from pyrofit.estimate import sceua
from pyrofit.estimate.turns import in_turns
from pyrofit.results.files import Results
from pyrofit.solver.run import LANES
from pyrofit.stages import fit

SIZES: Counter[int] = Counter()
"""How often the solver is asked for a number of sets at once."""


def counted(
    searches: Sequence[Any], answer: Callable[[list[Any]], Sequence[Any]], together: int = 1
) -> list[Any]:
    """Run searches in turns, and count their questions."""

    def counting(questions: list[Any]) -> Sequence[Any]:
        SIZES[len(questions)] += 1
        return answer(questions)

    return in_turns(searches, counting, together)


def main() -> None:
    """Print the share of the lanes that are filled."""
    study, finished, cost = read_study(Path(sys.argv[1])), Path(sys.argv[2]), sys.argv[3]
    sceua.in_turns = counted  # type: ignore[attr-defined]
    with tempfile.TemporaryDirectory() as folder:
        for part in ("measurements", "kinetics"):
            shutil.copytree(finished / part, Path(folder) / part)
        fit.repeat(study, Results(Path(folder)), cost, range(study.imp.repetitions))
    sets = sum(size * times for size, times in SIZES.items())
    lanes = sum(-(-size // LANES) * LANES * times for size, times in SIZES.items())
    print(f"{sets:,} model calls fill {100.0 * sets / lanes:.1f} % of the lanes")


if __name__ == "__main__":
    main()
