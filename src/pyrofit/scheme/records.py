"""The thermogravimetric records that schemes are fitted to, and those they predict."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.config import Study, TermSpec
from pyrofit.errors import StudyError
from pyrofit.estimate.targets import Measurements, target_for
from pyrofit.experiments.heated.simulate import programme
from pyrofit.model.heated import HeatedExperiment
from pyrofit.scheme.masses import FEWEST_RATES, masses_of
from pyrofit.solver.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class MassRecord:
    """One record of mass against temperature.

    Parameters
    ----------
    experiment, signal
        Names in the study.
    rate
        Nominal heating rate [K/min].
    laboratory
        Who recorded it; '' if the study does not say.
    calibrated
        Whether schemes are fitted to it, else it is predicted only.
    term
        The term of a cost that compares it.
    time_s, temperature_K, mass
        The record at the compared points, shape (n,); mass over initial mass.
    """

    experiment: str
    signal: str
    rate: float
    laboratory: str
    calibrated: bool
    term: TermSpec
    time_s: FloatArray
    temperature_K: FloatArray
    mass: FloatArray

    @property
    def converted(self) -> FloatArray:
        """Conversion from the first to the last mass, within 0 and 1, never falling."""
        first, last = self.mass[0], self.mass[-1]
        conversion = (first - self.mass) / max(float(first - last), 1e-9)
        return np.asarray(np.clip(np.maximum.accumulate(conversion), 0.0, 1.0))

    def temperature_at(self, share: float) -> float:
        """Return the temperature [K] at which this share of the mass loss is still to come."""
        return float(np.interp(1.0 - share, self.converted, self.temperature_K))

    @property
    def slope(self) -> FloatArray:
        """Slope of the mass, dm/dT [1/K], at the points; 0 where the temperature does not rise."""
        rise = np.gradient(self.temperature_K)
        safe = np.where(np.abs(rise) > 1e-9, rise, np.inf)
        return np.asarray(np.gradient(self.mass) / safe)


def records_of(study: Study, measurements: Measurements, points: int) -> list[MassRecord]:
    """Return the records of a study, those that schemes are fitted to first.

    Raises
    ------
    StudyError
        The study fits no mass, or fits it at one heating rate only.
    """
    masses = masses_of(study)
    found = [
        _record(study, measurements, name, signal, pairs is masses.fitted, points)
        for pairs in (masses.fitted, masses.predicted)
        for name, signal in pairs
    ]
    _check(study, masses.place, [r for r in found if r.calibrated])
    return found


def rates_of(records: Sequence[MassRecord]) -> list[float]:
    """Return the heating rates of records [K/min], each once, slowest first."""
    return sorted({r.rate for r in records})


def _check(study: Study, place: str, fitted: Sequence[MassRecord]) -> None:
    if not fitted:
        raise StudyError(
            f"study '{study.name}': {place} compares no mass of a TGA. Add a term with "
            "the signal of its mass fraction: the reaction scheme is chosen from it"
        )
    rates = rates_of(fitted)
    if len(rates) < FEWEST_RATES:
        raise StudyError(
            f"study '{study.name}': {place} compares TGA at {rates[0]:g} K/min only. A "
            f"scheme is judged by heating rates left out: give at least {FEWEST_RATES}, better "
            "three that differ by a factor of 5 or more"
        )


def _record(
    study: Study,
    measurements: Measurements,
    name: str,
    signal: str,
    calibrated: bool,
    points: int,
) -> MassRecord:
    experiment = study.experiments[name]
    assert isinstance(experiment, HeatedExperiment)
    term = TermSpec(experiment=name, signal=signal, kind="RMSE", points=points)
    target = target_for(study, term, measurements)
    return MassRecord(
        experiment=name,
        signal=signal,
        rate=experiment.heating_rate_K_min,
        laboratory=getattr(experiment, "laboratory", ""),
        calibrated=calibrated,
        term=term,
        time_s=target.time_s,
        temperature_K=programme(experiment, measurements[name, signal], target.time_s),
        mass=target.value,
    )
