"""The Python interface without the solver: names, studies, series, messages."""

import ast
import subprocess
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import get_args

import matplotlib
import numpy as np
import pandas as pd
import pytest
from pydantic import BaseModel

import pyrofit as pf
from pyrofit.api import fitting, searching
from pyrofit.config import digest
from pyrofit.errors import DataError, StudyError
from pyrofit.estimate.optimisers import OPTIMISERS

matplotlib.use("agg")
ROOT = Path(__file__).parents[2]
SMOKE = ROOT / "config" / "smoke.yaml"
TIME = np.arange(2.5, 600.0, 5.0)
RATE = 0.012 * np.exp(-(((TIME - 300.0) / 90.0) ** 2))
KEY = ("slab_25", "mlr")


@pytest.fixture(scope="module")
def study() -> pf.Study:
    return pf.read_study(SMOKE)


def test_import_loads_nothing_but_the_package() -> None:
    large = ("numpy", "pandas", "pydantic")
    code = f"import sys, pyrofit; print([name for name in {large} if name in sys.modules])"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"


def test_types_have_the_names_of_the_interface() -> None:
    package = Path(pf.__file__).parent
    assert (package / "py.typed").exists()
    tree = ast.parse((package / "__init__.pyi").read_text(encoding="utf-8"))
    homes = {
        alias.asname: node.module
        for node in tree.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert sorted([*homes, "__version__"]) == sorted(pf.__all__) == dir(pf)
    for name, home in homes.items():
        assert getattr(pf, name) is getattr(import_module(str(home)), name)
        assert getattr(pf, name).__doc__


def test_functions_stand_before_modules_of_their_names() -> None:
    # In a new process, as the order of imports counts.
    code = (
        "import pyrofit as pf, pyrofit.simulate, pyrofit.effects, pyrofit.diagnose; "
        "from pyrofit.effects import known_effects; "
        "print(*map(callable, (pf.simulate, pf.effects, pf.diagnose, known_effects)))"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.split() == ["True"] * 4


def test_expression_is_not_given_a_value_and_not_changed_once_read() -> None:
    eps = {"unit": "-", "expression": "1 - k"}
    study = pf.read_study(
        SMOKE, **{"parameters.r": eps, "material.components.residue.emissivity": "r"}
    )
    with pytest.raises(StudyError, match="'r' is the expression '1 - k'; give values"):
        pf.simulate(study, {"r": 0.8})
    with pytest.raises(StudyError, match=r"parameters\.r\.expression: a study that was read"):
        pf.read_study(study, **{"parameters.r.expression": "1 - 2 * k"})
    assert pf.read_study(study, seed=3).parameters["r"].expression == "1 - k"


def test_unknown_name_is_refused() -> None:
    with pytest.raises(AttributeError, match="no attribute 'fitt'"):
        pf.fitt  # noqa: B018


def test_changes_make_the_study_that_a_file_with_them_would(study: pf.Study) -> None:
    changes = {"imp": {"repetitions": 3}, "parameters.k.upper": 0.5}
    one = pf.read_study(SMOKE, **changes)
    assert (one.imp.repetitions, one.parameters["k"].upper) == (3, 0.5)
    assert one.imp.estimate == study.imp.estimate
    again = pf.read_study(study, **changes)
    assert digest(again.model_dump(mode="json")) == digest(one.model_dump(mode="json"))
    assert study.imp.repetitions == 2


def test_change_to_none_removes_a_key(study: pf.Study) -> None:
    residue = "material.reactions.pyrolysis.products"
    with_char = pf.read_study(study, **{f"{residue}.residue": 0.1})
    assert with_char.material.reactions["pyrolysis"].products == {"residue": 0.1}
    without = pf.read_study(with_char, **{f"{residue}.residue": None})
    assert without.material.reactions["pyrolysis"].products == {}
    fewer = pf.read_study(SMOKE, **{"imp.repetitions": None})
    assert fewer.imp.repetitions == type(fewer.imp).model_fields["repetitions"].default
    with pytest.raises(StudyError, match="unknown key 'repetition'"):
        pf.read_study(study, **{"imp.repetition": None})


def test_no_key_with_a_default_of_its_own_takes_none() -> None:
    # Otherwise None would mean that default as a change, and nothing in a file.
    assert [key for key in keys_that_take_none(pf.Study) if key[1] is not None] == []


def keys_that_take_none(model: type[BaseModel]) -> Iterator[tuple[str, object]]:
    """Yield the keys of a description that take None, in all its parts, with their defaults."""
    seen, ahead = set(), [model]
    while ahead:
        part = ahead.pop()
        if isinstance(part, type) and issubclass(part, BaseModel) and part not in seen:
            seen.add(part)
            for name, field in part.model_fields.items():
                ahead.append(field.annotation)
                if type(None) in get_args(field.annotation):
                    yield f"{part.__name__}.{name}", field.default
        ahead += get_args(part)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda s: pf.read_study(s, imp={"repetition": 3}), "Did you mean 'repetitions'"),
        (lambda s: pf.simulate(s, {"kk": 1.0}), "no parameter 'kk'. Did you mean 'k'"),
        (lambda s: pf.simulate(s, {"k": "high"}), "parameter 'k': 'high' is no finite number"),
        (lambda s: pf.simulate(s, {"k": 0.2}), r"no value for E_p \(100 to 300 kJ/mol\)"),
        (lambda s: pf.simulate(s, experiments="slab"), "no experiment 'slab'. Did you mean"),
        (lambda s: pf.fit(s, signals={"slab_25": "mrl"}), "no signal 'mrl'. Did you mean 'mlr'"),
        (lambda s: pf.fit(s, stage="tga"), "unknown stage 'tga'"),
        (lambda s: pf.fit(s, estimate=["k"], fixed={"k": 0.2}), "both fixed and estimated"),
        (lambda s: pf.fit(s, cost="RMS"), "no cost 'RMS'. Did you mean 'RMSE'"),
        (lambda s: pf.fit(s, cost="RMSE", stage="imp"), "a cost has its own signals"),
        (lambda s: pf.diagnose(s, effects=["k_Y"]), "unknown effect 'k_Y'. Did you mean 'k_T'"),
        (lambda s: pf.read_data(s, data={"slab_25": []}), "several signals: mlr, back_temp"),
        (lambda s: pf.read_data(s, data={5: []}), "5 names no series"),
        (lambda s: pf.new_study("wood", tgaa="a.csv"), "'tgaa'. Did you mean 'tga'"),
        (lambda s: pf.new_study("wood"), "no measured file is given"),
        (lambda s: pf.new_study("wood", tga=pd.DataFrame()), "tga: give paths of files, or"),
        (lambda s: pf.new_study("wood", tga=np.ones(3)), "tga: give paths of files, or"),
        (lambda s: pf.new_study("wood", tga=[pd.DataFrame()]), "this is a list"),
        (lambda s: pf.new_study("wood", tga={3: TIME}), "tga: 3 is no name of an experiment"),
        (lambda s: pf.new_study("wood", cone={"a": (TIME, RATE)}), "data of a: .* give a table"),
        (lambda s: pf.simulate(s, {"k": -0.2}), "'k': -0.2 must be above 0 .it is used as"),
        (lambda s: pf.fit(s, fixed={"eps": 1.5}), "'eps': 1.5 must lie within 0 and 1"),
        (lambda s: pf.fit(s, fixed={"k": 900.0}), "fixed: 'k' is 900 .* outside its limits"),
        (lambda s: pf.fit(s, fixed=["k"]), "values by name are needed.* this is a list"),
        (lambda s: pf.fit(s, estimate=["k", "k"]), "estimate: 'k' stands twice"),
        (lambda s: pf.fit(s, signals=["tga_5K", "tga_5K"]), "'tga_5K, mass_fraction' stands twice"),
        (lambda s: pf.fit(s, starts=-1), "starts: a whole number from 1 on is needed.* int: -1"),
        (lambda s: pf.fit(s, optimiser="cmaes"), "chosen for a cost only"),
        (lambda s: pf.simulate(s, experiments=5), "names of experiments are needed"),
        (lambda s: pf.diagnose(s, effects=[]), "no effect is named"),
        (lambda s: pf.diagnose(s, effects="k_Y"), "study 'smoke': .*\n.*unknown effect 'k_Y'"),
        (lambda s: pf.read_study(None), "study: this is a NoneType; give the path"),
        (lambda s: pf.read_study([1]), "study: this is a list; give the path"),
        (lambda s: pf.read_study(s, parameters=None), "parameters"),
        (lambda s: pf.read_study(s, **{"parameters.k": 5}), r"parameters\.k"),
        (lambda s: pf.fit(s, signals=3), "signals: a list of names is needed.* int: 3"),
        (lambda s: pf.fit(s, signals={"slab_25": 3}), "signals of slab_25: a list of names"),
        (lambda s: pf.fit(s, estimate=3), "estimate: a list of names is needed.* int: 3"),
        (lambda s: pf.fit(s, estimate=[3]), "no parameter '3'"),
        (lambda s: pf.fit(s, cost=3), "cost: the name of a cost or a function is needed"),
        (lambda s: pf.simulate(3), "study: this is a int"),
        (lambda s: pf.read_study(s, **{"parameters.k.fixed": 0.9}), "outside the limits 0.1 to"),
    ],
)
def test_wrong_name_or_value_is_explained(wrong, message: str, study: pf.Study) -> None:
    with pytest.raises(StudyError, match=message):
        wrong(study)


