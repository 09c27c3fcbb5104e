"""The mass balance of a gasification run: the integral of its rate beside the sample's mass."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from pyrofit.errors import DataError


@dataclass(frozen=True)
class Closure:
    """How much mass left the sample, and how much there was.

    Parameters
    ----------
    released_kg_m2 : float
        Integral of the mass loss rate over time [kg/m2].
    initial_kg_m2 : float
        Initial mass of the sample per exposed area [kg/m2].
    ratio : float
        `released_kg_m2 / initial_kg_m2` [-]; 1 where nothing remains and the balance closes.
    """

    released_kg_m2: float
    initial_kg_m2: float
    ratio: float

    def describe(self) -> str:
        """Say it in one line.

        >>> Closure(6.3, 7.0, 0.9).describe()
        'released 6.300 of 7.000 kg/m² (90.0 %)'
        """
        return (
            f"released {self.released_kg_m2:.3f} of {self.initial_kg_m2:.3f} kg/m² "
            f"({100 * self.ratio:.1f} %)"
        )


def mass_closure(frame: pd.DataFrame, initial_mass_kg_m2: float) -> Closure:
    """Integrate a mass loss rate over time and compare it with the mass of the sample.

    Each value is taken as the mean over a bin around its time,

        M = sum_i mlr_i (e_(i+1) - e_i),
        e_0 = 0,  e_i = (t_(i-1) + t_i) / 2,  e_n = t_(n-1)  for times t_0 ... t_(n-1).

    The first bin reaches back to t = 0, where the exposure starts, and nothing is added after the
    last time: M equals the trapezoidal rule plus `mlr_0 t_0`. Negative values count as they are.

    Parameters
    ----------
    frame : DataFrame
        Columns `time_s` [s], increasing, and `mlr_kg_m2_s` [kg/(m2 s)].
    initial_mass_kg_m2 : float
        Initial mass per exposed area [kg/m2]: density times thickness.

    Returns
    -------
    Closure
        Released mass, initial mass and their ratio.

    Raises
    ------
    DataError
        The initial mass is not a positive number.

    Examples
    --------
    >>> frame = pd.DataFrame({"time_s": [5.0, 15.0, 25.0], "mlr_kg_m2_s": [0.1, 0.2, 0.1]})
    >>> mass_closure(frame, 8.0)  # 0.1 x 10 s + 0.2 x 10 s + 0.1 x 5 s
    Closure(released_kg_m2=3.5, initial_kg_m2=8.0, ratio=0.4375)
    """
    if not (np.isfinite(initial_mass_kg_m2) and initial_mass_kg_m2 > 0.0):
        raise DataError(
            f"initial mass {initial_mass_kg_m2} kg/m2: it must be a number above 0; "
            "check density and thickness."
        )
    time = frame["time_s"].to_numpy(dtype=np.float64)
    rate = frame["mlr_kg_m2_s"].to_numpy(dtype=np.float64)
    edges = np.concatenate(([0.0], 0.5 * (time[:-1] + time[1:]), time[-1:]))
    released = float(rate @ np.diff(edges))
    return Closure(released, initial_mass_kg_m2, released / initial_mass_kg_m2)
