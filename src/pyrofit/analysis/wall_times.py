"""Wall times of the searches, where the workflow has measured them."""

from pyrofit.analysis.uses import SCEUA
from pyrofit.config import Study
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.results.files import Results

_FILES = {
    SCEUA: "imp_{}_[0-9]*",
    **{by.words: f"{key}_{{}}" for key, by in OPTIMISERS.items()},
}


def wall_times(study: Study, results: Results) -> dict[str, list[float]]:
    """Return the wall times of all jobs of each optimiser [s], all cost functions."""
    folder = results.root / "benchmarks"
    return {
        by: [
            float(path.read_text().splitlines()[-1].split("\t")[0])
            for cost in study.imp.costs
            for path in sorted(folder.glob(f"{pattern.format(cost)}.tsv"))
        ]
        for by, pattern in _FILES.items()
    }
