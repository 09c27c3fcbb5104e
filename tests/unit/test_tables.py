from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from made_records import noise_of, searched

from pyrofit.analysis import optimisers, uses
from pyrofit.analysis.estimates import Estimated
from pyrofit.analysis.isoconversional.analyse import no_table
from pyrofit.analysis.recovery import compared
from pyrofit.analysis.repetitions import Repeated
from pyrofit.config import Study, as_study
from pyrofit.errors import StudyError
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.quantities import known_quantities
from pyrofit.results import goodness, isoconversional, searches
from pyrofit.results.files import Results, read_csv, write_csv, write_json
from pyrofit.results.goodness import Goodness, Miss, SignalGoodness
from pyrofit.results.identification import Noise, write_noise
from pyrofit.results.kinetics import LOWEST, labels
from pyrofit.results.record import write_record
from pyrofit.show.costs.table5 import table5
from pyrofit.show.facts import facts_of
from pyrofit.show.fit.table4 import flags
from pyrofit.show.identification.sentences import sentences
from pyrofit.show.names import data_name, flag
from pyrofit.show.sections import TABLES, make_named, make_table
from pyrofit.show.table import readable
from pyrofit.show.text import number
from pyrofit.stages import compare

SETS = ("SCE-UA best", "SCE-UA mean", "least squares best", "CMA-ES best")
TGA_K = np.linspace(500.0, 700.0, 41)


def described(**changes: Any) -> dict[str, Any]:
    """A study with two costs, three TGA runs, two slabs; the last measured its temperature."""
    slab = {
        "kind": "gasification",
        "sample": {"layers": [{"thickness_m": 0.004}]},
        "front": {"flux_W_m2": 25000},
        "signals": {"mlr": {"file": "slab.csv"}},
    }
    warm = {"mlr": {"file": "slab.csv"}, "back_temperature": {"file": "slab.csv"}}
    study: dict[str, Any] = {
        "name": "fake",
        "parameters": {
            "T_p": {"unit": "K", "lower": 560, "upper": 660},
            "k": {"unit": "W/(m K)", "lower": 0.1, "upper": 0.5},
            "cp": {"unit": "kJ/(kg K)", "lower": 0.5, "upper": 3.5},
        },
        "material": {
            "components": {
                "polymer": {
                    "density_kg_m3": 1000,
                    "conductivity_W_mK": "k",
                    "specific_heat_J_kgK": "cp",
                    "emissivity": 0.9,
                }
            },
            "reactions": {
                "pyrolysis": {
                    "reactant": "polymer",
                    "reference_temperature_K": "T_p",
                    "reference_rate_1_s": 0.001,
                    "E_J_mol": 190000,
                    "heat_of_reaction_J_kg": 800000,
                }
            },
            "composition": {"polymer": 1.0},
        },
        "experiments": {
            "fast": tga(20),
            "slow": tga(5),
            "unused": tga(50),
            "slab_25": {**slab, "title": "Slab 25 kW/m²"},
            "slab_60": {**slab, "signals": warm},
        },
        "kinetics": {
            "estimate": ["T_p"],
            "compare": ["fast"],
            "cost": [{"experiment": "slow", "signal": "mass_fraction", "kind": "RMSE"}],
            "sets": {
                "book": {
                    "reactions": {"pyrolysis": {"A_1_s": 1e10, "E_J_mol": 150000}},
                    "composition": {"polymer": 1.0},
                }
            },
        },
        "imp": {
            "estimate": ["k", "cp"],
            "kinetics": "fitted",
            "costs": {
                "RMSE": [{"experiment": "slab_25", "signal": "mlr", "kind": "RMSE"}],
                "BANDS": [{"experiment": "slab_25", "signal": "mlr", "kind": "BANDS"}],
            },
            "repetitions": 3,
        },
        "validation": {"experiments": ["slab_25", "slab_60"]},
        "published": {
            "source": "a book",
            "costs": {"RMSE": {"fit": [0.1, 0.2, 0.3], "k": [0.2, 0.3, 0.1], "cp": [2, 2.5, 0.1]}},
        },
    }
    return {**study, **changes}


def repeats(**changes: Any) -> dict[str, Any]:
    """The same with two repeats of a test; the second lacks the back temperature."""
    study = described(**changes)
    del study["experiments"]["slab_60"]["signals"]["mlr"]["file"]
    study["experiments"]["slab_60"]["repeats"] = [
        {"signals": {"mlr": "a.csv", "back_temperature": "a_T.csv"}},
        {"signals": {"mlr": "b.csv"}},
    ]
    return study


