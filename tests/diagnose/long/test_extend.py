"""The study with what was found: it is read again and simulates what was fitted."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hidden_effects import HIDDEN, SEED, Diagnosed
from small import CHANNELS, LIMITS, given, measured, study, truth_of

from pyrofit.config import (
    Study,
    TermSpec,
    as_study,
    as_yaml,
    candidate_effects,
    read_mapping,
    read_study,
)
from pyrofit.diagnose.base.descent import Fit
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import extended, model_of
from pyrofit.diagnose.result.extended_study import extended_keys
from pyrofit.effects import known_effects
from pyrofit.estimate.problem import make_problem
from pyrofit.results.files import Results
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.diagnose import diagnose_study


def reread(described: Study, trial: FittedModel, folder: Path, **signals: Any) -> Study:
    path = folder / "extended.yaml"
    path.write_text(
        as_yaml(extended_keys(described, trial, signals.get("signals", {})), "Found.\n")
    )
    return read_study(path)


def simulated(described: Study, hidden: str, values: FloatArray) -> FloatArray:
    """Simulate the calibrated channels of a study at values of the base's parameters [SI]."""
    terms = [TermSpec(experiment=e, signal=q, kind="RMSE") for e, q in CHANNELS]
    series = measured(HIDDEN[hidden], SEED)
    problem = make_problem(
        described, tuple(LIMITS), terms, series, described.material, described.fixed_values()
    )
    status, curves = problem.simulate(values)
    assert status.finished
    return np.concatenate(curves)


def check(described: Study, hidden: str, trial: FittedModel) -> None:
    values = trial.model.likelihood.values(trial.fit.x)[: len(LIMITS)]
    fitted = trial.model.likelihood.curves(trial.fit.x)
    assert fitted is not None
    # The runs of a search may be coarser than those of a study.
    as_fitted = {"accuracy": trial.model.likelihood.problem.accuracy}
    again = simulated(described.model_copy(update=as_fitted), hidden, values)
    assert np.all(np.abs(again - fitted) <= 1e-12 * np.abs(fitted))
    without = simulated(study(), hidden, values)
    assert np.any(np.abs(without - fitted) > 1e-3 * np.abs(fitted))


@pytest.mark.parametrize("hidden", ["k_T", "in_depth", "heater_ramp"])
def test_extended_study_is_read_again_and_simulates_what_was_fitted(
    hidden: str, diagnosed: Diagnosed, tmp_path: Path
) -> None:
    end = diagnosed(hidden).search.end
    described = reread(study(), end, tmp_path)
    assert set(described.with_effects) == set(end.effects)
    check(described, hidden, end)


def test_fitted_form_is_kept(diagnosed: Diagnosed, tmp_path: Path) -> None:
    effect = known_effects()["glass_transition"]
    (strength, of), (form, by) = *effect.strength.items(), next(iter(effect.form.items()))
    base = diagnosed("k_T").search.base.model.base
    model = model_of(base, {"glass_transition": (strength, form)})
    x = extended(truth_of(base, {}), "glass_transition", of.typical, (form,))
    x[-1] = 0.3
    r = model.residuals(x)
    trial = FittedModel(model, Fit(float(r @ r), x, r, np.zeros((r.size, x.size))))
    described = reread(study(), trial, tmp_path)
    kept = described.with_effects["glass_transition"]
    assert kept == {
        strength: pytest.approx(of.typical),
        form: by.lower + 0.3 * (by.upper - by.lower),
    }
    check(described, "k_T", trial)


def test_second_effect_joins_the_first(diagnosed: Diagnosed, tmp_path: Path) -> None:
    """A study that was extended may be diagnosed, and extended, once more."""
    first = reread(study(), diagnosed("k_T").search.end, tmp_path)
    assert "k_T" not in candidate_effects(first)
    second = reread(first, diagnosed("heater_ramp").search.end, tmp_path)
    assert set(second.with_effects) == {"k_T", "heater_ramp"}
    assert second.experiments["slab_25"].front.rise_time_s > 0.0  # type: ignore[union-attr]


def test_name_and_title_say_what_was_added(diagnosed: Diagnosed, tmp_path: Path) -> None:
    described = reread(study(), diagnosed("k_T").search.end, tmp_path)
    assert described.name == "small_extended"
    assert described.title == "small, with slope of the conductivity"


@pytest.mark.parametrize(
    "candidates", [["k_T"], ["k_T", "c_T"], ["in_depth", "in_depth_lost", "k_T"]]
)
def test_candidates_that_were_listed_and_found_are_no_obstacle(
    candidates: list[str], diagnosed: Diagnosed, tmp_path: Path
) -> None:
    listed = study(effects=candidates)
    hidden = "in_depth" if "in_depth" in candidates else "k_T"
    described = reread(listed, diagnosed(hidden).search.end, tmp_path)
    left = set(candidate_effects(described))
    assert hidden not in left
    assert {"c_T", "k_T"} & set(candidates) - {hidden} <= left


def test_files_of_signals_are_replaced(diagnosed: Diagnosed, tmp_path: Path) -> None:
    described = reread(
        study(),
        diagnosed("k_T").search.end,
        tmp_path,
        signals={("slab_25", "mlr"): {"file": "../measurements/slab_25_mlr.csv"}},
    )
    file = Path(described.experiments["slab_25"].signals["mlr"].file)
    assert file.name == "slab_25_mlr.csv"
    assert "measurements" in file.parts
    assert Path(described.experiments["slab_60"].signals["mlr"].file).name == "slab_60_mlr.csv"


def test_extended_study_finds_its_plugins(
    diagnosed: Diagnosed, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = diagnosed("k_T")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("pyrofit.stages.diagnose.examine", lambda *_, **__: found)
    monkeypatch.setattr("pyrofit.stages.diagnose.load", lambda *_: {})
    results = Results(Path("results/small"))
    diagnose_study(study().model_copy(update={"plugins": ("mine/own",)}), results, lambda *_: None)
    path = results.diagnosis("extended.yaml")
    (folder,) = read_mapping(path)["plugins"]
    assert (path.parent / folder).resolve() == tmp_path / "mine" / "own"


def test_truth_goes_when_nothing_is_computed_any_more(diagnosed: Diagnosed, tmp_path: Path) -> None:
    keys = given()
    for experiment in keys["experiments"].values():
        experiment["duration_s"] = 300
        for signal in experiment["signals"].values():
            signal |= {"file": "synthetic", "columns": {}, "units": {}, "every": 10}
    keys["synthetic"] = {"truth": {"rho": 1190, "k": 0.2, "cp": 2.1, "eps": 0.9, "dh": 800}}
    computed = as_study(keys, "small.yaml")
    end = diagnosed("k_T").search.end
    assert "synthetic" in extended_keys(computed, end, {})
    files = {key: {"file": "a.csv"} for key in CHANNELS}
    assert "synthetic" not in extended_keys(computed, end, files)
    assert reread(computed, end, tmp_path, signals=files).synthetic is None
