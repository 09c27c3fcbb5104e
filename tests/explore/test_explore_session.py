"""What the page of the explorer shows are the curves and numbers of the library."""

import base64
import json
import time
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import cone_twin as cone
import numpy as np
import pandas as pd
import pytest
from calorimetry_study import STUDY as CALORIMETRY

import pyrofit as pf
from pyrofit.config import Study, as_study, as_yaml, read_mapping
from pyrofit.errors import StudyError
from pyrofit.estimate.problem import Problem
from pyrofit.plugins import use_plugins
from pyrofit.results.files import Results
from pyrofit_explore.describe import described_study
from pyrofit_explore.fit import descend_and_tell
from pyrofit_explore.model import pose_model
from pyrofit_explore.save import save_state
from pyrofit_explore.session import Session, State, session_of, state_of
from pyrofit_explore.sets import named_sets

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"
TRUTH = {"T_p": 605.0, "E_p": 190.0, "rho": 1190.0, "k": 0.2, "cp": 2.1, "eps": 0.9, "dh": 800.0}
SPREAD = {"flux_spread_spread": 0.2}


def drawn_curves(session: Session, state: State) -> dict[str, np.ndarray]:
    found = session.curves(state)
    assert found["failed"] == {}
    values = np.frombuffer(base64.b64decode(found["curves"]), "<f4")
    curves, at = {}, 0
    for signal in session.description()["signals"]:
        curves[signal["id"]] = values[at : at + len(signal["x"])]
        at += len(signal["x"])
    assert at == values.size
    return curves


def test_curves_are_those_of_simulate(session: Session) -> None:
    of_page = drawn_curves(session, State(TRUTH))
    series = dict(session.measurements)
    curves = pf.simulate(session.study, TRUTH, data=series)
    signals = {s["id"]: s for s in session.description()["signals"]}
    for (name, signal), frame in curves.items():
        quantity = session.study.experiments[name].quantity(signal)
        own = quantity.shown.factor * frame[quantity.column].to_numpy() + quantity.shown.offset
        axis = frame["temperature_K"] - 273.15 if quantity.against_temperature else frame["time_s"]
        at = np.searchsorted(axis, np.array(signals[f"{name}/{signal}"]["x"]) - 1e-2)
        largest = np.abs(own).max()
        np.testing.assert_allclose(of_page[f"{name}/{signal}"], own[at], atol=2e-3 * largest)


def test_chi_square_is_that_of_the_log_likelihood(session: Session) -> None:
    assert session.pending is not None
    session.pending.wait(300.0)
    assert session.pending.error == ""
    of_signals = session.curves(State(TRUTH))["numbers"]["signals"]
    log_p = pf.log_likelihood(session.study, dict(session.measurements))
    total = sum(s["chi2"] for s in of_signals.values())
    assert -0.5 * total == pytest.approx(log_p({n: TRUTH[n] for n in log_p.names}), rel=1e-9)


def test_held_out_signals_count_in_no_number(session: Session) -> None:
    found = session.curves(State(TRUTH))["numbers"]
    fitted = {"tga_5K/mass_fraction", "tga_20K/mass_fraction", "slab_25/mlr"}
    assert set(found["signals"]) == fitted
    assert set(found["mass"]) == {"slab_25/mlr"}
    shown = {s["id"] for s in session.description()["signals"] if s["fitted"]}
    assert shown == fitted


def test_costs_are_those_of_the_study(session: Session) -> None:
    costs = session.curves(State(TRUTH))["numbers"]["costs"]
    assert list(costs) == ["RMSE", "RANGE", "BANDS"]
    mlr = session.measurements["slab_25", "mlr"]["mlr_kg_m2_s"].to_numpy()
    model, simulated = session.simulate(State(TRUTH))
    curve = simulated.models[model.signals.index(("slab_25", "mlr"))]
    by_hand = np.sqrt(np.mean((curve - mlr) ** 2)) / mlr.mean()
    assert costs["RMSE"] == pytest.approx(by_hand, rel=1e-9)


def test_an_effect_at_null_leaves_the_curves_and_elsewhere_changes_them(session: Session) -> None:
    base = drawn_curves(session, State(TRUTH))
    null = drawn_curves(session, State({**TRUTH, "flux_spread_spread": 0.0}, ("flux_spread",)))
    spread = drawn_curves(session, State({**TRUTH, **SPREAD}, ("flux_spread",)))
    for name, curve in base.items():
        assert np.array_equal(null[name], curve)
        assert np.array_equal(spread[name], curve) == name.startswith("tga")


