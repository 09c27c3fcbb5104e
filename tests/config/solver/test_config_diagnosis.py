"""What a study says of its diagnosis, what holds where it says nothing, and hidden truths."""

import json
from typing import Any

import numpy as np
import pytest
from diagnosis_keys import CONFIG, given, study_with

from pyrofit.config import (
    TermSpec,
    as_study,
    calibration_channels,
    candidate_effects,
    diagnosed_parameters,
    digest,
    held_out_channels,
    read_mapping,
    read_study,
    true_description,
)
from pyrofit.config.resolve import obstacle
from pyrofit.effects import known_effects
from pyrofit.errors import StudyError
from pyrofit.estimate.likelihood import likelihood_of
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.problem import make_problem
from pyrofit.estimate.targets import Measurements
from pyrofit.results import dependencies
from pyrofit.stages.measurements import computed

STUDIES = ("paper", "pmma", "smoke", "twin")
KINETICS = ("T_p", "E_p")
SLAB = ("rho", "k", "cp", "eps", "dh")
TGA = [("tga_5K", "mass_fraction"), ("tga_20K", "mass_fraction")]


def pairs(channels: tuple[TermSpec, ...]) -> list[tuple[str, str]]:
    assert all(c.kind == "RMSE" and c.points is None for c in channels)
    return [(c.experiment, c.signal) for c in channels]


# --- signals --------------------------------------------------------------------------------


def test_by_default_the_signals_of_both_stages_are_calibrated() -> None:
    study = study_with()
    assert pairs(calibration_channels(study)) == [*TGA, ("slab_25", "mlr")]


def test_calibrated_window_is_that_of_the_costs() -> None:
    terms = [{"experiment": "slab_25", "signal": "mlr", "kind": "RMSE", "window_s": [50, 900]}]
    study = study_with(imp__costs={"RMSE": terms})
    assert calibration_channels(study)[-1].window_s == (50.0, 900.0)


def test_tga_is_not_calibrated_where_its_kinetics_are_published() -> None:
    given = read_mapping(CONFIG / "paper.yaml")
    study = as_study({**given, "diagnosis": {}}, "paper.yaml")
    assert pairs(calibration_channels(study)) == [("capa_25", "mlr")]
    assert set(diagnosed_parameters(study)) == set(study.imp.estimate)
    assert "tga_lag" not in candidate_effects(study)


def test_given_signals_are_calibrated_whole() -> None:
    chosen = {"slab_60": ["back_temperature", "mlr"], "tga_5K": ["mass_fraction"]}
    channels = calibration_channels(study_with(diagnosis={"calibrate": chosen}))
    assert pairs(channels) == [("slab_60", "back_temperature"), ("slab_60", "mlr"), TGA[0]]
    assert all(c.window_s is None for c in channels)


def test_what_validation_predicts_and_is_not_calibrated_is_held_out() -> None:
    back = ("slab_25", "back_temperature")
    study = study_with()
    assert pairs(held_out_channels(study)) == [
        back,
        ("slab_60", "mlr"),
        ("slab_60", "back_temperature"),
    ]
    all_but_one = {"slab_25": ["mlr"], "slab_60": ["mlr", "back_temperature"]}
    assert pairs(held_out_channels(study_with(diagnosis={"calibrate": all_but_one}))) == [back]


def test_given_signals_are_held_out() -> None:
    study = study_with(diagnosis={"hold_out": {"slab_60": ["mlr"]}})
    assert pairs(held_out_channels(study)) == [("slab_60", "mlr")]


# --- parameters -----------------------------------------------------------------------------


def test_kinetics_are_estimated_where_a_tga_is_calibrated_or_nothing_else_gives_them() -> None:
    assert diagnosed_parameters(study_with()) == (*KINETICS, *SLAB)
    slab_only = study_with(diagnosis={"calibrate": {"slab_25": ["mlr"]}})
    assert diagnosed_parameters(slab_only) == (*KINETICS, *SLAB)


def test_kinetics_of_a_given_value_are_not_estimated_without_a_tga() -> None:
    given = study_with().model_dump(mode="json", exclude_defaults=True)
    for name, value in {"T_p": 605, "E_p": 190}.items():
        given["parameters"][name]["value"] = value
    given["diagnosis"] = {"calibrate": {"slab_25": ["mlr"]}}
    assert diagnosed_parameters(as_study(given, "smoke.yaml")) == SLAB


def test_parameter_of_both_stages_is_estimated_once() -> None:
    study = study_with(imp__kinetics="described", imp__estimate=[*SLAB, *KINETICS])
    assert diagnosed_parameters(study) == (*KINETICS, *SLAB)


