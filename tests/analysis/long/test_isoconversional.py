"""Isoconversional analysis on curves of known kinetics."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import pytest

from pyrofit.analysis.isoconversional.analyse import Analysis, analyse
from pyrofit.analysis.isoconversional.curve import Curve, curve_of
from pyrofit.analysis.isoconversional.findings import findings
from pyrofit.analysis.isoconversional.levels import LEVELS
from pyrofit.constants import GAS_CONSTANT
from pyrofit.solver.arrays import FloatArray

RATES = (2.0, 5.0, 10.0, 20.0)
CORE = slice(1, 18)
"""Levels 0.10 to 0.90."""


@dataclass(frozen=True)
class Component:
    """k = 1e-3 1/s at T, activation energy E, order n, and its share of the mass that is lost."""

    T: float
    E: float
    n: float = 1.0
    share: float = 1.0

    def rate_constant(self, temperature: FloatArray) -> FloatArray:
        apart = 1.0 / temperature - 1.0 / self.T
        return np.asarray(1e-3 * np.exp(-self.E / GAS_CONSTANT * apart))

    def left(self, time: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return the share of it that is left, exact but for the integral of k."""
        k = self.rate_constant(temperature)
        passed = np.concatenate([[0.0], np.cumsum(0.5 * (k[1:] + k[:-1]) * np.diff(time))])
        if self.n == 1.0:
            return np.asarray(np.exp(-passed))
        base = np.maximum(1.0 - (1.0 - self.n) * passed, 0.0)
        return np.asarray(base ** (1.0 / (1.0 - self.n)))


def record(
    components: Sequence[Component],
    name: str,
    rate: float | None,
    temperature_of: Callable[[FloatArray], FloatArray],
    length_s: float,
    noise: FloatArray | float = 0.0,
    points: int = 500,
    last: float | None = None,
) -> Curve:
    fine = np.linspace(0.0, length_s, 40 * points + 1)
    temperature = temperature_of(fine)
    mass = 0.2 + 0.8 * sum(c.share * c.left(fine, temperature) for c in components)
    shown = slice(None, None, 40)
    given = np.asarray(mass)[shown] + noise
    condition = name.split("_")[0]
    return curve_of(name, condition, rate, fine[shown], temperature[shown], given, last)


def heated(
    components: Sequence[Component],
    rates: Sequence[float] = RATES,
    sd: float = 0.0,
    seed: int = 0,
    last: float | None = None,
) -> list[Curve]:
    rng = np.random.default_rng(seed)
    found = []
    for rate in rates:
        noise = sd * rng.standard_normal(501)
        found.append(
            record(
                components,
                f"{rate:g}",
                rate,
                lambda t, b=rate: 400.0 + b / 60.0 * t,  # type: ignore[misc]
                450.0 * 60.0 / rate,
                noise,
                last=last,
            )
        )
    return found


@pytest.mark.parametrize("energy", [9e4, 1.5e5, 2.5e5])
@pytest.mark.parametrize("order", [0.5, 1.0, 2.0])
def test_one_reaction_has_its_activation_energy_at_each_conversion(
    energy: float, order: float
) -> None:
    # At order 2, the mass still falls where the records end.
    found = analyse(heated([Component(600.0, energy, order)], last=0.2))
    for method, energies in found.energies.items():
        assert energies.value == pytest.approx(energy, rel=0.01), method


def local_energy(components: Sequence[Component], level: float, rate: float) -> float:
    """Return E = -R d ln(dx/dt)/d(1/T) at one conversion between neighbouring heating rates."""
    ends = []
    for b in (rate * 0.99, rate * 1.01):
        time = np.linspace(0.0, 450.0 * 60.0 / b, 60001)
        temperature = 400.0 + b / 60.0 * time
        left = sum(c.share * c.left(time, temperature) for c in components)
        speed = np.gradient(1.0 - np.asarray(left), time)
        at = float(np.interp(level, 1.0 - np.asarray(left), temperature))
        ends.append((1.0 / at, float(np.log(np.interp(at, temperature, speed)))))
    (x1, y1), (x2, y2) = ends
    return -GAS_CONSTANT * (y2 - y1) / (x2 - x1)


def test_two_parallel_components_have_the_local_activation_energy() -> None:
    both = [Component(560.0, 1.4e5, share=0.5), Component(620.0, 1.9e5, share=0.5)]
    found = analyse(heated(both, (8.0, 10.0, 12.5)))
    exact = np.array([local_energy(both, level, 10.0) for level in LEVELS])
    # Where one component takes over from the other, E changes within the reach of the parabolas.
    steady = np.abs(np.gradient(exact, LEVELS)) < 1e5
    assert steady.sum() >= 12
    for method in ("friedman", "vyazovkin"):
        value = found.energies[method].value
        assert value[steady] == pytest.approx(exact[steady], rel=0.01), method
        assert value == pytest.approx(exact, rel=0.06), method


