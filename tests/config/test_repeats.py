"""Repeats of a test: experiments of their own, shared weights, what differs, one simulation."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from diagnosis_keys import given
from shown_studies import fake, repeats

from pyrofit.analysis import repeats as analysed
from pyrofit.config import (
    Study,
    as_study,
    calibration_channels,
    diagnosed_parameters,
    held_out_channels,
)
from pyrofit.errors import StudyError
from pyrofit.estimate import problem as problems
from pyrofit.estimate.prior import prior_of
from pyrofit.estimate.problem import Problem, make_problem
from pyrofit.experiments.base import Kind
from pyrofit.results.files import Results
from pyrofit.show.subjects.identification import repeats as shown
from pyrofit.show.subjects.identification.repeats import repeats_table
from pyrofit.stages.measurements import computed

SDS = {"thickness_sd": 0.02, "flux_sd": 0.03, "clock_sd_s": 1.0}


def keys(test: str = "slab_25", **repeated: Any) -> dict[str, Any]:
    """Return the smoke study with a computed test repeated twice."""
    study = given()
    study["experiments"][test]["repeats"] = {"tests": [{}, {}], **repeated}
    return study


def study_of(described: dict[str, Any]) -> Study:
    return as_study(described, "smoke.yaml")


def files(**signals: list[str]) -> list[dict[str, Any]]:
    """Return repeats with files by signal; "" = the repeat lacks the signal."""
    count = max(len(names) for names in signals.values())
    return [
        {"signals": {s: names[i] for s, names in signals.items() if names[i]}} for i in range(count)
    ]


def measured(listed: Any) -> dict[str, Any]:
    """Return the smoke study whose slab at 25 kW/m2 is read from files of repeats."""
    study = given()
    slab = study["experiments"]["slab_25"]
    slab["signals"] = {"mlr": {"average_s": 5}}
    slab["repeats"] = listed
    return study


# --- experiments ----------------------------------------------------------------------------


def test_each_repeat_is_an_experiment_with_its_own_files() -> None:
    study = study_of(measured(files(mlr=["a.csv", "b.csv"], back_temperature=["Ta.csv", ""])))
    assert list(study.experiments) == ["tga_5K", "tga_20K", "slab_25_1", "slab_25_2", "slab_60"]
    one, two = study.experiments["slab_25_1"], study.experiments["slab_25_2"]
    assert (one.signals["mlr"].file, two.signals["mlr"].file) == ("a.csv", "b.csv")
    assert one.signals["mlr"].average_s == two.signals["mlr"].average_s == 5.0
    assert list(two.signals) == ["mlr"]
    assert one.title == "synthetic gasification 25 kW/m², 1"
    assert one.repeat is not None
    assert one.repeat.test == "slab_25"


def test_repeats_may_have_names_titles_and_masses() -> None:
    listed = {
        "first": {"signals": {"mlr": {"file": "a.csv", "units": {"value": "g/s"}}}},
        "again": {"signals": {"mlr": "b.csv"}, "title": "B", "sample_mass_kg": 0.05},
    }
    study = study_of(measured(listed))
    assert [n for n in study.experiments if n in listed] == ["first", "again"]
    assert study.experiments["again"].title == "B"
    assert study.experiments["again"].signals["mlr"].sample_mass_kg == 0.05
    assert study.experiments["first"].signals["mlr"].units == {"value": "g/s"}


def test_study_with_repeats_is_the_same_once_written_and_read() -> None:
    study = study_of(keys(**SDS))
    assert as_study(json.loads(study.model_dump_json()), "study.json") == study


# --- names ----------------------------------------------------------------------------------


def test_terms_of_a_test_are_shared_equally_by_its_repeats() -> None:
    described = keys()
    described["imp"]["costs"]["RMSE"][0]["weight"] = 3.0
    terms = study_of(described).imp.costs["RMSE"]
    assert [(t.experiment, t.weight) for t in terms] == [("slab_25_1", 1.5), ("slab_25_2", 1.5)]


def test_weight_is_shared_by_the_repeats_that_have_the_signal() -> None:
    described = measured(files(mlr=["a.csv", "b.csv", ""], back_temperature=["Ta.csv", "", "Tc"]))
    terms = study_of(described).imp.costs["RMSE"]
    assert [(t.experiment, t.weight) for t in terms] == [("slab_25_1", 0.5), ("slab_25_2", 0.5)]


def test_all_places_that_name_a_test_name_its_repeats() -> None:
    described = keys()
    described["imp"]["identification"] = {"slab_25": ["mlr"]}
    described["validation"]["experiments"] = ["slab_60", "slab_25"]
    described["diagnosis"] = {
        "calibrate": {"slab_25": ["mlr"]},
        "hold_out": {"slab_25": ["back_temperature"]},
    }
    study = study_of(described)
    both = ["slab_25_1", "slab_25_2"]
    assert list(study.imp.identification) == both
    assert list(study.validation.experiments) == ["slab_60", *both]
    assert [c.experiment for c in calibration_channels(study)] == both
    assert [(c.experiment, c.signal) for c in held_out_channels(study)] == [
        (name, "back_temperature") for name in both
    ]


def test_one_repeat_may_be_named_alone() -> None:
    described = keys(**SDS)
    for terms in described["imp"]["costs"].values():
        terms[0]["experiment"] = "slab_25_1"
    study = study_of(described)
    assert study.imp.estimate[-3:] == tuple(
        f"slab_25_1_{what}" for what in ("thickness", "flux", "clock")
    )
    # The other is predicted only: the diagnosis alone estimates what differs of it.
    assert study.experiments["slab_25_2"].front.flux_factor == "slab_25_2_flux"
    assert study.fixed_values()["slab_25_2_flux"] == 1.0
    assert "slab_25_2_flux" in diagnosed_parameters(study)


# --- what differs ---------------------------------------------------------------------------


def test_what_differs_becomes_parameters_of_known_value() -> None:
    study = study_of(keys(**SDS))
    flux = study.parameters["slab_25_2_flux"]
    assert (flux.value, flux.unit) == (1.0, "-")
    assert (flux.lower, flux.upper) == pytest.approx((0.88, 1.12))
    assert (study.known["slab_25_2_flux"].value, study.known["slab_25_2_flux"].sd) == (1.0, 0.03)
    slab = study.experiments["slab_25_2"]
    assert slab.sample.thickness_factor == "slab_25_2_thickness"
    assert slab.front.flux_factor == "slab_25_2_flux"
    assert {s.delay_s for s in slab.signals.values()} == {"slab_25_2_clock"}
    names = [f"slab_25_{i}_{what}" for i in (1, 2) for what in ("thickness", "flux", "clock")]
    assert list(study.imp.estimate) == ["rho", "k", "cp", "eps", "dh", *names]
    assert set(names) <= set(diagnosed_parameters(study))


def test_standard_deviation_of_one_repeat_stands_for_that_of_all() -> None:
    study = study_of(keys(thickness_sd=0.02, tests=[{}, {"thickness_sd": 0.05}]))
    sds = [study.known[f"slab_25_{i}_thickness"].sd for i in (1, 2)]
    assert sds == [0.02, 0.05]


def test_tga_repeats_differ_in_their_lag_and_the_kinetics_estimate_it() -> None:
    study = study_of(keys("tga_5K", lag_sd_s=4.0))
    assert study.kinetics is not None
    assert study.kinetics.estimate == ("T_p", "E_p", "tga_5K_1_lag", "tga_5K_2_lag")
    assert study.experiments["tga_5K_1"].lag_s == "tga_5K_1_lag"
    assert study.imp.estimate == ("rho", "k", "cp", "eps", "dh")


def test_tga_repeats_may_differ_by_an_offset_of_the_temperature() -> None:
    study = study_of(keys("tga_5K", temperature_sd_K=3.0))
    assert study.experiments["tga_5K_1"].temperature_offset_K == "tga_5K_1_temperature"
    assert study.known["tga_5K_1_temperature"].sd == 3.0
    assert study.parameters["tga_5K_1_temperature"].bounds_si == (-12.0, 12.0)


def test_test_that_only_the_diagnosis_fits_differs_there() -> None:
    described = keys("slab_60", **SDS)
    described["diagnosis"] = {"calibrate": {"slab_25": ["mlr"], "slab_60": ["mlr"]}}
    study = study_of(described)
    assert study.imp.estimate == ("rho", "k", "cp", "eps", "dh")
    assert "slab_60_2_flux" in diagnosed_parameters(study)
    described["diagnosis"]["estimate"] = ["rho", "k", "cp", "eps", "dh", "T_p", "E_p"]
    assert diagnosed_parameters(study_of(described))[-1] == "slab_60_2_clock"


def test_computed_repeats_differ_by_their_seeds_and_stated_scatter() -> None:
    described = keys(**SDS)
    study = study_of(described)
    assert study.synthetic is not None
    truth = study.synthetic.truth
    z = [
        (truth[name] - study.known[name].value) / study.known[name].sd
        for name in study.imp.estimate[5:]
    ]
    assert len(set(z)) == 6
    assert max(abs(x) for x in z) <= 3.0
    described["seed"] = 99
    other = study_of(described).synthetic
    assert other is not None
    assert other.truth["slab_25_1_flux"] != truth["slab_25_1_flux"]


@pytest.mark.solver
def test_computed_repeats_have_noise_of_their_own() -> None:
    described = keys()
    for name in ("tga_5K", "tga_20K"):
        described["experiments"][name]["every"] = 10
    described["experiments"] = {"slab_25": described["experiments"]["slab_25"]}
    described["experiments"]["slab_25"]["duration_s"] = 60
    described.pop("kinetics")
    described["imp"]["kinetics"] = "described"
    described["imp"]["estimate"] += ["T_p", "E_p"]
    described["validation"]["experiments"] = ["slab_25"]
    series = computed(study_of(described))
    one, two = (series[f"slab_25_{i}", "mlr"]["mlr_kg_m2_s"].to_numpy() for i in (1, 2))
    assert not np.any(one == two)
    assert np.std(one - two) == pytest.approx(2e-4 * np.sqrt(2.0), rel=0.6)


# --- simulations ----------------------------------------------------------------------------


class Counted:
    """A kind whose simulations are counted and return the name of the experiment's first file."""

    def __init__(self, kind: Kind) -> None:
        self.kind = kind
        self.experiments: list[Any] = []
        self.sets: list[int] = []

    def simulate(self, experiments: Any, *rest: Any) -> Any:
        *_, sets, _ = rest
        self.experiments += experiments
        self.sets += [sets] * len(experiments)
        return self.kind.simulate(experiments, *rest)