def tga(rate: float) -> dict[str, Any]:
    signals = {"mass_fraction": {"file": "tga.csv"}}
    return {"kind": "tga", "heating_rate_K_min": rate, "signals": signals}


def synthetic(**changes: Any) -> dict[str, Any]:
    """The same with computed measurements, nothing published, and one temperature less."""
    study = described(**changes)
    for experiment in study["experiments"].values():
        experiment["signals"] = {
            name: {"file": "synthetic"}
            for name in experiment["signals"]
            if name != "back_temperature"
        }
    study["kinetics"] = {**study["kinetics"], "sets": {}} if study.get("kinetics") else None
    del study["published"]
    return {**study, "synthetic": {"truth": {"T_p": 600, "k": 0.2, "cp": 1.5}}}


def fake(root: Path, given: dict[str, Any] | None = None) -> tuple[Study, Results]:
    """Write the results that the stages would leave behind, a few points each."""
    study = as_study(given or described(), "fake.json")
    results = Results(root)
    _measurements(study, results)
    if study.kinetics is not None:
        _kinetics(study, results)
    isoconversional.write(results, no_table().fillna(150.0), ["E varies with conversion."], 0.5)
    _imp(study, results)
    _identification(study, results)
    _validation(study, results)
    comparison(study, results)
    return study, results


def _measurements(study: Study, results: Results) -> None:
    time = np.arange(5.0, 105.0, 5.0)
    signals: dict[str, Any] = {}
    for name, experiment in study.experiments.items():
        signals[name] = {}
        for signal in experiment.signals:
            if signal == "mass_fraction":
                frame = _tga(0.0)
            elif signal == "mlr":
                columns = {"time_s": time, "mlr_kg_m2_s": 1e-4 * time}
                frame = pd.DataFrame({**columns, "mlr_uncertainty_kg_m2_s": 2e-4})
            else:
                frame = pd.DataFrame({"time_s": time, "back_temperature_K": 300.0 + time})
            write_csv(results.measurement(name, signal), frame)
            source = experiment.signals[signal].file
            signals[name][signal] = {"source": source, "sha256": "ab12", "points": len(frame)}
            if signal == "mlr":
                signals[name][signal]["released_kg_m2"] = 4.0
    write_json(results.measurements_summary, {"signals": signals})


def _tga(shift: float) -> pd.DataFrame:
    mass = 1.0 / (1.0 + np.exp((TGA_K - 600.0 - shift) / 10.0))
    return pd.DataFrame({"time_s": TGA_K * 3.0, "temperature_K": TGA_K, "mass_fraction": mass})


def _kinetics(study: Study, results: Results) -> None:
    assert study.kinetics is not None
    sets = labels(study)
    pyrolysis = {"A_1_s": 2e13, "E_J_mol": 190000.0, "order": 1.0, "mass_fraction": 1.0}
    write_record(results.kinetics("fit.json"), searched({"T_p": 601.0}, 0.0125))
    reactions = {label: {"pyrolysis": pyrolysis} for label in sets}
    write_json(results.kinetics("sets.json"), reactions)
    history = pd.DataFrame({"cost": [0.3, 0.02, 0.02], "T_p": [570.0, 605.0, 650.0]})
    write_csv(results.kinetics("history.csv.gz"), history)
    curves, scores = [], []
    for i, name in enumerate(("fast", "slow")):
        for k, label in enumerate(sets):
            curves.append(_tga(5.0 * k + 1.0).assign(experiment=name, set=label))
            score = {"experiment": name, "set": label, "rmse_mass_fraction": 0.01 * (i + 1) + k}
            scores.append(score)
    write_csv(results.kinetics("curves.csv"), pd.concat(curves))
    write_csv(results.kinetics("scores.csv"), pd.DataFrame(scores))


