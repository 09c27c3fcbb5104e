"""Simulated curves of many parameter sets."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from pyrofit.api.choices import Key
from pyrofit.api.tables import html_page
from pyrofit.config import Study
from pyrofit.config.resolve import diagnosed_material
from pyrofit.errors import StudyError, suggest
from pyrofit.experiments import kind_of
from pyrofit.solver.arrays import FloatArray, Values
from pyrofit.solver.curves import Request


@dataclass(frozen=True, eq=False)
class Ensemble:
    """Curves of many parameter sets by experiment and signal, in SI units.

    ``ensemble["slab_25", "mlr"]`` is a table with a row for each time and a column for each set.
    Its index is ``time_s``, with ``temperature_K`` beside it for heated samples.

    Parameters
    ----------
    study
        The study that describes the experiments.
    sets
        The parameter sets, one a row, in the units of the study.
    arrays
        Values by experiment and signal, shape (sets, points); NaN where a run does not finish.
    times
        Times [s] by experiment and signal, or times and temperatures [K]; of ``points`` entries.
    failed
        By set why a run of it did not finish; empty where all did.
    """

    study: Study
    sets: pd.DataFrame
    arrays: Mapping[Key, FloatArray]
    times: Mapping[Key, pd.Index]
    failed: pd.Series

    def __getitem__(self, key: Key) -> pd.DataFrame:
        """Return a signal: a row for each time, a column for each set."""
        if key not in self.arrays:
            named = ".".join(map(str, key)) if isinstance(key, tuple) else str(key)
            known = suggest(named, [".".join(k) for k in self.arrays])
            raise StudyError(f"there is no simulated series {key!r}; name a pair. {known}")
        return pd.DataFrame(
            self.arrays[key].T, index=self.times[key], columns=self.sets.index, copy=True
        )

    def __iter__(self) -> Iterator[Key]:
        """Go through the pairs of experiment and signal."""
        return iter(self.arrays)

    def __len__(self) -> int:
        """Return the number of series."""
        return len(self.arrays)

    def keys(self) -> list[Key]:
        """Return the pairs of experiment and signal."""
        return list(self.arrays)

    @property
    def frame(self) -> pd.DataFrame:
        """All values in one table.

        Columns: set, experiment, signal, time_s, temperature_K, value, unit (SI).
        """
        parts = []
        for (name, signal), values in self.arrays.items():
            at = self.times[name, signal].to_frame(index=False)
            sets, points = values.shape
            columns = {
                "set": self.sets.index.repeat(points),
                "experiment": name,
                "signal": signal,
                "time_s": np.tile(at["time_s"], sets),
                "temperature_K": np.tile(at.get("temperature_K", np.full(points, np.nan)), sets),
                "value": values.ravel(),
                "unit": self.study.experiments[name].quantity(signal).unit,
            }
            parts.append(pd.DataFrame(columns))
        return pd.concat(parts, ignore_index=True)

    def __repr__(self) -> str:
        """List the series."""
        rows = [f"  {name}, {s}: {self.arrays[name, s].shape[1]} points" for name, s in self]
        failed = f", {len(self.failed)} of which failed" if len(self.failed) else ""
        return "\n".join(
            [f"{len(self.sets)} sets of study '{self.study.name}'{failed}, simulated", *rows]
        )

    def _repr_html_(self) -> str:
        rows = [
            {"experiment": name, "signal": signal, "sets": a.shape[0], "points": a.shape[1]}
            for (name, signal), a in self.arrays.items()
        ]
        return html_page(f"simulated sets of {self.study.name}", [("", pd.DataFrame(rows))])


def ensemble_of(
    study: Study,
    sets: pd.DataFrame,
    values: Values,
    requests: Mapping[str, Mapping[str, Request]],
) -> Ensemble:
    """Simulate sets side by side; values in SI units, a number or shape (sets,) by name."""
    material, count = diagnosed_material(study), len(sets)
    arrays: dict[Key, FloatArray] = {}
    times: dict[Key, pd.Index] = {}
    failed: dict[int, str] = {}
    for name, asked in requests.items():
        experiment = study.experiments[name]
        simulate = kind_of(experiment).simulate
        [runs] = simulate([experiment], material, values, [asked], study.accuracy, count)
        for s, run in enumerate(runs):
            if not run.status.finished:
                failed.setdefault(s, f"experiments.{name}: {run.status.explanation}")
        for signal, request in asked.items():
            nothing = np.full(request.time_s.size, np.nan)
            arrays[name, signal] = np.array(
                [run.signals[signal] if run.status.finished else nothing for run in runs]
            )
            times[name, signal] = _index(request, experiment.quantity(signal).against_temperature)
    whys = pd.Series([failed[s] for s in sorted(failed)], sets.index[sorted(failed)], dtype=str)
    return Ensemble(study, sets, arrays, times, whys.rename("failed"))


def _index(request: Request, heated: bool) -> pd.Index:
    if not heated:
        return pd.Index(request.time_s, name="time_s")
    both = [request.time_s, request.programme()[0]]
    return pd.MultiIndex.from_arrays(both, names=["time_s", "temperature_K"])
