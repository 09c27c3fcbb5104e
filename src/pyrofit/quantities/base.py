"""Properties of every measured quantity: units, sampling, checks, noise, words."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

Sampling = Literal["point", "bin mean", "cumulative"]
Place = Literal["fixed", "depth", "interface"]
Guess = Callable[[float, float], str]
"""From the first and the largest number of a column to the unit that they look like."""

Released = Callable[[FloatArray, FloatArray], float]
"""From times and values to the released mass per area."""

Remark = Callable[[FloatArray, FloatArray], str]
"""From temperatures [K] and values to a remark."""


LIMITS = ("lower", "upper")
"""Roles of columns with the limits of a band; they are read where a study names them."""


@dataclass(frozen=True)
class Shown:
    """How a quantity is shown: y = factor x + offset, x in SI units."""

    unit: str
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class Quantity:
    """A measured quantity, in SI units."""

    kinds: tuple[str, ...]
    """Kinds of experiment that measure it."""
    title: str
    """The words for it, as they stand on axes and in tables."""
    symbol: str
    unit: str
    """SI unit, as a study writes it."""
    column: str
    """Column of the value in tidy files, with the unit."""
    uncertainty_column: str
    """Column of its uncertainty, in the same unit."""
    shown: Shown
    """Unit on axes and in tables."""
    scales: tuple[str, ...]
    """Kinds of unit in files, see `units.SCALES`; the first is that of the value itself."""
    headers: tuple[str, ...]
    """Headers of the value that are recognised without being named."""
    pattern: str
    """Further headers that a new study recognises: a regular expression of the whole header."""
    guess: Guess
    """Unit of a column without one, as a new study guesses it."""
    largest: tuple[float, float]
    """Limits of the largest value; a value outside has a wrong unit."""
    solver_error: float
    """Error of a simulated curve at default settings, as a fraction of its largest rise."""
    usual_sd: float
    """Standard deviation of a record that does not exist yet."""
    output: str = ""
    """Curve of the solver that it is, see `pyrofit.solver.outputs`; by default that of its name."""
    uncertainty_headers: tuple[str, ...] = ()
    """Headers of the uncertainty, besides ``Error`` and ``Uncertainty``."""
    sampling: Sampling = "point"
    """Whether a value holds for its time, for a bin around it, or from the start until then."""
    against_temperature: bool = False
    """Whether the sample's temperature is recorded beside it."""
    all_within: bool = False
    """Whether every value, not the largest alone, lies within the limits."""
    sign_ratio: float | None = None
    """The lowest value may be this multiple of the largest below zero; none = no rule."""
    discrepancy: float | None = None
    """Standard deviation of the discrepancy of models that the diagnosis tolerates in a record
    without an uncertainty."""
    drift: float = 0.0
    """Standard deviation of the drift of a record without an uncertainty."""
    drift_share: float = 0.0
    """The same as a fraction of its range."""
    sensitivity_error: float = 0.0
    """Relative error of all values of such a record alike."""
    temperature_error_K: float = 0.0
    """Error of the temperatures of such a record, the same for all."""
    relative: bool = False
    """Whether a prediction is scored relative to the mean measured value."""
    place: Place = "fixed"
    """Where in the sample it is measured: where its name tells, or where a signal tells."""
    before_backing: str = ""
    """Quantity that files name alike: that of a sensor between a sample and its backing."""
    released: Released | None = None
    """Mass per area that a record shows to be released [kg/m2]; none = it does not show that."""
    heat: Released | None = None
    """Heat per area that a record shows to be released [J/m2]; none = it does not show that."""
    discrepancy_share: float = 0.0
    """The discrepancy that the diagnosis tolerates, as a fraction of the range."""
    has_sign: bool = False
    """Whether files differ in their sign: heat taken up is positive, or negative."""
    remark: Remark | None = None
    """Doubts about a record against temperature; empty if there are none."""
    rests_on: tuple[str, ...] = ()
    """Keys of components and reactions, besides the kinetics, on which a heated sample's values
    depend."""
    name: str = ""

    @property
    def curve(self) -> str:
        """Name of the solver's curve."""
        return self.output or self.name

    @property
    def roles(self) -> dict[str, tuple[str, ...]]:
        """Headers that are recognised, by the role of a column."""
        abscissa: dict[str, tuple[str, ...]] = {"time": ("Time",)}
        if self.against_temperature:
            abscissa["temperature"] = ("Temperature", "Temp")
        return abscissa | {
            "value": self.headers,
            "uncertainty": (*self.uncertainty_headers, "Error", "Uncertainty"),
        }

    @property
    def limit_columns(self) -> dict[str, str]:
        """Columns of the lower and the upper limit of a band about the values, by role.

        >>> from pyrofit.quantities import known_quantities
        >>> known_quantities()["mlr"].limit_columns["lower"]
        'mlr_lower_kg_m2_s'
        """
        return {role: self.uncertainty_column.replace("uncertainty", role) for role in LIMITS}

    @property
    def is_temperature(self) -> bool:
        """Whether it is a temperature, whose differences are in K and which is shown in °C."""
        return self.unit == "K"

    @property
    def unit_text(self) -> str:
        """The SI unit as it is printed.

        >>> from pyrofit.quantities import known_quantities
        >>> known_quantities()["mlr"].unit_text
        'kg/(m² s)'
        """
        return self.unit.replace("m2", "m²").replace("m3", "m³")

    @property
    def metric(self) -> str:
        """Name of the score of a prediction, over all measured points.

        >>> from pyrofit.quantities import known_quantities
        >>> known_quantities()["back_temperature"].metric
        'RMSE of the back temperature'
        """
        return f"{'CV(RMSE)' if self.relative else 'RMSE'} of the {self.title}"

    @property
    def label(self) -> str:
        """Label of an axis: title and unit shown."""
        return f"{self.title} [{self.shown.unit}]"

    def tidy_keys(self) -> dict[str, dict[str, str]]:
        """Return ``columns`` and ``units`` of a signal whose file is a tidy table.

        >>> from pyrofit.quantities import known_quantities
        >>> known_quantities()["mlr"].tidy_keys()["units"]
        {'time': 's', 'value': 'kg/(m2 s)', 'uncertainty': 'kg/(m2 s)'}
        """
        columns = {
            "time": "time_s",
            "value": self.column,
            "uncertainty": self.uncertainty_column,
        }
        units = {"time": "s", "value": self.unit, "uncertainty": self.unit}
        if self.against_temperature:
            columns["temperature"], units["temperature"] = "temperature_K", "K"
        return {"columns": columns, "units": units}