def _imp(study: Study, results: Results) -> None:
    rows, running = [], []
    for cost in study.imp.costs:
        for n, (fit, k, cp) in enumerate(
            [(0.10, 0.4985, 1000.0), (0.12, 0.4, 2000.0), (0.11, 0.45, 3000.0)]
        ):
            row = {
                "cost_function": cost,
                "repetition": n,
                "seed": n,
                "cost": fit,
                "cost_refined": fit,
                "calls": 100 + n,
            }
            rows.append({**row, "failed_calls": n, "generations": 5, "k": k, "cp": cp})
            best = [fit * (x if cost == "BANDS" else 1) for x in (5, 4, 3, 2, 1)]
            steps = {"generation": [1, 2, 3, 4, 5], "calls": [10 + n, 40, 60, 80, 100 + n]}
            frame = pd.DataFrame({**steps, "best_cost": best})
            running.append(frame.assign(cost_function=cost, repetition=n))
        starts = [
            {"cost": 0.08, "calls": 30, "at_bound": ["k"], "parameters": {"k": 0.5, "cp": 1500.0}},
            {"cost": 0.09, "calls": 20, "at_bound": [], "parameters": {"k": 0.3, "cp": 1500.0}},
        ]
        _starts(results, cost, "least_squares", starts)
        ends = [{**start, "cost": start["cost"] + 0.005, "calls": 500} for start in starts]
        _starts(results, cost, "cmaes", ends)
        # From SCE-UA's best, least squares gets nowhere for RMSE and further for BANDS.
        end = searches.End(
            cost=0.0995 if cost == "RMSE" else 0.08, calls=9, at_bound=[], parameters={}
        )
        write_record(results.descent(cost), searches.Descent(cost_function=cost, end=end))
    write_csv(results.imp("summary.csv"), pd.DataFrame(rows))
    write_csv(results.imp("convergence.csv"), pd.concat(running))


def _starts(results: Results, cost: str, optimiser: str, starts: list[dict[str, Any]]) -> None:
    ends = [searches.End(**start) for start in starts]
    found = searches.Starts(cost_function=cost, seed=1, starts=ends)
    write_record(results.starts(cost, optimiser), found)


def _identification(study: Study, results: Results) -> None:
    """k is determined, cp is not: its interval ends at the upper limit."""
    common = {"low_open": False, "bound": "", "noise_width": 0.05}
    k = {"parameter": "k", "estimate": 0.3, "sd": 0.01, "low": 0.28, "high": 0.32, "width": 0.1}
    k |= {"noise_low": 0.29, "noise_high": 0.31, "high_open": False, "method": "linear"}
    cp = {"parameter": "cp", "estimate": 3500.0, "sd": 800.0, "low": 1400.0, "high": 3500.0}
    cp |= {"width": 0.7, "noise_low": 2450.0, "noise_high": 3500.0, "high_open": True}
    cp |= {"method": "profile", "bound": "upper", "verdict": "undetermined, at its upper limit"}
    rows = [{**common, **k, "verdict": "determined"}, {**common, **cp}]
    write_csv(results.identification("estimate.csv"), pd.DataFrame(rows))
    matrix = {"parameter": ["k", "cp"], "k": [1.0, -0.8], "cp": [-0.8, 1.0]}
    write_csv(results.identification("correlation.csv"), pd.DataFrame(matrix))
    profile = {"parameter": "cp", "value": [1000.0, 2450.0, 3500.0], "rise": [16.0, 4.0, 0.0]}
    write_csv(results.identification("profiles.csv"), pd.DataFrame(profile))
    channel = noise_of("slab_25", "mlr", points=20, sd=2e-4, chi2=72.0)
    found = Noise(channels=[channel], chi2=72.0, freedom=18.0, dispersion=4.0)
    write_noise(results, "imp", found)
    window = Miss(20.0, 60.0, None, None, -3e-4)
    missed = SignalGoodness("slab_25", "mlr", 0.002, 4e-4, 8e-3, 2e-4, 1.0, 4e-4, (window,))
    goodness.write(results, "imp", Goodness(0.002, (missed,)))
    time = np.arange(5.0, 105.0, 5.0)
    curves = [
        pd.DataFrame({"time_s": time, "si": size * time, "whitened": time}).assign(
            experiment="slab_25", signal="mlr", parameter=name
        )
        for name, size in (("k", 1e-5), ("cp", -1e-6))
    ]
    write_csv(results.identification("sensitivities.csv"), pd.concat(curves))
    if study.kinetics is not None:
        kinetics = {**common, **k, "parameter": "T_p", "verdict": "determined"}
        write_csv(results.identification("estimate.csv", "kinetics"), pd.DataFrame([kinetics]))
        alone = pd.DataFrame({"parameter": ["T_p"], "T_p": [1.0]})
        write_csv(results.identification("correlation.csv", "kinetics"), alone)
        channel = noise_of("slow", "mass_fraction", points=20, sd=2e-4, chi2=20.0)
        found = Noise(channels=[channel], chi2=20.0, freedom=19.0, dispersion=1.0)
        write_noise(results, "kinetics", found)
        described = SignalGoodness("slow", "mass_fraction", 0.4, 5e-4, 1.0, 5e-4, 1.0, 1e-5, ())
        goodness.write(results, "kinetics", Goodness(0.4, (described,)))
    sets = [
        {"cost_function": cost, "set": label, "chi2": 90.0 * n, "k": -0.5 * n, "cp": 1.0 * n}
        for cost in study.imp.costs
        for n, label in enumerate(SETS, 1)
    ]
    write_csv(results.identification("sets.csv"), pd.DataFrame(sets))


