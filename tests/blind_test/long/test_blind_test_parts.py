"""The blind test of the diagnosis: plans, twins that hide their truth, verdicts judged by hand."""

import json
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import pandas as pd
import pytest

from pyrofit.config import Study, candidate_effects, diagnosed_parameters
from pyrofit.effects import known_effects, same_as
from pyrofit.errors import DataError, StudyError
from pyrofit.estimate.targets import Measurements
from pyrofit.model.accuracy import Resolution
from pyrofit.model.parameters import Parameter
from pyrofit.results.diagnosis_candidates import OfCandidate
from pyrofit.results.diagnosis_schema import (
    Diagnosis,
    OfBase,
    OfExtended,
    OfGap,
    OfParameter,
    OfScreen,
    OfVerdict,
    OfWindow,
)
from pyrofit.results.files import read_json, write_json
from pyrofit_blind_test.detectability import detectability
from pyrofit_blind_test.page import TABLES, write_results
from pyrofit_blind_test.places import Places
from pyrofit_blind_test.plan import TwinPlan, cases_of, chunk_of
from pyrofit_blind_test.rates import by_detectability, rate_interval, rates
from pyrofit_blind_test.run import run_case, run_chunk
from pyrofit_blind_test.setting import Setting, read_setting
from pyrofit_blind_test.table import row_of
from pyrofit_blind_test.twin import describe_twin, make_twin, read_twin, write_twin

FILE = Path(__file__).parents[3] / "config" / "blind_test.yaml"
FORM = {"kind": "form", "strength": 1.0, "signals": "mlr", "noise": "white", "seed": 5}


@pytest.fixture(scope="module")
def setting() -> Setting:
    coarse = Resolution(elements=40, tolerance=1e-5)
    return read_setting(FILE).model_copy(update={"accuracy": coarse})


@pytest.fixture(scope="module")
def full(setting: Setting) -> tuple[TwinPlan, ...]:
    return cases_of(setting, "full")


def case_of(setting: Setting, **wanted: Any) -> TwinPlan:
    return case_of_plan(setting, "develop", **wanted)


def case_of_plan(setting: Setting, plan: str, **wanted: Any) -> TwinPlan:
    cases = cases_of(setting, plan)
    return next(c for c in cases if all(getattr(c, k) == v for k, v in wanted.items()))


def altered(**changes: Any) -> dict[str, Any]:
    given = read_setting(FILE).model_dump(mode="json")
    for place, value in changes.items():
        part = given
        *path, last = place.split("__")
        for key in path:
            part = part[key]
        part[last] = value
    return given


# Plans


def test_plan_is_the_same_each_time_and_every_twin_is_another(
    setting: Setting, full: tuple[TwinPlan, ...]
) -> None:
    assert cases_of(setting, "full") == full
    assert len({case.id for case in full}) == len(full)
    assert len({case.seed for case in full}) == len(full)


def test_full_plan_hides_every_effect_at_both_strengths_wherever_it_can_be_seen(
    full: tuple[TwinPlan, ...],
) -> None:
    found = {(*c.hidden, c.signals, round(c.strength, 3)) for c in full if c.kind == "effect"}
    sets = dict.fromkeys(known_effects(), ("mlr", "mlr+back", "mlr+back+tga"))
    sets |= dict.fromkeys(("tga_lag", "tga_offset"), ("mlr+back+tga",))
    del sets["char_oxidation"]  # no test of the base is made in a gas with oxygen
    assert found == {(n, s, part) for n, of in sets.items() for s in of for part in (1.0, 0.333)}


