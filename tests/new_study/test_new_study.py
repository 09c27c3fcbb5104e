"""A study for a user's own files."""

import re
from pathlib import Path

import numpy as np
import pytest
import yaml

from pyrofit import cli
from pyrofit.config import Study, read_study
from pyrofit.config.read import read_mapping
from pyrofit.data.fetch import store
from pyrofit.experiments import KINDS
from pyrofit.new_study import draft
from pyrofit.new_study.write import init
from pyrofit.solver.lower import fractions
from pyrofit.stages.reading import read_all

ROOT = Path(__file__).parents[2]
TEMPERATURE_K = np.arange(400.0, 800.0, 5.0)
RATE_K_MIN = 10.0
MINUTES = (TEMPERATURE_K - TEMPERATURE_K[0]) / RATE_K_MIN
MASS = 0.05 + 0.95 / (1.0 + np.exp((TEMPERATURE_K - 640.0) / 12.0))
SECONDS = np.arange(0.0, 600.0, 10.0)
MLR = 0.012 * np.exp(-(((SECONDS - 300.0) / 90.0) ** 2))
BACK_K = 293.15 + SECONDS / 2.0


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(name: str, header: str, *columns: np.ndarray, sep: str = ",") -> None:
    # Files with the same numbers would be copies of one.
    own = 1.0 + 1e-9 * (sum(name.encode()) % 7)
    columns = (columns[0], own * columns[1], *columns[2:])
    rows = [sep.join(f"{x:.10g}" for x in row) for row in zip(*columns, strict=True)]
    Path(name).write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")


def lab(tga: str = "tga_10K.csv", slab: str = "cone_25.csv") -> None:
    """Write a TGA file and a gasification file."""
    header = "Time (min),Temperature (degC),Mass (mg)"
    write(tga, header, MINUTES, TEMPERATURE_K - 273.15, 5.0 * MASS)
    write(slab, "Time [s],MLR [g/m2/s],MLR error [g/m2/s]", SECONDS, 1e3 * MLR, 0.2 + 0 * MLR)


