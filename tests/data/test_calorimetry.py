"""What a study and its files may say of heat flow and heat release, and what is refused."""

import copy
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from calorimetry_study import STUDY

from pyrofit.config import as_study
from pyrofit.data.fetch import store
from pyrofit.data.series import Measurement, read_series
from pyrofit.data.spec import SeriesSpec
from pyrofit.effects import known_effects
from pyrofit.errors import DataError, PyrofitError
from pyrofit.experiments import Dsc
from pyrofit.experiments.heated.simulate import heating_rate, request
from pyrofit.quantities.heat_flow import remark

PEAK_K = 640.0


def written(folder: Path, unit: str, factor: float, header: str = "Heat flow") -> Path:
    """Write 300 W/kg and a peak of 2000 W/kg in some unit and sign."""
    T = np.arange(320.0, 800.0, 4.0)
    flow = factor * (300.0 + 2000.0 * np.exp(-(((T - PEAK_K) / 20.0) ** 2)))
    rows = [f"{6.0 * (t - T[0])},{t},{q}" for t, q in zip(T, flow, strict=True)]
    path = folder / "dsc.csv"
    path.write_text(f"Time,Temperature,{header}\ns,K,{unit}\n" + "\n".join(rows), "utf-8")
    return path


def read(path: Path, **more: Any) -> Measurement:
    return read_series(SeriesSpec("heat_flow", path, **more))


@pytest.mark.parametrize(
    ("unit", "factor"),
    [("W/g", 1e-3), ("mW/mg", 1e-3), ("W g-1", 1e-3), ("W/kg", 1.0), ("mW", 5e-3), ("µW", 5.0)],
)
def test_heat_flow_is_read_in_every_unit(tmp_path: Path, unit: str, factor: float) -> None:
    found = read(written(tmp_path, unit, factor), sample_mass_kg=5e-6)
    assert found.frame["heat_flow_W_kg"].max() == pytest.approx(2300.0)
    assert ("power divided by 5e-06 kg" in found.notes) == (unit in ("mW", "µW"))


@pytest.mark.parametrize("header", ["Heat flow", "Heat Flow Rate", "Heat flux", "DSC"])
def test_header_of_a_laboratory_is_recognised(tmp_path: Path, header: str) -> None:
    assert len(read(written(tmp_path, "W/g", 1e-3, header)).frame) == 120


def test_power_without_a_sample_mass_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"the unit is that of a power\. Give `sample_mass_kg`"):
        read(written(tmp_path, "mW", 5e-3))


def test_file_of_the_other_sign_is_turned(tmp_path: Path) -> None:
    found = read(written(tmp_path, "W/g", -1e-3), sign=-1)
    assert found.frame["heat_flow_W_kg"].max() == pytest.approx(2300.0)
    assert "the sign is changed" in found.notes


def test_largest_peak_of_the_wrong_sign_is_noted(tmp_path: Path) -> None:
    (note,) = [n for n in read(written(tmp_path, "W/g", -1e-3)).notes if "peak" in n]
    assert note.startswith("its largest peak, at 640 K, releases heat")
    assert "change `endothermic`" in note
    right = read(written(tmp_path, "W/g", 1e-3)).notes
    assert not [n for n in right if "peak" in n]


def test_falling_baseline_is_not_taken_for_a_peak() -> None:
    T = np.arange(310.0, 870.0, 2.0)
    peak = 1500.0 * np.exp(-(((T - PEAK_K) / 20.0) ** 2))
    assert remark(T, peak - 4.0 * (T - 310.0) - 3e-3 * (T - 310.0) ** 2) == ""


def test_wrong_unit_is_noted_by_the_small_range() -> None:
    T = np.arange(310.0, 870.0, 2.0)
    assert "is its unit right?" in remark(T, 0.3 + 1e-3 * (T - 310.0))


# Studies


def refused(**changes: Any) -> str:
    """Return how a study with changed values at dotted places is refused."""
    given = copy.deepcopy(STUDY)
    for place, value in changes.items():
        *above, last = place.split("__")
        part = given
        for key in above:
            part = part[int(key)] if isinstance(part, list) else part[key]
        part[last] = value
    with pytest.raises(PyrofitError) as error:
        as_study(given, "mine.yaml")
    return str(error.value)


