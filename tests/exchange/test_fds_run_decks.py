"""Decks of another writer that FDS 6.7.4 has run, agreeing with pyrofit to 0.4 % of the rate.

Ours must say the same of material, layers and surroundings.
"""

import gzip
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from bases import Base, having
from decks import base, deck_of
from numpy.typing import NDArray

from pyrofit.model.slab import SlabExperiment
from pyrofit_exchange.fds.export import text_of_file
from pyrofit_exchange.fds.parse import read_namelists
from pyrofit_exchange.fds.predicted import PredictedByPyrofit

HERE = Path(__file__).parent / "data" / "run"
NAMES = ("T_A", "E_A", "T_B", "E_B", "w_A", "rho_a", "k_a", "cp_a", "eps_a", "dh")
B1 = (575.6, 224200.0, 611.6, 262300.0, 0.06, 1171.0, 0.177, 1762.0, 0.933, 671000.0)
B2 = (584.8, 224800.0, 611.7, 269500.0, 0.158, 1213.0, 0.185, 1623.0, 0.948, 678100.0)
B3 = (580.0, 210800.0, 612.4, 259800.0, 0.29, 1119.0, 0.184, 1754.0, 0.938, 732000.0)
CHAR = {"density_kg_m3": 258.0, "conductivity_W_mK": 0.2, "yield": 0.0729}
VOLATILE = {"temperature_K": 440.0, "E_J_mol": 80400.0, "share": 0.0371}
CASES: dict[str, tuple[tuple[float, ...], dict[str, dict[str, float]]]] = {
    "d05_60": (
        B1,
        {"c_T": {"slope_1_K": 0.00156}, "foil_contact": {"resistance_m2K_W": 0.00119}},
    ),
    "d06_60": (B3, {"char_layer": CHAR}),
    "d07_40": (B1, {"k_T": {"slope_1_K": -0.00141}, "back_loss": {"factor": 0.35}}),
    "d12_25": (B2, {"volatile": VOLATILE}),
    "d14_25": (B1, {"flux_decay": {"time_s": 136.0, "drift_1_s": -0.000742}}),
}
T_C, TIME_S = np.linspace(0.0, 600.0, 121), np.linspace(0.0, 1400.0, 141)
Keys = dict[str, list[Any]]


class Read(NamedTuple):
    """Lines of a deck: components by name, points of ramps, the surface, the ambient."""

    matls: dict[str, Keys]
    ramps: dict[str, list[tuple[float, float]]]
    surface: Keys
    ambient: float

    def over(self, ramp: str, x: NDArray[np.float64]) -> NDArray[np.float64]:
        # The other writer's identifiers are cut at 30 characters.
        points = next(p for name, p in self.ramps.items() if name[:30] == ramp[:30])
        return np.interp(x, *np.array(points).T)

    def property_of(self, name: str, key: str) -> NDArray[np.float64]:
        of = self.matls[name]
        return np.full(T_C.shape, of[key][0]) if key in of else self.over(of[f"{key}_RAMP"][0], T_C)

    def flux(self) -> NDArray[np.float64]:
        shape = np.ones(TIME_S.shape)
        if "RAMP_EF" in self.surface:
            shape = self.over(self.surface["RAMP_EF"][0], TIME_S)
        return float(self.surface["EXTERNAL_FLUX"][0]) * shape


def read(text: str) -> Read:
    groups = [(group, keys) for group, keys, _ in read_namelists(text, "x.fds")]
    ramps: dict[str, list[tuple[float, float]]] = {}
    for group, keys in groups:
        if group == "RAMP":
            ramps.setdefault(keys["ID"][0], []).append((keys["T"][0], keys["F"][0]))
    (surface,) = (keys for group, keys in groups if group == "SURF")
    (misc,) = (keys for group, keys in groups if group == "MISC")
    matls = {keys["ID"][0].upper(): keys for group, keys in groups if group == "MATL"}
    return Read(matls, ramps, surface, float(misc["TMPA"][0]))


def ours(name: str) -> Read:
    values, effects = CASES[name]
    experiment = base().experiments["capa_25"]
    assert isinstance(experiment, SlabExperiment)
    front = experiment.front.model_copy(update={"flux_W_m2": 1e3 * float(name[-2:])})
    sample = experiment.sample.model_copy(update={"initial_temperature_K": 300.0})
    slab = experiment.model_copy(update={"front": front, "sample": sample, "signals": {}})
    of = Base(base().material, {"x": slab}, dict(zip(NAMES, values, strict=True)))
    time = np.arange(0.5, 1500.0)
    warm, none = np.full(time.shape, 500.0), np.zeros(time.shape)
    like = PredictedByPyrofit(time, none, warm, warm, none, 1430.0, 1500.0)
    return read(text_of_file(deck_of(having(replace(of), effects), "x", like=like), []))


def plain(keys: Keys, leave_out: tuple[str, ...]) -> dict[str, list[Any]]:
    """Return keys but for some; names in capitals."""
    return {
        key: [v.upper() if isinstance(v, str) else v for v in value]
        for key, value in keys.items()
        if not key.startswith(leave_out)
    }


def same(mine: dict[str, list[Any]], theirs: dict[str, list[Any]]) -> None:
    assert set(mine) == set(theirs)
    for key, value in theirs.items():
        if isinstance(value[0], float):
            np.testing.assert_allclose(mine[key], value, rtol=1e-6, err_msg=key)
        else:
            assert mine[key] == value, key


@pytest.mark.parametrize("name", CASES)
def test_a_deck_says_the_same_as_one_that_was_run(name: str) -> None:
    theirs = read(gzip.decompress((HERE / f"{name}.fds.gz").read_bytes()).decode())
    mine = ours(name)
    assert mine.ambient == pytest.approx(theirs.ambient)
    assert set(mine.matls) == set(theirs.matls)
    for matl, keys in theirs.matls.items():
        thermal = ("CONDUCTIVITY", "SPECIFIC_HEAT")
        same(plain(mine.matls[matl], thermal), plain(keys, thermal))
        for key in thermal:
            found, wanted = (deck.property_of(matl, key) for deck in (mine, theirs))
            np.testing.assert_allclose(found, wanted, rtol=1e-5, err_msg=f"{matl} {key}")
    flux = ("EXTERNAL_FLUX", "RAMP_EF", "ID", "CELL_SIZE_FACTOR")
    same(plain(mine.surface, flux), plain(theirs.surface, flux))
    np.testing.assert_allclose(mine.flux(), theirs.flux(), rtol=2e-4)
