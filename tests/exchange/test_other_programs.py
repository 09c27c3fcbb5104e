"""Files for Gpyro, ThermaKin and scaling pyrolysis: their form, and what they mean."""

import re
from pathlib import Path

import numpy as np
import pytest
from bases import Base, having
from decks import base, predicted
from scipy.integrate import solve_ivp

from pyrofit.cli import main
from pyrofit.errors import StudyError
from pyrofit.experiments import Tga
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.slab import SlabExperiment
from pyrofit.model.time_table import TimeTable
from pyrofit.solver.arrays import TABLE_TEMPERATURES_K
from pyrofit_exchange.fds.namelists import write_all
from pyrofit_exchange.fds.parse import read_namelists
from pyrofit_exchange.fds.predicted import predict_heated
from pyrofit_exchange.fitted_forms import power_law, quadratic
from pyrofit_exchange.gpyro.data import Data, heated_data, slab_data
from pyrofit_exchange.programs import strongest
from pyrofit_exchange.spyro import ReferenceTest, ignition, ramp
from pyrofit_exchange.steps import steps_of
from pyrofit_exchange.thermakin.components import Components, component_file
from pyrofit_exchange.thermakin.conditions import heated_conditions, slab_conditions

ROOT = Path(__file__).parents[2]
GROUPS = [
    "GENERAL",
    "OUTPUT",
    "SPROPS",
    "RXNS",
    "HGRXNS",
    "GPROPS",
    "GYIELDS",
    "HGYIELDS",
    "CASES",
    "IC",
    "ALLBC",
    "GEOM",
]
REACTING = {"char_layer": {"yield": 0.1}, "consecutive": {"yield": 0.2}}
TEN = Tga(kind="tga", heating_rate_K_min=10.0)


def slab(of: Base, name: str = "capa_25") -> SlabExperiment:
    found = of.experiments[name]
    assert isinstance(found, SlabExperiment)
    return found


def gpyro(of: Base, name: str = "capa_25") -> Data:
    return slab_data(name, slab(of, name), of.material, of.values, predicted(base(), "capa_25"))


def keys(data: Data) -> dict[str, dict[str, list[object]]]:
    text = write_all(data.namelists)
    return {group.removeprefix("GPYRO_"): of for group, of, _ in read_namelists(text, "x.data")}


def number(value: object) -> float:
    assert isinstance(value, list)
    return float(value[0])


def thermakin(of: Base) -> Components:
    return component_file(of.material, of.values, 0.0, 0.0, (8940.0, 380.0), 0.95)


def test_gpyro_gets_all_groups_that_its_samples_have() -> None:
    found = keys(gpyro(base()))
    assert set(found) >= set(GROUPS)
    assert {"GA_GENINPUT", "GA_PHI", "GA_VARS"} <= set(found)
    count = int(number(found["SPROPS"]["NSSPEC"]))
    assert [f"NAME({n + 1})" in found["SPROPS"] for n in range(count + 1)] == [True] * count + [
        False
    ]
    assert number(found["GEOM"]["NOBST"]) == number(found["IC"]["NIC"]) == 2.0  # and the foil


def test_gpyro_heat_belongs_to_the_gas_and_solids_keep_their_mass() -> None:
    of = having(base(), REACTING)
    found = keys(gpyro(of))["RXNS"]
    heat = released = 0.0
    factor: dict[str, float] = {}
    for n in range(1, int(number(found["NRXNS"])) + 1):
        reactant, product = str(found[f"CFROM({n})"][0]), str(found[f"CTO({n})"][0])
        assert number(found[f"CHI({n})"]) == (1.0 if product == "gases" else 0.0)
        factor[reactant] = factor.get(reactant, 0.0) + number(found[f"Z({n})"])
        if reactant == "B" and product == "gases":
            heat, released = number(found[f"DHV({n})"]), number(found[f"Z({n})"])
    assert heat * released / factor["B"] == pytest.approx(of.values["dh"])
    k = factor["B"] * np.exp(-of.values["E_B"] / (8.314 * of.values["T_B"]))
    assert k == pytest.approx(1e-3, rel=1e-6)


def test_gpyro_front_has_the_flux_over_time_in_order() -> None:
    of = having(base(), {"flux_drift": {"drift_1_s": 1e-4}})
    bc = keys(gpyro(of))["ALLBC"]
    count = int(number(bc["NSURF_IDX"]))
    times = [
        number(bc[f"T({n})"]) for n in range(1, count + 1) if number(bc[f"SURF_IDX({n})"]) == 1
    ]
    assert len(times) == count - 1 > 10
    assert np.all(np.diff(times) > 0.0)


