"""Measured or simulated series by experiment and signal."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import pandas as pd

from pyrofit.api import plots
from pyrofit.api.choices import Key
from pyrofit.api.tables import html_page
from pyrofit.config import Study
from pyrofit.errors import StudyError, suggest
from pyrofit.quantities.base import Quantity

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MEASURED, SIMULATED = "measured", "simulated"
"""Kinds of series, in words."""


@dataclass(frozen=True, eq=False)
class Curves:
    """Series by experiment and signal.

    ``curves["slab_25", "mlr"]`` is a table of one signal, in SI units: ``time_s``,
    ``temperature_K`` of heated samples, the value, and its uncertainty where it is known.
    ``curves["slab_25"]`` has all signals of an experiment side by side. Columns name their units;
    ``table.attrs["units"]`` has them as well.

    Parameters
    ----------
    study
        The study that describes the experiments.
    series
        Tables by experiment and signal.
    words
        Kind of the series: 'measured' or 'simulated'.
    """

    study: Study
    series: Mapping[Key, pd.DataFrame]
    words: str

    def __getitem__(self, key: str | Key) -> pd.DataFrame:
        """Return a signal, or all signals of an experiment side by side."""
        if isinstance(key, tuple):
            if key not in self.series:
                known = suggest(".".join(map(str, key)), [".".join(k) for k in self.series])
                raise StudyError(f"there is no {self.words} series {key}. {known}")
            return self.series[key]
        of = [frame for (name, _), frame in self.series.items() if name == key]
        if not of:
            known = suggest(str(key), {name for name, _ in self.series})
            raise StudyError(f"there is no {self.words} series of '{key}'. {known}")
        return beside(of)

    def __iter__(self) -> Iterator[Key]:
        """Go through the pairs of experiment and signal."""
        return iter(self.series)

    def __contains__(self, key: object) -> bool:
        """Tell whether there is a pair of experiment and signal, or any signal of an experiment."""
        return key in self.series or any(name == key for name, _ in self.series)

    def __len__(self) -> int:
        """Return the number of series."""
        return len(self.series)

    def keys(self) -> list[Key]:
        """Return the pairs of experiment and signal."""
        return list(self.series)

    def values(self) -> list[pd.DataFrame]:
        """Return the tables."""
        return list(self.series.values())

    def get(self, key: str | Key, default: Any = None) -> Any:
        """Return a signal, or all signals of an experiment; ``default`` where there is none."""
        if key in self:
            return self[key]
        return default

    def items(self) -> list[tuple[Key, pd.DataFrame]]:
        """Return the pairs of experiment and signal with their tables."""
        return list(self.series.items())

    @property
    def frame(self) -> pd.DataFrame:
        """All series in one table.

        Columns: experiment, signal, time_s, temperature_K, value, unit (SI).
        """
        parts = []
        for (name, signal), frame in self.series.items():
            quantity = self.study.experiments[name].quantity(signal)
            columns = {
                "experiment": name,
                "signal": signal,
                "time_s": frame["time_s"],
                "temperature_K": frame.get("temperature_K", float("nan")),
                "value": frame[quantity.column],
                "unit": quantity.unit,
            }
            parts.append(pd.DataFrame(columns))
        return pd.concat(parts, ignore_index=True)

    def plot(
        self,
        experiment: str | Key,
        signal: str | None = None,
        ax: "Axes | None" = None,
        **style: Any,
    ) -> "Axes":
        """Draw a signal on ``ax``, by default on a new one; ``style`` goes to Matplotlib."""
        key = plots.chosen(list(self.series), experiment, signal)
        ax = plots.axes_of(ax)
        plots.draw_series(ax, self.study, key, self.series[key], {"label": self.words, **style})
        return ax

    def __repr__(self) -> str:
        """List the series."""
        rows = []
        for (name, signal), frame in self.series.items():
            rows.append(f"  {name}, {signal}: {len(frame)} points")
            rows += [f"    {note}" for note in frame.attrs.get("notes", [])]
        return "\n".join([f"{self.words} series of study '{self.study.name}'", *rows])

    def _repr_html_(self) -> str:
        rows = [
            {
                "experiment": name,
                "signal": self.study.experiments[name].words(signal),
                "points": len(frame),
                "to [s]": float(frame["time_s"].max()),
                "columns": ", ".join(frame.columns),
                "notes": "; ".join(frame.attrs.get("notes", [])),
            }
            for (name, signal), frame in self.series.items()
        ]
        table = pd.DataFrame(rows)
        table = table if any(table["notes"]) else table.drop(columns="notes")
        return html_page(f"{self.words} series of {self.study.name}", [("", table)])


def with_unit_attributes(frame: pd.DataFrame, quantity: Quantity) -> pd.DataFrame:
    """Return a series that has the units of its columns in ``attrs``."""
    units = {"time_s": "s", "temperature_K": "K"}
    frame = frame.reset_index(drop=True)
    frame.attrs["units"] = {c: units.get(c, quantity.unit) for c in map(str, frame.columns)}
    frame.attrs["title"] = quantity.title
    return frame


def beside(frames: list[pd.DataFrame]) -> pd.DataFrame:
    """Return series of an experiment side by side; cells stay empty where a time is of others."""
    whole, *others = frames
    units = {name: unit for frame in frames for name, unit in frame.attrs["units"].items()}
    for frame in others:
        shared = [c for c in ("time_s", "temperature_K") if c in whole and c in frame]
        whole = whole.merge(frame, on=shared, how="outer")
    whole.attrs = {"units": units}
    return whole
