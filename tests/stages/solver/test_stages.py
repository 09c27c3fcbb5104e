"""The steps of a study, on results made by hand or with a tiny budget."""

import json
import shutil
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest
from stage_studies import CONFIG, SETS, by_hand, estimated_by_hand, given, parameters, study_with

from pyrofit.analysis.closure import closure_lines
from pyrofit.config import Study, as_study, digest, read_study
from pyrofit.errors import DataError, StudyError
from pyrofit.estimate.coarse import OF_MISFIT
from pyrofit.estimate.least_squares import Start
from pyrofit.results import dependencies, kinetics
from pyrofit.results.files import Results, read_csv, read_json, write_json
from pyrofit.running import shares
from pyrofit.stages import fit, identify, measurements, predict, unfinished
from pyrofit.stages.unfinished import Unfinished

# --- prepare --------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Results:
    """Return the results of a tiny run of every step but the searches, which are made by hand."""
    results = Results(tmp_path_factory.mktemp("results"))
    study = study_with()
    measurements.prepare(study, results)
    fit.fit_kinetics(study, results)
    identify.identify_kinetics(study, results)
    by_hand(study, results)
    fit.collect(study, results)
    estimated_by_hand(results, parameters("RMSE", 9))
    predict.predict_sets(study, results)
    return results


def test_synthetic_measurements_are_equal_for_equal_seeds() -> None:
    first, again = measurements.computed(study_with()), measurements.computed(study_with())
    assert set(first) == {
        ("tga_5K", "mass_fraction"),
        ("tga_20K", "mass_fraction"),
        ("slab_25", "mlr"),
        ("slab_25", "back_temperature"),
        ("slab_60", "mlr"),
        ("slab_60", "back_temperature"),
    }
    for key, frame in first.items():
        pd.testing.assert_frame_equal(frame, again[key], check_exact=True)


def test_synthetic_noise_differs_by_seed_and_signal_and_has_the_size_asked_for() -> None:
    clean = given()
    for experiment in clean["experiments"].values():
        for signal in experiment["signals"].values():
            signal["noise"] = 0.0
    truth = measurements.computed(as_study(clean, "smoke.yaml"))
    noise = {}
    for seed in (7, 8):
        found = measurements.computed(study_with(seed=seed))
        for key, frame in found.items():
            noise[seed, *key] = frame.iloc[:, -2] - truth[key].iloc[:, -1]
    back = [v.to_numpy() for k, v in noise.items() if k[-1] == "back_temperature"]
    for i, one in enumerate(back):
        assert np.std(one) == pytest.approx(1.0, rel=0.25)
        for other in back[i + 1 :]:
            size = min(one.size, other.size)
            assert abs(np.corrcoef(one[:size], other[:size])[0, 1]) < 0.4


def test_synthetic_noise_is_given_as_the_uncertainty(results: Results) -> None:
    frame = read_csv(results.measurement("slab_25", "mlr"))
    assert list(frame.columns) == ["time_s", "mlr_kg_m2_s", "mlr_uncertainty_kg_m2_s"]
    assert set(frame["mlr_uncertainty_kg_m2_s"]) == {2e-4}
    assert frame["time_s"].tolist() == np.arange(2.5, 300, 5).tolist()


def test_synthetic_tga_runs_between_its_temperatures(results: Results) -> None:
    frame = read_csv(results.measurement("tga_5K", "mass_fraction"))
    assert frame["temperature_K"].tolist() == list(range(450, 750, 2))
    assert frame["time_s"].to_numpy() == pytest.approx((frame["temperature_K"] - 450) * 12)


def test_synthetic_measurement_that_cannot_be_simulated_is_told() -> None:
    study = study_with(synthetic__accuracy={"elements": 40, "most_steps": 100})
    said = r"experiments.slab_25: synthetic measurement failed: .*; change synthetic.truth or"
    with pytest.raises(DataError, match=said):
        measurements.computed(study)