def test_gpyro_gets_no_back_warmer_than_the_sample_which_would_end_the_flux() -> None:
    of = base()
    experiment = slab(of)
    for given, written in ((280.0, 280.0), (295.0, 294.9), (320.0, 294.9)):
        back = experiment.back.model_copy(
            update={"gas_temperature_K": given, "wall_temperature_K": given}
        )
        sample = experiment.sample.model_copy(update={"initial_temperature_K": 295.0})
        changed = experiment.model_copy(update={"back": back, "sample": sample})
        found = slab_data("a", changed, of.material, of.values, predicted(of, "capa_25"))
        bc = keys(found)["ALLBC"]
        last = int(number(bc["NSURF_IDX"]))
        assert number(bc[f"SURF_IDX({last})"]) == 2
        assert number(bc[f"TINF({last})"]) == pytest.approx(written)
        named = [r for r in found.remarks if "gas behind" in r.what]
        assert bool(named) == (given != written)


def test_gpyro_heats_every_rate_in_a_case() -> None:
    rates = [TEN, Tga(kind="tga", heating_rate_K_min=50.0), TEN]
    cases = keys(heated_data("tga", rates, base().material, base().values))["CASES"]
    assert [number(cases[f"BETA({n})"]) for n in (1, 2)] == [10.0, 50.0]
    assert number(cases["NCASES"]) == 2.0
    assert cases["ZEROD(1)"] == [True]


@pytest.mark.parametrize("effects", [{}, REACTING])
def test_steps_of_one_product_lose_the_same_mass(effects: dict[str, dict[str, float]]) -> None:
    of = having(base(), effects) if effects else base()
    names = list(of.material.components)
    steps = steps_of(of.material, of.values, names, 8.314462618)

    def rate(T: float, m: np.ndarray) -> np.ndarray:
        change = np.zeros_like(m)
        for step in steps:
            r = (
                step.A_1_s
                * np.exp(-step.E_J_mol / (8.314462618 * T))
                * m[names.index(step.reactant)]
            )
            change[names.index(step.reactant)] -= 6.0 * r
            if step.product is not None:
                change[names.index(step.product)] += 6.0 * r
        return change

    start = np.zeros(len(names))
    start[names.index("A")] = of.values["w_A"]
    start[names.index("B")] = 1.0 - of.values["w_A"]
    T = np.arange(310.0, 800.0, 10.0)
    found = solve_ivp(rate, (300.0, 800.0), start, "LSODA", T, rtol=1e-8, atol=1e-10)
    ours = predict_heated(TEN, of.material, of.values, Accuracy(tga_step_K=0.25))(T)
    np.testing.assert_allclose(found.y.sum(axis=0), ours, atol=1e-4)


def test_thermakin_components_have_the_lines_of_its_samples() -> None:
    text = thermakin(base()).text
    blocks = re.findall(r"COMPONENT: +(\S+)\n((?:.+\n)+)", text)
    assert [name for name, _ in blocks] == ["A", "B", "residue", "GAS", "FOIL", "BACK_FACE"]
    for _, block in blocks:
        words = [line.split(":")[0] for line in block.strip().splitlines()]
        assert words == [
            *("STATE", "DENSITY", "HEAT CAPACITY", "CONDUCTIVITY", "TRANSPORT"),
            "EMISSIVITY & ABSORPTION",
        ]
        for line in block.strip().splitlines()[1:5]:
            assert len(line.split(":")[1].split()) == 4
    assert "MIXTURES\nS SWELLING:" in text


def test_thermakin_takes_up_heat_with_a_negative_sign() -> None:
    text = thermakin(base()).text
    heats = [float(h) for h in re.findall(r"HEAT: +(\S+)", text)]
    assert set(heats) == {-base().values["dh"]}
    factors = re.findall(r"REACTION: +B \+ NOCOMP.*\n.*\nARRHENIUS: +(\S+) +(\S+)", text)
    k = sum(float(A) * np.exp(-float(E) / (8.314 * base().values["T_B"])) for A, E in factors)
    assert k == pytest.approx(1e-3, rel=1e-6)


def test_thermakin_splits_an_order_into_parts_of_the_whole() -> None:
    of = having(base(), {"reaction_order": {"order": 1.4}})
    components = thermakin(of)
    text, _ = slab_conditions(
        slab(of), of.material, of.values, components, predicted(base(), "capa_25")
    )
    shares = re.search(r"MASS FRACTIONS:\n((?:\S+  \S+\n)+)", text)
    assert shares is not None
    found = dict(line.split() for line in shares[1].splitlines())
    assert [*found] == ["A", "B1", "B2", "B3", "B4"]
    assert sum(map(float, found.values())) == pytest.approx(1.0, abs=1e-8)


def test_thermakin_radiation_holds_that_of_the_surroundings() -> None:
    text, remarks = slab_conditions(
        slab(base()),
        base().material,
        base().values,
        thermakin(base()),
        predicted(base(), "capa_25"),
    )
    q = float(re.findall(r"TIME PROG1: +(\S+)", text)[0])
    assert q == pytest.approx(25000.0 + 5.670374419e-8 * 290.0**4, rel=1e-6)
    assert remarks == ()
    assert "OUTSIDE TEMP TIME PROG:  300  0.166666667" in heated_conditions(
        TEN, base().material, base().values, thermakin(base())
    )