def test_given_parameters_are_estimated_and_known() -> None:
    study = study_with(
        known={"E_p": {"value": 190, "sd": 9.5, "source": "isoconversional"}},
        diagnosis={"calibrate": {"slab_25": ["mlr"]}, "estimate": [*SLAB, *KINETICS]},
    )
    assert diagnosed_parameters(study) == (*SLAB, *KINETICS)
    assert (study.known["E_p"].value, study.known["E_p"].sd) == (190.0, 9.5)


# --- candidates -----------------------------------------------------------------------------


def test_by_default_every_effect_is_a_candidate_that_the_signals_can_show() -> None:
    # No gas of it holds oxygen.
    others = tuple(name for name in known_effects() if name != "char_oxidation")
    assert candidate_effects(study_with()) == others
    back = {"calibrate": {"slab_25": ["back_temperature"]}}
    left_out = set(known_effects()) - set(candidate_effects(study_with(diagnosis=back)))
    assert left_out == {"balance_drift", "char_oxidation", "tga_lag", "tga_offset"}


def test_effects_of_the_model_and_what_excludes_them_are_no_candidates() -> None:
    study = study_with(effects={"in_depth": {"length_m": 3e-4}, "k_T": {"slope_1_K": -1e-3}})
    left_out = set(known_effects()) - set(candidate_effects(study))
    absorption = {"in_depth", "in_depth_bands", "in_depth_lost"}
    assert left_out == {"char_oxidation", "k_T"} | absorption


def test_forms_that_are_one_model_here_are_offered_once() -> None:
    # Behind a board nothing passes the sample that could be lost.
    given = study_with().model_dump(mode="json", exclude_defaults=True)
    board = {"density_kg_m3": 300.0, "conductivity_W_mK": 0.1, "specific_heat_J_kgK": 900.0}
    given["material"]["components"]["board"] = board
    for name in ("slab_25", "slab_60"):
        behind = [{"component": "board", "thickness_m": 0.02}]
        given["experiments"][name]["sample"]["backing"] = behind
    backed = as_study(given, "smoke.yaml")
    assert set(candidate_effects(study_with())) - set(candidate_effects(backed)) >= {
        "in_depth_lost"
    }
    assert "in_depth" in candidate_effects(backed)
    assert "the same model as another" in obstacle(backed, "in_depth_lost")


def test_what_the_description_sets_is_no_candidate() -> None:
    study = study_with(experiments__slab_60__front__rise_time_s=4.0)
    assert "heater_ramp" not in candidate_effects(study)


@pytest.mark.parametrize("name", STUDIES)
def test_default_candidates_can_be_put_into_shipped_studies(name: str) -> None:
    study = read_study(CONFIG / f"{name}.yaml")
    candidates = candidate_effects(study)
    # What is uncertain of the calibrated experiments is estimated, and is no effect.
    estimated = {"thickness", "flux_level", "front_convection", "time_offset", "tga_offset"}
    described = {"in_depth", "in_depth_bands", "in_depth_lost"}
    of_pmma = estimated | described if name == "pmma" else set()
    assert len(candidates) >= len(known_effects().keys() - of_pmma) - 1
    listed = json.loads(study.model_dump_json())
    listed["diagnosis"]["effects"] = list(candidates)
    assert candidate_effects(as_study(listed, "study.json")) == candidates


def test_given_candidates_are_the_only_ones() -> None:
    study = study_with(diagnosis={"effects": ["k_T", "c_T"], "most_effects": 1})
    assert candidate_effects(study) == ("k_T", "c_T")
    assert study.diagnosis.most_effects == 1
    assert study_with().diagnosis.most_effects == 3


# --- truths ---------------------------------------------------------------------------------


def measured(**changes: Any) -> Measurements:
    accuracy = {"elements": 30, "tolerance": 1e-5}
    return computed(study_with(synthetic__accuracy=accuracy, **changes))


def test_truth_with_an_effect_is_measured_as_that_of_a_model_with_it() -> None:
    hidden = {"back_loss": {"factor": 0.5}, "tga_lag": {"time_s": 5.0}}
    of_the_truth = measured(synthetic__effects=hidden)
    of_the_model = measured(effects=hidden)
    plain = measured()
    for key, frame in of_the_truth.items():
        assert frame.equals(of_the_model[key]), key
        assert not frame.equals(plain[key]), key


def test_effect_of_the_truth_is_hidden_from_the_model() -> None:
    study = study_with(synthetic__effects={"back_loss": {"factor": 0.5}})
    plain = study_with()
    assert (study.material, study.experiments) == (plain.material, plain.experiments)
    assert digest(dependencies.diagnose_slice(study)) == digest(dependencies.diagnose_slice(plain))
    assert digest(dependencies.data_slice(study)) != digest(dependencies.data_slice(plain))


def test_truth_with_shares_above_one_is_refused() -> None:
    study = given(synthetic__effects={"volatile": {"share": 0.05}})
    study["material"]["composition"] = {"polymer": "rest", "residue": "w"}
    study["parameters"]["w"] = {"unit": "-", "value": 0.97}
    with pytest.raises(StudyError, match=r"synthetic\.effects: .* add up to 1\.02, above 1; lower"):
        as_study(study, "smoke.yaml")