def _validation(study: Study, results: Results) -> None:
    curves, scores = [], []
    for name in study.validation.experiments:
        # The estimates come first; they predict a little worse than the best of the others.
        for i, chosen in zip((0.2, *range(99)), uses.predicted_sets(study), strict=False):
            for signal in study.experiments[name].signals:
                frame = read_csv(results.measurement(name, signal))
                column = "mlr_kg_m2_s" if signal == "mlr" else "back_temperature_K"
                here = {"experiment": name, "signal": signal, "set": chosen.label}
                columns = {"time_s": frame["time_s"], "measured": frame[column]}
                values = frame[column] * (1.0 + 0.02 * i)
                curves.append(pd.DataFrame({**columns, "simulated": values}).assign(**here))
                cv = 0.25 + i if signal == "mlr" else np.nan
                own = {"solver_rmse_si": 0.01, "solver_cv_rmse": 1e-3 * cv}
                score = {"points": 20, "rmse_si": 7.0 + i, "cv_rmse": cv}
                scores.append({**here, **score, **own})
    write_csv(results.validation("curves.csv"), pd.concat(curves))
    write_csv(results.validation("scores.csv"), pd.DataFrame(scores))


def comparison(study: Study, results: Results) -> None:
    """Under its own cost a set has its cost, under another 0.01 more; the metric is 0.1 + that."""
    found = compare.ends(study, searches.read(study, results, OPTIMISERS))
    rows = []
    for row in found.to_dict("records"):
        about = {key: row[key] for key in ("cost_function", "found_by", "number", "best")}
        value = 0.2 if np.isnan(row["cost"]) else row["cost"]
        for cost in study.imp.costs:
            judged = value + 0.01 * (cost != row["cost_function"])
            rows.append({**about, "place": compare.FITTED, "measure": cost, "value": judged})
        for name in study.validation.experiments:
            for signal in study.experiments[name].signals:
                measure = known_quantities()[signal].metric
                rows.append({**about, "place": name, "measure": measure, "value": 0.1 + value})
    write_csv(results.comparison("scores.csv"), pd.DataFrame(rows))
    sets = [{"cost_function": c, "cost": 0.1, "met": 40 + i} for i, c in enumerate(study.imp.costs)]
    write_csv(results.comparison("family.csv"), pd.DataFrame(sets))
    bands = []
    for name in study.validation.experiments:
        for signal in study.experiments[name].signals:
            frame = read_csv(results.measurement(name, signal))
            measured = frame["mlr_kg_m2_s" if signal == "mlr" else "back_temperature_K"]
            for i, cost in enumerate(study.imp.costs):
                # From 1 % below to 1 % above all but the first point, which is missed.
                edges = {"low": measured * (0.99 - 0.01 * i), "high": measured * 1.01}
                edges["low"].iloc[0] = edges["high"].iloc[0]
                curve = {"time_s": frame["time_s"], "measured": measured, "best": measured, **edges}
                about = {"experiment": name, "signal": signal, "cost_function": cost, "sets": 10}
                bands.append(pd.DataFrame(curve).assign(**about))
    write_csv(results.comparison("bands.csv"), pd.concat(bands))


def made(name: str, study: Study, results: Results) -> pd.DataFrame:
    make_table(name, study, results)
    return read_csv(results.root / "tables" / f"{name}.csv")


@pytest.mark.parametrize("name", [name for name in TABLES if name != "heat_scores"])
def test_every_table_is_written_twice_and_alike_each_time(name: str, tmp_path: Path) -> None:
    needs = {
        "truth": synthetic,
        "known_values": lambda: described(known={"k": {"value": 0.2, "sd": 0.01}}),
        "repeats": repeats,
    }
    study, results = fake(tmp_path, needs.get(name, described)())
    make_table(name, study, results)
    files = [tmp_path / "tables" / f"{name}.{kind}" for kind in ("csv", "md")]
    first = [path.read_bytes() for path in files]
    make_table(name, study, results)
    assert [path.read_bytes() for path in files] == first
    assert b"nan" not in first[1].lower()
    assert b"None" not in first[1]


