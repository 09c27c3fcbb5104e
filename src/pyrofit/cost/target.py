"""The measured curve a model is compared with."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pyrofit.errors import CostError

FloatArray = NDArray[np.float64]

Residuals = Callable[[FloatArray], FloatArray]
"""From the model at the target's times to residuals whose norm is the cost."""

_FEWEST_POINTS = 2


@dataclass(frozen=True, eq=False)
class Target:
    """A curve to be met, with its uncertainty where one is known.

    The arrays are copied and cannot be written to.

    Parameters
    ----------
    time_s : array, shape (n,)
        Times [s], strictly increasing, n >= 2.
    value : array, shape (n,)
        Target y at these times, in the unit of the model.
    uncertainty : array, shape (n,), optional
        Half width of the scatter of y, in the unit of `value`, never negative.

    Raises
    ------
    CostError
        An array is not one-dimensional, not finite or of another length, there are fewer than
        2 points, time does not increase, or an uncertainty is negative.

    Examples
    --------
    >>> Target([0.0, 1.0, 2.0], [0.0, 4.0, 6.0]).window(0.5, 2.0).value.tolist()
    [4.0, 6.0]
    """

    time_s: FloatArray
    value: FloatArray
    uncertainty: FloatArray | None = None

    def __post_init__(self) -> None:
        for name in ("time_s", "value", "uncertainty"):
            if (given := getattr(self, name)) is not None:
                object.__setattr__(self, name, checked_curve(name, given))
        if self.time_s.size < _FEWEST_POINTS:
            raise CostError(
                f"target: given {self.time_s.size} points; a target needs at least "
                f"{_FEWEST_POINTS}. Give a longer series."
            )
        if (stops := np.flatnonzero(np.diff(self.time_s) <= 0.0)).size:
            at = int(stops[0])
            raise CostError(
                f"target: time_s[{at + 1}] = {self.time_s[at + 1]:g} follows {self.time_s[at]:g}; "
                "times must increase. Sort the points and remove doubled ones."
            )
        for name, array in (("value", self.value), ("uncertainty", self.uncertainty)):
            if array is not None and array.size != self.time_s.size:
                raise CostError(
                    f"target: {name} has {array.size} points and time_s has {self.time_s.size}; "
                    "give one for each time."
                )
        if self.uncertainty is not None and self.uncertainty.min() < 0.0:
            raise CostError(
                f"target: the smallest uncertainty is {self.uncertainty.min():g}; it is a half "
                "width and must not be negative. Correct it or leave it out."
            )

    def window(self, start_s: float, end_s: float) -> "Target":
        """Keep the points with start_s <= t <= end_s.

        Parameters
        ----------
        start_s, end_s : float
            Ends of the window [s], both included.

        Returns
        -------
        Target
            The points inside.

        Raises
        ------
        CostError
            Fewer than 2 points lie inside.

        Examples
        --------
        >>> Target([0.0, 1.0, 2.0], [0.0, 4.0, 6.0]).window(0.0, 1.0).time_s.tolist()
        [0.0, 1.0]
        """
        inside = (self.time_s >= start_s) & (self.time_s <= end_s)
        if (count := np.count_nonzero(inside)) < _FEWEST_POINTS:
            raise CostError(
                f"window {start_s:g} to {end_s:g} s: {count} points lie inside; at least "
                f"{_FEWEST_POINTS} must. The target runs from {self.time_s[0]:g} to "
                f"{self.time_s[-1]:g} s. Move or widen the window."
            )
        spread = self.uncertainty
        return Target(
            self.time_s[inside], self.value[inside], None if spread is None else spread[inside]
        )

    def resampled(self, n: int) -> "Target":
        """Interpolate linearly to n equidistant times over the same range, as PROPTI does.

        Parameters
        ----------
        n : int
            Number of points, at least 2.

        Returns
        -------
        Target
            Value and uncertainty at t_min + i (t_max - t_min) / (n - 1), i = 0 .. n - 1.

        Raises
        ------
        CostError
            n is not a whole number or below 2.

        Examples
        --------
        >>> Target([0.0, 1.0, 2.0], [0.0, 4.0, 6.0]).resampled(5).value.tolist()
        [0.0, 2.0, 4.0, 5.0, 6.0]
        """
        if n != int(n) or n < _FEWEST_POINTS:
            raise CostError(
                f"points = {n}; a target is resampled to a whole number of points, at least "
                f"{_FEWEST_POINTS}. Give a larger number or keep the points as measured."
            )
        time_s = np.linspace(self.time_s[0], self.time_s[-1], int(n))
        value = np.interp(time_s, self.time_s, self.value)
        if self.uncertainty is None:
            return Target(time_s, value)
        return Target(time_s, value, np.interp(time_s, self.time_s, self.uncertainty))


def checked_curve(name: str, given: object) -> FloatArray:
    """Give a read-only copy of a one-dimensional, finite array, or raise an error.

    >>> checked_curve("value", [1, 2]).tolist()
    [1.0, 2.0]
    """
    try:
        array = np.array(given, dtype=np.float64)
    except (TypeError, ValueError):
        raise CostError(f"{name}: given {given!r}; it must be a list of numbers.") from None
    if array.ndim != 1:
        raise CostError(f"{name}: given {array.ndim} dimensions; it must have one. Pass a column.")
    if (bad := np.flatnonzero(~np.isfinite(array))).size:
        raise CostError(
            f"{name}[{bad[0]}] = {array[bad[0]]}; every number must be finite. Remove the point."
        )
    array.setflags(write=False)
    return array


def number(name: str, given: object, *, above: float = -math.inf) -> float:
    """Give a finite number above a limit, or raise an error.

    >>> number("r", "0.05", above=0.0)
    0.05
    """
    try:
        value = float(given)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        value = math.nan
    if not (math.isfinite(value) and value > above):
        rule = "a finite number" if above == -math.inf else f"a finite number above {above:g}"
        raise CostError(f"{name} = {given!r}; it must be {rule}. Correct it.")
    return value
