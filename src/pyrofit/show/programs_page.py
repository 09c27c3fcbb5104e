"""The external programs of a study, as a section of the report."""

from typing import Any

import pandas as pd

from pyrofit.config import Study
from pyrofit.config.expand.programs import externals
from pyrofit.external.store import Store
from pyrofit.results.files import Results
from pyrofit.results.trial import timed_runs
from pyrofit.show.page import Page
from pyrofit.show.table import Table


def was_tried(study: Study, results: Results) -> bool:
    """Whether external programs simulate experiments, and have been tried."""
    return bool(externals(study)) and results.programs("trial.json").is_file()


def origin_of_runs(results: Results) -> dict[str, Any]:
    """Return command, program, version and checksums of the runs by experiment.

    Raises
    ------
    DataError
        The record of the timed run is missing or broken.
    """
    left_out = {"seconds", "time_limit_s"}
    return {name: one.model_dump(exclude=left_out) for name, one in timed_runs(results).items()}


def _table(study: Study, results: Results) -> pd.DataFrame:
    rows = []
    for name, one in timed_runs(results).items():
        runs, reasons = Store(str(results.programs(name))).counts()
        often = reasons.most_common(1)
        rows.append(
            {
                "experiment": study.experiments[name].title or name,
                "program": " ".join(filter(None, [one.executable, one.version])),
                "sha256": one.sha256[:12],
                "seconds": one.seconds,
                "runs": runs,
                "failed": sum(reasons.values()),
                "why": f"{often[0][0]} ({often[0][1]})" if often else "",
            }
        )
    return pd.DataFrame(rows)


TABLE = Table(
    place=10,
    make=_table,
    title="External programs",
    note="Runs: parameter sets whose run succeeded. The folder `failed` holds a record of every "
    "failed one.",
    headings={
        "sha256": "SHA-256 of the program",
        "seconds": "one run [s]",
        "why": "most frequent reason (runs)",
    },
)


PAGE = Page(
    "programs",
    heading="External programs",
    text="Other programs simulate these experiments. Each run fills a template, starts the program "
    "and reads its output.",
    tables={"programs": TABLE},
    figures={},
    written=False,
    exists=was_tried,
)
