"""More reactions are offered where the fitted ones miss the masses of TGA."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

import pyrofit as pf
from pyrofit.results import goodness
from pyrofit.results.files import Results
from pyrofit.results.goodness import Goodness
from pyrofit.scheme.settings import SchemeSettings
from pyrofit.stages import isoconversional
from pyrofit.stages.isoconversional import more_reactions

FEW = SchemeSettings(points=40, most_reactions=2, branches=1, random_starts=1, rounds=1)
PARTS = [(0.5, 150e3, 560.0), (0.5, 200e3, 640.0)]
"""Share, E and temperature of k = 0.001 1/s of two parallel components."""


def records(parts: list[tuple[float, float, float]]) -> dict[str, pd.DataFrame]:
    """Return TGA at two rates."""
    rng = np.random.default_rng(2)
    found = {}
    for rate in (5.0, 20.0):
        T = np.linspace(400.0, 800.0, 150)
        time, mass = (T - T[0]) * 60.0 / rate, np.full(T.size, 0.05)
        for share, E, at in parts:
            k = 1e-3 * np.exp(-E / 8.314 * (1.0 / T - 1.0 / at))
            done = np.concatenate([[0.0], np.cumsum(0.5 * (k[1:] + k[:-1]) * np.diff(time))])
            mass += 0.95 * share * np.exp(-done)
        mass += rng.normal(0.0, 5e-4, T.size)
        found[f"foam_{rate:g}K"] = pd.DataFrame(
            {"time_s": time, "temperature_K": T, "mass_fraction": mass}
        )
    return found


@pytest.fixture
def offered(tmp_path: Path) -> Callable[[float], list[str]]:
    """Return the sentences after a fit of two components by one, with p of its test."""
    data = records(PARTS)
    study = pf.new_study("foam", tga=data)
    measurements = {(name, "mass_fraction"): frame for name, frame in data.items()}

    def after(p: float) -> list[str]:
        results = Results(tmp_path)
        goodness.write(results, "imp", Goodness(p, ()))
        return list(more_reactions(study, results, measurements, lambda text: None, FEW))

    return after


@pytest.mark.solver
def test_two_components_are_offered_after_a_misfit_of_one(
    offered: Callable[[float], list[str]],
) -> None:
    (said,) = offered(1e-6)
    assert said.startswith("Two parallel reactions of first order predict heating rates left out")
    assert "`pyrofit scheme STUDY --write FILE`" in said


@pytest.mark.parametrize(("gain", "first"), [(883.0, "Three"), (6.0, "No"), (-200.0, "No")])
def test_the_log_score_tells_whether_a_scheme_is_offered(
    gain: float, first: str, offered: Callable[[float], list[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    def choice(*_: object) -> SimpleNamespace:
        fitted = SimpleNamespace(posed=SimpleNamespace(words="three parallel reactions"))
        chosen = SimpleNamespace(left_out_rms=0.03, fitted=fitted)
        own = SimpleNamespace(left_out_rms=0.035)
        return SimpleNamespace(chosen=chosen, own=own, gain=gain)

    monkeypatch.setattr(isoconversional, "choose_scheme", choice)
    (said,) = offered(1e-6)
    assert said.split()[0] == first
    assert "0.03 of the initial mass with three parallel" in said or "883.0 above" in said


def test_nothing_is_offered_where_the_fit_describes(offered: Callable[[float], list[str]]) -> None:
    assert offered(0.5) == []
