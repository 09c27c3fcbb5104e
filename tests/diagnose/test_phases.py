"""Phases of synthetic courses, and windows of disagreement in physical terms."""

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hidden_effects import Diagnosed
from small import TIMES

from pyrofit.diagnose.diagnosis import DiagnosisWork
from pyrofit.diagnose.result import phases
from pyrofit.diagnose.result.phases import course_of_channel, describe_windows
from pyrofit.experiments.base import PHASES
from pyrofit.experiments.heated.kind import of_mass
from pyrofit.experiments.slab.kind import of_curves

TIME = np.arange(0.0, 1001.0)


def slab(back_warms_at: float) -> dict[str, np.ndarray[Any, Any]]:
    """Rate 0 until 100 s, up to 1 within 100 s, 1 until 800 s, down to 0 at 900 s."""
    rate = np.interp(TIME, [0, 100, 200, 800, 900, 1000], [0, 0, 1, 1, 0, 0])
    gone = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]))])
    front = 300.0 + 300.0 * np.clip(TIME / 200.0, 0.0, 1.0)
    back = 300.0 + 300.0 * (back_warms_at <= TIME)
    mass = 700.0 + 50.0 - gone
    return {"mlr": rate, "mass": mass, "front_temperature": front, "back_temperature": back}


def starts(
    phase: np.ndarray[Any, Any], time: np.ndarray[Any, Any], called: Sequence[str] = PHASES
) -> dict[str, float]:
    names = [called[int(p)] for p in phase]
    assert list(phase) == sorted(phase)
    return {name: float(time[names.index(name)]) for name in dict.fromkeys(names)}


def test_phases_of_a_slab_begin_where_the_documentation_says() -> None:
    # 700 released in all: 0.9 of it after 100 + 50 + 580 = 730 s, 0.99 after 862.6 s:
    # 7 are left of the ramp's 50, (900 - t)^2/200 = 7.
    found = starts(of_curves(slab(back_warms_at=400.0)).phase, TIME)
    assert found == {
        "heat-up": 0.0,
        "onset": 110.0,
        "plateau": 180.0,
        "heated back": 400.0,
        "burn-out": 780.0,
        "tail": 863.0,
    }


def test_slab_whose_back_is_warm_early_has_no_plateau() -> None:
    found = starts(of_curves(slab(back_warms_at=50.0)).phase, TIME)
    assert list(found) == ["heat-up", "onset", "heated back", "burn-out", "tail"]
    assert found["heated back"] == 180.0


def test_phases_do_not_return_where_the_rate_falls_again() -> None:
    curves = slab(back_warms_at=400.0)
    curves["mlr"][300:320] = 0.05
    assert starts(of_curves(curves).phase, TIME)["heated back"] == 400.0


def test_conversion_is_the_released_share() -> None:
    found = of_curves(slab(back_warms_at=400.0))
    assert found.conversion[0] == 0.0
    assert found.conversion[-1] == pytest.approx(1.0)
    assert found.conversion[500] == pytest.approx((50.0 + 300.0) / 700.0)
    assert found.surface_temperature_K is not None
    assert found.surface_temperature_K[100] == 450.0


def test_phases_of_a_tga_begin_where_the_documentation_says() -> None:
    T = np.arange(1001.0)
    course = of_mass(1.0 - 0.9 * T / 1000.0)
    found = starts(course.phase, T, course.phases)
    ends = {"main reaction": 200, "end of reaction": 900, "residue": 990}
    expected = {"heat-up": 0, "onset": 20, **ends}
    assert list(found) == list(expected)
    assert all(abs(found[name] - at) <= 1.0 for name, at in expected.items())


def test_course_of_a_simulation_runs_through_the_phases_in_order(diagnosed: Diagnosed) -> None:
    found = diagnosed("nothing").search.base
    for channel in found.model.channels:
        one = course_of_channel(found.model, found.fit.x, channel)
        name, _ = found.model.base.channels[channel]
        assert one.phase.size == TIMES[name].size
        assert list(one.phase) == sorted(one.phase)
        assert one.phase[0] == 0
        assert one.phases[int(one.phase[-1])] == "tail"


def test_course_at_the_times_of_a_channel_keeps_the_phases_of_its_kind(
    diagnosed: Diagnosed, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = diagnosed("nothing").search.base
    heated = of_mass(np.linspace(1.0, 0.1, 1000))
    kind = SimpleNamespace(course=lambda *given: heated)
    monkeypatch.setattr(phases, "kind_of", lambda experiment: kind)
    one = phases.course_of_channel(found.model, found.fit.x, 0)
    assert one.phase.size < heated.phase.size
    assert one.phases == heated.phases


def test_windows_say_simulated_less_measured_at_their_place(unexplained: DiagnosisWork) -> None:
    found = unexplained.search
    windows = describe_windows("base", found.base, found.rounds[0].lack().windows, 1.0)
    assert windows
    for w, stretch in zip(windows, found.rounds[0].lack().windows, strict=True):
        rows = unexplained.curves.query("experiment == @w.experiment and signal == @w.signal")
        part = rows.iloc[stretch.start : stretch.end]
        assert part["time_s"].iloc[0] == w.start_s
        assert part["time_s"].iloc[-1] == w.end_s
        mean = float((part["before"] - part["measured"]).mean())
        assert w.mean == pytest.approx(mean, rel=1e-9)
        assert w.relative == pytest.approx(mean / part["measured"].abs().mean(), rel=1e-9)
        assert w.unit == ("K" if w.signal == "back_temperature" else "kg/(m² s)")
        assert w.start_K is None
        assert w.critical == 1.0


def test_model_without_the_late_heater_starts_too_early(unexplained: DiagnosisWork) -> None:
    """The heater comes up slowly in truth: at first the model is ahead, to be behind later."""
    windows = [w for w in unexplained.content.windows if w.model == "base"]
    rate = [w for w in windows if w.signal == "mlr" and w.experiment == "slab_60"]
    early = min(rate, key=lambda w: w.start_s)
    assert early.phase in ("heat-up", "onset")
    assert early.sign == 1
    assert early.mean > 0.0
