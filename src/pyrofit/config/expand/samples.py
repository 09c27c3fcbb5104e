"""Mass and area of a sample, given once for all files of an experiment."""

from collections.abc import Mapping
from typing import Any

from pyrofit.config.expand.repeats import SYNTHETIC

KEYS = ("sample_mass_kg", "sample_area_m2")


def with_samples(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return a description in which each file has the mass and area that its experiment gives.

    A signal or a repeat that gives its own keeps it.

    >>> signals = {"mass": "a.csv", "mlr": {"file": "b.csv", "sample_area_m2": 0.02}}
    >>> study = {"experiments": {"a": {"sample_area_m2": 0.01, "signals": signals}}}
    >>> with_samples(study)["experiments"]["a"]["signals"]["mass"]
    {'sample_area_m2': 0.01, 'file': 'a.csv'}
    """
    experiments = given.get("experiments")
    if not isinstance(experiments, Mapping):
        return dict(given)
    spread = {
        name: _spread(one) if isinstance(one, Mapping) else one for name, one in experiments.items()
    }
    return {**given, "experiments": spread}


def _spread(experiment: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return an experiment whose signals and repeats have its keys of the sample."""
    shared = {key: experiment[key] for key in KEYS if key in experiment}
    if not shared:
        return experiment
    new = {key: value for key, value in experiment.items() if key not in KEYS}
    signals = experiment.get("signals")
    if isinstance(signals, Mapping):
        new["signals"] = {name: _signal(shared, one) for name, one in signals.items()}
    repeats = experiment.get("repeats")
    tests = repeats.get("tests") if isinstance(repeats, Mapping) else None
    if isinstance(repeats, Mapping) and isinstance(tests, Mapping):
        new["repeats"] = {**repeats, "tests": {n: _with(shared, one) for n, one in tests.items()}}
    elif isinstance(repeats, Mapping) and isinstance(tests, list | tuple):
        new["repeats"] = {**repeats, "tests": [_with(shared, one) for one in tests]}
    return new


def _with(shared: Mapping[str, Any], part: Any) -> Any:
    return {**shared, **part} if isinstance(part, Mapping) else part


def _signal(shared: Mapping[str, Any], signal: Any) -> Any:
    if isinstance(signal, str) and signal != SYNTHETIC:
        return {**shared, "file": signal}
    if isinstance(signal, Mapping) and signal.get("file") != SYNTHETIC:
        return {**shared, **signal}
    return signal