def test_truth_is_that_of_computed_experiments() -> None:
    study = study_with(
        experiments__slab_60__signals={"mlr": {"file": "measured.csv"}},
        synthetic__effects={"front_convection": {"change_W_m2K": 4.0}},
    )
    _, experiments = true_description(study)
    assert set(experiments) == {"tga_5K", "tga_20K", "slab_25"}
    assert experiments["slab_25"].front.h_change_W_m2K == 4.0
    assert experiments["tga_5K"] == study.experiments["tga_5K"]


# --- error of the clock ---------------------------------------------------------------------


def test_error_of_the_clock_counts_where_the_curve_is_steep() -> None:
    def variances(**changes: Any) -> list[np.ndarray[Any, Any]]:
        study = study_with(**changes)
        problem = make_problem(
            study, SLAB, study.imp.channels, series, study.material, study.fixed_values()
        )
        return [noise.sd**2 for noise in likelihood_of(problem).noise]

    series = measured()
    place = "experiments__slab_25__signals__mlr__timing_s"
    (usual,), (right,), (double,) = variances(), variances(**{place: 0}), variances(**{place: 1})
    assert np.ptp(usual - right) > 0.0
    np.testing.assert_allclose(double - right, 4.0 * (usual - right), rtol=1e-6, atol=1e-18)


# --- errors that last -----------------------------------------------------------------------


def test_lasting_error_of_a_record_replaces_that_of_its_quantity() -> None:
    def of_tga(**changes: Any) -> NoiseModel:
        study = study_with(**changes)
        terms = [TermSpec(experiment="tga_20K", signal="mass_fraction", kind="RMSE")]
        fixed = study.fixed_values() | study.true_values()
        problem = make_problem(study, SLAB, terms, bare, study.material, fixed)
        return likelihood_of(problem, tolerant=True).noise[0]

    bare = {
        key: frame.drop(columns="mass_fraction_uncertainty", errors="ignore")
        for key, frame in measured().items()
    }
    place = "experiments__tga_20K__signals__mass_fraction__lasting_sd"
    usual, given = of_tga(), of_tga(**{place: 0.011})
    assert usual.floors["discrepancy"] == 0.02
    assert given.floors["discrepancy"] == 0.011
    assert given.correlation == usual.correlation
    assert np.all(given.sd < usual.sd)


# --- what the step depends on ---------------------------------------------------------------

CHANGES: dict[str, tuple[dict[str, Any], bool]] = {
    "title": ({"experiments__slab_25__title": "x"}, False),
    "costs of the same signals": ({"imp__repetitions": 3}, False),
    "truth": ({"synthetic__truth__dh": 900}, False),
    "calibrated signals": ({"diagnosis": {"calibrate": {"slab_25": ["mlr"]}}}, True),
    "held-out signals": ({"validation__experiments": ["slab_25"]}, True),
    "boundary of a held-out experiment": ({"experiments__slab_60__back__h_W_m2K": 5}, True),
    "parameters": ({"diagnosis": {"estimate": ["T_p", "E_p", *SLAB[::-1]]}}, True),
    "limits": ({"parameters__k__upper": 0.5}, True),
    "known value": ({"known": {"k": {"value": 0.2, "sd": 0.01}}}, True),
    "candidates": ({"diagnosis": {"effects": ["k_T"]}}, True),
    "effects at most": ({"diagnosis": {"most_effects": 2}}, True),
    "kinetics": ({"imp__kinetics": "described", "imp__estimate": [*SLAB, *KINETICS]}, False),
    "error of a clock": ({"experiments__slab_25__signals__mlr__timing_s": 0}, True),
    "cells": ({"accuracy": {"cells": 11}}, True),
    "seed": ({"seed": 8}, True),
}


@pytest.mark.parametrize(("change", "seen"), CHANGES.values(), ids=CHANGES)
def test_diagnosis_depends_on_what_matters_to_it(change: dict[str, Any], seen: bool) -> None:
    before, after = (
        digest(dependencies.diagnose_slice(s)) for s in (study_with(), study_with(**change))
    )
    assert (before != after) == seen


def test_error_of_a_clock_matters_to_likelihoods_only() -> None:
    of_slab = {"experiments__slab_25__signals__mlr__timing_s": 0}
    before, after = study_with(), study_with(**of_slab)
    steps = {
        "data": dependencies.data_slice,
        "imp": lambda study: dependencies.imp(study, "RMSE", "sceua"),
        "validation": dependencies.validation_slice,
        "identify": dependencies.identify_slice,
    }
    changed = {n for n, part in steps.items() if digest(part(before)) != digest(part(after))}
    assert changed == {"identify"}