def test_synthetic_noise_has_the_autocorrelation_asked_for() -> None:
    kinds: dict[str, Any] = {
        "none": 0.0,
        "balance": {"sd": 1.0, "autocorrelation": [-0.25, -0.2]},
        "slow": {"sd": 1.0, "ar": 0.9},
    }
    found = {}
    for kind, noise in kinds.items():
        study = given(experiments__slab_25__duration_s=2000)
        mlr = {"file": "synthetic", "every": 1, "noise": noise}
        study["experiments"]["slab_25"]["signals"] = {"mlr": mlr}
        series = measurements.computed(as_study(study, "smoke.yaml"))
        found[kind] = series["slab_25", "mlr"]["mlr_kg_m2_s"].to_numpy()
    for kind, expected in {"balance": [-0.25, -0.2, 0.0], "slow": [0.9, 0.81, 0.729]}.items():
        e = found[kind] - found["none"]
        r = [float(np.corrcoef(e[:-k], e[k:])[0, 1]) for k in (1, 2, 3)]
        # 2000 points; the slow noise varies over 10 of them.
        assert r == pytest.approx(expected, abs=0.06), kind
        assert np.std(e) == pytest.approx(1.0, rel=0.1)


def test_summary_says_what_was_read(results: Results) -> None:
    summary = read_json(results.measurements_summary)
    assert set(summary["signals"]) == {"tga_5K", "tga_20K", "slab_25", "slab_60"}
    entry = summary["signals"]["slab_25"]["mlr"]
    assert (entry["source"], entry["points"]) == ("synthetic", 60)
    rate = read_csv(results.measurement("slab_25", "mlr"))["mlr_kg_m2_s"]
    released = 5.0 * rate.sum() - 2.5 * rate.iloc[-1]  # until the middle of the last bin
    assert entry["released_kg_m2"] == pytest.approx(released, rel=1e-9)


TGA_FILE = "t;T;m\nmin;degC;mg\n0;20;5\n1;120;5\n2;220;4\n3;320;2\n4;420;1\n"
MLR_FILE = "Time,MLR\n[s],[g/s/m^2]\n" + "".join(
    f"{5 + 10 * i},{r}\n" for i, r in enumerate("012210")
)


def on_files(folder: Path, **signal: Any) -> Study:
    """Return a study on measured files of the user's own, beside the study file."""
    (folder / "data").mkdir()
    (folder / "data" / "run.csv").write_text(TGA_FILE)
    (folder / "data" / "mlr.csv").write_text(MLR_FILE)
    study = given()
    names = {"time": "t", "temperature": "T", "value": "m"}
    tga = {"file": "data/run.csv", "columns": names, "uncertainty": 0.01, **signal}
    study["experiments"]["tga_5K"]["signals"]["mass_fraction"] = tga
    study["experiments"]["tga_5K"]["heating_rate_K_min"] = 100
    for name in ("slab_25", "slab_60"):
        study["experiments"][name]["signals"] = {
            "mlr": {"file": "data/mlr.csv", "uncertainty": 1e-4}
        }
    return as_study(study, str(folder / "mine.yaml"))


def test_own_files_are_read_in_si_units_from_beside_the_study(tmp_path: Path) -> None:
    study, results = on_files(tmp_path), Results(tmp_path / "results")
    measurements.prepare(study, results)
    frame = read_csv(results.measurement("tga_5K", "mass_fraction"))
    assert frame["time_s"].tolist() == [0.0, 60.0, 120.0, 180.0, 240.0]
    assert frame["temperature_K"].tolist() == [293.15, 393.15, 493.15, 593.15, 693.15]
    assert frame["mass_fraction"].to_numpy() == pytest.approx([1.0, 1.0, 0.8, 0.4, 0.2])
    assert set(frame["mass_fraction_uncertainty"]) == {0.01}
    mlr = read_csv(results.measurement("slab_25", "mlr"))
    assert mlr["mlr_kg_m2_s"].to_numpy() == pytest.approx(
        [0.0, 0.001, 0.002, 0.002, 0.001, 0.0], abs=1e-12
    )
    entry = read_json(results.measurements_summary)["signals"]["tga_5K"]["mass_fraction"]
    assert entry["source"].endswith("data/run.csv")
    assert len(entry["sha256"]) == 64
    assert "mass divided by its first value, 5e-06 kg" in entry["notes"]


def test_points_after_until_K_are_left_out(tmp_path: Path) -> None:
    results = Results(tmp_path / "results")
    measurements.prepare(on_files(tmp_path, until_K=600), results)
    frame = read_csv(results.measurement("tga_5K", "mass_fraction"))
    assert frame["temperature_K"].tolist() == [293.15, 393.15, 493.15, 593.15]