@pytest.mark.parametrize(
    "given",
    [
        pd.DataFrame({"Time (min)": TIME / 60.0, "MLR (g/m2s)": 1e3 * RATE}),
        pd.DataFrame({"time_s": TIME, "mlr_kg_m2_s": RATE}),
        np.column_stack([TIME, RATE]),
        (TIME, RATE),
    ],
)
def test_series_in_memory_are_read_as_files_are(given: object, study: pf.Study) -> None:
    found = pf.read_data(study, {"slab_25": "mlr"}, {KEY: given})
    frame = found["slab_25", "mlr"]
    assert np.allclose(frame["time_s"], TIME)
    assert np.allclose(frame["mlr_kg_m2_s"], RATE)
    assert frame.attrs["units"]["mlr_kg_m2_s"] == "kg/(m2 s)"
    assert found.frame["unit"].unique().tolist() == ["kg/(m2 s)"]
    again = pf.read_data(study, {"slab_25": "mlr"}, found)
    assert np.array_equal(again[KEY], frame)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (np.zeros((5, 7)), r"data of slab_25, mlr: an array of the shape \(5, 7\)"),
        ("a.csv", "data of slab_25, mlr: neither a table nor"),
        (pd.DataFrame({"a": [1, 2, 3], "b": [1, 2, 3]}), "data of slab_25, mlr: no column"),
        ((TIME[::-1], RATE), "data of slab_25, mlr"),
    ],
)
def test_wrong_series_is_named_in_the_message(given: object, message: str, study: pf.Study) -> None:
    with pytest.raises(DataError, match=message):
        pf.read_data(study, {"slab_25": "mlr"}, {KEY: given})