def test_curves_with_an_effect_are_those_of_a_study_with_it(session: Session) -> None:
    changed = pf.read_study(session.study, effects={"flux_spread": {"spread": 0.2}})
    other = pose_model(changed, session.measurements)
    model, simulated = session.simulate(State({**TRUTH, **SPREAD}, ("flux_spread",)))
    values = session.values(model, State(TRUTH))
    for mine, theirs in zip(simulated.models, other.simulate(values).models, strict=True):
        assert np.array_equal(mine, theirs)


def test_every_possible_effect_is_simulated(session: Session) -> None:
    offered = session.description()["effects"]
    assert len(offered) > 20
    for effect in offered:
        numbers = {n["name"]: n["start"] for n in effect["numbers"]}
        found = session.curves(State({**TRUTH, **numbers}, (effect["name"],)))
        assert found["failed"] == {}, effect["name"]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({}, "`values` by name"),
        ({"values": {"kk": 1.0}}, "unknown parameter 'kk'"),
        ({"values": {"k": "wide"}}, "no finite number"),
        ({"values": {"k": -0.2}}, "'k': -0.2"),
        ({"values": {}, "effects": ["swell"]}, "unknown effect 'swell'"),
    ],
)
def test_a_wrong_state_is_told(session: Session, given: dict[str, Any], words: str) -> None:
    with pytest.raises(StudyError, match=words):
        session.curves(state_of(given))


def test_a_failing_run_is_told_and_leaves_the_other_curves(session: Session) -> None:
    accuracy = session.study.accuracy.model_copy(update={"most_steps": 3})
    study = session.study.model_copy(update={"accuracy": accuracy})
    base = pose_model(study, session.measurements)
    other = Session(study, session.measurements, base, {}, [])
    found = other.curves(State(TRUTH))
    assert set(found["failed"]) == {"slab_25", "slab_60"}
    assert "steps" in found["failed"]["slab_25"]
    assert found["numbers"]["costs"]["RMSE"] is None
    assert found["numbers"]["signals"]["tga_5K/mass_fraction"]["rms"] < 0.01
    json.dumps(found, allow_nan=False)


def fitted(session: Session, start: Mapping[str, float], ticked: list[str]) -> dict[str, float]:
    sent: list[Mapping[str, Any]] = []
    descend_and_tell(session, State(start), ticked, sent.append)
    assert "has ended" in sent[-1]["said"]
    return {**start, **sent[-1]["values"]}


def test_a_fit_ends_at_the_optimum_of_the_ticked_parameters(session: Session) -> None:
    start = {**TRUTH, "k": 0.3, "eps": 0.7}
    values = fitted(session, start, ["k", "eps"])
    own = pf.fit(
        session.study,
        dict(session.measurements),
        estimate=["k", "eps"],
        fixed={n: v for n, v in TRUTH.items() if n not in ("k", "eps")},
        profiles=False,
        starts=1,
    )
    assert values["k"] == pytest.approx(own.values["k"], rel=1e-3)
    assert values["eps"] == pytest.approx(own.values["eps"], rel=1e-3)
    assert values["cp"] == TRUTH["cp"]


def test_a_page_that_is_gone_ends_its_fit(session: Session) -> None:
    calls = []

    def gone(message: Mapping[str, Any]) -> None:
        calls.append(message)
        raise BrokenPipeError

    with pytest.raises(BrokenPipeError):
        descend_and_tell(session, State(TRUTH), ["k"], gone)
    assert len(calls) == 1


def test_a_fit_needs_a_ticked_parameter(session: Session) -> None:
    with pytest.raises(StudyError, match="no parameter is ticked"):
        descend_and_tell(session, State(TRUTH), [], lambda message: None)