def test_points_after_until_s_are_left_out(tmp_path: Path) -> None:
    results = Results(tmp_path / "results")
    measurements.prepare(on_files(tmp_path, until_s=120), results)
    assert read_csv(results.measurement("tga_5K", "mass_fraction"))["time_s"].max() == 120.0


def test_limit_that_leaves_too_few_points_is_told(tmp_path: Path) -> None:
    study = on_files(tmp_path, until_K=400)
    with pytest.raises(DataError, match=r"run.csv: until_K or until_s leaves 2 points; raise it"):
        measurements.prepare(study, Results(tmp_path / "results"))


def test_other_heating_rate_than_the_files_is_told(tmp_path: Path) -> None:
    study = on_files(tmp_path)
    tga = study.experiments["tga_5K"].model_copy(update={"heating_rate_K_min": 5.0})
    study = study.model_copy(update={"experiments": {**study.experiments, "tga_5K": tga}})
    with pytest.raises(DataError, match=r"rises by 100 K/min, the .* heating_rate_K_min is 5;"):
        measurements.prepare(study, Results(tmp_path / "results"))


def test_missing_own_file_is_told(tmp_path: Path) -> None:
    study = on_files(tmp_path)
    (tmp_path / "data" / "run.csv").unlink()
    with pytest.raises(DataError, match=r"run.csv"):
        measurements.prepare(study, Results(tmp_path / "results"))


# By hand, the files release 10 s x (0 + 1 + 2 + 2 + 1) g/(m2 s) + 5 s x 0 = 0.060 kg/m2.


def test_closure_with_unknown_density_gives_the_density_it_would_take(tmp_path: Path) -> None:
    lines = measurements.prepare(on_files(tmp_path), Results(tmp_path / "results"))
    assert lines[0] == (
        "slab_25: released 0.060 kg/m², 15 kg/m³ over the 4 mm of the sample; "
        "initial mass not given, density to be estimated"
    )
    assert lines[2] == "slab_25 and slab_60: equal samples, released masses 0.0 % apart"


def test_closure_of_many_equal_samples_is_one_line() -> None:
    study = read_study(CONFIG / "smoke.yaml")
    one = study.experiments["slab_25"]
    many = {f"slab_{k}": one for k in range(4)}
    study = study.model_copy(update={"experiments": many})
    about = {
        f"slab_{k}": {"mlr": SimpleNamespace(released_kg_m2=mass, released_J_m2=None)}
        for k, mass in enumerate([4.0, 4.2, 3.8, 4.1])
    }
    lines = closure_lines(study, about)
    assert lines[4:] == [
        "4 equal samples: released masses at most 9.5 % apart, those of slab_2 and slab_1"
    ]


def test_closure_with_given_sample_mass_says_the_share(tmp_path: Path) -> None:
    study = on_files(tmp_path)
    weighed = {"uncertainty": 1e-4, "sample_mass_kg": 0.0005, "sample_area_m2": 0.005}
    described = json.loads(study.model_dump_json())
    described["experiments"]["slab_25"]["signals"]["mlr"] |= {
        **weighed,
        "file": str(tmp_path / "data/mlr.csv"),
    }
    lines = measurements.prepare(as_study(described, "study.json"), Results(tmp_path / "results"))
    assert lines[0] == "slab_25: released 0.060 of 0.100 kg/m² (60.0 %)"


def test_closure_with_known_density_takes_the_described_mass(tmp_path: Path) -> None:
    described = json.loads(on_files(tmp_path).model_dump_json())
    described["material"]["components"]["polymer"]["density_kg_m3"] = 1000.0
    described["imp"]["estimate"].remove("rho")
    del described["parameters"]["rho"], described["synthetic"]["truth"]["rho"]
    lines = measurements.prepare(as_study(described, "study.json"), Results(tmp_path / "results"))
    assert lines[0] == "slab_25: released 0.060 of 4.000 kg/m² (1.5 %)"


def test_closure_with_a_denser_piece_takes_its_mass(tmp_path: Path) -> None:
    described = json.loads(on_files(tmp_path).model_dump_json())
    described["material"]["components"]["polymer"]["density_kg_m3"] = 1000.0
    described["experiments"]["slab_25"]["sample"]["density_factor"] = 1.5
    described["imp"]["estimate"].remove("rho")
    del described["parameters"]["rho"], described["synthetic"]["truth"]["rho"]
    lines = measurements.prepare(as_study(described, "study.json"), Results(tmp_path / "results"))
    assert lines[0] == "slab_25: released 0.060 of 6.000 kg/m² (1.0 %)"