def test_checked_series_are_not_read_again(
    study: pf.Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    data = pf.read_data(study, {"slab_25": "mlr"}, {KEY: (TIME, RATE)})
    with monkeypatch.context() as patch:
        patch.setattr("pyrofit.api.measurements.read_all", None)
        again = pf.read_data(study, {"slab_25": "mlr"}, data)
    assert again[KEY].equals(data[KEY])
    assert again[KEY] is not data[KEY]
    cut = pf.read_study(study, **{"experiments.slab_25.signals.mlr.until_s": 300.0})
    assert pf.read_data(cut, {"slab_25": "mlr"}, data)[KEY]["time_s"].max() <= 300.0


@pytest.mark.parametrize(("row", "column"), [(3, "mlr_kg_m2_s"), (3, "time_s")])
def test_checked_series_that_was_changed_is_checked_again(
    row: int, column: str, study: pf.Study
) -> None:
    data = pf.read_data(study, {"slab_25": "mlr"}, {KEY: (TIME, RATE)})
    data[KEY].loc[row, column] = -np.inf
    with pytest.raises(DataError, match="data of slab_25, mlr"):
        pf.read_data(study, {"slab_25": "mlr"}, data)


def test_signals_of_an_experiment_stand_side_by_side(study: pf.Study) -> None:
    data = {KEY: (TIME, RATE), ("slab_25", "back_temperature"): (TIME[1:], 300.0 + TIME[1:])}
    frame = pf.read_data(study, "slab_25", data)["slab_25"]
    assert list(frame) == ["time_s", "mlr_kg_m2_s", "back_temperature_K"]
    assert frame["back_temperature_K"].isna().tolist() == [True] + [False] * (TIME.size - 1)
    assert frame.attrs["units"]["back_temperature_K"] == "K"


def test_plot_uses_the_axes_that_are_given(study: pf.Study) -> None:
    from matplotlib.figure import Figure

    ax = Figure().subplots()
    curves = pf.read_data(study, {"slab_25": "mlr"}, {KEY: (TIME, RATE)})
    assert curves.plot("slab_25", ax=ax, color="green") is ax
    (line,) = ax.lines
    assert np.allclose(line.get_ydata(), 1e3 * RATE)  # g/(m2 s)
    assert ax.get_ylabel() == "mass loss rate [g/(m² s)]"


def test_parameter_that_was_fixed_needs_limits_to_be_free(study: pf.Study) -> None:
    held = pf.read_study(study, **{"parameters.k.fixed": 0.2})
    assert "k" not in held.imp.estimate
    with pytest.raises(StudyError, match=r"parameters\.k\.fixed: .* Give `lower` and `upper`"):
        pf.read_study(held, **{"parameters.k.fixed": None})
    limits = {"fixed": None, "lower": 0.1, "upper": 0.4}
    free = pf.read_study(held, **{"parameters.k": limits, "imp.estimate": study.imp.estimate})
    assert free.imp.estimate == study.imp.estimate


def test_notes_of_the_reader_stand_below_a_series(study: pf.Study) -> None:
    rate = RATE.copy()
    rate[-2:] = np.nan
    found = pf.read_data(study, {"slab_25": "mlr"}, {KEY: (TIME, rate)})
    (note,) = [note for note in found[KEY].attrs["notes"] if "without" in note or "empty" in note]
    assert f"    {note}" in repr(found)
    assert note in found._repr_html_()


def test_unusual_value_gives_a_warning(study: pf.Study) -> None:
    with pytest.warns(UserWarning, match="study 'smoke': .*'cp'.* outside the usual range"):
        pf.read_study(study, **{"parameters.cp.upper": 3000})


def test_study_shows_its_parameters_and_experiments(study: pf.Study) -> None:
    assert "parameter k: 0.1 to 0.4 W/(m K)" in repr(study)
    assert "experiment slab_25: gasification; mlr, back_temperature" in repr(study)
    assert study._repr_html_().startswith("<pre>study")


def test_record_without_times_is_read_with_the_rate_that_is_warned_of(tmp_path: Path) -> None:
    T = np.arange(400.0, 800.0, 5.0)
    mass = 0.2 + 0.8 / (1.0 + np.exp((T - 640.0) / 12.0))
    pd.DataFrame({"Temperature (K)": T, "Mass (-)": mass}).to_csv(
        tmp_path / "wood.csv", index=False
    )
    with pytest.warns(UserWarning, match=r"wood\.csv: no heating rate is given; 10 K/min is"):
        study = pf.new_study("wood", tga=tmp_path / "wood.csv")
    read = pf.read_data(study)
    again = pf.read_data(study, data=read)
    short = pf.read_data(study, data={"wood": (T, mass)})
    for other in (again, short):
        assert np.allclose(other["wood"], read["wood"])


def test_files_of_heated_samples_alone_make_a_study(tmp_path: Path) -> None:
    T = np.arange(400.0, 800.0, 5.0)
    mass = 0.2 + 0.8 / (1.0 + np.exp((T - 640.0) / 12.0))
    for rate in (5, 20):
        columns = {"Time (min)": (T - 400.0) / rate, "Temperature (K)": T, "Mass (mg)": 5.0 * mass}
        pd.DataFrame(columns).to_csv(tmp_path / f"tga_{rate}K.csv", index=False)
    study = pf.new_study("wood", tga=sorted(tmp_path.glob("*.csv")))
    data = pf.read_data(study, ["tga_5K", "tga_20K"])
    assert np.allclose(data["tga_5K"]["mass_fraction"], mass)
    assert study.experiments["tga_20K"].heating_rate_K_min == 20.0
    assert set(study.experiments) == {"tga_5K", "tga_20K"}
    assert study.kinetics is None  # the inverse modelling fits them


def test_study_that_was_written_is_the_same_study(
    study: pf.Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "files").mkdir()
    (tmp_path / "studies").mkdir()
    monkeypatch.chdir(tmp_path)
    pd.DataFrame({"Time (s)": TIME, "MLR (g/m2s)": 1e3 * RATE}).to_csv("files/a.csv", index=False)
    file = {"experiments.slab_25.signals.mlr.file": "files/a.csv"}
    changed = pf.read_study(study, **file)
    again = pf.read_study(pf.write_study(changed, "studies/again.yaml"))
    there = Path(again.experiments["slab_25"].signals["mlr"].file)
    assert there.resolve() == tmp_path / "files" / "a.csv"
    assert np.allclose(pf.read_data(again, {"slab_25": "mlr"})[KEY]["mlr_kg_m2_s"], RATE)
    same = pf.read_study(again, **file)
    assert digest(same.model_dump(mode="json")) == digest(changed.model_dump(mode="json"))


def test_effects_are_listed_with_the_reason_for_leaving_one_out(study: pf.Study) -> None:
    assert pf.effects().loc["k_T", "unit"] == "1/K"
    few = pf.effects(pf.read_study(study, **{"diagnosis.effects": ["k_T"]}))
    assert few.index[few["candidate"]].tolist() == ["k_T"]
    assert few.loc["c_T", "obstacle"] == "diagnosis.effects does not list it"


def test_results_are_tables_by_name(tmp_path: Path, study: pf.Study) -> None:
    with pytest.raises(DataError, match="no results of a campaign"):
        pf.read_results(tmp_path)
    (tmp_path / "study.json").write_text(study.model_dump_json(), encoding="utf-8")
    (tmp_path / "tables").mkdir()
    pd.DataFrame({"a": [1.0]}).to_csv(tmp_path / "tables" / "table4.csv", index=False)
    campaign = pf.read_results(tmp_path)
    assert campaign.study.name == "smoke"
    assert campaign["table4"]["a"].tolist() == [1.0]
    with pytest.raises(DataError, match="Did you mean 'table4'"):
        campaign["tabel4"]


def test_fit_takes_every_optimiser_of_the_workflow() -> None:
    assert set(get_args(fitting.Optimiser)) == {searching.SCEUA, *OPTIMISERS}