def test_table3_gives_both_units_of_E_and_marks_the_fitted_rates(tmp_path: Path) -> None:
    table = made("table3", *fake(tmp_path)).set_index(["quantity", "of", "unit"])
    assert table.loc[("E", "reaction pyrolysis", "kJ/mol"), "fitted"] == 190.0
    assert table.loc[("E", "reaction pyrolysis", "kJ/kmol"), "fitted"] == 190000.0
    assert table.loc[("cost", "fit", "-"), LOWEST] == 0.0125
    scores = table.loc["RMSE of mass fraction"]
    # Slowest first; 'slow' alone was fitted; its scores are 0.02 and, for the book, 2 more;
    # a run that is neither fitted nor compared has no score.
    assert scores["used_in_fit"].tolist() == ["yes", "no"]
    assert scores["fitted"].tolist() == [0.02, 0.01]
    assert scores["book"].tolist() == [2.02, 2.01]


def test_table4_by_hand(tmp_path: Path) -> None:
    table = made("table4", *fake(tmp_path)).set_index(["cost_function", "quantity"])
    fit = table.loc[("RMSE", "fit")]
    assert fit["best"] == 0.10
    assert fit["mean"] == pytest.approx(0.11, rel=1e-14)
    # Deviations -0.01, 0.01, 0: sqrt(2e-4 / (3 - 1)).
    assert fit["sigma"] == pytest.approx(0.01, rel=1e-12)
    assert fit["published_sigma"] == 0.3
    # J/(kg K) become kJ/(kg K); the best is that of the best cost, not the mean's neighbour.
    cp = table.loc[("RMSE", "cp")]
    assert [cp["best"], cp["mean"], cp["sigma"]] == pytest.approx([1.0, 2.0, 1.0], rel=1e-14)
    assert cp["flags"].startswith("spread > 20 % of search range; undetermined")
    # 0.4985 is 0.0015 below 0.5, and 0.5 % of 0.4 is 0.002; sigma = sqrt(0.004852/2) < 0.08.
    k = table.loc[("BANDS", "k")]
    assert k["flags"] == "at limit (upper)"
    assert np.isnan(k["published_best"])


def test_table5_has_the_papers_symbols_with_its_misprints_corrected(tmp_path: Path) -> None:
    table = made("table5", *fake(tmp_path)).set_index("symbol")
    assert len(table) == 12
    assert table["paper_unit"].to_dict() == {
        "E": "kJ/kmol",
        "ρ": "kg/m3",
        "ε": "-",
        "Δh": "kJ/kg",
        "MLR": "kg/(s m2)",
        "A": "1/s",
        "T": "°C",
        "k": "W/(m K)",
        "t": "s",
        "c_p": "kJ/(kg K)",
        "σ": "as the data",
        "n": "-",
    }
    here = table["parameters"].dropna().to_dict()
    assert here == {"T": "T_p [K]", "k": "k [W/(m K)]", "c_p": "cp [kJ/(kg K)]"}
    assert table.loc["c_p", "si_unit"] == "J/(kg K)"


def test_table5_gives_parameters_that_are_none_of_its_symbols_a_row_of_their_own() -> None:
    given = described()
    given["parameters"]["slope"] = {"unit": "1/K", "value": 0.0, "label": "slope of k"}
    given["parameters"]["d"] = {"unit": "mm", "value": 4.0}
    polymer = given["material"]["components"]["polymer"]
    polymer["conductivity_W_mK"] = {"value": "k", "slope_1_K": "slope"}
    given["experiments"]["slab_25"]["sample"] = {"layers": [{"thickness_m": "d"}]}
    table = table5(as_study(given, "fake.json"), None).set_index("symbol")
    assert table.loc["k", "parameters"] == "k [W/(m K)]"
    assert table.index[12:].tolist() == ["slope", "d"]
    assert table.loc["slope", ["quantity", "parameters"]].tolist() == ["slope of k", "slope [1/K]"]


