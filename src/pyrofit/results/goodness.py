"""The test of a fit: made by `pyrofit.estimate.goodness`, one stored file for each stage."""

from dataclasses import dataclass
from typing import Literal

from pydantic import TypeAdapter, ValidationError

from pyrofit.errors import DataError
from pyrofit.results.files import Results

FILE = "goodness.json"
LEVEL = 0.01
"""Probability of a false alarm with a model that is right."""
FAR_OFF = 0.1
"""Lasting misfit, over the range of a signal, above which no model describes it."""
APPARENT: Literal["apparent value"] = "apparent value"
"""Verdict on a parameter of a model that misses the tests."""
MISFIT = "misfit"
"""Method of an interval of a model that misses the tests."""
AS_DESCRIBED: Literal["determined as described"] = "determined as described"
"""Verdict on a parameter that usual errors of the apparatus move too far to be determined."""
ONE_RATE: Literal["rests on one heating rate"] = "rests on one heating rate"
"""Verdict on a parameter that follows from the assumed reaction, where one rate is fitted."""


@dataclass(frozen=True)
class Miss:
    """A window in which a signal is missed.

    Parameters
    ----------
    start_s, end_s
        Its first and last time [s].
    start_K, end_K
        Measured temperatures there, where the signal is recorded against them.
    mean
        Mean of simulated less measured values, SI unit.
    rms
        Their root mean square.
    """

    start_s: float
    end_s: float
    start_K: float | None
    end_K: float | None
    mean: float
    rms: float = 0.0


@dataclass(frozen=True)
class SignalGoodness:
    """The test of one signal.

    Parameters
    ----------
    p
        Probability that noise alone misses it as much.
    rms
        Root mean square of simulated less measured values, SI unit.
    range
        Largest less smallest measured value, SI unit.
    points_sd
        Median standard deviation of the noise of its points, SI unit.
    total
        Integral of the simulated rate over that of the measured one; None where it is no rate.
    of_sample
        Whether that is the total heat of a sample, a robust number: a calorimeter burns all gas.
    scatter
        Scatter from point to point over that of the noise, 1 at least.
    averaged
        Root mean square of the difference averaged over a moving window, SI unit.
    misses
        Where it is missed, in order of time; nowhere if it is described.
    """

    experiment: str
    signal: str
    p: float
    rms: float
    range: float
    points_sd: float
    scatter: float
    averaged: float
    misses: tuple[Miss, ...]
    total: float | None = None
    of_sample: bool = False

    @property
    def heat_off(self) -> bool:
        """Whether the total heat of the sample is missed by more than `FAR_OFF` of it."""
        return self.of_sample and self.total is not None and abs(self.total - 1.0) > FAR_OFF

    @property
    def far_off(self) -> bool:
        """Whether it is missed for long by more than `FAR_OFF` of its range, or its heat is."""
        return self.averaged > FAR_OFF * self.range or self.heat_off


@dataclass(frozen=True)
class RepeatDiffers:
    """A repeat that differs from the others of its test, see `pyrofit.estimate.repeats_agree`."""

    experiment: str
    signal: str
    kind: str
    size: float
    low: float
    high: float
    held: bool = False
    """Whether the temperature is held: start, low and high are times [s]."""


@dataclass(frozen=True)
class Goodness:
    """The test of a fit: of all signals together, of each, and of repeats against each other."""

    p: float
    signals: tuple[SignalGoodness, ...]
    repeats: tuple[RepeatDiffers, ...] = ()

    @property
    def describes(self) -> bool:
        """Whether the model describes the tests: p is at least `LEVEL`, and none is far off."""
        return self.p >= LEVEL and not any(s.far_off for s in self.signals)

    @property
    def passes(self) -> bool:
        """Whether the values are those of the sample: it does, and repeats agree."""
        return self.describes and not self.repeats


_GOODNESS = TypeAdapter(Goodness)


def write(results: Results, stage: str, found: Goodness) -> None:
    """Write the test of a stage's fit, 'kinetics' or 'imp'."""
    path = results.identification(FILE, stage)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(_GOODNESS.dump_json(found, indent=1) + b"\n")


def read(results: Results, stage: str) -> Goodness:
    """Return it.

    Raises
    ------
    DataError
        It is missing or broken.
    """
    path = results.identification(FILE, stage)
    try:
        return _GOODNESS.validate_json(path.read_bytes())
    except FileNotFoundError:
        raise DataError(f"{path}: there is no such result; run the step identify") from None
    except ValidationError as error:
        raise DataError(f"{path}: {error.errors()[0]['msg']}; run the step identify anew") from None