def test_full_plan_has_enough_nulls_and_pairs(full: tuple[TwinPlan, ...]) -> None:
    nulls = [(c.signals, c.noise) for c in full if c.kind == "null"]
    assert len(nulls) >= 210
    assert {nulls.count(cell) for cell in set(nulls)} == {len(nulls) // 9}
    pairs = {tuple(sorted(c.hidden)) for c in full if c.kind == "pair"}
    assert len(pairs) >= 10
    catalogue = known_effects()
    assert all(catalogue[a].group != catalogue[b].group for a, b in pairs)


def test_each_noise_meets_each_effect(full: tuple[TwinPlan, ...]) -> None:
    for name in known_effects().keys() - {"char_oxidation", "tga_lag", "tga_offset"}:
        seen = {c.noise for c in full if c.kind == "effect" and name in c.hidden}
        assert seen == {"white", "measured", "ar0.5"}, name


def test_seeds_for_developing_and_for_reporting_are_disjoint(setting: Setting) -> None:
    seeds = {plan: {c.seed for c in cases_of(setting, plan)} for plan in setting.plans}
    assert not seeds["full"] & (seeds["develop"] | seeds["short"])
    for plan, found in seeds.items():
        first, last = setting.seeds[setting.plans[plan].seeds]
        assert all(first <= seed <= last for seed in found)


def test_seed_of_a_case_does_not_change_when_the_plan_grows(setting: Setting) -> None:
    more = setting.plans["develop"].model_copy(update={"nulls": 9, "effects": 2})
    larger = setting.model_copy(update={"plans": {"develop": more}})
    seeds = {c.seed for c in cases_of(larger, "develop")}
    assert seeds > {c.seed for c in cases_of(setting, "develop")}


def test_nominal_strengths_are_the_published_ones_and_a_third_is_counted_from_the_null(
    full: tuple[TwinPlan, ...],
) -> None:
    def strengths(name: str) -> list[float]:
        effects = (c for c in full if c.kind == "effect" and name in c.hidden)
        return sorted({value for c in effects for value in c.hidden[name].values()})

    assert strengths("k_T") == pytest.approx([-1e-3, -1e-3 / 3])
    assert strengths("foil_mass") == pytest.approx([1 + 2.5 / 3, 3.5])
    assert strengths("back_loss") == pytest.approx([0.5, 1 - 0.5 / 3])
    assert strengths("thickness") == pytest.approx([1 + 0.02 / 3, 1.02])


def test_twins_are_those_that_were_counted(full: tuple[TwinPlan, ...]) -> None:
    # A case that no catalogue of effects changes; the counts of docs/blind_test.md are of these.
    null = {"kind": "null", "signals": "mlr", "noise": "white"}
    first = next(c for c in full if all(getattr(c, key) == value for key, value in null.items()))
    assert (first.id, first.seed) == ("twin_053cb85435", 7472747)


def test_jobs_share_the_cases(full: tuple[TwinPlan, ...]) -> None:
    parts = [chunk_of(full, i, 7) for i in range(7)]
    assert sorted(c.id for part in parts for c in part) == [c.id for c in full]
    assert max(map(len, parts)) - min(map(len, parts)) <= 1


def test_short_plan_keeps_to_its_numbers(setting: Setting) -> None:
    kinds = [c.kind for c in cases_of(setting, "short")]
    most = setting.plans["short"].most
    assert {kind: kinds.count(kind) for kind in most} == dict(most)


def test_every_truth_of_the_plan_is_a_valid_study(
    setting: Setting, full: tuple[TwinPlan, ...]
) -> None:
    # Each combination of effects once, under the signals that show most.
    by_signals = sorted(full, key=lambda c: c.signals)
    shown = {json.dumps([c.hidden, c.error], sort_keys=True): c for c in by_signals}
    for case in shown.values():
        _, truth = describe_twin(setting, case)
        assert truth.synthetic is not None
        assert truth.synthetic.effects == case.hidden


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"nominal__k_TT": 1.0}, "unknown effect 'k_TT'. Did you mean 'k_T'"),
        ({"seeds__report": [5, 10]}, "overlaps 'develop'"),
        ({"plans__full__seeds": "reports"}, "Did you mean 'report'"),
        ({"signals__tga": ["mass_fraction"]}, "signals.tga: lacks the cost_signal mlr; add it"),
        ({"noise__measured__mlr": {"autocorrelation": [-0.9]}}, "not positive definite"),
        ({"pair_signals": ["back"]}, "unknown set of signals 'back'"),
    ],
)
def test_bad_setting_says_what_is_wrong(tmp_path: Path, changes: dict[str, Any], says: str) -> None:
    path = tmp_path / "blind.yaml"
    path.write_text(json.dumps(altered(**changes)))
    with pytest.raises(StudyError) as error:
        read_setting(path)
    assert says in str(error.value)


