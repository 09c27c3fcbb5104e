"""Times to ignition, and the critical heat flux of a series of radiant fluxes."""

from pathlib import Path

import numpy as np
import pytest

from pyrofit.cli import main
from pyrofit.config import read_study
from pyrofit.new_study.write import init
from pyrofit.results.files import Results
from pyrofit.steps.ignition import page, record
from pyrofit.steps.ignition.series import EXPONENTS, Law, ignition_temperature, line_of
from pyrofit.steps.ignition.times import first_above

FLUX = np.array([20e3, 25e3, 35e3, 50e3, 75e3])
CRITICAL, TRP = 11e3, 280e3


def times(law: Law = "thick", critical: float = CRITICAL) -> np.ndarray:
    """Return times that follow a relation exactly."""
    factor = 1.0 if law == "thin" else np.sqrt(4.0 / np.pi)
    return np.asarray((factor / TRP * (FLUX - critical)) ** (-1.0 / EXPONENTS[law]))


@pytest.mark.parametrize("law", EXPONENTS)
def test_exact_times_give_the_critical_flux_and_the_response(law: Law) -> None:
    line = line_of(law, FLUX, times(law))
    assert line.critical_W_m2 == pytest.approx(CRITICAL, rel=1e-6)
    assert line.critical_within == pytest.approx((CRITICAL, CRITICAL), rel=1e-3)
    assert line.scatter == pytest.approx(0.0, abs=1e-9)
    assert line.remarks == []
    if law == "janssens":
        assert line.response is None
    else:
        assert line.response == pytest.approx(TRP, rel=1e-6)


def test_closed_form_of_a_semi_infinite_solid_gives_its_thermal_inertia() -> None:
    # T_s - T_0 = 2 q (t / (pi k rho c))^(1/2); k rho c = 0.2 1200 1500, 300 K to ignition
    inertia, rise = 0.2 * 1200.0 * 1500.0, 300.0
    t = np.pi * inertia * (rise / (2.0 * FLUX)) ** 2
    line = line_of("thick", FLUX + 5e3, t)  # 5 kW/m2 are lost
    assert line.critical_W_m2 == pytest.approx(5e3, rel=1e-6)
    assert line.response == pytest.approx(np.sqrt(inertia) * rise, rel=1e-6)


def test_intervals_hold_the_truth_as_often_as_they_say() -> None:
    random, exact = np.random.default_rng(1), times() ** -0.5
    inside = {"critical": 0, "response": 0}
    for _ in range(400):
        t = (exact + random.normal(0.0, 0.01, FLUX.size)) ** -2.0
        line = line_of("thick", FLUX, t)
        assert line.critical_within is not None
        assert line.response_within is not None
        inside["critical"] += line.critical_within[0] <= CRITICAL <= line.critical_within[1]
        inside["response"] += line.response_within[0] <= TRP <= line.response_within[1]
    # 380 of 400 are expected, with a standard deviation of 4.4.
    assert 366 <= inside["critical"] <= 394
    assert 366 <= inside["response"] <= 394


def test_critical_flux_below_zero_is_told_and_not_given() -> None:
    line = line_of("thick", FLUX, times(critical=-4e3))
    assert line.critical_W_m2 is None
    assert line.critical_within is None
    assert line.response == pytest.approx(TRP, rel=1e-6)
    assert "meets zero at a flux below 0" in line.remarks[0]


def test_limit_below_zero_is_given_as_zero_and_told() -> None:
    t = times(critical=1e3) * np.array([1.1, 0.9, 1.05, 0.95, 1.0])
    line = line_of("thick", FLUX, t)
    assert line.critical_W_m2 is not None
    assert line.critical_within is not None
    assert line.critical_within[0] == 0.0
    assert "reaches zero" in line.remarks[0]