def test_table6_by_hand(tmp_path: Path) -> None:
    given = described()
    given["published"]["costs"]["BANDS"] = {"k": [0.35, 0.3, 0.1]}
    given["published"]["limits"] = {"k": [0.09, 0.55]}
    table = made("table6", *fake(tmp_path, given)).set_index(["stage", "parameter"])
    assert table.index.tolist() == [
        ("kinetics", "T_p"),
        ("inverse modelling", "k"),
        ("inverse modelling", "cp"),
    ]
    limits = table[["lower_limit", "upper_limit"]].to_numpy().tolist()
    assert limits == [[560, 660], [0.1, 0.5], [0.5, 3.5]]
    theirs = table[["published_lower", "published_upper"]]
    assert theirs.loc[("inverse modelling", "k")].tolist() == [0.09, 0.55]
    assert theirs.drop(("inverse modelling", "k")).isna().all(axis=None)
    best = ["published_lowest", "published_highest"]
    assert table.loc[("inverse modelling", "k"), best].tolist() == [0.2, 0.35]
    assert table.loc[("inverse modelling", "cp"), best].tolist() == [2.0, 2.0]
    assert table.loc[("kinetics", "T_p"), best].isna().all()


def test_table6_of_a_study_without_published_numbers_shows_its_own_limits_alone(
    tmp_path: Path,
) -> None:
    table = made("table6", *fake(tmp_path, synthetic()))
    assert not [column for column in table if column.startswith("published")]


def test_determined_by_hand(tmp_path: Path) -> None:
    table = made("determined", *fake(tmp_path)).set_index("parameter")
    k, cp = table.loc["k"], table.loc["cp"]
    assert k[["low", "high", "noise_low", "width_percent"]].tolist() == [0.28, 0.32, 0.29, 10.0]
    # J/(kg K) become kJ/(kg K).
    assert cp[["estimate", "low", "high"]].tolist() == [3.5, 1.4, 3.5]
    assert cp["ends"] == "upper"
    assert [k["method"], cp["method"]] == ["linear", "profile"]
    assert k["strongest_correlation"] == "cp −0.80"


def test_trade_offs_by_hand(tmp_path: Path) -> None:
    (row,) = made("trade_offs", *fake(tmp_path)).to_dict("records")
    assert (row["parameter"], row["partner"]) == ("k", "cp")
    # k by its sd of 0.01; cp by -0.8 times 800 J/(kg K).
    assert row["rise"] == 0.01
    assert (row["shift"], row["partner_unit"]) == (pytest.approx(-0.64), "kJ/(kg K)")
    assert row["correlation"] == -0.8