def test_range_beyond_a_limit_is_refused(setting: Setting) -> None:
    wide = setting.model_copy(update={"vary": {**setting.vary, "k_r": 0.2}})
    with pytest.raises(StudyError, match=r"vary.k_r: 0.16 -\+ 0.2 passes the limits 0.09 to 0.55"):
        cases_of(wide, "full")


def test_unknown_plan_is_refused(setting: Setting) -> None:
    with pytest.raises(StudyError, match=r"unknown plan 'ful'. Did you mean 'full'"):
        cases_of(setting, "ful")


# Twins


def test_twin_holds_no_truth(setting: Setting, tmp_path: Path) -> None:
    case = case_of(
        setting,
        kind="effect",
        strength=1.0,
        signals="mlr+back",
        hidden={"k_T": {"slope_1_K": -1e-3}},
    )
    places = Places(tmp_path)
    twin = make_twin(setting, case)
    write_twin(places, twin)
    study, measurements = read_twin(places, case.id)
    assert study.synthetic is None
    assert not study.with_effects
    text = (places.twin(case.id) / "study.yaml").read_text()
    assert "k_T" not in text
    assert "k_T" not in case.id
    assert str(case.seed) not in text
    truth = read_json(places.truth(case.id))
    assert truth["case"]["hidden"] == case.hidden
    for name, value in truth["values"].items():
        assert repr(value) not in text, name
    assert {f.name for f in places.twin(case.id).iterdir()} == {
        "study.yaml",
        *(f"{experiment}_{signal}.csv" for experiment, signal in measurements),
    }
    for key, frame in twin.series.items():
        pd.testing.assert_frame_equal(measurements[key], frame, check_dtype=False)


def test_twin_is_fitted_at_two_fluxes_and_predicted_at_a_third(setting: Setting) -> None:
    study, _ = describe_twin(setting, case_of(setting, kind="null", signals="mlr+back"))
    both = ["mlr", "back_temperature"]
    assert study["diagnosis"]["calibrate"] == {"capa_25": both, "capa_60": both}
    assert study["diagnosis"]["hold_out"] == {"capa_90": both}
    assert study["experiments"]["capa_90"]["front"]["flux_W_m2"] == 90000
    assert study["experiments"]["capa_60"]["front"]["flux_W_m2"] == 60000
    assert study["kinetics"] is None
    for experiment in study["experiments"].values():
        assert all("timing_s" not in signal for signal in experiment["signals"].values())


def test_kinetics_are_known_about_the_truth_where_no_tga_tells_them(setting: Setting) -> None:
    scaled = []
    for case in cases_of(setting, "develop"):
        if case.kind != "null":
            continue
        study, truth = describe_twin(setting, case)
        known = study["known"]
        assert set(known) == (set() if "tga" in case.signals else set(setting.known))
        assert truth.synthetic is not None
        scaled += [
            (prior["value"] - truth.synthetic.truth[name]) / prior["sd"]
            for name, prior in known.items()
        ]
    # 24 twins of 5 priors: mean 0 and standard deviation 1 within three of their own.
    assert len(scaled) == 120
    assert abs(np.mean(scaled)) < 3 / np.sqrt(120)
    assert abs(np.std(scaled) - 1.0) < 3 / np.sqrt(240)