def test_forms_are_exact_where_they_can_be() -> None:
    T = TABLE_TEMPERATURES_K
    law = power_law(2.0 * (T / 300.0) ** 0.5, 300.0)
    assert law.coefficients == pytest.approx((2.0, 0.5))
    assert law.error < 1e-9
    assert quadratic(0.45 - 3.8e-4 * T).coefficients == pytest.approx((0.45, -3.8e-4, 0.0))
    bent = quadratic(0.1 + 1e-7 * T**2)
    assert bent.coefficients == pytest.approx((0.1, 0.0, 1e-7), abs=1e-9)
    assert quadratic(np.where(T < 500.0, 1.0, 2.0)).error > 0.1


def test_a_reference_curve_begins_at_ignition_and_holds_all_heat() -> None:
    of = predicted(base(), "capa_60")
    curve = ReferenceTest("capa_60", 6e4, 0.0058, of.time_s, of.rate)
    points = [(float(str(p.items["T"])), float(str(p.items["F"]))) for p in ramp(curve, "Q", 25e6)]
    t, q = np.array(points).T
    assert t[0] == 0.0
    assert np.all(np.diff(t) > 0.0)
    since = of.rate[of.time_s >= ignition(curve)].sum()
    assert np.trapezoid(q, t) == pytest.approx(25e3 * since, rel=0.01)


def test_the_flux_of_a_test_behind_a_shield_is_that_without_it() -> None:
    table = TimeTable(time_s=(0.0, 90.0, 90.0), value=(3700.0, 3700.0, "q"))
    assert strongest(table, {"q": 25000.0}) == 25000.0


@pytest.mark.parametrize(
    ("program", "files"),
    [
        ("gpyro", ["README.txt", "slab_25.data", "slab_60.data", "tga.data"]),
        ("spyro", ["spyro.fds"]),
        (
            "thermakin",
            [
                "README.txt",
                "material.cmp",
                "slab_25.cnd",
                "slab_60.cnd",
                "tga_20K.cnd",
                "tga_5K.cnd",
            ],
        ),
    ],
)
def test_the_commands_write_their_files(program: str, files: list[str], tmp_path: Path) -> None:
    study = str(ROOT / "config" / "smoke.yaml")
    assert main(["export", program, study, "--set", "truth", "--out", str(tmp_path)]) == 0
    assert sorted(p.name for p in tmp_path.iterdir()) == files


def test_scaling_pyrolysis_has_no_reactions(tmp_path: Path) -> None:
    study = str(ROOT / "config" / "smoke.yaml")
    assert main(["export", "spyro", study, "--set", "truth", "--out", str(tmp_path)]) == 0
    text = (tmp_path / "spyro.fds").read_text()
    read = list(read_namelists(text, "spyro.fds"))
    (surface,) = (of for group, of, _ in read if group == "SURF")
    assert surface["INERT_Q_REF"] == [True]
    assert len(surface["RAMP_Q(1:2)"]) == len(surface["REFERENCE_HEAT_FLUX(1:2)"]) == 2
    assert "N_REACTIONS" not in text


def test_reference_curves_may_be_the_measured_ones(tmp_path: Path) -> None:
    study, results = str(ROOT / "config" / "smoke.yaml"), str(tmp_path)
    assert main(["prepare", "--study", study, "--results", results]) == 0
    given = ["export", "spyro", study, "--set", "truth", "--results", results]
    texts = []
    for curves in ("measured", "simulated"):
        assert main([*given, "--curves", curves]) == 0
        texts.append((tmp_path / "spyro" / "spyro.fds").read_text())
    areas = []
    for text in texts:
        ramps = [of for group, of, _ in read_namelists(text, "spyro.fds") if group == "RAMP"]
        points = [(r["T"][0], r["F"][0]) for r in ramps if r["ID"] == ["Q_1"]]
        areas.append(np.trapezoid([q for _, q in points], [t for t, _ in points]))
    assert "reference curves: measured" in texts[0]
    assert areas[0] != areas[1]  # noise
    assert areas[0] == pytest.approx(areas[1], rel=0.03)


def test_autocatalytic_reaction_is_refused_with_the_way_out() -> None:
    of = base()
    reactions = {
        name: reaction.model_copy(update={"catalysis": 5.0})
        for name, reaction in of.material.reactions.items()
    }
    material = of.material.model_copy(update={"reactions": reactions})
    with pytest.raises(StudyError, match=r"autocatalytic \(`catalysis`\).*several reactions"):
        component_file(material, of.values, 0.0, 0.0, (8940.0, 380.0), 0.95)
    with pytest.raises(StudyError, match="autocatalytic"):
        steps_of(material, of.values, list(material.components), 8.314)