def contents(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def made(*arguments: str, name: str = "wood") -> Study:
    """Make a study and read it as `pyrofit check` does."""
    assert cli.main(["init", name, *arguments]) == 0
    return read_study(Path(name, f"{name}.yaml"))


TGA_FILES = {
    "units in the header": ("Time (min),Temperature (degC),Mass (mg)", 1.0, -273.15, 5.0),
    "seconds, kelvin, fraction": ("Time [s],Temp [K],Mass fraction [-]", 60.0, 0.0, 1.0),
    "units at the end of names": ("time_s,temperature_K,mass_fraction", 60.0, 0.0, 1.0),
    "other words": ("Elapsed time (sec),Sample Temp (Celsius),Weight (%)", 60.0, -273.15, 100.0),
    "symbols, no units": ("t,T,m", 1.0, -273.15, 5.0),
    "symbols, seconds": ("t,T_degC,TG [%]", 60.0, -273.15, 100.0),
    "hours": ("Time (h);Temperature (K);Mass (g)", 1.0 / 60.0, 0.0, 0.005),
}


@pytest.mark.parametrize(("header", "time", "zero", "mass"), TGA_FILES.values(), ids=TGA_FILES)
def test_tga_file_of_a_laboratory_is_recognised_and_read_in_si_units(
    header: str, time: float, zero: float, mass: float, folder: Path
) -> None:
    lab()
    sep = ";" if ";" in header else ","
    write("tga_10K.csv", header, time * MINUTES, TEMPERATURE_K + zero, mass * MASS, sep=sep)
    study = made("--tga", "tga_10K.csv", "--gasification", "cone_25.csv")
    frame, _ = read_all(study)["tga_10K", "mass_fraction"]
    np.testing.assert_allclose(frame["time_s"], 60.0 * MINUTES, rtol=1e-8)
    np.testing.assert_allclose(frame["temperature_K"], TEMPERATURE_K, rtol=1e-8)
    # A mass is divided by its first value, which is not quite that of the virgin sample.
    np.testing.assert_allclose(frame["mass_fraction"], MASS, rtol=1e-6)
    assert study.experiments["tga_10K"].heating_rate_K_min == RATE_K_MIN


SLAB_FILES = {
    "g/m2/s with uncertainty": ("Time [s],MLR [g/m2/s],MLR error [g/m2/s]", 1.0, 1e3, True),
    "kg/m2/s in minutes": ("Time (min),Mass loss rate (kg/m2/s),Std (kg/m2/s)", 1 / 60, 1.0, True),
    "units at the end of names": ("time_s,mlr_g_m2_s,mlr_uncertainty_g_m2_s", 1.0, 1e3, True),
    "no units": ("time,mass flux,sigma", 1.0, 1e3, True),
    "no uncertainty": ("t,MLRPUA (g/m2s),note", 1.0, 1e3, False),
}


@pytest.mark.parametrize(("header", "time", "rate", "sure"), SLAB_FILES.values(), ids=SLAB_FILES)
def test_file_of_a_mass_loss_rate_is_recognised_and_read_in_si_units(
    header: str, time: float, rate: float, sure: bool, folder: Path
) -> None:
    write("cone 25 kW.csv", header, time * SECONDS, rate * MLR, rate * (2e-4 + 0 * MLR))
    study = made("--gasification", "cone 25 kW.csv")
    frame, _ = read_all(study)["cone_25_kW", "mlr"]
    np.testing.assert_allclose(frame["time_s"], SECONDS, rtol=1e-8)
    np.testing.assert_allclose(frame["mlr_kg_m2_s"], MLR, rtol=1e-8)
    if sure:
        np.testing.assert_allclose(frame["mlr_uncertainty_kg_m2_s"], 2e-4, rtol=1e-8)
    else:
        assert "mlr_uncertainty_kg_m2_s" not in frame
    assert study.experiments["cone_25_kW"].front.flux_W_m2 == 25e3


def test_back_temperature_of_the_same_file_is_a_second_signal(folder: Path) -> None:
    header = "Time (s);MLR (g/m2s);T_back [C];MLR error (g/m2s)"
    columns = (SECONDS, 1e3 * MLR, BACK_K - 273.15, 0.2 + 0 * MLR)
    write("slab_25kW.csv", header, *columns, sep=";")
    study = made("--gasification", "slab_25kW.csv")
    series = read_all(study)
    np.testing.assert_allclose(
        series["slab_25kW", "back_temperature"][0]["back_temperature_K"], BACK_K, rtol=1e-8
    )
    assert "back_temperature_uncertainty_K" not in series["slab_25kW", "back_temperature"][0]
    assert "mlr_uncertainty_kg_m2_s" in series["slab_25kW", "mlr"][0]
    assert [t.signal for t in study.imp.costs["RMSE"]] == ["mlr", "back_temperature"]
    assert study.experiments["slab_25kW"].sample.initial_temperature_K == 293.1


def test_written_study_passes_check_and_says_what_it_took(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lab()
    before = contents(folder)
    made("--tga", "tga_10K.csv", "--gasification", "cone_25.csv")
    said = capsys.readouterr().out
    assert "tga_10K.csv: mass_fraction: time 'Time', temperature 'Temperature', value 'M" in said
    assert "study 'wood' is valid; 2 measured series read" in said
    assert cli.main(["check", "wood/wood.yaml"]) == 0
    marked = capsys.readouterr().err
    lines = Path("wood/wood.yaml").read_text("utf-8").splitlines()
    (numbers,) = re.findall(
        r"set the values marked CHANGE and delete this word: lines (.*)", marked
    )
    assert all("CHANGE" in lines[int(number) - 1] for number in numbers.split(", "))
    text = "\n".join(line.replace("CHANGE", "") for line in lines)
    Path("wood/wood.yaml").write_text(text, encoding="utf-8")
    assert cli.main(["check", "wood/wood.yaml"]) == 0
    assert "CHANGE" not in capsys.readouterr().err
    after = contents(folder)
    assert {name: after[name] for name in before} == before
    assert after["wood/data/tga_10K.csv"] == before["tga_10K.csv"]


def test_every_group_of_keys_is_commented_and_marks_what_to_change(folder: Path) -> None:
    lab()
    made("--tga", "tga_10K.csv", "--gasification", "cone_25.csv")
    text = Path("wood/wood.yaml").read_text(encoding="utf-8")
    for key in read_mapping(Path("wood/wood.yaml")):
        if key not in ("title", "experiments"):
            # On its own line, or in the comment above.
            assert re.search(rf"(#[^\n]*\n{key}:|^{key}:[^\n]*#)", text, re.M), key
    assert text.count("CHANGE") > 5
    for place in ("thickness_m: 0.006}] # CHANGE", "<<: &front # CHANGE", "insulated"):
        assert place in text


def test_limits_of_the_kinetics_hold_the_truth_of_a_record(folder: Path) -> None:
    # First order, 10 K/min: k = 0.001 1/s at 605 K with 190 kJ/mol is seen at half the mass later.
    rate = 1e-3 * np.exp(-190e3 / 8.314 * (1.0 / TEMPERATURE_K - 1.0 / 605.0))
    mass = 0.05 + 0.95 * np.exp(-np.cumsum(rate) * 5.0 / (RATE_K_MIN / 60.0))
    lab()
    write("tga_10K.csv", "time_s,temperature_K,mass_fraction", 60 * MINUTES, TEMPERATURE_K, mass)
    study = made("--tga", "tga_10K.csv", "--gasification", "cone_25.csv")
    limits = study.parameters["T_p"]
    assert limits.lower is not None
    assert limits.upper is not None
    assert limits.lower + 50.0 < 605.0 < limits.upper - 20.0
    assert study.material.reactions["pyrolysis"].products == {"residue": "y"}
    assert study.parameters["y"].bounds_si == pytest.approx((0.0, 0.1), abs=1e-3)


def char(water: float, residue: float = 0.2) -> None:
    """Write a TGA file of a solid that dries and chars by three reactions, and a slab's mass."""
    steps = ((350.0, 8.0, water), (560.0, 12.0, 0.2), (630.0, 9.0, 0.4), (690.0, 15.0, 0.4))
    kelvin, dry = np.arange(300.0, 900.0, 2.0), (1.0 - water - residue)
    mass = np.ones_like(kelvin)
    for i, (middle, width, share) in enumerate(steps):
        mass -= share * (dry if i else 1.0) / (1.0 + np.exp((middle - kelvin) / width))
    write("tga_10K.csv", "time_s,temperature_K,mass_fraction", 6.0 * (kelvin - 300.0), kelvin, mass)
    write("slab_25kW.csv", "Time [s],Mass per area [kg/m2]", SECONDS, 7.0 - np.cumsum(MLR) * 10.0)


@pytest.mark.parametrize("water", [0.0, 0.06], ids=["dry", "moist"])
@pytest.mark.parametrize("slabs", [True, False], ids=["slabs", "TGA alone"])
def test_charring_solid_of_one_reaction_has_one(water: float, slabs: bool, folder: Path) -> None:
    char(0.0)
    kelvin = np.arange(300.0, 900.0, 2.0)
    rate = 1e-3 * np.exp(-180e3 / 8.314 * (1.0 / kelvin - 1.0 / 590.0))
    mass = 1.0 - water / (1.0 + np.exp((350.0 - kelvin) / 8.0))
    mass -= (0.8 - water) * (1.0 - np.exp(-np.cumsum(rate) * 12.0))
    write("tga_10K.csv", "time_s,temperature_K,mass_fraction", 6.0 * (kelvin - 300.0), kelvin, mass)
    study = made("--tga", "tga_10K.csv", *(["--gasification", "slab_25kW.csv"] if slabs else []))
    first = study.kinetics if slabs else study.imp
    assert first is not None
    if not water:
        drying = ["drying"] if slabs else []
        assert list(study.material.reactions) == [*drying, "pyrolysis"]
        assert {*first.estimate} == {"T_p", "E_p", "y"}
    assert ({"rho_c", "k_c", "eps_c"} <= set(study.imp.estimate)) == slabs


@pytest.mark.parametrize("water", [0.0, 0.06], ids=["dry", "moist"])
@pytest.mark.parametrize("slabs", [True, False], ids=["slabs", "TGA alone"])
def test_charring_solid_gets_parallel_reactions_char_and_its_water(
    water: float, slabs: bool, folder: Path
) -> None:
    char(water)
    study = made("--tga", "tga_10K.csv", *(["--gasification", "slab_25kW.csv"] if slabs else []))
    reactions = study.material.reactions
    assert list(reactions) == [*(["drying"] if water or slabs else []), "early", "main", "late"]
    assert all(reactions[name].products == {"char": "y"} for name in ("early", "main", "late"))
    first = study.kinetics if slabs else study.imp
    assert first is not None
    assert {"T_e", "T_m", "T_l", "w_e", "w_l", "y"} <= set(first.estimate)
    assert ({"w_w", "T_w"} <= set(first.estimate)) == bool(water)
    assert ({"rho_c", "k_c", "eps_c"} <= set(study.imp.estimate)) == slabs
    # The truth lies within the limits: half of each part comes 20 K to 80 K above T_ref.
    for name, half in {"T_e": 560.0, "T_m": 630.0, "T_l": 690.0}.items():
        lower, upper = study.parameters[name].bounds_si
        assert lower < half - 80.0
        assert half - 20.0 < upper
    for name, true in {"y": 0.2 / (1.0 - water), **({"w_w": water} if water else {})}.items():
        lower, upper = study.parameters[name].bounds_si
        assert lower < true < upper


@pytest.mark.parametrize("water", [0.11, 0.18, 0.3, 0.4])
def test_limits_of_water_hold_the_measured_loss_with_room(water: float, folder: Path) -> None:
    char(water, residue=0.15)
    study = made("--tga", "tga_10K.csv")
    lower, upper = study.parameters["w_w"].bounds_si
    assert lower < 0.8 * water
    assert upper > 1.15 * water


@pytest.mark.parametrize("given", [0.0, 0.1])
def test_water_of_slabs_is_asked_once_where_the_tga_shows_none(given: float, folder: Path) -> None:
    char(0.0)
    write("slab_50kW.csv", "Time [s],Mass per area [kg/m2]", SECONDS, 7.0 - np.cumsum(MLR) * 10.0)
    made("--tga", "tga_10K.csv", "--gasification", "slab_25kW.csv", "slab_50kW.csv")
    path = Path("wood/wood.yaml")
    text = path.read_text("utf-8")
    assert text.count("CHANGE: wood in moist air") == 1
    path.write_text(
        text.replace(
            "value: 0, label: mass fraction of water",
            f"value: {given}, label: mass fraction of water",
        ),
        "utf-8",
    )
    study = read_study(path)
    assert "water" not in study.material.composition
    values = study.fixed_values() | {"w_e": 0.2, "w_l": 0.1}
    for name in ("slab_25kW", "slab_50kW"):
        (layer,) = study.experiments[name].sample.layers  # type: ignore[attr-defined]
        names = list(study.material.components)
        composed = layer.composed(study.material.composition)
        shares = dict(zip(names, fractions(composed, names, values)[:, 0], strict=True))
        assert shares["water"] == given
        assert shares["early"] == pytest.approx(0.2 * (1.0 - given))
        assert shares["main"] == pytest.approx(0.7 * (1.0 - given))


def test_water_is_not_asked_where_records_show_it_or_no_slab_is_given(folder: Path) -> None:
    char(0.06)
    made("--tga", "tga_10K.csv", "--gasification", "slab_25kW.csv")
    assert "0.06 to 0.12" not in Path("wood/wood.yaml").read_text("utf-8")
    char(0.0)
    made("--tga", "tga_10K.csv", name="alone")
    assert "water" not in Path("alone/alone.yaml").read_text("utf-8")


def test_place_of_a_back_temperature_is_asked_once(folder: Path) -> None:
    lab()
    header = "Time [s],MLR [g/m2/s],TC back 1 (K),TC back 2 (K)"
    for flux in (25, 50):
        write(f"cone_{flux}.csv", header, SECONDS, 1e3 * MLR, BACK_K, BACK_K)
    made("--tga", "tga_10K.csv", "--gasification", "cone_25.csv", "cone_50.csv")
    text = Path("wood/wood.yaml").read_text("utf-8")
    assert text.count("interface_temperature") == 1
    before, after = text.split("# CHANGE where a layer such as wool", 1)
    assert before.rindex("back_temperature_1:") > before.rindex("cone_25:\n")
    assert {"back_temperature_2:", "cone_50:"} <= set(after.split())


@pytest.mark.parametrize(("slope", "chars"), [(4e-4, True), (4e-3, False)])
def test_char_that_still_loses_mass_slowly_is_char(slope: float, chars: bool, folder: Path) -> None:
    kelvin = np.arange(300.0, 900.0, 2.0)
    mass = 0.25 + 0.75 / (1.0 + np.exp((kelvin - 620.0) / 12.0))
    mass -= slope * np.maximum(kelvin - 840.0, 0.0)
    write("tga_10K.csv", "time_s,temperature_K,mass_fraction", 6.0 * (kelvin - 300.0), kelvin, mass)
    assert ("char" in made("--tga", "tga_10K.csv").material.components) == chars


def test_residue_below_a_tenth_gives_one_reaction(folder: Path) -> None:
    char(0.0, residue=0.09)
    study = made("--tga", "tga_10K.csv", "--gasification", "slab_25kW.csv")
    assert list(study.material.reactions) == ["pyrolysis"]
    assert list(study.material.components) == ["virgin", "residue"]


@pytest.mark.parametrize(("thickness", "told"), [("0.006", False), ("0.0001", True)])
def test_first_mass_that_no_density_within_limits_gives_is_told(
    thickness: str, told: bool, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    char(0.06)
    made("--tga", "tga_10K.csv", "--gasification", "slab_25kW.csv")
    path = Path("wood/wood.yaml")
    text = path.read_text("utf-8").replace("thickness_m: 0.006", f"thickness_m: {thickness}")
    path.write_text(text, "utf-8")
    capsys.readouterr()
    assert cli.main(["check", str(path)]) == 0
    shown = capsys.readouterr()
    said = "the first mass is 7.000 kg/m2, the limits of density and thickness allow"
    assert (said in shown.out + shown.err) == told


def not_in_costs(study: Study) -> set[str]:
    """Return the experiments that are predicted and that no cost uses."""
    fitted = {term.experiment for terms in study.imp.costs.values() for term in terms}
    return set(study.validation.experiments) - fitted - set(study.imp.identification)


FLUXES = {
    "in order": ("slab_25.csv", "slab_40.csv", "slab_60.csv"),
    "largest first": ("slab_60.csv", "slab_25.csv", "slab_40.csv"),
    "unit in the name": ("Lab_60kW_7.csv", "Lab_25kW_8.csv"),
}


@pytest.mark.parametrize("files", FLUXES.values(), ids=FLUXES)
@pytest.mark.parametrize("kind", ["gasification", "cone"])
def test_largest_of_several_fluxes_is_held_out(
    kind: str, files: tuple[str, ...], folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in files:
        write(name, "Time [s],MLR [g/m2/s]", SECONDS, 1e3 * MLR)
    study = made(f"--{kind}", *files)
    (held,) = not_in_costs(study)
    assert "60" in held
    assert held in study.validation.experiments
    assert len(study.imp.costs["RMSE"]) == len(files) - 1
    assert f"Held out: {held}." in capsys.readouterr().out
    assert study.kinetics is None
    assert {"T_p", "E_p"} <= set(study.imp.estimate)


def test_all_files_of_the_largest_flux_are_held_out(folder: Path) -> None:
    names = ("a_25kW_1.csv", "a_50kW_1.csv", "a_50kW_2.csv")
    for name in names:
        write(name, "Time [s],MLR [g/m2/s]", SECONDS, 1e3 * MLR)
    assert not_in_costs(made("--gasification", *names)) == {"a_50kW_1", "a_50kW_2"}


REPEATS = {
    "numbers": ("a_25kW_1.csv", "a_25kW_2.csv", "a_25kW_3.csv"),
    "letter and number": ("a_25kW_R1.csv", "a_25kW_R2.csv"),
}


@pytest.mark.parametrize("files", REPEATS.values(), ids=REPEATS)
def test_files_that_differ_in_a_number_at_the_end_are_repeats(
    files: tuple[str, ...], folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for i, name in enumerate(files):
        # Each repeat has a header of its own.
        write(name, f"Time [s],{['MLR', 'Mass loss rate'][i % 2]} [g/m2/s]", SECONDS, 1e3 * MLR)
    study = made("--gasification", *files)
    assert "taken as repeats of a_25kW" in capsys.readouterr().out
    names = [Path(name).stem for name in files]
    assert list(study.experiments) == names
    assert {e.repeat.test for e in study.experiments.values()} == {"a_25kW"}
    assert [term.experiment for term in study.imp.costs["RMSE"]] == names
    for name in names:
        np.testing.assert_allclose(read_all(study)[name, "mlr"][0]["mlr_kg_m2_s"], MLR, rtol=1e-8)


NO_REPEATS = {
    "other fluxes": ("slab_25.csv", "slab_40.csv"),
    "flux not known": ("slab_1.csv", "slab_2.csv"),
    "other atmosphere": ("a_N2_25kW_1.csv", "a_O2_25kW_1.csv"),
    "other experiment of that name": ("a_25kW.csv", "a_25kW_1.csv", "a_25kW_2.csv"),
}


@pytest.mark.parametrize("files", NO_REPEATS.values(), ids=NO_REPEATS)
def test_files_that_differ_in_more_are_experiments_of_their_own(
    files: tuple[str, ...], folder: Path
) -> None:
    for name in files:
        write(name, "Time [s],MLR [g/m2/s]", SECONDS, 1e3 * MLR)
    study = made("--gasification", *files)
    assert list(study.experiments) == [Path(name).stem for name in files]
    assert all(e.repeat is None for e in study.experiments.values())


@pytest.mark.parametrize("files", [("slab_25.csv",), ("a_25kW_1.csv", "a_25kW_2.csv")])
def test_one_flux_leaves_nothing_to_hold_out_and_that_is_told(
    files: tuple[str, ...], folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in files:
        write(name, "Time [s],MLR [g/m2/s]", SECONDS, 1e3 * MLR)
    study = made("--gasification", *files)
    assert not not_in_costs(study)
    for text in (capsys.readouterr().out, Path("wood/wood.yaml").read_text("utf-8")):
        assert "Nothing is held out" in text
        assert "Measure at a second radiant flux" in text
        assert "name it in `validation`" in text


def test_middle_of_three_heating_rates_is_held_out_of_the_kinetics(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lab()
    names = [f"tga_{rate}K.csv" for rate in (20, 5, 10)]
    for name, rate in zip(names, (20.0, 5.0, 10.0), strict=True):
        columns = (MINUTES * RATE_K_MIN / rate, TEMPERATURE_K, 5.0 * MASS)
        write(name, "Time (min),Temperature (K),Mass (mg)", *columns)
    study = made("--tga", *names, "--gasification", "cone_25.csv")
    assert study.kinetics is not None
    assert study.kinetics.compare == ("tga_10K",)
    assert [term.experiment for term in study.kinetics.cost] == ["tga_20K", "tga_5K"]
    for text in (capsys.readouterr().out, Path("wood/wood.yaml").read_text("utf-8")):
        assert "No slab is held out" in text
        assert "Nothing is held out" not in text


def test_two_heating_rates_are_both_fitted(folder: Path) -> None:
    lab()
    write("tga_20K.csv", "t (min),T (K),m (mg)", MINUTES / 2.0, TEMPERATURE_K, MASS)
    study = made("--tga", "tga_10K.csv", "tga_20K.csv", "--gasification", "cone_25.csv")
    assert study.kinetics is not None
    assert study.kinetics.compare == ()
    assert len(study.kinetics.cost) == 2


def test_tga_alone_gives_a_study_of_the_kinetics(folder: Path) -> None:
    for rate in (5, 10, 20):
        minutes = 10.0 / rate * MINUTES
        columns = (minutes, TEMPERATURE_K, MASS)
        write(f"tga_{rate}K.csv", "Time (min),T (K),Mass fraction", *columns)
    study = made("--tga", "tga_5K.csv", "tga_10K.csv", "tga_20K.csv")
    assert study.kinetics is None
    assert study.imp.estimate == ("T_p", "E_p", "y")
    (terms,) = study.imp.costs.values()
    assert [term.experiment for term in terms] == ["tga_5K", "tga_20K"]
    assert study.validation.experiments == ("tga_5K", "tga_10K", "tga_20K")


def test_without_files_the_study_computes_its_measurements(folder: Path) -> None:
    study = made()
    assert study.is_synthetic
    assert study.own_files == ()
    assert not_in_costs(study) == {"gasification_50"}
    assert {e.front.flux_W_m2 for e in study.of_stage("imp").values()} == {25e3, 50e3}
    assert Path("wood/data").is_dir()


def test_column_that_is_not_recognised_is_told_and_left_to_the_user(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write("run_25.csv", "time_s,alpha,beta", SECONDS, 1e3 * MLR, MLR)
    assert cli.main(["init", "wood", "--gasification", "run_25.csv"]) == 0
    said = capsys.readouterr().out
    assert "run_25.csv: mlr: time 'time_s' in s, value not recognised: name it in the study" in said
    assert "Still to do, as `pyrofit check` says:" in said
    path = Path("wood/wood.yaml")
    text = path.read_text(encoding="utf-8")
    assert "# CHANGE: no one column is recognised as value." in text
    assert '# The file has: "time_s", "alpha", "beta".' in text
    assert cli.main(["check", str(path)]) == 2
    assert "no column is known to be the value of mlr" in capsys.readouterr().err
    # Named, as the comment asks, it is read.
    text = text.replace('{time: "time_s"}', '{time: "time_s", value: alpha}')
    path.write_text(text.replace('{time: "s"}', '{time: "s", value: g/m2/s}'), encoding="utf-8")
    assert cli.main(["check", str(path)]) == 0


def test_two_columns_that_may_have_one_role_are_left_to_the_user(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write("run_25.csv", "time_s,mlr_1,mlr_2", SECONDS, MLR, MLR)
    assert cli.main(["init", "wood", "--gasification", "run_25.csv"]) == 0
    assert "value not recognised" in capsys.readouterr().out


TWO_TIMES = {
    "seconds first": ("Time (s),Time (min),Temperature (C),Mass (mg)", 60.0, 1.0, "Time (s)"),
    "minutes first": ("Time (min),Time (s),Temperature (C),Mass (mg)", 1.0, 60.0, "Time (min)"),
    "other words": ("Elapsed (min),t [s],Elapsed time [h],T [C],m [mg]", 1.0, 60.0, "t"),
}


@pytest.mark.parametrize(("header", "one", "other", "taken"), TWO_TIMES.values(), ids=TWO_TIMES)
def test_one_of_two_columns_of_the_same_times_is_taken(
    header: str, one: float, other: float, taken: str, folder: Path
) -> None:
    times = [one * MINUTES, other * MINUTES, *[MINUTES / 60.0] * header.count("[h]")]
    write("tga_20K.csv", header, *times, TEMPERATURE_K - 273.15, 5.0 * MASS)
    run = draft.read_experiment("tga", Path("tga_20K.csv"))
    assert not run.lacks
    assert run.signals[0].columns["time"] == taken
    np.testing.assert_allclose(run.frames["mass_fraction"]["time_s"], 60.0 * MINUTES, rtol=1e-8)
    assert run.number == pytest.approx(RATE_K_MIN)


def test_two_columns_of_different_times_are_asked_for(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    header = "Time (min),Time (s),Temperature (C),Mass (mg)"
    write("tga_20K.csv", header, MINUTES, 60.0 * MINUTES + 300.0, TEMPERATURE_K - 273.15, MASS)
    assert cli.main(["init", "wood", "--tga", "tga_20K.csv"]) == 0
    said, text = capsys.readouterr().out, Path("wood/wood.yaml").read_text("utf-8")
    assert "no times" not in said
    assert "time not recognised: name it in the study" in said
    assert "# CHANGE: no one column is recognised as time." in text
    assert "from_temperature" not in text


def test_temperature_of_the_sample_comes_before_another(folder: Path) -> None:
    columns = (MINUTES, TEMPERATURE_K - 250.0, TEMPERATURE_K - 273.15, 5.0 * MASS)
    write("tga_10K.csv", "Time (min),Temp. (°C),Sample temp. (°C),Mass (mg)", *columns)
    run = draft.read_experiment("tga", Path("tga_10K.csv"))
    assert run.signals[0].columns["temperature"] == "Sample temp."
    np.testing.assert_allclose(run.frames["mass_fraction"]["temperature_K"], TEMPERATURE_K)


def test_guessed_unit_is_told_and_marked(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write("run_25.csv", "t,MLR", SECONDS, 1e3 * MLR)
    made("--gasification", "run_25.csv")
    assert "value 'MLR' in g/m2/s (guessed)" in capsys.readouterr().out
    text = Path("wood/wood.yaml").read_text(encoding="utf-8")
    assert "# CHANGE where wrong: guessed from the numbers: value and time" in text


def test_minutes_are_told_from_seconds_where_most_of_the_record_is_a_hold(folder: Path) -> None:
    held = np.arange(1.0, 101.0)
    minutes = np.r_[MINUTES, MINUTES[-1] + held]
    columns = (
        minutes,
        np.r_[TEMPERATURE_K, 795.0 + 0.01 * (held % 2)],
        np.r_[MASS, 0.2 + 0 * held],
    )
    write("tga_10K.csv", "Time,Temperature (K),Mass fraction", *columns)
    (found,) = draft.read_experiment("tga", Path("tga_10K.csv")).signals
    assert found.units["time"] == "min"


def test_stated_unit_per_square_centimetre_is_kept(folder: Path) -> None:
    # The numbers look like g/m2/s, which would be ten times less.
    for name, header in {
        "a": "MLR [mg/cm2/s]",
        "b": "mlr_mg_cm2_s",
        "c": "MLR (mg cm-2 s-1)",
    }.items():
        write("slab_25.csv", f"time_s,{header}", SECONDS, 100.0 * MLR)
        study = made("--gasification", "slab_25.csv", name=name)
        frame, _ = read_all(study)["slab_25", "mlr"]
        np.testing.assert_allclose(frame["mlr_kg_m2_s"], MLR, rtol=1e-8)


@pytest.mark.parametrize("header", ["MLR [lb/ft2/s]", "mlr_lb_ft2_s", "MLR (g/plate/s)"])
def test_stated_unit_that_is_unknown_is_asked_for_and_not_guessed(
    header: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write("slab_25.csv", f"time_s,{header}", SECONDS, 1e3 * MLR)
    assert cli.main(["init", "wood", "--gasification", "slab_25.csv"]) == 0
    said = capsys.readouterr().out
    assert "an unknown unit: convert it, or give another" in said
    assert "guessed" not in said
    assert "which is not known" in Path("wood/wood.yaml").read_text("utf-8")
    assert cli.main(["check", "wood/wood.yaml"]) == 2
    assert "unit" in capsys.readouterr().err


def test_rate_of_the_whole_sample_is_divided_by_an_area_to_be_changed(folder: Path) -> None:
    write("slab_25.csv", "time_s,MLR [g/s]", SECONDS, 1e3 * MLR * 0.01)
    study = made("--gasification", "slab_25.csv")
    frame, _ = read_all(study)["slab_25", "mlr"]
    np.testing.assert_allclose(frame["mlr_kg_m2_s"], MLR, rtol=1e-8)
    assert "sample_area_m2: &area 0.01 # CHANGE" in Path("wood/wood.yaml").read_text("utf-8")


HEAT = 500.0 + 3e3 * np.exp(-(((TEMPERATURE_K - 640.0) / 12.0) ** 2))
"""Heat flow of a DSC, or heat release of an MCC [W/kg]."""


@pytest.mark.parametrize(
    ("kind", "header", "quantity"),
    [
        ("dsc", "Heat Flow [W/g]", "heat_flow"),
        ("dsc", "heat flow (mW/mg)", "heat_flow"),
        ("mcc", "HRR [W/g]", "specific_heat_release_rate"),
    ],
)
def test_calorimeter_file_joins_the_kinetics(
    kind: str, header: str, quantity: str, folder: Path
) -> None:
    lab()
    write("a_10K.csv", f"Time [min],Temperature [K],{header}", MINUTES, TEMPERATURE_K, HEAT / 1e3)
    files = ["--tga", "tga_10K.csv", f"--{kind}", "a_10K.csv", "--gasification", "cone_25.csv"]
    study = made(*files)
    frame, _ = read_all(study)["a_10K", quantity]
    np.testing.assert_allclose(frame[f"{quantity}_W_kg"], HEAT, rtol=1e-8)
    assert study.kinetics is not None
    assert {(t.experiment, t.signal) for t in study.kinetics.cost} == {
        ("tga_10K", "mass_fraction"),
        ("a_10K", quantity),
    }
    heats = {"dsc": {"dh", "cp"}, "mcc": {"dhc"}}[kind]
    assert set(study.kinetics.estimate) == {"T_p", "E_p", "y"} | heats
    assert not (heats - {"cp"}) & set(study.imp.estimate)


def test_power_of_a_calorimeter_is_divided_by_a_mass_to_be_changed(folder: Path) -> None:
    lab()
    write("a_10K.csv", "t [min],T [K],DSC [mW]", MINUTES, TEMPERATURE_K, HEAT * 5e-6 * 1e3)
    study = made("--dsc", "a_10K.csv", "--gasification", "cone_25.csv")
    np.testing.assert_allclose(
        read_all(study)["a_10K", "heat_flow"][0]["heat_flow_W_kg"], HEAT, rtol=1e-8
    )
    text = Path("wood/wood.yaml").read_text("utf-8")
    assert "sample_mass_kg: 5e-06 # CHANGE" in text
    assert "endothermic: positive # CHANGE" in text


def test_heat_that_a_file_shows_with_the_other_sign_is_told(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lab()
    write("a_10K.csv", "t [min],T [K],DSC [W/g]", MINUTES, TEMPERATURE_K, -HEAT / 1e3)
    made("--dsc", "a_10K.csv", "--gasification", "cone_25.csv")
    assert "releases heat" in capsys.readouterr().out


def test_cone_calorimeter_file_brings_a_flame_and_a_heat_of_combustion(folder: Path) -> None:
    rate = 25e3 * MLR
    header = "Time [s],HRR [kW/m2],Back temp [K]"
    for flux in (25, 50):
        write(f"run_{flux}kW.csv", header, SECONDS, rate, BACK_K)
    study = made("--cone", "run_25kW.csv", "run_50kW.csv")
    assert not_in_costs(study) == {"run_50kW"}
    wanted = ["heat_release_rate", "back_temperature"]
    assert [t.signal for t in study.imp.costs["RMSE"]] == wanted
    assert "dhc" in study.imp.estimate
    # 10 % of the largest rate are reached 1.517 widths before the peak.
    ignition = SECONDS[300.0 - 90.0 * np.sqrt(np.log(10.0)) <= SECONDS][0]
    assert study.experiments["run_25kW"].flame.ignition_s == ignition


@pytest.mark.parametrize(("lost", "ignition"), [(True, 152.0), (False, 0.0)])
def test_mass_of_a_cone_tells_when_it_burns(lost: bool, ignition: float, folder: Path) -> None:
    # One value jumps before.
    mass = 70.0 - (300.0 * np.cumsum(MLR) if lost else 0.0)
    write("run_25kW.csv", "Time (s),Mass (g)", SECONDS, np.where(SECONDS == 50.0, 40.0, mass))
    study = made("--cone", "run_25kW.csv")
    assert study.experiments["run_25kW"].flame.ignition_s == pytest.approx(ignition, abs=15.0)
    assert ("1 % of the lost mass" in Path("wood/wood.yaml").read_text("utf-8")) == lost


def test_temperatures_of_a_test_burn_when_its_mass_tells(folder: Path) -> None:
    write("a_25kW_Mass.csv", "Time (s),Mass (g)", SECONDS, 70.0 - 300.0 * np.cumsum(MLR))
    write("a_25kW_Temp.csv", "Time [s],Back temperature [K]", SECONDS, BACK_K)
    study = made("--cone", "a_25kW_Mass.csv", "a_25kW_Temp.csv")
    times = [e.flame.ignition_s for e in study.experiments.values()]
    assert times[0] == times[1] > 100.0


def test_numbered_temperatures_are_a_signal_each(folder: Path) -> None:
    header = "Time [s],MLR [g/m2/s],Back temp 1 [K],Back temp 2 [K]"
    write("slab_25.csv", header, SECONDS, 1e3 * MLR, BACK_K, BACK_K + 5.0)
    study = made("--gasification", "slab_25.csv")
    wanted = ("mlr", "back_temperature_1", "back_temperature_2")
    assert tuple(t.signal for t in study.imp.costs["RMSE"]) == wanted
    frame, _ = read_all(study)["slab_25", "back_temperature_2"]
    np.testing.assert_allclose(frame["back_temperature_K"], BACK_K + 5.0, rtol=1e-8)


MASS_FILES = {
    "whole sample in g": ("Time [s],Mass [g]", 1e3 * 0.01),
    "per area": ("Time [s],Mass per area [kg/m2]", 1.0),
    "with a temperature": ("Time [s],Mass [g],Temperature [K]", 1e3 * 0.01),
}


@pytest.mark.parametrize(("header", "factor"), MASS_FILES.values(), ids=MASS_FILES)
@pytest.mark.parametrize("kind", ["gasification", "cone"])
def test_file_with_mass_alone_is_fitted_by_the_mass(
    kind: str, header: str, factor: float, folder: Path
) -> None:
    mass = 7.0 - np.cumsum(MLR) * 10.0
    columns = [SECONDS, factor * mass, BACK_K][: header.count(",") + 1]
    write("slab_25kW.csv", header, *columns)
    study = made(f"--{kind}", "slab_25kW.csv")
    frame, _ = read_all(study)["slab_25kW", "mass"]
    np.testing.assert_allclose(frame["mass_kg_m2"], mass, rtol=1e-8)
    assert study.imp.costs["RMSE"][0].signal == "mass"
    text = Path("wood/wood.yaml").read_text("utf-8")
    assert ("sample_area_m2: &area 0.01 # CHANGE" in text) == (factor > 1.0)


def test_slab_with_temperatures_alone_is_in_the_cost_beside_others(folder: Path) -> None:
    write("slab_25kW.csv", "Time [s],MLR [g/m2/s]", SECONDS, 1e3 * MLR)
    write("plate_25kW.csv", "Time [s],Back temp [K]", SECONDS, BACK_K)
    study = made("--gasification", "slab_25kW.csv", "plate_25kW.csv")
    assert [(t.experiment, t.signal) for t in study.imp.costs["RMSE"]] == [
        ("slab_25kW", "mlr"),
        ("plate_25kW", "back_temperature"),
    ]


def test_temperatures_of_a_held_out_flux_are_held_out(folder: Path) -> None:
    for flux in (25, 60):
        write(f"a_{flux}kW_Mass.csv", "Time [s],Mass [kg/m2]", SECONDS, 7.0 - np.cumsum(MLR) * 10.0)
        write(f"a_{flux}kW_Temp.csv", "Time [s],Back temperature [K]", SECONDS, BACK_K + flux)
    study = made("--gasification", *map(str, sorted(folder.glob("a_*.csv"))))
    assert [term.experiment for term in study.imp.costs["RMSE"]] == ["a_25kW_Mass", "a_25kW_Temp"]


def test_rate_is_fitted_where_the_file_has_the_mass_as_well(folder: Path) -> None:
    mass = 7.0 - np.cumsum(MLR) * 10.0
    write("slab_25kW.csv", "Time [s],Mass [g],MLR [g/m2/s]", SECONDS, 10.0 * mass, 1e3 * MLR)
    study = made("--gasification", "slab_25kW.csv")
    assert [t.signal for t in study.imp.costs["RMSE"]] == ["mlr"]
    told = "slab_25kW, mass: in no cost, as the rate is of the same load cell."
    assert told in Path("wood/wood.yaml").read_text("utf-8")
    assert set(study.experiments["slab_25kW"].signals) == {"mlr", "mass"}


def test_thermocouple_at_a_depth_is_told_as_no_file_tells_where(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write("slab_25kW.csv", "Time [s],MLR [g/m2/s],T_3 [K]", SECONDS, 1e3 * MLR, BACK_K)
    study = made("--gasification", "slab_25kW.csv")
    assert list(study.experiments["slab_25kW"].signals) == ["mlr"]
    assert "'T_3' is not used: may be in_depth_temperature, whose place" in capsys.readouterr().out


MACFP_FILES = {
    "UQ/UQ_Cone_25kW_1.csv": ("cone", ["heat_release_rate", "mass"], 25.0),
    "TIFP/TIFP_Cone_65kW_1.csv": ("cone", ["heat_release_rate", "mass"], 65.0),
    "DBI_Lund/DBI_Lund_Gasification_50kW_1.csv": ("gasification", ["mass"], 50.0),
    "FM/FM_FPA_25kW_1.csv": ("gasification", ["mass"], 25.0),
    "Aalto/Aalto_Gasification_65kW_1.csv": ("gasification", ["mass"], 65.0),
    "LCPP/LCPP_TGA_N2_2-5K_1.csv": ("tga", ["mass_fraction"], 2.5),
    "TIFP/TIFP_DSC_O2-21_10K_1.csv": ("dsc", ["heat_flow"], 10.0),
    "UMD/UMD_MCC_N2_60K.csv": ("mcc", ["specific_heat_release_rate"], 60.0),
}


@pytest.mark.measured
@pytest.mark.parametrize("file", MACFP_FILES)
def test_file_of_a_real_laboratory_gives_a_study_that_is_valid(file: str, folder: Path) -> None:
    kind, signals, number = MACFP_FILES[file]
    path = store() / "PMMA" / "Calibration_Data" / file
    if not path.exists():
        pytest.skip(f"{file} is not among the downloaded files")
    write("slab_25.csv", "Time [s],MLR [g/m2/s]", SECONDS, 1e3 * MLR)
    files = {kind: [path]}
    if KINDS[kind].stage == "kinetics":
        files["gasification"] = [Path("slab_25.csv")]
    given = [word for k, paths in files.items() for word in (f"--{k}", *map(str, paths))]
    study = made(*given)
    run = draft.read_experiment(kind, path)
    assert (run.number, run.told) == (number, "record" if run.of.stage == "kinetics" else "unit")
    imp = [term for terms in study.imp.costs.values() for term in terms]
    fitted = imp if KINDS[kind].stage == "imp" else study.kinetics.cost
    temperatures = [s for s in study.experiments[run.name].signals if "temperature" in s]
    assert [term.signal for term in fitted] == [*signals, *temperatures]
    assert read_all(study)[run.name, signals[0]][0]["time_s"].size > 20


def test_every_column_that_is_not_used_is_told_with_the_reason(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    header = (
        "Time [s],MLR [g/m2/s],Smoothed mass loss rate [g/m2/s],Oxygen [%],TC back 1 [K],CO [%]"
    )
    columns = (SECONDS, 1e3 * MLR, 1e3 * MLR, 20.0 + 0.0 * MLR, 0.0 * MLR, np.nan * MLR)
    write("slab_25.csv", header, *columns)
    made("--gasification", "slab_25.csv")
    said, text = capsys.readouterr().out, Path("wood/wood.yaml").read_text("utf-8")
    for name, why in {
        "Smoothed mass loss rate": "may be mlr as well",
        "Oxygen": "not recognised",
        "TC back 1": "zero throughout",
        "CO": "it holds no values",
    }.items():
        assert f"'{name}' is not used: {why}" in said
        assert f'# Not used: column "{name}": {why}' in text


APPARATUS = {
    "flow of a gas": ("mdot_N2 (g/s)", "gasification"),
    "exhaust": ("Temp exhaust (C)", "gasification"),
    "heater": ("Heater surface temperature (C)", "gasification"),
    "gas over the sample": ("T_top_gas (C)", "gasification"),
    "purge of the sample": ("Sample purge flow (mL/min)", "gasification"),
    "air": ("Temp. air [°C]", "cone"),
    "duct": ("DuctTemp (K)", "cone"),
}


@pytest.mark.parametrize(("header", "kind"), APPARATUS.values(), ids=APPARATUS)
def test_column_of_a_gas_or_the_apparatus_is_not_taken_for_the_sample(
    header: str, kind: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write("slab_25.csv", f"Time [s],Mass [g],{header}", SECONDS, 70.0 - SECONDS / 20.0, BACK_K)
    made(f"--{kind}", "slab_25.csv")
    assert "is not used: it belongs to a gas or the apparatus, not to" in capsys.readouterr().out
    assert [f.quantity for f in draft.read_experiment(kind, Path("slab_25.csv")).signals] == [
        "mass"
    ]


def test_rate_measured_in_nitrogen_is_that_of_the_sample(folder: Path) -> None:
    write("slab_25.csv", "Time [s],MLR N2 [g/m2/s],T_back N2 probe [K]", SECONDS, 1e3 * MLR, BACK_K)
    run = draft.read_experiment("gasification", Path("slab_25.csv"))
    assert [f.quantity for f in run.signals] == ["mlr", "back_temperature"]


@pytest.mark.parametrize("kind", ["cone", "mcc"])
def test_total_of_the_heat_release_is_no_rate(kind: str, folder: Path) -> None:
    header = "Time [s],Temperature [C],Total Heat Release"
    write("run_25.csv", header, SECONDS, SECONDS, SECONDS)
    run = draft.read_experiment(kind, Path("run_25.csv"))
    assert all(header != "Total Heat Release" for f in run.signals for header in f.columns.values())
    assert run.left["Total Heat Release"] == "it is a total over the test, not a rate"


def test_derivative_of_the_mass_is_the_rate_of_a_slab_that_has_no_other(folder: Path) -> None:
    write("slab_25.csv", "Time [s],dm/dt (g/s)", SECONDS, 1e3 * MLR * 0.01)
    run = draft.read_experiment("gasification", Path("slab_25.csv"))
    np.testing.assert_allclose(run.frames["mlr"]["mlr_kg_m2_s"], MLR, rtol=1e-8)
    write("slab_25.csv", "Time [s],dm/dt (g/s),MLR [g/m2/s]", SECONDS, MLR, 1e3 * MLR)
    (found,) = draft.read_experiment("gasification", Path("slab_25.csv")).signals
    assert found.columns["value"] == "MLR"


def test_flux_that_no_name_tells_is_marked(folder: Path) -> None:
    write("slab.csv", "Time [s],MLR [g/m2/s]", SECONDS, 1e3 * MLR)
    made("--gasification", "slab.csv")
    text = Path("wood/wood.yaml").read_text(encoding="utf-8")
    assert "flux_W_m2: 50000 # CHANGE: neither the file nor its name tells it" in text


@pytest.mark.parametrize("name", ['he said "no": {x}', "Zeit, Uhr", "a#b", "- x"])
def test_header_with_signs_of_yaml_is_text_in_the_study(name: str, folder: Path) -> None:
    header = f'"{name.replace(chr(34), chr(34) * 2)}",time_s,MLR [g/m2/s]'
    write("slab_25.csv", header, SECONDS, SECONDS, 1e3 * MLR)
    made("--gasification", "slab_25.csv")
    assert cli.main(["init", "other", "--gasification", "slab_25.csv"]) == 0


def test_files_that_the_reader_refuses_are_still_to_do(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    # Numbers that cannot be: time that stands still, and temperatures that overflow.
    lab()
    columns = (0 * MINUTES, 1e299 * TEMPERATURE_K**3, MASS)
    write("tga_10K.csv", "t,T,m", *columns)
    arguments = ["--tga", "tga_10K.csv", "--gasification", "cone_25.csv"]
    assert cli.main(["init", "wood", *arguments]) == 0
    assert "Still to do, as `pyrofit check` says:\nwood/wood.yaml: " in capsys.readouterr().out
    assert cli.main(["check", "wood/wood.yaml"]) == 2
    assert "too large a number" in capsys.readouterr().err


def test_heating_rate_is_that_of_the_record_where_the_name_says_another(folder: Path) -> None:
    lab(tga="tga_20K.csv")
    assert draft.read_experiment("tga", Path("tga_20K.csv")).number == pytest.approx(RATE_K_MIN)


BAD = {
    "no name": ("1wood --gasification cone_25.csv", "'1wood' is no name; letters, digits and _"),
    "path as name": ("a/b --gasification cone_25.csv", "'a/b' is no name"),
    "name too long": (
        f"{'x' * 300} --gasification cone_25.csv",
        "has 300 letters, too many for the name of a folder; use at",
    ),
    "folder exists": ("there --gasification cone_25.csv", "there: exists already and is left"),
    "file of that name": ("cone --gasification cone_25.csv", "cone: exists already and is left"),
    "no such file": ("x --gasification cone_52.csv", "Did you mean 'cone_25.csv'?"),
    "folder as file": ("x --gasification there", "there: this is a folder; give a file in it"),
    "empty file": ("x --gasification empty.csv", "empty.csv: the file is empty"),
    "no number": ("x --gasification text.csv", "text.csv: the file holds a header and no numbers"),
    "no header": ("x --gasification bare.csv", "bare.csv, line 1: the first row holds numbers"),
    "not text": ("x --gasification bytes.csv", "bytes.csv: the file is empty"),
    "one name twice": (
        "x --tga tga_10K.csv --gasification sub/tga_10K.csv",
        "would both be experiment 'tga_10K'; give the files different names",
    ),
}


@pytest.mark.parametrize(("command", "words"), BAD.values(), ids=BAD)
def test_bad_input_is_told_and_nothing_is_written(
    command: str, words: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lab()
    Path("there").mkdir()
    Path("there/kept.txt").write_text("kept")
    Path("cone").write_text("kept")
    Path("empty.csv").write_text("")
    Path("text.csv").write_text("a,b\nx,y\n")
    Path("bare.csv").write_text("1,2\n3,4\n")
    Path("bytes.csv").write_bytes(b"\xff\xfe")
    Path("sub").mkdir()
    lab(tga="sub/tga_10K.csv")
    before, folders = contents(folder), sorted(folder.rglob("*"))
    assert cli.main(["init", *command.split()]) == 2
    shown = capsys.readouterr()
    assert words in shown.err
    assert shown.out == ""
    assert contents(folder) == before
    assert sorted(folder.rglob("*")) == folders


def test_values_that_all_files_share_are_asked_once(tmp_path: Path) -> None:
    T = np.arange(300.0, 900.0, 10.0)
    heat = np.exp(-(((T - 640.0) / 30.0) ** 2))
    files = []
    for rate in (5, 10, 20, 40):
        files.append(tmp_path / f"board_{rate}.csv")
        columns = np.c_[60.0 / rate * (T - 300.0), T - 273.15, heat + 0.001 * rate]
        np.savetxt(files[-1], columns, "%.6g", ",", header="t,T,DSC (W/g)", comments="")
    init("board", {"dsc": files}, tmp_path)
    text = (tmp_path / "board" / "board.yaml").read_text(encoding="utf-8")
    for words in ("guessed from the numbers", "CHANGE to negative", "CHANGE where the baseline"):
        assert text.count(words) == 1
    read = yaml.safe_load(text)["experiments"]
    signals = [test["signals"]["heat_flow"] for test in read.values()]
    assert len(signals) == 4
    assert all(signal["endothermic"] == "positive" for signal in signals)
    assert all(signal["units"] == {"temperature": "degC", "time": "s"} for signal in signals)