@pytest.mark.parametrize("noise", ["white", "measured", "ar0.5"])
def test_noise_of_a_twin_is_of_its_kind_and_of_the_base_s_size(
    setting: Setting, noise: str
) -> None:
    _, truth = describe_twin(
        setting, case_of(setting, kind="null", noise=noise, signals="mlr+back")
    )
    mlr = truth.experiments["capa_25"].signals["mlr"].noise
    assert mlr.sd == 2.9e-4
    lag_one = {"white": 0.0, "measured": -0.25, "ar0.5": 0.5}[noise]
    assert mlr.correlation(3)[1] == lag_one


def test_form_may_leave_its_effect_out_of_the_candidates(setting: Setting, tmp_path: Path) -> None:
    hidden = {"back_convection": {"change_W_m2K": 4.0}}
    case = TwinPlan(hidden=hidden, without=("back_convection",), **FORM)
    write_twin(Places(tmp_path), make_twin(setting, case))
    study, _ = read_twin(Places(tmp_path), case.id)
    candidates = candidate_effects(study)
    assert "back_convection" not in candidates
    assert "back_loss" in candidates
    assert not {"tga_lag", "tga_offset"} & set(candidates)


def test_description_of_an_error_is_wrong_where_the_truth_is_not(setting: Setting) -> None:
    case = case_of_plan(setting, "errors", error="cold_back", signals="mlr+back")
    study, truth = describe_twin(setting, case)
    told = {name: one["back"]["h_W_m2K"] for name, one in study["experiments"].items()}
    assert told == {"capa_25": 4.0, "capa_60": 4.0, "capa_90": 4.0}
    true = {experiment.back.h_W_m2K for experiment in truth.experiments.values()}
    assert true == {30.0}
    assert truth.synthetic is not None
    assert truth.synthetic.effects == {}


def test_wrong_known_value_is_as_wrong_as_stated(setting: Setting) -> None:
    case = case_of_plan(setting, "errors", error="conductivity", signals="mlr+back+tga")
    study, truth = describe_twin(setting, case)
    assert truth.synthetic is not None
    assert study["known"].keys() == {"k_a"}
    known = study["known"]["k_a"]
    assert known["value"] - truth.synthetic.truth["k_a"] == pytest.approx(4 * known["sd"])


def test_error_of_the_tga_needs_a_tga(setting: Setting) -> None:
    errors = [c for c in cases_of(setting, "errors") if c.error == "tga_of_another_laboratory"]
    assert [c.signals for c in errors] == ["mlr+back+tga"]


def test_error_that_changes_nothing_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "blind.yaml"
    path.write_text(json.dumps(altered(errors={"foil": {"same": ["foil_mass"]}})))
    with pytest.raises(StudyError, match="changes nothing; give `known` or `truth`"):
        read_setting(path)


# Running


class Fake:
    """A diagnosis that always names k(T), and notes what it was given."""

    def __init__(self) -> None:
        self.candidates: list[tuple[str, ...]] = []

    def __call__(self, study: Study, measurements: Measurements) -> Diagnosis:
        self.candidates.append(candidate_effects(study))
        base = {name: at_middle(study.parameters[name]) for name in diagnosed_parameters(study)}
        return as_record(verdict("named", ["k_T"]) | {"base": {"parameters": base}})


def as_record(given: dict[str, Any]) -> Diagnosis:
    """Return the parts of a diagnosis that the blind test reads."""
    models = {"base": OfBase, "extended": OfExtended}
    parameters = {
        key: {n: OfParameter.model_construct(**p) for n, p in given[key]["parameters"].items()}
        for key in models
    }
    lists = {"candidates": OfCandidate, "gap": OfGap, "screen": OfScreen, "windows": OfWindow}
    return Diagnosis.model_construct(
        verdict=OfVerdict.model_construct(**given["verdict"]),
        **{key: of.model_construct(parameters=parameters[key]) for key, of in models.items()},
        **{key: [of.model_construct(**one) for one in given[key]] for key, of in lists.items()},
    )