def test_holds_and_steps_are_analysed_by_friedman_and_vyazovkin() -> None:
    one = [Component(600.0, 1.5e5)]
    curves = [
        record(one, f"hold{at:g}", None, lambda t, a=at: np.full(t.size, a), length)  # type: ignore[misc]
        for at, length in ((560.0, 60000.0), (580.0, 30000.0), (600.0, 15000.0))
    ]
    curves.append(
        record(one, "steps", None, lambda t: 540.0 + 20.0 * np.floor(t / 3000.0), 15000.0)
    )
    found = analyse(curves)
    assert np.isnan(found.energies["kas"].value).all()
    value = found.energies["vyazovkin"].value[CORE]
    # A parabola about a sudden step of temperature is a worse one.
    assert value == pytest.approx(1.5e5, rel=0.015)
    assert np.sum(np.abs(value / 1.5e5 - 1.0) < 0.01) >= value.size - 1
    only_holds = analyse(curves[:3])
    assert only_holds.energies["friedman"].value == pytest.approx(1.5e5, rel=0.01)


def test_errors_by_noise_cover_the_truth_and_are_not_idle() -> None:
    inside: dict[str, list[bool]] = {"friedman": [], "kas": [], "vyazovkin": []}
    for seed in range(12):
        curves = heated([Component(600.0, 1.5e5)], sd=5e-4, seed=seed)
        found = analyse(curves, temperature_sd_K=0.0)
        for method, energies in found.energies.items():
            # KAS has a bias of its own: 2 (R T/E)^2.
            bias = 0.004 * 1.5e5 if method == "kas" else 0.0
            apart = np.abs(energies.value - 1.5e5) - bias
            inside[method] += (apart < energies.error).tolist()
            assert np.median(energies.error) < 0.04 * 1.5e5, method
    for method, hits in inside.items():
        assert np.mean(hits) > 0.9, method


def test_repeats_count_as_their_mean() -> None:
    shifted = [
        record(
            [Component(600.0 + shift, 1.5e5)],
            f"{rate:g}_{i}",
            rate,
            lambda t, b=rate: 400.0 + b / 60.0 * t,  # type: ignore[misc]
            450.0 * 60.0 / rate,
        )
        for rate in RATES
        for i, shift in enumerate((-2.0, 2.0))
    ]
    found = analyse(shifted)
    assert found.temperature_sd_K == pytest.approx(np.sqrt((4 * 0.25 + 4 * 8.0) / 8), rel=0.1)
    assert found.energies["vyazovkin"].value == pytest.approx(1.5e5, rel=0.01)
    assert any("Repeats at 2 differ by 3." in text or "Repeats at 2 differ by 4." in text
               for text in findings(found))  # fmt: skip


def said(found: Analysis) -> str:
    return " ".join(findings(found))


def test_one_reaction_gives_no_finding() -> None:
    one = heated([Component(600.0, 1.5e5)], sd=5e-4)
    assert findings(analyse(one, one)) == []


def test_two_components_and_the_model_of_one_reaction_are_told() -> None:
    both = [Component(560.0, 1.4e5, share=0.5), Component(640.0, 2.1e5, share=0.5)]
    text = said(analyse(heated(both, sd=5e-4), heated([Component(600.0, 7e4)])))
    assert "E varies with conversion from" in text
    assert "the model has 70 kJ/mol" in text


def test_records_that_cross_are_named() -> None:
    curves = heated([Component(600.0, 1.5e5)])
    slow = heated([Component(640.0, 1.5e5)], RATES[:1])
    assert "The curves of 2 and 5 cross: at conversion 0.05 to 0.95" in said(
        analyse([*slow, *curves[1:]])
    )


def test_a_record_that_ends_too_early_is_named() -> None:
    short = [
        record(
            [Component(600.0, 1.5e5)],
            f"{rate:g}",
            rate,
            lambda t, b=rate: 400.0 + b / 60.0 * t,  # type: ignore[misc]
            210.0 * 60.0 / rate,
        )
        for rate in RATES
    ]
    assert "The mass still falls at the end of" in said(analyse(short))


def test_two_close_rates_are_called_few() -> None:
    text = said(analyse(heated([Component(600.0, 1.5e5)], (10.0, 20.0))))
    assert "Two heating programmes give a line, but no test of it" in text
    assert "The heating rates 10 and 20 K/min are close" in text
