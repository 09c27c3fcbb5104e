"""Repeats of tests: their signals, and their differences beside the stated scatter."""

from collections.abc import Iterable
from dataclasses import dataclass

from pyrofit.analysis.estimates import Estimated
from pyrofit.config import Study


@dataclass(frozen=True)
class Differing:
    """A value that differs between repeats: the key of its standard deviation, and its estimate."""

    key: str
    null: float
    sd: float
    estimate: Estimated

    @property
    def away_sd(self) -> float:
        """(estimate - value of no difference) / stated standard deviation."""
        return (self.estimate.value - self.null) / self.sd


@dataclass(frozen=True)
class RepeatOfTest:
    """One repeat of a test: its signals, those of other repeats that it lacks, its differences."""

    test: str
    name: str
    signals: tuple[str, ...]
    missing: tuple[str, ...]
    differing: tuple[Differing, ...]


def repeats_of_tests(study: Study, estimates: Iterable[Estimated]) -> list[RepeatOfTest]:
    """Return all repeats of the study's tests, in its order."""
    by_name = {e.name: e for e in estimates}
    of_tests: dict[str, dict[str, None]] = {}
    for experiment in study.experiments.values():
        if experiment.repeat is not None:
            signals = dict.fromkeys(experiment.signals)
            of_tests.setdefault(experiment.repeat.test, {}).update(signals)
    found = []
    tests = _tests(study)
    for name, experiment in study.experiments.items():
        if experiment.repeat is None or experiment.repeat.test not in tests:
            continue
        test, nuisances = experiment.repeat.test, experiment.repeat.nuisances
        known = {key: study.known[p] for key, p in nuisances.items() if p in by_name}
        differing = [Differing(k, v.value, v.sd, by_name[nuisances[k]]) for k, v in known.items()]
        own = tuple(experiment.signals)
        missing = tuple(s for s in of_tests[test] if s not in own)
        found.append(RepeatOfTest(test, name, own, missing, tuple(differing)))
    return found


def has_repeats(study: Study) -> bool:
    """Tell whether a test of the study is repeated."""
    return bool(_tests(study))


def _tests(study: Study) -> set[str]:
    """Return the names of the tests with several records."""
    tests = [e.repeat.test for e in study.experiments.values() if e.repeat is not None]
    return {test for test in tests if tests.count(test) > 1}