def test_report_names_strongly_correlated_pairs(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    facts = facts_of(study, results, {})
    words = (
        "These changes compensate each other in the inverse modelling, the strongest first: "
        "k +0.01 W/(m K) and cp −0.64 kJ/(kg K)."
    )
    assert words in sentences(study, facts)
    weak = [replace(pair, correlation=-0.69) for pair in facts.trade_offs]
    assert words not in sentences(study, replace(facts, trade_offs=weak))


def test_noise_gives_chi_square_per_point(tmp_path: Path) -> None:
    kinetics, row = made("noise", *fake(tmp_path)).to_dict("records")
    assert kinetics["signal"] == "mass fraction"
    assert (row["experiment"], row["signal"]) == ("Slab 25 kW/m²", "mass loss rate")
    assert row["chi2_per_point"] == 3.6


def test_distances_by_hand(tmp_path: Path) -> None:
    table = made("distances", *fake(tmp_path))
    rows = table[table["cost_function"] == "RMSE"]
    assert rows["chi2_per_freedom"].tolist() == [5.0, 10.0, 15.0, 20.0]
    # k is 0.5, 1, 1.5, 2 and cp 1, 2, 3, 4 standard deviations off; 1.96 bound the interval.
    assert rows["within"].tolist() == [2, 1, 1, 0]
    assert rows["farthest"].tolist() == ["cp"] * 4
    assert rows["distance_sd"].tolist() == [1.0, 2.0, 3.0, 4.0]


def test_verdicts_are_flags_of_table4(tmp_path: Path) -> None:
    table = made("table4", *fake(tmp_path)).set_index(["cost_function", "quantity"])
    words = "undetermined by the data; estimate at its upper limit"
    assert table.loc[("RMSE", "cp"), "flags"] == f"spread > 20 % of search range; {words}"
    assert table.loc[("RMSE", "k"), "flags"] == "at limit (upper)"


def test_flag_of_a_parameter_at_its_bound() -> None:
    words = {"unit": "-", "method": "linear", "partner": "", "verdict": "at its lower limit"}
    numbers = dict.fromkeys(("value", "low", "high", "width"), 0.1)
    none = dict.fromkeys(("cut_off", "noise_low", "noise_high", "correlation"))
    low = Estimated(stage="imp", name="k", bound="lower", **words, **numbers, **none)
    assert low.grade == "at a limit"
    assert flag(low) == "estimate at its lower limit"


def test_flags_at_their_limits() -> None:
    def said(best: float, sigma: float) -> str:
        return flags(Repeated("RMSE", "k", best, best, sigma, 0.0, 2.0))

    assert said(0.009, 0.0) == "at limit (lower)"
    assert said(0.011, 0.0) == ""
    assert said(1.0, 0.41) == "spread > 20 % of search range"
    assert said(1.0, float("nan")) == ""
    assert said(1.999, 0.5) == "at limit (upper); spread > 20 % of search range"


def test_table4_of_synthetic_data_shows_nothing_published(tmp_path: Path) -> None:
    table = made("table4", *fake(tmp_path, synthetic()))
    assert not [column for column in table if column.startswith("published")]


def test_truth_by_hand(tmp_path: Path) -> None:
    table = made("truth", *fake(tmp_path, synthetic())).set_index(["fit", "parameter"])
    assert list(table.index) == [
        ("kinetics", "T_p"),
        *((cost, name) for cost in ("RMSE", "BANDS") for name in ("k", "cp")),
    ]
    # The best call of the search is the first of two equal ones, 605 K; the limits are 100 K apart.
    kinetics = table.loc[("kinetics", "T_p")]
    assert kinetics.tolist()[:8] == ["K", 600.0, 605.0, 100 * 5 / 600, 5.0, 601.0, 100 / 600, 1.0]
    assert kinetics[8:].isna().all()  # CMA-ES does not fit them
    # J/(kg K) become kJ/(kg K); the limits are 3 kJ/(kg K) apart.
    cp = table.loc[("BANDS", "cp")]
    found = [1.5, 1.0, 100 * -0.5 / 1.5, 100 * -0.5 / 3.0, 1.5, 0.0, 0.0, 1.5, 0.0, 0.0]
    assert cp["unit"] == "kJ/(kg K)"
    assert cp.tolist()[1:] == pytest.approx(found, rel=1e-14)


def test_truth_of_zero_has_no_relative_error() -> None:
    given = synthetic()
    given["imp"]["estimate"] = ["k", "cp", "slope"]
    given["parameters"]["slope"] = {"unit": "1/K", "lower": -0.01, "upper": 0.01}
    given["material"]["components"]["polymer"]["conductivity_W_mK"] = {
        "value": "k",
        "slope_1_K": "slope",
    }
    given["synthetic"]["truth"]["slope"] = 0.0
    study = as_study(given, "fake.json")
    row = compared(study, "RMSE", "slope", {"sceua": 0.002})
    assert row["sceua_error_truth_percent"] is None
    assert row["sceua_error_limits_percent"] == pytest.approx(10.0, rel=1e-14)


def test_truth_is_shown_only_of_what_was_fitted_to_computed_signals(tmp_path: Path) -> None:
    given = synthetic()
    given["experiments"]["slow"]["signals"]["mass_fraction"]["file"] = "tga.csv"
    study, results = fake(tmp_path, given)
    assert set(made("truth", study, results)["fit"]) == {"RMSE", "BANDS"}
    given["experiments"]["slab_25"]["signals"]["mlr"]["file"] = "slab.csv"
    assert not TABLES["truth"].applies(as_study(given, "fake.json"))


def test_data_are_called_what_they_are() -> None:
    given = synthetic()
    given["experiments"]["slab_60"]["signals"]["mlr"]["file"] = "slab.csv"
    study = as_study(given, "fake.json")
    assert data_name(study, [("slab_25", "mlr")]) == "synthetic data"
    assert data_name(study, [("slab_60", "mlr")]) == "measured"
    both = [("slab_25", "mlr"), ("slab_60", "mlr")]
    assert data_name(study, both) == "measured or synthetic data"


def test_one_repetition_has_no_sigma(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    summary = read_csv(results.imp("summary.csv"))
    write_csv(results.imp("summary.csv"), summary[summary["repetition"] == 0])
    table = made("table4", study, results)
    assert table["sigma"].isna().all()


def test_costs_by_hand(tmp_path: Path) -> None:
    table = made("costs", *fake(tmp_path)).set_index("cost_function")
    row = table.loc["RMSE"]
    assert [row["sceua_best"], row["least_squares_best"]] == [0.10, 0.08]
    assert row["ratio"] == pytest.approx(0.8, rel=1e-14)
    assert [row["sceua_calls"], row["sceua_failed_calls"]] == [303, 3]
    assert row["least_squares_calls"] == 50
    assert row["least_squares_at_bound"] == "k"
    assert row["least_squares_from_sceua"] == 0.0995
    assert [row["least_squares_starts"], row["least_squares_starts_at_best"]] == [2, 1]
    assert [row["cmaes_best"], row["cmaes_calls"], row["cmaes_starts_at_best"]] == [0.085, 1000, 1]
    assert row["lowest_by"] == "least squares"
    assert row["sceua_at_lowest"] == 0
    assert table["remark"].tolist() == [optimisers.LOCAL_OPTIMUM, optimisers.NOT_A_MINIMUM]


def test_lowest_cost_may_be_that_of_cmaes(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    end = {"cost": 0.05, "calls": 7, "at_bound": [], "parameters": {"k": 0.2, "cp": 1500.0}}
    _starts(results, "RMSE", "cmaes", [end])
    row = made("costs", study, results).set_index("cost_function").loc["RMSE"]
    assert row["lowest_by"] == "CMA-ES"
    assert row["ratio"] == pytest.approx(0.5, rel=1e-14)


def test_optimisers_within_one_percent_agree() -> None:
    assert optimisers.remark(1.0, 0.991, 1.0) == optimisers.AGREE
    assert optimisers.remark(1.0, 0.989, 1.0) == optimisers.LOCAL_OPTIMUM
    assert optimisers.remark(1.0, 0.9, 0.989) == optimisers.NOT_A_MINIMUM
    assert optimisers.remark(0.989, 1.0, 0.989) == optimisers.SCEUA_AHEAD
    assert optimisers.remark(0.0, 0.0, 0.0) == optimisers.AGREE


def test_validation_marks_fitted_and_held_out_data(tmp_path: Path) -> None:
    table = made("validation", *fake(tmp_path))
    assert set(table[table["experiment"] == "Slab 25 kW/m²"]["data"]) == {"fitted"}
    assert set(table[table["experiment"] == "slab_60"]["data"]) == {"held out"}
    temperature = table[table["signal"] == "back temperature"]
    assert temperature["rmse_K"].tolist() == [7.2, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0]
    assert temperature["cv_rmse"].isna().all()
    assert table["rmse_K"].notna().sum() == 8


def test_measures_in_other_units_are_headed_in_words() -> None:
    frame = pd.DataFrame({"rmse_K": [1.0], "rmse [kg/m²]": [2.0], "solver_rmse [kg/m²]": [0.1]})
    ((_, shown),) = readable(replace(TABLES["validation"], group_by=None), frame)
    assert list(shown) == ["RMSE [K]", "RMSE [kg/m²]", "solver, RMSE [kg/m²]"]


def test_other_signal_of_a_fitted_experiment_is_a_held_out_signal(tmp_path: Path) -> None:
    study = as_study(described(), "fake.json")
    assert uses.use_of(study, "RMSE", "slab_25", "back_temperature") == "held-out signal"
    assert uses.use_of(study, "unknown", "slab_25", "mlr") == "not known"


def test_labels_are_those_of_the_prediction() -> None:
    labels = [chosen.label for chosen in uses.predicted_sets(as_study(described(), "fake.json"))]
    assert labels == [
        "estimates",
        "RMSE",
        "BANDS",
        "RMSE least squares",
        "BANDS least squares",
        "RMSE CMA-ES",
        "BANDS CMA-ES",
        "RMSE published",
    ]


def test_unknown_table_names_the_nearest(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    with pytest.raises(StudyError, match="Did you mean 'table4'"):
        make_named("tabel4", study, results)


def test_study_without_kinetics_has_no_table3(tmp_path: Path) -> None:
    given = described(kinetics=None)
    given["imp"]["kinetics"] = "described"
    given["parameters"]["T_p"]["value"] = 600
    study, results = fake(tmp_path, given)
    assert not TABLES["table3"].applies(study)
    with pytest.raises(StudyError, match="has no table3"):
        make_table("table3", study, results)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (600.0, "600"),
        (1201.3, "1201.3"),
        (0.0892, "0.0892"),
        (1 / 3, "0.3333"),
        (-1 / 3, "-0.3333"),
        (123456, "123456"),
        (9.98e4, "99800"),
        (2e16, "2.000e+16"),
        (None, ""),
    ],
)
def test_numbers_have_four_digits(value: float | None, text: str) -> None:
    assert number(value) == text