def test_different_samples_are_not_compared(tmp_path: Path) -> None:
    described = json.loads(on_files(tmp_path).model_dump_json())
    described["experiments"]["slab_25"]["sample"]["layers"][0]["thickness_m"] = 0.003
    lines = measurements.prepare(as_study(described, "study.json"), Results(tmp_path / "results"))
    assert len(lines) == 2
    assert "20 kg/m³ over the 3 mm" in lines[0]


# --- kinetics -------------------------------------------------------------------------------


@pytest.mark.parametrize(("cost", "winner"), [(0.0, "least squares"), (1e3, "SCE-UA")])
def test_fit_is_the_better_of_both_optimisers(
    cost: float, winner: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    start = Start(cost, np.array([600.0, 150e3]), 1, ())
    monkeypatch.setattr(fit, "multistart", lambda *given: [start])
    study, own = study_with(), Results(tmp_path)
    measurements.prepare(study, own)
    fit.fit_kinetics(study, own)
    found = read_json(own.kinetics("fit.json"))
    history = read_csv(own.kinetics("history.csv.gz"))
    best = history.loc[history["cost"].idxmin()]
    assert found["optimiser"] == winner
    assert found["cost"] == min(cost, best["cost"])
    ends = {"least squares": {"T_p": 600.0, "E_p": 150e3}, "SCE-UA": best[["T_p", "E_p"]].to_dict()}
    assert found["parameters"] == ends[winner]


def test_fitted_rate_has_the_reference_value_at_the_reference_temperature(
    results: Results,
) -> None:
    reaction = read_json(results.kinetics("sets.json"))["fitted"]["pyrolysis"]
    temperature = kinetics.parameters(study_with(), results)["T_p"]
    rate = reaction["A_1_s"] * np.exp(-reaction["E_J_mol"] / 8.314462618 / temperature)
    assert rate == pytest.approx(0.001, rel=1e-6)
    assert reaction["mass_fraction"] == 1.0


def test_kinetics_are_scored_where_used_or_compared(tmp_path: Path) -> None:
    published = {
        "reactions": {"pyrolysis": {"A_1_s": 1e13, "E_J_mol": 190e3}},
        "composition": {"polymer": 1.0},
    }
    study = study_with(kinetics__sets={"Table 3": published})
    terms = [t for t in study.kinetics.cost if t.experiment == "tga_5K"]
    alone = study.kinetics.model_copy(update={"cost": tuple(terms)})
    results = Results(tmp_path)
    measurements.prepare(study, results)
    for compare, names in ((), {"tga_5K"}), (("tga_20K",), {"tga_5K", "tga_20K"}):
        stage = alone.model_copy(update={"compare": compare})
        changed = study.model_copy(update={"kinetics": stage})
        fit.fit_kinetics(changed, results)
        identify.identify_kinetics(changed, results)
        scores = read_csv(results.kinetics("scores.csv"))
        assert set(scores["experiment"]) == names
        assert set(scores["set"]) == {"fitted", "Table 3"}
        assert scores["used_in_fit"].tolist() == (scores["experiment"] == "tga_5K").tolist()
        assert set(read_csv(results.kinetics("curves.csv"))["experiment"]) == names


def test_study_without_kinetics_refuses_the_fit(tmp_path: Path) -> None:
    described = given(imp__kinetics="described", imp__estimate=["rho", "k", "cp", "eps", "dh"])
    described["kinetics"] = None
    for name, value in (("T_p", 605), ("E_p", 190)):
        described["parameters"][name]["value"] = value
    with pytest.raises(StudyError, match="has no kinetics stage; add `kinetics:` to it"):
        fit.fit_kinetics(as_study(described, "smoke.yaml"), Results(tmp_path))


def test_inverse_modelling_takes_the_estimates_of_the_kinetics(results: Results) -> None:
    study = study_with()
    frame = read_csv(results.identification("estimate.csv", "kinetics"))
    fitted = dict(zip(frame["parameter"], frame["estimate"], strict=True))
    assert fitted != read_json(results.kinetics("fit.json"))["parameters"]
    assert kinetics.fixed_for_imp(study, results) == fitted
    problem = fit.imp_problem(study, results, "RMSE")
    assert problem.fixed == fitted
    assert problem.names == ("rho", "k", "cp", "eps", "dh")


# --- inverse modelling ----------------------------------------------------------------------


def test_repetition_writes_its_best_history_and_convergence(
    results: Results, tmp_path: Path
) -> None:
    study = study_with()
    own = Results(tmp_path)
    measurements.prepare(study, own)
    estimated_by_hand(own, kinetics.parameters(study, results), "kinetics")
    fit.repeat(study, own, "RMSE", [0, 1])
    found = read_json(own.repetition("RMSE", 1, ".json"))
    history = read_csv(own.repetition("RMSE", 1, ".csv.gz"))
    frame = read_csv(own.repetition("RMSE", 1, "_convergence.csv"))
    best = history.loc[history["cost"].idxmin()]
    assert best["cost"] == frame["best_cost"].iloc[-1]
    # The history may be one of coarser runs, the result is not.
    assert found["cost"] == pytest.approx(best["cost"], rel=OF_MISFIT)
    x = np.array([found["parameters"][name] for name in study.imp.estimate])
    assert found["cost"] == fit.imp_problem(study, own, "RMSE").evaluate(x).cost
    assert found["parameters"] == {n: best[n] for n in study.imp.estimate}
    assert (found["calls"], found["generations"]) == (len(history), 3)
    assert found["failed_calls"] == (~history["status"].isin([0, 1])).sum()


def files_of(results: Results) -> dict[str, bytes]:
    """Return all files of repetitions."""
    folder = results.imp("RMSE")
    return {path.name: path.read_bytes() for path in sorted(folder.glob("*"))}


def posed(results: Results, root: Path) -> Results:
    """Return a folder with measurements and kinetics alone."""
    for name in ("measurements", "kinetics", "identification"):
        shutil.copytree(results.root / name, root / name)
    return Results(root)


def test_job_that_fails_keeps_the_repetitions_that_it_has_finished(
    results: Results, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study, search, asked = study_with(), fit._search, []
    together = posed(results, tmp_path / "together")
    fit.repeat(study, together, "RMSE", [0, 1, 2])

    def fails(*given: Any) -> None:
        asked.append(given[-1])
        if len(asked) == 2:
            raise MemoryError
        search(*given)

    monkeypatch.setattr(shares, "SIDE_BY_SIDE", 1)
    monkeypatch.setattr(fit, "_search", fails)
    own = posed(results, tmp_path / "own")
    with pytest.raises(MemoryError):
        fit.repeat(study, own, "RMSE", [0, 1, 2])
    assert files_of(own) == {}
    fit.repeat(study, own, "RMSE", [0, 1, 2])
    assert asked == [[0], [1], [], [1], [2]]
    assert files_of(own) == files_of(together)
    assert len(files_of(own)) == 9
    assert not (own.root / "unfinished").exists()


@pytest.mark.parametrize("changed", ["seed", "measurement", "kinetics", "source"])
def test_finished_repetitions_of_what_has_changed_since_are_not_taken(
    changed: str, results: Results, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own, study = posed(results, tmp_path), study_with()
    kept = Unfinished(study, own, "RMSE")
    write_json(kept.results.repetition("RMSE", 0, ".json"), {})
    assert Unfinished(study, own, "RMSE").has(0)
    assert not Unfinished(study, own, "RANGE").has(0)
    if changed == "seed":
        study = study_with(seed=8)
    elif changed == "source":
        monkeypatch.setattr(unfinished, "source_fingerprint", lambda *modules: "another")
    else:
        path = own.identification("estimate.csv", "kinetics")
        if changed == "measurement":
            path = own.measurement("slab_25", "mlr")
        path.write_bytes(path.read_bytes() + b" ")
    assert not Unfinished(study, own, "RMSE").has(0)
    unfinished.sweep(own)
    assert not (own.root / "unfinished").exists()


def test_summary_has_one_row_for_each_repetition(results: Results) -> None:
    summary = read_csv(results.imp("summary.csv"))
    assert summary["cost_function"].tolist() == ["RMSE"] * 2 + ["RANGE"] * 2 + ["BANDS"] * 2
    assert summary["repetition"].tolist() == [0, 1, 0, 1, 0, 1]
    assert summary["cost"].tolist() == [0.3, 0.2, 0.1, 0.1, 0.5, 0.6]
    assert summary["rho"].tolist() == [1150, 1160, 1151, 1161, 1152, 1162]


def test_convergence_of_all_repetitions_is_gathered(results: Results) -> None:
    frame = read_csv(results.imp("convergence.csv"))
    assert len(frame) == 12
    assert frame.iloc[-1].to_dict() == {
        "generation": 2,
        "calls": 22,
        "best_cost": 0.6,
        "cost_function": "BANDS",
        "repetition": 1,
    }


def test_missing_repetition_is_told(tmp_path: Path) -> None:
    own = Results(tmp_path)
    by_hand(study_with(), own)
    own.repetition("RANGE", 1, ".json").unlink()
    with pytest.raises(DataError, match=r"RANGE.01.json: this result is missing"):
        fit.collect(study_with(), own)


def test_best_set_of_each_cost_has_its_lowest_cost(results: Results) -> None:
    best = fit.best_set_of_each_cost(study_with(), results)
    assert best["RMSE"] == parameters("RMSE", 1)
    assert best["RANGE"] == parameters("RANGE", 0)  # of equal ones the first
    assert best["BANDS"] == parameters("BANDS", 0)


# --- prediction -----------------------------------------------------------------------------


def test_sets_to_predict_are_the_best_of_every_optimiser_and_published(results: Results) -> None:
    shown = {"rho": [1200, 1, 1], "k": [0.2, 1, 1], "cp": [2, 1, 1], "eps": [0.9, 1, 1]}
    published = {"RMSE": {**shown, "dh": [700, 1, 1]}, "RANGE": shown}
    study = study_with(published={"source": "x", "costs": published})
    sets = predict.sets_of(study, results)
    assert set(sets) == {
        "estimates",
        *SETS,
        *(f"{cost} {who}" for cost in SETS for who in ("least squares", "CMA-ES")),
        "RMSE published",  # that of RANGE lacks a parameter
    }
    assert sets["estimates"] == parameters("RMSE", 9)
    assert sets["RANGE least squares"] == parameters("RANGE", 5)
    assert sets["RANGE CMA-ES"] == parameters("RANGE", 7)
    assert sets["RMSE published"] == {"rho": 1200, "k": 0.2, "cp": 2000, "eps": 0.9, "dh": 700e3}


def test_predicted_curves_stand_beside_the_measured_ones(results: Results) -> None:
    curves = read_csv(results.validation("curves.csv"))
    assert list(curves.columns) == [
        "experiment",
        "signal",
        "set",
        "time_s",
        "simulated",
        "measured",
    ]
    assert set(curves["experiment"]) == {"slab_25", "slab_60"}
    assert set(curves["signal"]) == {"mlr", "back_temperature"}
    one = curves.query("experiment == 'slab_60' and signal == 'mlr' and set == 'RMSE'")
    frame = read_csv(results.measurement("slab_60", "mlr"))
    assert one["measured"].tolist() == frame["mlr_kg_m2_s"].tolist()
    assert one["time_s"].tolist() == frame["time_s"].tolist()


def test_scores_are_those_of_the_curves(results: Results) -> None:
    scores = read_csv(results.validation("scores.csv"))
    assert len(scores) == 2 * 2 * 10
    curves = read_csv(results.validation("curves.csv")).groupby(["experiment", "signal", "set"])
    for row in scores.itertuples():
        curve = curves.get_group((row.experiment, row.signal, row.set))
        rmse = np.sqrt(np.mean((curve["simulated"] - curve["measured"]) ** 2))
        assert row.rmse_si == pytest.approx(rmse, rel=1e-12)
        assert row.points == len(curve)
        assert row.largest_simulated_si == curve["simulated"].max()
        if row.signal == "mlr":
            assert row.cv_rmse == pytest.approx(rmse / curve["measured"].mean(), rel=1e-12)
        else:
            assert np.isnan(row.cv_rmse)


def test_set_that_cannot_be_predicted_is_told(results: Results) -> None:
    study = study_with(accuracy={"cells": 10, "most_steps": 100, "tolerance": 1e-6})
    with pytest.raises(DataError, match=r"slab_25: the set 'estimates' cannot be predicted: "):
        predict.predict_sets(study, results)


# --- what each step depends on --------------------------------------------------------------

SLICES = {
    "data": dependencies.data_slice,
    "kinetics": dependencies.kinetics,
    "RMSE": lambda study: dependencies.imp(study, "RMSE", "sceua"),
    "RANGE": lambda study: dependencies.imp(study, "RANGE", "sceua"),
    "least squares": lambda study: dependencies.imp(study, "RMSE", "least_squares"),
    "CMA-ES": lambda study: dependencies.imp(study, "RMSE", "cmaes"),
    "collect": dependencies.collect_slice,
    "validation": dependencies.validation_slice,
    "presentation": dependencies.presentation,
}
IMP = {"RMSE", "RANGE", "least squares", "CMA-ES"}
RANGE_TERM = {"experiment": "slab_25", "signal": "mlr", "kind": "RANGE", "options": {"r": 0.1}}
CHANGES: dict[str, tuple[dict[str, Any], set[str]]] = {
    "title": ({"title": "x"}, set()),
    "title of an experiment": ({"experiments__slab_25__title": "x"}, set()),
    "label of a parameter": ({"parameters__rho__label": "x"}, set()),
    "repetitions": ({"imp__repetitions": 3}, {"collect"}),
    "option of one cost": ({"imp__costs__RANGE": [RANGE_TERM]}, {"RANGE"}),
    "budget of SCE-UA": ({"imp__sceua": {"generations": 4}}, {"RMSE", "RANGE"}),
    "budget of least squares": ({"imp__least_squares": {"starts": 3}}, {"least squares"}),
    "budget of CMA-ES": ({"imp__cmaes": {"calls": 100}}, {"CMA-ES"}),
    "budget of the kinetics": ({"kinetics__sceua": {"generations": 4}}, {"kinetics"}),
    "limits of a slab parameter": ({"parameters__k__upper": 0.5}, IMP),
    "limits of a TGA parameter": ({"parameters__T_p__upper": 650}, IMP | {"kinetics"}),
    "experiments to predict": ({"validation__experiments": ["slab_60"]}, {"validation"}),
    "cells": ({"accuracy": {"cells": 11}}, IMP | {"validation"}),
    "step of TGA": ({"accuracy": {"cells": 10, "tga_step_K": 2}}, IMP | {"kinetics", "validation"}),
    "published values": (
        {"published": {"source": "x", "costs": {"RMSE": {"rho": [1, 2, 3]}}}},
        {"validation"},
    ),
    "seed": ({"seed": 8}, IMP | {"data", "kinetics"}),
    "truth": ({"synthetic__truth__dh": 900}, {"data"}),
    "compared TGA": ({"kinetics__compare": ["tga_20K"]}, {"kinetics"}),
}


@pytest.mark.parametrize(("change", "steps"), CHANGES.values(), ids=CHANGES)
def test_change_is_seen_by_the_steps_it_matters_to_and_no_other(
    change: dict[str, Any], steps: set[str]
) -> None:
    before, after = study_with(), study_with(**change)
    changed = {n for n, part in SLICES.items() if digest(part(before)) != digest(part(after))}
    assert changed == steps | {"presentation"}


def test_kinetics_depend_on_the_tga_they_are_compared_with() -> None:
    def study(program: str) -> Study:
        described = given(kinetics__compare=["tga_20K"])
        described["kinetics"]["cost"] = described["kinetics"]["cost"][:1]
        described["experiments"]["tga_20K"]["program"] = program
        return as_study(described, "smoke.yaml")

    seen = [digest(dependencies.kinetics(study(program))) for program in ("measured", "nominal")]
    assert seen[0] != seen[1]


def test_measured_data_do_not_depend_on_the_material(tmp_path: Path) -> None:
    described = json.loads(on_files(tmp_path).model_dump_json())
    described["experiments"].pop("tga_20K")
    described["kinetics"]["cost"] = described["kinetics"]["cost"][:1]
    described["synthetic"] = None
    before = digest(dependencies.data_slice(as_study(described, "study.json")))
    described["parameters"]["rho"]["upper"] = 1600
    assert digest(dependencies.data_slice(as_study(described, "study.json"))) == before
    described["experiments"]["tga_5K"]["signals"]["mass_fraction"]["until_K"] = 600
    assert digest(dependencies.data_slice(as_study(described, "study.json"))) != before