def at_middle(parameter: Parameter) -> dict[str, Any]:
    """Return a parameter as a fit that ended in the middle of its limits."""
    low, high = parameter.lower, parameter.upper
    assert low is not None
    assert high is not None
    return {"value": 0.5 * (low + high), "low": low, "high": high, "unit": parameter.unit}


def verdict(kind: str, effects: list[str], sets: list[list[str]] | None = None) -> dict[str, Any]:
    gap = {"experiment": "capa_25", "signal": "mlr", "points": 100, "rms_before": 1, "rms_after": 1}
    before_after = {"chi2_before": 400.0, "chi2_after": 100.0}
    return {
        "verdict": {
            "kind": kind,
            "effects": effects,
            "sets": sets or [[e] for e in effects],
            "confirmed": kind in ("named", "multiple"),
        },
        "candidates": [
            {"effects": [], "rejected": "gains too little", "predictions": {}, "parameters": {}},
            {
                "effects": effects,
                "rejected": "",
                "predictions": {"capa_25": 1.0, "held out": 3.0},
                "parameters": {},
            },
        ],
        "base": {"parameters": {}},
        "extended": {"parameters": {}},
        "windows": [],
        "screen": [{"effect": "c_T", "z": -9.0}, {"effect": "k_T", "z": 3.0}],
        "gap": [
            {**gap, **before_after, "role": "calibration"},
            {**gap, **before_after, "chi2_after": 144.0, "role": "held out"},
        ],
    }


@pytest.fixture(scope="module")
def little(setting: Setting) -> Setting:
    """A plan of three twins in two jobs."""
    tiny = setting.plans["develop"].model_copy(
        update={"most": {"effect": 1, "null": 1, "form": 0, "pair": 1}, "strengths": (1.0,)}
    )
    update = {"chunks": 2, "left_out": 1}
    some = {"mlr": setting.signals["mlr"]}
    pairs = {"pair_signals": ("mlr",), "forms": (), "pairs": (("c_T", "k_T"),), "errors": {}}
    plans = {"tiny": tiny.model_copy(update=update)}
    return setting.model_copy(update={"plans": plans, "signals": some, **pairs})