def test_a_saved_study_has_the_same_curves(session: Session, tmp_path: Path) -> None:
    state = State({**TRUTH, "k": 0.25, **SPREAD}, ("flux_spread",))
    ticked = ["k", "eps", "flux_spread_spread"]
    study, values = save_state(session, state, ticked, "mine", tmp_path)
    again = session_of(study, tmp_path, str(values), noise=False)
    assert set(again.study.imp.estimate) == set(ticked)
    assert again.study.kinetics is None or again.study.kinetics.estimate == ()
    kept = again.sets[str(values)]
    mine = drawn_curves(session, state)
    saved = drawn_curves(again, State({n: kept[n] for n in ticked}))
    for name, curve in mine.items():
        np.testing.assert_allclose(saved[name], curve, rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("ticked", [["k"], ["k", "swelling_step"]])
def test_a_saved_study_keeps_its_measurements(
    session: Session, tmp_path: Path, ticked: list[str]
) -> None:
    numbers = {"swelling_step": 0.5, "swelling_temperature_K": 560.0, "swelling_width_K": 20.0}
    state = State({**TRUTH, **numbers}, ("swelling",))
    study, values = save_state(session, state, ticked, "mine", tmp_path)
    again = session_of(study, tmp_path, str(values), noise=False)
    for key, frame in session.measurements.items():
        pd.testing.assert_frame_equal(again.measurements[key], frame, rtol=1e-9)
    mine = session.curves(state)["numbers"]
    assert again.curves(State(again.sets[str(values)]))["numbers"]["costs"] == pytest.approx(
        mine["costs"], rel=1e-6
    )


def test_a_saved_study_writes_over_nothing(session: Session, tmp_path: Path) -> None:
    save_state(session, State(TRUTH), ["k"], "mine", tmp_path)
    with pytest.raises(StudyError, match="there already"):
        save_state(session, State(TRUTH), ["k"], "mine", tmp_path)
    with pytest.raises(StudyError, match="letters, digits and _"):
        save_state(session, State(TRUTH), ["k"], "../mine", tmp_path)


def test_twenty_curves_take_little_of_a_processor(twenty: Study) -> None:
    # The page wants them within 50 ms. Time of the processor does not depend on other programs.
    many = session_of(twenty, noise=False)
    assert len(many.base.signals) == 20
    many.curves(State(TRUTH))
    begin = time.process_time()
    for k in range(10):
        many.curves(State({**TRUTH, "k": 0.15 + 0.01 * k}))
    assert time.process_time() - begin < 10 * 0.05


def test_only_experiments_with_new_values_are_simulated(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    model, simulated, asked = replace(session.base), Problem.simulated, []

    def watched(of: Problem, values: Any, sets: int, names: Any = None) -> Any:
        asked.append(list(names))
        return simulated(of, values, sets, names)

    values = {name: model.study.parameters[name].factor * v for name, v in TRUTH.items()}
    monkeypatch.setattr(Problem, "simulated", watched)
    model.simulate(values)
    moved = values | {"k": 0.25}
    found = model.simulate(moved)
    slabs = [n for n in model.problem.runs if n.startswith("slab")]
    assert asked == [list(model.problem.runs), slabs]
    model.simulate(moved)
    assert asked[2:] == [[]]
    anew = replace(session.base).simulate(moved)
    for one, other in zip(found.models, anew.models, strict=True):
        np.testing.assert_array_equal(one, other)


def test_bands_of_the_posterior_stand_at_the_drawn_points(session: Session) -> None:
    time_s = np.linspace(0.0, 1600.0, 81)
    about = {"experiment": "slab_25", "signal": "mlr", "time_s": time_s}
    bands = pd.DataFrame({**about, "low": 1e-6 * time_s, "high": 2e-6 * time_s})
    signals = {s["id"]: s for s in described_study(session.base, bands)["signals"]}
    low, high = np.array(signals["slab_25/mlr"]["band"])
    at = np.array(signals["slab_25/mlr"]["x"])
    np.testing.assert_allclose(low, 1e-3 * at, rtol=1e-4)  # shown in g/(m2 s)
    np.testing.assert_allclose(high, 2e-3 * at, rtol=1e-4)
    assert signals["slab_25/back_temperature"]["band"] is None


def test_the_published_sets_of_a_study_need_no_results(tmp_path: Path) -> None:
    paper = pf.read_study(SMOKE.with_name("paper.yaml"))
    sets, remarks = named_sets(paper, Results(tmp_path), "", tmp_path)
    assert list(sets) == ["Table 3, kinetics", *(f"{c} published" for c in paper.imp.costs)]
    assert remarks == []
    values = sets["RMSE published"]
    assert values["k_a"] == 0.1083
    # k = A exp(-E / (R T)) is the rate at the reference temperature.
    for of, A, E in (("A", 9.98e4, 62.4e3), ("B", 1.0e11, 160.0e3)):
        assert values[f"E_{of}"] == pytest.approx(1e-3 * E)
        assert A * np.exp(-E / (8.314462618 * values[f"T_{of}"])) == pytest.approx(0.001)
    assert values["w_A"] == 0.025


@pytest.mark.measured
def test_the_published_set_has_the_published_cost(tmp_path: Path) -> None:
    paper = session_of(SMOKE.with_name("paper.yaml"), tmp_path, noise=False)
    found = paper.curves(State(paper.sets["RMSE published"]))["numbers"]["costs"]["RMSE"]
    assert found == pytest.approx(paper.study.published.costs["RMSE"]["fit"][0], rel=0.01)


def test_every_kind_of_test_has_curves_and_effects() -> None:
    for study in (as_study(CALORIMETRY, "calorimetry.yaml"), cone.study()):
        of_kinds = session_of(study, noise=False)
        state = State(of_kinds.sets["truth"])
        found = of_kinds.curves(state)
        assert found["failed"] == {}
        assert all(one["rms"] > 0.0 for one in found["numbers"]["signals"].values())
        before = drawn_curves(of_kinds, state)
        moved = set()
        for effect in of_kinds.description()["effects"]:
            numbers = {n["name"]: n["start"] for n in effect["numbers"]}
            on = State({**state.values, **numbers}, (effect["name"],))
            after = drawn_curves(of_kinds, on)
            moved |= {name for name, y in after.items() if not np.array_equal(y, before[name])}
        assert moved == set(before)


def test_curves_of_another_program_follow(tmp_path: Path) -> None:
    plate = session_of(SMOKE.with_name("hotplate.yaml"), tmp_path, noise=False)
    truth = plate.sets["truth"]
    name = next(iter(truth))
    near, far = (drawn_curves(plate, State({**truth, name: f * truth[name]})) for f in (1.0, 1.1))
    signals = {s["id"]: s for s in plate.description()["signals"]}
    for key, curve in near.items():
        measured = np.array(signals[key]["measured"])
        assert np.sqrt(np.mean((curve - measured) ** 2)) < 0.05 * np.ptp(measured)
        assert not np.array_equal(curve, far[key])


@pytest.fixture
def own_study(tmp_path: Path) -> Iterator[Path]:
    """Return a study whose folder has the effect, quantity and cost of the documentation."""
    page = (SMOKE.parents[1] / "docs" / "adding.md").read_text(encoding="utf-8")
    codes = [part.split("```")[0] for part in page.split("```python\n")[1:]]
    places = ("effects/natural_convection", "quantities/thickness_of_sample", "costs/huber")
    for place, code in zip(places, codes, strict=False):
        path = tmp_path / "own" / f"{place}.py"
        path.parent.mkdir(parents=True)
        path.write_text(code, encoding="utf-8")
    keys = read_mapping(SMOKE) | {"plugins": ["own"]}
    signals = keys["experiments"]["slab_25"]["signals"]
    signals["thickness_of_sample"] = {"file": "synthetic", "every": 20, "noise": 1e-5}
    term = {"experiment": "slab_25", "signal": "mlr", "kind": "huber", "options": {"bend": 1e-3}}
    keys["imp"]["costs"]["OWN"] = [term]
    study = tmp_path / "own.yaml"
    study.write_text(as_yaml(keys, ""), encoding="utf-8")
    yield study
    use_plugins([])


def test_effects_quantities_and_costs_of_an_own_folder_are_explored(
    own_study: Path, tmp_path: Path
) -> None:
    own = session_of(own_study, tmp_path)
    try:
        assert own.pending is not None
        own.pending.wait(300.0)  # another process knows the folder, too
        assert (own.noise is not None, own.pending.error) == (True, "")
        base = State(own.sets["truth"])
        (effect,) = (e for e in own.description()["effects"] if e["name"] == "natural_convection")
        numbers = {n["name"]: n["start"] for n in effect["numbers"]}
        on = State({**base.values, **numbers}, ("natural_convection",))
        thickness = "slab_25/thickness_of_sample"
        before, after = drawn_curves(own, base), drawn_curves(own, on)
        assert not np.array_equal(before[thickness], after[thickness])
        costs = own.curves(on)["numbers"]["costs"]
        assert costs["OWN"] > 2.0 * own.curves(base)["numbers"]["costs"]["OWN"]
        study, values = save_state(own, on, ["k"], "mine", tmp_path)
        again = session_of(study, tmp_path, str(values), noise=False)
        saved = again.curves(State(again.sets[str(values)]))["numbers"]["costs"]
        assert saved == pytest.approx(costs, rel=1e-6)
    finally:
        own.close()