HEAT_RELEASE = "experiments.mcc_60.signals.specific_heat_release_rate"
STA = "experiments__sta_10"
REFUSED = {
    "heat release without a heat of combustion": (
        {"material__reactions__pyrolysis__heat_of_combustion_J_kg": 0.0},
        f"{HEAT_RELEASE}: every heat_of_combustion_J_kg of the material is 0; give at least one",
    ),
    "heat flow without a specific heat": (
        {
            "kinetics__estimate": ["T_p", "E_p", "dh", "b_0", "b_1", "h", "tau"],
            "imp__estimate": ["rho", "k", "c"],
        },
        "parameters.c: DSC or MCC needs it; add it to kinetics.estimate or give a value",
    ),
    "specific heat that no fitted signal shows": (
        {
            "kinetics__cost": [STUDY["kinetics"]["cost"][0], STUDY["kinetics"]["cost"][2]],
        },
        "kinetics.estimate: 'c' has no effect on",
    ),
    "delay of a mass": (
        {f"{STA}__signals__mass_fraction__delay_s": 3.0},
        "signal 'mass_fraction' of a DSC experiment takes neither delay_s nor offset. A sample "
        "behind its programme has lag_s; one whose recorded temperature is wrong has "
        "temperature_offset_K, and a heat flow has the baseline of its experiment",
    ),
    "offset of a heat flow": (
        {f"{STA}__signals__heat_flow__offset": 30.0},
        "takes neither delay_s nor offset",
    ),
    "sign of a mass": (
        {f"{STA}__signals__mass_fraction__endothermic": "negative"},
        "experiments.sta_10.signals.mass_fraction.endothermic: only a heat flow has a sign",
    ),
    "sign in other words": (
        {f"{STA}__signals__heat_flow__endothermic": "up"},
        "must be 'positive' or 'negative'",
    ),
    "baseline of a TGA": ({f"{STA}__kind": "tga"}, "unknown key 'baseline'"),
    "unit of the baseline": (
        {"parameters__b_1__unit": "W/kg"},
        "parameters.b_1.unit: 'W/kg' is no unit of experiments.sta_10.baseline.slope_W_kgK",
    ),
    "negative heat of combustion": (
        {"parameters__h__lower": -5.0},
        "must not be negative (it is used as material.reactions.pyrolysis.heat_of_combustion",
    ),
    "negative response time": ({"experiments__mcc_60__response_s": -1.0}, "must not be negative"),
    "heat flow of an MCC": (
        {"experiments__mcc_60__signals": {"heat_flow": {"file": "synthetic"}}},
        "unknown signal 'heat_flow'",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_study_is_refused_with_place_rule_and_way_out(name: str) -> None:
    changes, words = REFUSED[name]
    assert words in refused(**changes)


@pytest.mark.parametrize("name", ["c_T", "glass_transition", "melting"])
def test_effect_on_the_specific_heat_is_seen_by_a_heat_flow_but_not_by_a_mass(name: str) -> None:
    study = as_study(STUDY, "mine.yaml")
    sta, mcc = study.experiments["sta_10"], study.experiments["mcc_60"]
    mass = sta.model_copy(update={"signals": {"mass_fraction": sta.signals["mass_fraction"]}})
    needs = known_effects()[name].needs
    seen = [needs(e) for e in (sta, study.experiments["slab_60"], mass, mcc)]
    assert seen == [True, True, False, False]


# Heating rate


def measured(noise_K: float) -> pd.DataFrame:
    time = np.arange(0.0, 2400.0, 2.0)
    draw = np.random.default_rng(2)
    T = 320.0 + 10.0 / 60.0 * time + draw.normal(0.0, noise_K, time.size)
    return pd.DataFrame({"time_s": time, "temperature_K": T})


def test_measured_heating_rate_is_not_the_difference_of_neighbours() -> None:
    experiment = Dsc.model_validate(
        {"kind": "dsc", "heating_rate_K_min": 10, "signals": {"heat_flow": {"file": "x"}}}
    )
    frame = measured(0.05)
    times = np.arange(0.0, 2400.0, 7.0)
    found = heating_rate(experiment, frame, times)
    assert np.abs(found / (10.0 / 60.0) - 1.0)[2:-2].max() < 0.05
    differences = np.gradient(frame["temperature_K"], frame["time_s"])
    assert np.abs(differences / (10.0 / 60.0) - 1.0).max() > 0.3
    np.testing.assert_allclose(heating_rate(experiment, measured(0.0), times), 10.0 / 60.0)
    nominal = experiment.model_copy(update={"program": "nominal"})
    assert set(heating_rate(nominal, frame, times)) == {10.0 / 60.0}
    asked = request(experiment, "heat_flow", frame, times)
    assert asked.output == "heat_flow"
    np.testing.assert_array_equal(asked.programme()[1], found)


# Files of laboratories


FOLDER = "PMMA/Calibration_Data"
FILES = {
    "FSRI/FSRI_DSC_N2_10K_1.csv": (2968.8, []),
    "Sandia/Sandia_DSC_Ar_50K_1.csv": (-0.3, ["5081 of 5081 values are negative"]),
    "TIFP/TIFP_DSC_N2_10K_5.csv": (5052.8, []),
    "NIST/NIST_DSC_N2_10K_1.csv": (2982.2, []),
}


def laboratory(name: str) -> Path:
    """Return a file of the data base that no shipped study needs."""
    path = store() / FOLDER / name
    if not path.is_file():
        pytest.skip("not in this copy of the data base")
    return path


@pytest.mark.measured
@pytest.mark.parametrize("name", FILES)
def test_heat_flow_of_a_laboratory_is_read(name: str) -> None:
    largest, notes = FILES[name]
    found = read(laboratory(name))
    assert found.frame["heat_flow_W_kg"].max() == pytest.approx(largest, rel=0.05)
    assert [n for n in notes if n not in found.notes] == []
    assert not [n for n in found.notes if "peak" in n]
    turned = read(laboratory(name), sign=-1)
    assert [n for n in turned.notes if "releases heat" in n]


@pytest.mark.measured
@pytest.mark.parametrize("number", [1, 2])
def test_heat_release_of_a_laboratory_is_read(number: int) -> None:
    path = laboratory(f"NIST/NIST_MCC_N2_60K_{number}.csv")
    frame = read_series(SeriesSpec("specific_heat_release_rate", path)).frame
    released = np.trapezoid(frame["specific_heat_release_rate_W_kg"], frame["time_s"])
    # PMMA releases about 24 MJ/kg.
    assert 22e6 < released < 26e6