def test_contradictions_with_the_tests_are_told() -> None:
    line = line_of("thick", FLUX, times(), without=[10e3, 15e3])
    assert line.remarks == ["a sample did not ignite at 15 kW/m², above this critical flux"]
    thin = line_of("thin", [*FLUX, 5e3], [*times("thin", 15e3), 2000.0])
    assert any("below this critical flux" in said for said in thin.remarks)


@pytest.mark.parametrize(
    ("flux", "time", "words"),
    [
        ([20e3, 50e3], [90.0, 20.0], "2 tests with ignition at 2 fluxes"),
        ([50e3] * 4, [20.0, 21.0, 19.0, 20.0], "4 tests with ignition at 1 fluxes"),
        ([20e3, 30e3, 50e3], [60.0, 20.0, 60.0], "hardly depend on the flux"),
        ([20e3, 30e3, 50e3], [20.0, 40.0, 60.0], "hardly depend on the flux"),
    ],
)
def test_too_little_is_told_and_no_number_is_given(
    flux: list[float], time: list[float], words: str
) -> None:
    line = line_of("thick", flux, time)
    assert (line.critical_W_m2, line.response, line.scatter) == (None, None, None)
    assert words in line.remarks[0]


def test_a_flash_is_no_ignition() -> None:
    t = np.arange(0.0, 100.0)
    rate = np.where((t >= 20) & (t < 25) | (t >= 60), 100e3, 0.0)
    assert first_above(t, rate, 25e3, 10.0) == pytest.approx(59.25)
    assert first_above(t, rate, 25e3, 3.0) == pytest.approx(19.25)
    assert first_above(t, rate, 200e3, 0.0) is None
    assert first_above(t, np.full(100, 1.0), 0.5, 10.0) == 0.0


def test_temperature_of_ignition_balances_the_critical_flux() -> None:
    T = ignition_temperature(12e3, 0.9, 10.0)
    lost = 10.0 * (T - 298.15) + 0.9 * 5.670374419e-8 * (T**4 - 298.15**4)
    assert lost == pytest.approx(0.9 * 12e3)


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Run the step for cone tests at five fluxes, and one that does not ignite."""
    folder = tmp_path_factory.mktemp("ignition")
    t = np.arange(0.0, 900.0, 1.0)
    files = []
    for q, begins in zip([10e3, *FLUX], [1e9, *times()], strict=True):
        # A ramp of 50 kW/m2 in 1 s crosses 25 kW/m2 at the given time.
        rate = np.clip(50.0 * (t - begins) + 25.0, 0.0, 200.0) + 0.5
        files.append(folder / f"board_{q / 1e3:.0f}kW.csv")
        mass = 60.0 - 0.01 * t
        head = "Time (s),HRR (kW/m2),Mass (g)"
        np.savetxt(files[-1], np.c_[t, rate, mass], "%.6g", ",", header=head, comments="")
    init("board", {"cone": files}, folder)
    study = folder / "board" / "board.yaml"
    assert main(["ignition", str(study), "--results", str(folder / "results")]) == 0
    return folder


def test_the_step_gives_times_lines_and_sentences(done: Path) -> None:
    study = read_study(done / "board" / "board.yaml")
    results = Results(done / "results")
    found = record.read(study, results)
    by_flux = {test.flux_W_m2: test.time_s["heat_release"] for test in found.tests}
    assert by_flux.pop(10e3) is None
    for q, time in zip(FLUX, times(), strict=True):
        assert by_flux[q] == pytest.approx(time, abs=0.6)
    thick, _, _ = (of for of in found.series if of.definition == "heat_release")
    assert thick.critical_W_m2 == pytest.approx(CRITICAL, rel=0.02)
    assert thick.response == pytest.approx(TRP, rel=0.02)
    assert thick.tests == 5
    said = " ".join(page.sentences(study, results))
    assert "By the heat release rate above a threshold, the critical heat flux is 11 kW/m²" in said
    table = page.times_table(study, results)
    assert "no ignition" in set(table["heat_release_s"])
    assert (done / "results" / "ignition" / "fluxes.svg").is_file()