def test_interrupted_job_goes_on_and_the_page_shows_all(
    little: Setting, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    places, fake = Places(tmp_path), Fake()
    monkeypatch.setattr("pyrofit_blind_test.run.source_fingerprint", lambda *_: "one source")
    cases = cases_of(little, "tiny")
    assert sorted(case.kind for case in cases) == ["effect", "null", "pair"]
    with pytest.raises(DataError, match=r"0.json: this result is missing"):
        write_results(little, "tiny", places)
    with pytest.raises(DataError, match="no twin of plan 'tiny' has been diagnosed"):
        write_results(little, "tiny", places, so_far=True)
    run_chunk(little, "tiny", 0, places, fake)
    write_results(little, "tiny", places, so_far=True)
    first = len(list(tmp_path.glob("cases/*.json")))
    assert f"{first} of 3 twins" in places.page.read_text()
    run_chunk(little, "tiny", 1, places, fake)
    # Each once, and effect and pair once more with an effect removed.
    assert len(fake.candidates) == 5
    again = read_json(places.case(cases[0].id))
    places.case(cases[1].id).unlink()
    for chunk in (0, 1):
        run_chunk(little, "tiny", chunk, places, fake)
    assert len(fake.candidates) == 5 + 1 + (cases[1].kind != "null")
    assert read_json(places.case(cases[0].id)) == again
    write_results(little, "tiny", places)
    page = places.page.read_text()
    assert "| no hidden effect: claimed | 1 | 1 | 1 |" in page
    for name in TABLES:
        assert (tmp_path / "tables" / f"{name}.csv").is_file()
    for name in ("confusion", "accuracy", "power", "false_alarms", "gaps"):
        assert f"figures/{name}.svg" in page
        assert (tmp_path / "figures" / f"{name}.svg").is_file()


def test_result_of_another_source_is_made_again(
    little: Setting, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    places, fake = Places(tmp_path), Fake()
    (index,) = (i for i in (0, 1) if len(chunk_of(cases_of(little, "tiny"), i, 2)) == 1)
    for source, runs in (("one", 1), ("one", 1), ("another", 2)):
        code = iter([source] * 99)
        monkeypatch.setattr("pyrofit_blind_test.run.source_fingerprint", lambda *_, c=code: next(c))
        run_chunk(little, "tiny", index, places, fake)
        case = cases_of(little, "tiny")[index]
        assert len(fake.candidates) == runs * (1 + case.left_out)


def test_effect_left_out_is_no_candidate_nor_its_double(little: Setting, tmp_path: Path) -> None:
    late = {"hidden": {"time_offset": {"delay_s": 5.0}}, "kind": "effect", "left_out": True}
    case = TwinPlan(**{**FORM, **late})
    fake = Fake()
    found = run_case(little, case, Places(tmp_path), fake)
    first, second = fake.candidates
    assert set(first) - set(second) == {"time_offset", "heater_ramp"}
    assert found["left_out"]["kind"] == "named"
    assert found["score_only"] == "c_T"


def test_of_a_pair_the_second_effect_is_left_out(little: Setting, tmp_path: Path) -> None:
    both = {"c_T": {"slope_1_K": 1e-3}, "time_offset": {"delay_s": 5.0}}
    case = TwinPlan(**{**FORM, "hidden": both, "kind": "pair", "left_out": True})
    fake = Fake()
    run_case(little, case, Places(tmp_path), fake)
    first, second = fake.candidates
    assert set(first) - set(second) == {"time_offset", "heater_ramp"}


def test_job_that_does_not_exist_is_refused(little: Setting, tmp_path: Path) -> None:
    with pytest.raises(StudyError, match="jobs 0 to 1; there is no job 2"):
        run_chunk(little, "tiny", 2, Places(tmp_path), Fake())


def test_detectability_is_nil_without_effect_and_grows_with_its_strength(
    setting: Setting,
) -> None:
    def of(hidden: dict[str, dict[str, float]]) -> float:
        case = TwinPlan(**{**FORM, "hidden": hidden, "signals": "mlr+back"})
        twin = make_twin(setting, case)
        return detectability(twin.truth, twin.series, setting.known).size

    assert of({}) < 1e-6
    weak, strong = (of({"edge_loss": {"h_W_m2K": h}}) for h in (1.0, 2.0))
    # In proportion while the effect is small.
    assert weak > 1.0
    assert strong == pytest.approx(2 * weak, rel=0.1)
    # Its size in sd does not depend on a parameter that is free to make up for it.
    assert of({"thickness": {"factor": 1.02}}) < 0.1 * of({"edge_loss": {"h_W_m2K": 10.0}})


def test_detectability_is_the_least_from_the_truth_and_from_a_fitted_base(setting: Setting) -> None:
    hidden = {"flux_level": {"factor": 1.03}}
    given = {"signals": "mlr+back", "noise": "measured", "seed": 7246807}
    twin = make_twin(setting, TwinPlan(**{**FORM, "kind": "effect", "hidden": hidden, **given}))
    fitted = {
        "T_A": 461.1,
        "E_A": 85.62,
        "T_B": 612.3,
        "E_B": 173.9,
        "w_A": 0.03488,
        "rho_a": 1223,
        "k_a": 0.2118,
        "cp_a": 2.249,
        "eps_a": 0.9881,
        "k_r": 0.1658,
        "dh": 653.3,
    }
    from_truth = detectability(twin.truth, twin.series, setting.known).size
    from_both = detectability(twin.truth, twin.series, setting.known, fitted).size
    # Descents that end early in a curved valley stay above 8 from the truth.
    assert from_both <= from_truth < 3.0


# Scoring


def judged(
    hidden: list[str],
    found: dict[str, Any],
    of_case: Mapping[str, Any] = MappingProxyType({}),
    **more: Any,
) -> dict[str, Any]:
    case = {
        "kind": "effect" if hidden else "null",
        "hidden": {name: {} for name in hidden},
        "without": [],
        "strength": 1.0,
        "signals": "mlr+back",
        "noise": "white",
        "seed": 1,
        "curves": "",
        **of_case,
    }
    result = {"id": "twin", "case": case, "detectability": 20.0, "score_only": "c_T", **found}
    result |= {"location": {"in_windows": 30, "off": 50, "both": 20}, "seconds": {"diagnosis": 9.0}}
    case |= {key: more.pop(key) for key in list(more) if key in case}
    return row_of({**result, **more})


@pytest.mark.parametrize(
    ("found", "claim", "surely_wrong", "noticed"),
    [
        (verdict("none", []), False, False, False),
        (verdict("unknown", []), False, False, True),
        (verdict("ambiguous", ["k_T"]), True, False, True),
        (verdict("named", ["k_T"]), True, True, True),
        (verdict("named", ["foil_mass"]), True, False, True),
    ],
)
def test_claim_about_a_wrong_description_is_wrong_unless_it_describes_the_error(
    found: dict[str, Any], claim: bool, surely_wrong: bool, noticed: bool
) -> None:
    of_case = {"kind": "error", "error": "thick_foil", "same": ["foil_mass"]}
    row = judged([], found, of_case)
    assert (row["claim"], row["surely_wrong"], row["noticed"]) == (claim, surely_wrong, noticed)


MARKS = ("claim", "right", "group_right", "all_lead", "in_set")
EITHER = [["k_T", "c_T"]]
BOTH = ["k_T", "c_T"]


@pytest.mark.parametrize(
    ("hidden", "found", "expected"),
    [
        (["k_T"], verdict("named", ["k_T"]), MARKS),
        (["time_offset"], verdict("named", ["heater_ramp"]), MARKS),
        (["k_T"], verdict("named", ["c_T"]), ("claim",)),
        (["c_T"], verdict("named", ["melting"]), ("claim", "group_right")),
        (["k_T"], verdict("ambiguous", ["k_T"], EITHER), MARKS),
        (["c_T"], verdict("ambiguous", ["k_T"], EITHER), ("claim", "in_set")),
        (["k_T"], verdict("multiple", BOTH), ("claim", "in_set")),
        (["k_T"], verdict("unknown", []), ()),
        (["k_T"], verdict("none", []), ()),
        ([], verdict("none", []), ()),
        ([], verdict("named", ["k_T"]), ("claim",)),
        (BOTH, verdict("multiple", ["c_T", "k_T"]), MARKS),
        (BOTH, verdict("named", ["k_T"]), ("claim", "right", "group_right")),
        (
            BOTH,
            verdict("multiple", ["k_T", "melting"], [["k_T"], ["melting", "c_T"]]),
            ("claim", "group_right", "in_set"),
        ),
    ],
)
def test_verdict_is_judged(
    hidden: list[str], found: dict[str, Any], expected: tuple[str, ...]
) -> None:
    row = judged(hidden, found)
    assert tuple(mark for mark in MARKS if row[mark]) == expected


def test_gap_and_set_of_a_verdict() -> None:
    sets = [["heater_ramp", "time_offset", "k_T"]]
    row = judged(["heater_ramp"], verdict("ambiguous", ["heater_ramp"], sets))
    assert row["set_size"] == 2.0
    assert (row["calibration_before"], row["calibration_after"]) == (2.0, 1.0)
    assert (row["held_out_before"], row["held_out_after"]) == (2.0, pytest.approx(1.2))
    assert row["held_out_gain"] == 3.0
    assert row["score_only_right"] is False
    assert judged(["c_T"], verdict("none", []))["score_only_right"] is True


@pytest.mark.parametrize(
    ("kind", "name", "wrong"),
    [
        ("named", "k_T", True),
        ("multiple", "k_T", True),
        ("named", "melting", False),
        ("ambiguous", "k_T", False),
        ("unknown", "k_T", False),
    ],
)
def test_diagnosis_without_the_effect_is_wrong_if_it_names_another_group(
    kind: str, name: str, wrong: bool
) -> None:
    left_out = verdict(kind, [name])["verdict"]
    assert judged(["c_T"], verdict("none", []), left_out=left_out)["left_out_wrong"] is wrong


def test_diagnosis_of_a_pair_without_its_second_effect() -> None:
    def again(name: str) -> dict[str, Any]:
        left_out = verdict("named", [name])["verdict"]
        return judged(["c_T", "back_loss"], verdict("none", []), left_out=left_out)

    found = {name: again(name) for name in ("c_T", "k_T")}
    assert [row["left_out_wrong"] for row in found.values()] == [False, True]
    assert [row["kept_named"] for row in found.values()] == [True, False]


def test_rates_are_counted() -> None:
    k_T = verdict("named", ["k_T"])
    twins = pd.DataFrame(
        [
            judged(["k_T"], k_T),
            judged(["k_T"], k_T, noise="measured"),
            judged(["c_T"], k_T),
            judged(["c_T"], verdict("none", [])),
            judged(["c_T"], k_T, detectability=9.9),
            judged(["k_T"], k_T, strength=1 / 3),
            judged(["k_T"], k_T, strength=1 / 3, signals="mlr", detectability=1.0),
            judged([], verdict("none", [])),
            judged([], k_T),
            judged(["k_T", "c_T"], verdict("multiple", ["k_T", "c_T"]), kind="pair"),
        ]
    )
    table = rates(twins)
    found = {(row.quantity, row.of): (row.hits, row.twins) for row in table.itertuples(index=False)}
    assert found["effect of 10 sd or more: claimed", ""] == (4, 5)
    assert found["effect of 10 sd or more, claimed: name right", ""] == (3, 4)
    assert found["effect of 10 sd or more, claimed: name right", "measured"] == (1, 1)
    assert found["effect of 10 sd or more: largest score right", ""] == (2, 5)
    assert found["effect of 10 sd or more, claimed: largest score right", ""] == (1, 4)
    assert found["effect of part strength, back temperature: name right", ""] == (1, 1)
    assert found["no hidden effect: claimed", ""] == (1, 2)
    assert found["any claim: a wrong name (false discovery)", ""] == (3, 8)
    assert found["confirmed claim: a wrong name (false discovery)", "measured"] == (0, 1)
    assert found["pair: both in the sets", ""] == (1, 1)
    assert found["effect, claimed: hidden effect in set", ""] == (4, 6)
    classes = by_detectability(twins).query("share == 'claimed'")
    assert classes["twins"].tolist() == [1, 1, 5, 0, 0]
    assert classes["hits"].tolist() == [1, 1, 4, 0, 0]


def test_interval_of_a_rate_is_clopper_and_pearson_s() -> None:
    # 7 of 10: from the published tables.
    assert rate_interval(7, 10) == pytest.approx((0.3475, 0.9333), abs=1e-4)
    assert rate_interval(0, 210)[1] == pytest.approx(1 - 0.025 ** (1 / 210))
    assert rate_interval(5, 5) == pytest.approx((0.025 ** (1 / 5), 1.0))


def test_effects_that_cannot_be_told_apart_count_as_one() -> None:
    assert same_as("heater_ramp") == same_as("time_offset") == {"heater_ramp", "time_offset"}
    assert same_as("k_T") == {"k_T"}


def test_missing_result_is_named(tmp_path: Path) -> None:
    places = Places(tmp_path)
    write_json(places.chunk(0), {"cases": ["twin_x"]})
    one = read_setting(FILE)
    plans = {"one": one.plans["full"].model_copy(update={"chunks": 1})}
    with pytest.raises(DataError, match=r"twin_x.json: this result is missing"):
        write_results(one.model_copy(update={"plans": plans}), "one", places)
