"""A finished campaign: the tables of its folder of results."""

import os
from pathlib import Path
from typing import Any

import pandas as pd

from pyrofit.analysis.answer import answer_values
from pyrofit.api.arguments import path_of
from pyrofit.api.choices import Signals, in_units
from pyrofit.api.comparison import Comparison, compare
from pyrofit.api.curves import MEASURED, Curves, with_unit_attributes
from pyrofit.api.tables import html_page
from pyrofit.config import Study, read_study
from pyrofit.errors import DataError, StudyError, suggest
from pyrofit.results import diagnosis, recorded
from pyrofit.results.files import Results
from pyrofit.results.kinetics import fixed_for_imp
from pyrofit.show.table import read_written_table
from pyrofit.stages.fit import best_set_of_each_cost


class Campaign:
    """The results of a campaign, read from their folder when they are asked for.

    ``campaign["table4"]`` is a table of the report.

    Parameters
    ----------
    folder
        Folder of the results, such as ``results/twin``.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._results = Results(folder)

    @property
    def study(self) -> Study:
        """The study as it was run, every key completed."""
        return read_study(self.folder / "study.json")

    @property
    def tables(self) -> list[str]:
        """Names of the tables."""
        return sorted(path.stem for path in (self.folder / "tables").glob("*.csv"))

    def __getitem__(self, name: str) -> pd.DataFrame:
        """Return a table by its name."""
        if name not in self.tables:
            raise DataError(f"{self.folder}: no table '{name}'. {suggest(name, self.tables)}")
        return read_written_table(self._results, name)

    @property
    def data(self) -> Curves:
        """The measured series as they were read."""
        study = self.study
        found = recorded.measured(study, self._results).series
        units = {
            key: with_unit_attributes(frame, study.experiments[key[0]].quantity(key[1]))
            for key, frame in found.items()
        }
        return Curves(study, units, MEASURED)

    @property
    def estimates(self) -> pd.DataFrame:
        """The answer: value, 95 % interval and verdict of each parameter, in its unit."""
        return self["answer"].set_index("parameter")

    @property
    def values(self) -> dict[str, float]:
        """The values of the answer with all given ones, in the units of the study.

        `pyrofit.simulate` takes them, with ``kinetics=study.imp.kinetics``.
        """
        study = self.study
        return in_units(study, answer_values(study, self._results))

    def best(self, cost: str) -> dict[str, float]:
        """Return the best set that SCE-UA found for a cost, in the units of the study.

        The kinetics and all fixed parameters are in it. `pyrofit.simulate` takes it, with
        ``kinetics=study.imp.kinetics``.
        """
        study = self.study
        sets = best_set_of_each_cost(study, self._results)
        if cost not in sets:
            raise StudyError(f"study '{study.name}' has no cost '{cost}'. {suggest(cost, sets)}")
        return in_units(study, {**fixed_for_imp(study, self._results), **sets[cost]})

    def predict(self, cost: str = "", signals: Signals | None = None) -> Comparison:
        """Compare the answer, or the best set of a cost, with the data of the validation."""
        study, chosen = self.study, signals
        values = self.best(cost) if cost else self.values
        if chosen is None:
            chosen = study.validation.experiments
        return compare(study, values, signals=chosen, data=self.data, kinetics=study.imp.kinetics)

    @property
    def diagnosis(self) -> dict[str, Any]:
        """The keys of ``diagnosis.json``, see docs/diagnosis_json.md."""
        return diagnosis.read(self.study, self._results).model_dump(by_alias=True)

    def __repr__(self) -> str:
        """List the tables."""
        return f"results in {self.folder}, tables: {', '.join(self.tables)}"

    def _repr_html_(self) -> str:
        rows = [{"table": name, "rows": len(self[name])} for name in self.tables]
        return html_page(f"results in {self.folder}", [("", pd.DataFrame(rows))])


def read_results(folder: str | os.PathLike[str]) -> Campaign:
    """Open the results of a campaign that Snakemake has run.

    Raises
    ------
    DataError
        The folder holds no results.
    """
    path = path_of("folder", folder)
    if not (path / "study.json").is_file():
        raise DataError(
            f"{path}: no results of a campaign; give the folder that holds study.json, such as "
            "results/twin"
        )
    return Campaign(path)
