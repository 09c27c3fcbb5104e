"""A fit is tested: right models pass, lasting misfits are found and told."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import pyrofit as pf
from pyrofit.api.measurements import read_measured
from pyrofit.cost import Target
from pyrofit.estimate.goodness import differing, missed, moving_mean, scatter
from pyrofit.estimate.pose import of_diagnosis
from pyrofit.estimate.pose_likelihood import pose_likelihood
from pyrofit.experiments import KINDS
from pyrofit.new_study.write import init
from pyrofit.results.goodness import Goodness, Miss, SignalGoodness
from pyrofit.show.goodness import next_step, verdict_words, where_missed
from pyrofit.solver.arrays import FloatArray

R = 8.314462618
RATES = (5.0, 10.0, 20.0)
T = np.linspace(420.0, 860.0, 12001)
SHARE = slice(None, None, 60)


def factor(peak_K: float, E: float) -> float:
    """Return A of a reaction with its peak at 10 K/min."""
    return E / 6.0 / (R * peak_K**2) * np.exp(E / (R * peak_K))


def mass(rate: float, reactions: list[tuple[float, float, float]], order: float) -> FloatArray:
    """Return the mass fraction of parallel reactions (share, peak, E), residue 0.1."""
    total = np.full(T.size, 0.1)
    for share, peak, E in reactions:
        k = factor(peak, E) * np.exp(-E / (R * T)) * 60.0 / rate
        x = np.concatenate([[0.0], np.cumsum(0.5 * (k[1:] + k[:-1]) * np.diff(T))])
        left = (
            np.exp(-x)
            if order == 1.0
            else np.maximum(1.0 + (order - 1.0) * x, 0.0) ** (1.0 / (1.0 - order))
        )
        total += 0.9 * share * left
    return total


def fit_of(folder: Path, curves: dict[str, FloatArray], rates: dict[str, float]) -> pf.Fit:
    """Return the fit of one reaction, as a new study has it, to TGA of the masses with noise."""
    files = []
    for k, (name, values) in enumerate(curves.items()):
        noisy = values[SHARE] + 5e-4 * np.random.default_rng(k + 11).standard_normal(201)
        at = T[SHARE]
        rows = np.column_stack([(at - at[0]) / rates[name] * 60.0, at, noisy])
        files.append(folder / f"{name}.csv")
        head = "Time (s),Temperature (K),Mass (-)"
        np.savetxt(files[-1], rows, "%.6f", ",", header=head, comments="")
    return pf.fit(init("x", {"tga": files}, folder)[0], profiles=False)


def at_rates(reactions: list[tuple[float, float, float]], order: float = 1.0) -> Any:
    curves = {f"t_N2_{rate:g}K": mass(rate, reactions, order) for rate in RATES}
    return curves, {f"t_N2_{rate:g}K": rate for rate in RATES}


ONE = [(1.0, 610.0, 180e3)]


@pytest.mark.solver
def test_right_model_passes_and_its_values_are_determined(tmp_path: Path) -> None:
    fit = fit_of(tmp_path, *at_rates(ONE))
    assert fit.goodness is not None
    assert fit.goodness.passes
    assert set(fit.table["verdict"]) == {"determined"}
    assert fit.table.loc["E_p", "low"] < 180.0 < fit.table.loc["E_p", "high"]
    assert "describes the tests" in fit.verdict[0]
    assert fit.summary().startswith(fit.verdict[0])
    assert f"E_p = {fit.values['E_p']:.4g} kJ/mol (" in fit.summary()
    assert fit.signals["noise_sd"].to_numpy() == pytest.approx(5e-4, rel=0.3)


@pytest.mark.solver
@pytest.mark.parametrize(
    ("reactions", "order"),
    [(ONE, 1.5), ([(0.5, 585.0, 170e3), (0.5, 635.0, 190e3)], 1.0)],
    ids=["order 1.5", "two reactions"],
)
def test_wrong_model_is_told_and_determines_nothing(
    tmp_path: Path, reactions: list[tuple[float, float, float]], order: float
) -> None:
    fit = fit_of(tmp_path, *at_rates(reactions, order))
    assert fit.goodness is not None
    assert not fit.goodness.describes
    assert fit.method == "least squares, as the model misses the tests"
    assert "determined" not in set(fit.table["verdict"])
    if order != 1.0:
        # Where there is one energy, the interval of the wrong order holds it.
        assert fit.table.loc["E_p", "low"] < 180.0 < fit.table.loc["E_p", "high"]
    text = str(fit)
    assert "apparent value" in fit.summary()
    assert "does not describe the tests" in text
    assert "°C" in fit.verdict[1]
    assert "scheme" in text


@pytest.mark.solver
def test_repeats_that_disagree_are_told_and_determine_nothing(tmp_path: Path) -> None:
    names = [f"t_N2_10K_{k}" for k in (1, 2, 3)]
    curve = mass(10.0, ONE, 1.0)
    curves = dict.fromkeys(names, curve) | {names[0]: np.interp(T + 26.0, T, curve)}
    fit = fit_of(tmp_path, curves, dict.fromkeys(names, 10.0))
    assert fit.goodness is not None
    (found,) = fit.goodness.repeats
    assert (found.experiment, found.kind) == (names[0], "start")
    assert found.size == pytest.approx(-26.0, abs=1.0)
    assert "determined" not in set(fit.table["verdict"])
    assert any("26 K lower" in line for line in fit.verdict)


@pytest.mark.solver
@pytest.mark.parametrize(
    ("reactions", "passes"),
    [(ONE, True), ([(0.5, 590.0, 170e3), (0.5, 635.0, 190e3)], False)],
    ids=["right model", "misfit of both"],
)
def test_misfit_that_two_repeats_share_is_no_scatter_between_them(
    tmp_path: Path, reactions: list[tuple[float, float, float]], passes: bool
) -> None:
    """They start 3 K apart; that scatter, known from two only, would cover a misfit of 1.6 %."""
    curve = mass(10.0, reactions, 1.0)
    curves = {f"t_N2_10K_{k}": np.interp(T + off, T, curve) for k, off in ((1, -1.5), (2, 1.5))}
    fit = fit_of(tmp_path, curves, dict.fromkeys(curves, 10.0))
    assert fit.goodness is not None
    assert fit.goodness.passes == passes


@pytest.mark.solver
@pytest.mark.parametrize("drift", [0.0, 0.01])
def test_interval_of_a_residue_holds_the_truth_where_balances_drift(
    tmp_path: Path, drift: float
) -> None:
    grown = np.linspace(0.0, 1.0, T.size)
    curves = {
        f"t_N2_{rate:g}K": mass(rate, ONE, 1.0) + sign * drift * grown
        for rate, sign in zip(RATES, (-0.2, 1.0, 1.0), strict=True)
    }
    fit = fit_of(tmp_path, curves, dict(zip(curves, RATES, strict=True)))
    low, high = fit.table.loc["y", "low"], fit.table.loc["y", "high"]
    assert low < 0.1 < high
    assert (high - low > 0.008) == bool(drift)


def test_scatter_from_point_to_point_ignores_what_lasts() -> None:
    white = np.random.default_rng(0).standard_normal(400)
    lasting = 5.0 * np.sin(np.linspace(0.0, 6.0, 400))
    assert scatter(white) == 1.0
    assert scatter(white + lasting) == 1.0
    assert scatter(3.0 * white) == pytest.approx(3.0, rel=0.1)


def test_missed_windows_are_those_that_are_off() -> None:
    off = np.zeros(400)
    off[100:180], off[300:320] = 0.1, -0.2
    sd = np.full(400, 0.01)
    windows = missed(off + 1e-3 * np.random.default_rng(1).standard_normal(400), sd)
    assert [pytest.approx(w, abs=4) for w in ((100, 179), (300, 319))] == windows
    assert missed(np.zeros(50), np.ones(50)) == [(0, 49)]


def test_a_signal_missed_for_long_by_a_tenth_of_its_range_is_told_whatever_the_noise() -> None:
    """Lasting errors of few repeats can be so large that no test of the noise fails."""
    time = np.linspace(0.0, 1.0, 500)
    noise = np.random.default_rng(3).standard_normal(500)
    for difference, passes in ((0.3 * noise, True), (0.2 * np.sin(9.0 * time), False)):
        averaged = float(np.sqrt(np.mean(moving_mean(difference, 0.02) ** 2)))
        signal = SignalGoodness("slab", "hrr", 0.5, 0.2, 1.0, 0.3, 1.0, averaged, ())
        found = Goodness(0.5, (signal,))
        assert found.describes == passes
        assert ("for long by more than a tenth" in verdict_words("", found)) != passes


def test_total_heat_of_a_sample_that_is_missed_is_told_whatever_the_noise() -> None:
    near = SignalGoodness("mcc", "hrr", 0.5, 0.03, 1.0, 0.01, 1.0, 0.03, (), total=0.92)
    for signal, described in (
        (replace(near, of_sample=True), True),
        (replace(near, of_sample=True, total=0.85), False),
        (replace(near, total=0.85), True),  # a slab: its burning is not all that it holds
    ):
        found = Goodness(0.5, (signal,))
        assert found.describes == described
        assert ("tenth of its range or of its total heat" in verdict_words("", found)) != described


def test_signals_that_are_far_off_count_as_missed_beside_one_that_noise_excludes() -> None:
    of_noise = SignalGoodness("slab", "mass", 1e-3, 0.1, 10.0, 0.01, 1.0, 0.1, ())
    far = SignalGoodness("slab", "back", 1.0, 5.0, 10.0, 0.1, 1.0, 5.0, ())
    said = verdict_words("", Goodness(1e-3, (of_noise, far, replace(far, averaged=0.1))))
    assert "it misses 2 of 3 signals (back of slab and mass of slab) by more than noise" in said
    assert "at most 50 % of a signal's range, that of back of slab." in said
    assert "or for long by more than a tenth of its range" in said
    assert "tenth" not in verdict_words("", Goodness(1e-3, (of_noise,)))


def test_signals_that_are_missed_are_named_the_worst_first() -> None:
    signals = tuple(
        SignalGoodness(f"slab_{k}", "mass", p, 0.1 * k, 10.0, 0.01, 1.0, 0.1, ())
        for k, p in enumerate((1.0, 1e-3, 1e-3, 1e-3, 1e-3))
    )
    said = verdict_words("", Goodness(1e-3, signals))
    assert "4 of 5 signals (mass of slab_4, mass of slab_3, mass of slab_2 and 1 more)" in said
    # None alone is excluded, but all together.
    together = tuple(replace(s, p=0.02 + 0.01 * k) for k, s in enumerate(signals))
    assert "1 of 5 signals (mass of slab_0) by" in verdict_words("", Goodness(1e-3, together))


def test_misfit_to_both_sides_is_told_by_its_rms() -> None:
    study = pf.read_study(Path(__file__).parents[2] / "config" / "smoke.yaml")
    for mean, rms, words in (
        (1e-5, 4e-3, "4 g/(m² s) off (rms), to both sides,"),
        (-1.5e-3, 4e-3, "4 g/(m² s) off (rms), to both sides,"),  # most of it cancels
        (2.5e-3, 4e-3, "2.5 g/(m² s) too high"),
        (1.5e-3, 1.6e-3, "1.5 g/(m² s) too high"),
    ):
        misses = (Miss(0.0, 99.0, None, None, mean, rms),)
        signal = SignalGoodness("slab_25", "mlr", 1e-6, 4e-3, 0.1, 1e-4, 1.0, 1e-3, misses)
        said = where_missed(study, signal)
        assert f"simulated {words}" in said
        # A window of the noise may be elsewhere than the largest misfit.
        assert ("of the whole record is 4 g/(m² s)" in said) == (rms < 4e-3)


def test_misfit_of_one_point_is_told_at_its_place() -> None:
    study = pf.read_study(Path(__file__).parents[2] / "config" / "smoke.yaml")
    for begin, end, words in ((10.2, 10.4, "too high at 10 s."), (10.0, 20.0, "from 10 to 20 s.")):
        misses = (Miss(begin, end, None, None, 2e-3, 2e-3),)
        signal = SignalGoodness("slab_25", "mlr", 1e-6, 2e-3, 0.1, 1e-4, 1.0, 1e-3, misses)
        assert where_missed(study, signal).endswith(words)


@pytest.mark.parametrize("described", [True, False])
def test_repeats_described_differently_are_compared_less_that_difference(described: bool) -> None:
    time = np.linspace(0.0, 900.0, 181)
    simulated = [0.01 / (1.0 + np.exp((time - end) / 20.0)) for end in (500.0, 500.0, 600.0)]
    factors = (1.0, 1.0, 1.2 if described else 1.0)
    runs, terms = {}, []
    for k, (curve, factor) in enumerate(zip(simulated, factors, strict=True)):
        sample = {"layers": [{"thickness_m": 0.01}], "density_factor": factor}
        experiment = KINDS["gasification"].description.model_validate(
            {
                "kind": "gasification",
                "sample": sample,
                "front": {"flux_W_m2": 25e3},
                "signals": {"mlr": {"file": "synthetic"}},
                "repeat": {"test": "slab"},
            }
        )
        runs[f"slab_{k}"] = SimpleNamespace(experiment=experiment)
        terms.append((1.0, SimpleNamespace(target=Target(time, curve))))
    problem = SimpleNamespace(
        names=(),
        runs=runs,
        picks=[(name, "mlr", np.arange(time.size)) for name in runs],
        cost=SimpleNamespace(terms=terms),
        temperature_K=lambda channel: None,
    )
    likelihood: Any = SimpleNamespace(problem=problem, split=lambda whole: np.split(whole, 3))
    curves = np.concatenate(simulated if described else simulated[:1] * 3)
    assert len(list(differing(likelihood, curves))) == (0 if described else 1)


@pytest.mark.solver
def test_noise_of_a_fit_follows_the_curve_of_least_squares_as_in_a_run(tmp_path: Path) -> None:
    """The likeliest curve may be far from the data, where lasting errors allow it."""
    at = np.linspace(400.0, 800.0, 201)
    humps = [1e5 * np.exp(-0.5 * ((at - peak) / 25.0) ** 2) for peak in (560.0, 640.0)]
    noise = 200.0 * np.random.default_rng(0).standard_normal(at.size)
    rows = np.column_stack([at - 400.0, at, sum(humps) + noise])
    file = tmp_path / "m_MCC_N2_60K_1.csv"
    head = "Time (s),Temperature (K),HRR (W/kg)"
    np.savetxt(file, rows, "%.6f", ",", header=head, comments="")
    study = pf.read_study(init("m", {"mcc": [file]}, tmp_path)[0])
    fit = pf.fit(study, profiles=False)
    assert fit.method.startswith("least squares")
    assert fit.goodness is not None
    total = fit.goodness.signals[0].total
    curve = fit.curves
    over = [float(np.trapezoid(curve[name], curve["time_s"])) for name in ("simulated", "measured")]
    assert total == pytest.approx(over[0] / over[1], rel=0.01)
    values = {n: v * study.parameters[n].factor for n, v in fit.values.items()}
    series = read_measured(study, [(file.stem, "specific_heat_release_rate")], None)
    posed = pose_likelihood(study, of_diagnosis(study), series, {}, [values])
    expected = np.median(posed.noise[0].lasting_sd)
    assert fit.signals["lasting_sd"].to_numpy() == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(
    ("tests", "advice"),
    [
        ({"tga": (5.0, 20.0)}, "pyrofit run STUDY scheme"),
        ({"tga": (5.0, 5.0)}, ""),
        ({"mcc": (30.0, 60.0)}, ""),
        ({"dsc": (5.0, 20.0)}, "baseline"),
    ],
)
def test_a_scheme_is_advised_only_where_it_can_be_chosen(
    tmp_path: Path, tests: dict[str, tuple[float, float]], advice: str
) -> None:
    ((kind, rates),) = tests.items()
    files = []
    for k, rate in enumerate(rates):
        values = mass(rate, ONE, 1.0)[SHARE]
        if kind != "tga":
            values = -2e7 * np.gradient(values, (T[SHARE] - T[0]) / rate * 60.0)
        rows = np.column_stack([(T[SHARE] - T[0]) / rate * 60.0, T[SHARE], values])
        files.append(tmp_path / f"t_N2_{rate:g}K_{k}.csv")
        measured = {"tga": "Mass (-)", "mcc": "HRR (W/kg)", "dsc": "Heat flow (W/kg)"}[kind]
        head = f"Time (s),Temperature (K),{measured}"
        np.savetxt(files[-1], rows, "%.6f", ",", header=head, comments="")
    study = pf.read_study(init("x", {kind: files}, tmp_path)[0])
    signals = tuple(
        SignalGoodness(name, signal, 0.0, 0.1, 1.0, 0.01, 1.0, 0.1, ())
        for name, experiment in study.experiments.items()
        for signal in experiment.signals
    )
    said, command = next_step(study, "imp", Goodness(0.0, signals))
    if advice == "baseline":
        assert "give the experiment a `baseline`" in said
    else:
        assert command == advice
        assert ("Measure" in said) == (not advice)