def posed(study: Study, shift: float = 0.0, end: float = 65.0) -> Problem:
    """Return the problem of the smoke study's RMSE with records on the same times, or shifted."""
    import pandas as pd

    time = np.arange(5.0, end, 10.0)
    frames = {}
    for i in (1, 2):
        at = time + (shift if i == 2 else 0.0)
        frames[f"slab_25_{i}", "mlr"] = pd.DataFrame({"time_s": at, "mlr_kg_m2_s": 1e-3 + 0 * at})
    fixed = {"T_p": 605.0, "E_p": 190e3, **study.fixed_values()}
    return make_problem(
        study, study.imp.estimate, study.imp.costs["RMSE"], frames, study.material, fixed
    )


VALUES = np.array([1190.0, 0.2, 2100.0, 0.9, 800e3])


@pytest.mark.solver
@pytest.mark.parametrize(
    ("repeated", "shift", "runs"),
    [({}, 0.0, 1), ({}, 2.0, 1), ({"clock_sd_s": 1.0}, 0.0, 2)],
    ids=["equal", "other times", "other clocks"],
)
def test_repeats_of_equal_description_are_simulated_once(
    repeated: dict[str, Any], shift: float, runs: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = study_of(keys(**repeated))
    problem = posed(study, shift)
    from pyrofit.experiments import kind_of

    counted = Counted(kind_of(study.experiments["slab_25_1"]))
    monkeypatch.setattr(problems, "kind_of", lambda experiment: counted)
    x = np.concatenate([VALUES, np.zeros(len(study.imp.estimate) - 5)])
    status, curves = problem.simulate(x)
    assert status.finished
    assert len(counted.experiments) == runs
    assert np.array_equal(*curves) == (shift == 0.0)


def apart(problem: Problem) -> Problem:
    """Return a problem that simulates each repeat by itself."""
    problem.__dict__["alike"] = {name: name for name in problem.runs}
    return problem


@pytest.mark.solver
def test_shared_simulation_has_the_bits_of_one_for_each() -> None:
    shared, each = posed(study_of(keys())), apart(posed(study_of(keys())))
    for one, other in zip(shared.simulate(VALUES)[1], each.simulate(VALUES)[1], strict=True):
        assert np.array_equal(one, other)
    assert shared.evaluate(VALUES) == each.evaluate(VALUES)


@pytest.mark.solver
def test_repeats_at_other_times_have_the_curves_of_their_own_simulations() -> None:
    # The second record ends 31 s later. Only the last steps of the first are not its own.
    shared, each = (posed(study_of(keys()), 31.0, 605.0) for _ in range(2))
    (_, (first, second)), (_, (alone, other)) = (p.simulate(VALUES) for p in (shared, apart(each)))
    assert first.max() > 1e-3
    assert second == pytest.approx(other, rel=1e-12)
    assert first[:-2] == pytest.approx(alone[:-2], rel=1e-12)
    assert first == pytest.approx(alone, rel=1e-3)


@pytest.mark.solver
def test_heated_repeats_with_programmes_of_their_own_are_simulated_each() -> None:
    import pandas as pd

    time = np.linspace(0.0, 3000.0, 40)
    heated = study_of(keys("tga_20K"))
    frames = {
        (f"tga_20K_{i}", "mass_fraction"): pd.DataFrame(
            {"time_s": time, "temperature_K": 300.0 + rise * time, "mass_fraction": 1.0 + 0 * time}
        )
        for i, rise in ((1, 0.2), (2, 0.21))
    }
    terms = [t for t in heated.kinetics.cost if t.experiment.startswith("tga_20K")]
    names = heated.kinetics.estimate
    problem = make_problem(heated, names, terms, frames, heated.material, heated.fixed_values())
    assert problem.alike == {name: name for name in problem.runs}


@pytest.mark.solver
def test_sets_that_differ_in_other_experiments_only_are_simulated_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    study = study_of(keys(flux_sd=0.03))
    problem = posed(study)
    X = np.tile([*VALUES, 1.0, 1.0], (4, 1))
    X[1, 5], X[2, 6], X[3, 0] = 1.02, 0.97, 1150.0  # flux of the first, of the second, density
    alone = [problem.simulate(x)[1] for x in X]
    from pyrofit.experiments import kind_of

    counted = Counted(kind_of(study.experiments["slab_25_1"]))
    monkeypatch.setattr(problems, "kind_of", lambda experiment: counted)
    together = [curves for _, curves in problem.simulate_all(X)]
    assert counted.sets == [3, 3]
    for one, other in zip(together, alone, strict=True):
        assert all(np.array_equal(a, b) for a, b in zip(one, other, strict=True))


def test_prior_of_a_problem_holds_what_differs() -> None:
    study = study_of(keys(**SDS))
    prior = prior_of(study, posed(study))
    assert prior.mean.tolist() == [1.0, 1.0, 0.0] * 2
    assert prior.sd.tolist() == [0.02, 0.03, 1.0] * 2


# --- the table ------------------------------------------------------------------------------


def test_table_names_repeats_and_the_signals_that_they_lack(tmp_path: Path) -> None:
    frame = repeats_table(*fake(tmp_path, repeats()))
    assert frame["repeat"].tolist() == ["slab_60_1", "slab_60_2"]
    assert frame["missing"].fillna("").tolist() == ["", "back_temperature"]


def test_table_gives_estimates_beside_their_stated_scatter(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = study_of(keys(thickness_sd=0.02))
    about: dict[str, Any] = {"stage": "imp", "unit": "-", "low": 1.0, "high": 1.1}
    found = [
        SimpleNamespace(name=f"slab_25_{i}_thickness", value=value, **about)
        for i, value in ((1, 1.05), (2, 0.99))
    ]
    monkeypatch.setattr(shown.identification, "read", lambda study, results: None)
    monkeypatch.setattr(shown, "estimates_of", lambda study, identified: found)
    frame = repeats_table(study, Results(tmp_path))
    assert frame["stated_sd"].tolist() == [0.02, 0.02]
    assert frame["away_sd"].tolist() == pytest.approx([2.5, -0.5])
    assert frame["differs"].tolist() == ["factor on the thickness"] * 2


# --- mistakes -------------------------------------------------------------------------------

PLACE = "experiments.slab_25.repeats"
MISTAKES: dict[str, tuple[Any, str]] = {
    "a single repeat": (files(mlr=["a.csv"]), f"{PLACE}: give at least two repeats"),
    "a repeat without a file": (
        [{"signals": {"mlr": "a.csv"}}, {}],
        f"{PLACE}.slab_25_2: it has no file; give under signals the file of each signal",
    ),
    "a signal without a file": (
        [{"signals": {"mlr": "a.csv"}}, {"signals": {"mlr": {"average_s": 2}}}],
        f"{PLACE}.slab_25_2.signals.mlr: give the file of this repeat",
    ),
    "one file twice": (
        files(mlr=["a.csv", "a.csv"]),
        f"{PLACE}.slab_25_2.signals.mlr: 'a.csv' is the file of slab_25_1, too",
    ),
    "an unknown signal": (
        files(mlr=["a.csv", "b.csv"], mrl=["c.csv", ""]),
        "experiments.slab_25_1: unknown signal 'mrl'. Did you mean 'mlr'?",
    ),
    "a name twice": (
        {"slab_60": {"signals": {"mlr": "a.csv"}}, "x": {"signals": {"mlr": "b.csv"}}},
        f"{PLACE}: another experiment is named 'slab_60'; give the repeats other names",
    ),
    "an unknown key": (
        [{"signal": {"mlr": "a.csv"}}, {"signals": {"mlr": "b.csv"}}],
        "unknown key 'signal'. Did you mean 'signals'?",
    ),
    "a lag of a slab": (
        {"lag_sd_s": 1.0, "tests": files(mlr=["a.csv", "b.csv"])},
        f"{PLACE}.slab_25_1.lag_sd_s: a gasification experiment has none; it may have",
    ),
    "a scatter as large as the thickness": (
        {"thickness_sd": 2.0, "tests": files(mlr=["a.csv", "b.csv"])},
        f"{PLACE}.thickness_sd: 2.0 must be below 0.25",
    ),
    "a scatter of nothing": (
        {"clock_sd_s": 0, "tests": files(mlr=["a.csv", "b.csv"])},
        f"{PLACE}.clock_sd_s: 0 must be above 0",
    ),
    "no repeat with the signal of a cost": (
        files(back_temperature=["a.csv", "b.csv"]),
        "imp.costs.RMSE.0.signal: no repeat of 'slab_25' has the signal 'mlr'",
    ),
}


@pytest.mark.parametrize(("listed", "said"), MISTAKES.values(), ids=MISTAKES)
def test_mistake_is_told_with_place_and_way_out(listed: Any, said: str) -> None:
    with pytest.raises(StudyError) as told:
        study_of(measured(listed))
    assert said in str(told.value)


def test_number_that_differs_varies_about_the_one_described() -> None:
    described = keys(flux_sd=0.03)
    described["experiments"]["slab_25"]["front"]["flux_factor"] = 1.02
    flux = study_of(described).parameters["slab_25_1_flux"]
    assert (flux.value, flux.lower, flux.upper) == pytest.approx((1.02, 0.9, 1.14))


def test_number_that_differs_and_is_a_parameter_is_refused() -> None:
    described = keys(flux_sd=0.03)
    described["parameters"]["gauge"] = {"unit": "-", "value": 1.0}
    described["experiments"]["slab_25"]["front"]["flux_factor"] = "gauge"
    with pytest.raises(StudyError, match=r"flux_factor is 'gauge' already, and differs"):
        study_of(described)


def test_parameter_of_the_same_name_is_refused() -> None:
    described = keys(flux_sd=0.03)
    described["parameters"]["slab_25_1_flux"] = {"unit": "-", "value": 1.0}
    with pytest.raises(
        StudyError, match=r"parameters\.slab_25_1_flux: the repeat slab_25_1 needs this name"
    ):
        study_of(described)


# --- what is uncertain of an experiment that is not repeated ----------------------------------


def uncertain(test: str = "slab_25", **sds: float) -> dict[str, Any]:
    study = given()
    study["experiments"][test]["uncertain"] = sds
    return study


def test_uncertain_numbers_are_parameters_of_the_diagnosis_alone() -> None:
    described = uncertain(**SDS, h_sd_W_m2K=2.0)
    plain, study = study_of(given()), study_of(described)
    names = [f"slab_25_{what}" for what in ("thickness", "flux", "h", "clock")]
    assert study.imp == plain.imp
    assert study.kinetics == plain.kinetics
    assert list(diagnosed_parameters(study)) == [*diagnosed_parameters(plain), *names]
    assert study.experiments["slab_25"].front.h_change_W_m2K == "slab_25_h"
    assert (study.parameters["slab_25_h"].unit, study.known["slab_25_h"].sd) == ("W/(m2 K)", 2.0)
    assert not analysed.has_repeats(study)


def test_study_with_uncertain_numbers_is_read_again_as_it_was_written() -> None:
    study = study_of(uncertain(**SDS))
    assert study_of(study.model_dump(mode="json")) == study


def test_uncertain_temperature_of_a_record_needs_a_temperature_programme() -> None:
    study = study_of(uncertain("tga_5K", temperature_sd_K=5.0))
    assert study.experiments["tga_5K"].temperature_offset_K == "tga_5K_temperature"
    with pytest.raises(StudyError, match=r"slab_25\.uncertain\.temperature_sd_K: .* has none"):
        study_of(uncertain(temperature_sd_K=5.0))


def test_repeat_has_its_own_sample() -> None:
    layers = [{"thickness_m": 0.0045}]
    study = study_of(keys(flux_sd=0.03, tests=[{"sample": {"layers": layers}}, {}]))
    one, other = (study.experiments[f"slab_25_{i}"].sample for i in (1, 2))
    assert (one.layers[0].thickness_m, other.layers[0].thickness_m) == (0.0045, 0.004)
    assert one.initial_temperature_K == other.initial_temperature_K


def test_uncertain_numbers_of_a_repeated_test_are_refused() -> None:
    described = keys(flux_sd=0.03)
    described["experiments"]["slab_25"]["uncertain"] = {"flux_sd": 0.03}
    with pytest.raises(
        StudyError, match=r"slab_25\.uncertain: the test has repeats; give it there"
    ):
        study_of(described)
