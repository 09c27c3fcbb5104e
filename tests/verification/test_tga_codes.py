"""TGA against FDS 6.7.4 and Gpyro 0.82

The paper's Table 3 kinetics at its three heating rates. FDS deletes the layer at about 1 % of the
mass; the comparison ends there. Gpyro's steps are first order in time: its own error is 1.1e-4,
and its mass fraction is written with seven digits.
"""

from typing import Any

from cases import E_SCALE, KINETICS, powder, reference, table_3, tga_fraction
from evidence import MASS, TEMPERATURE, Evidence, Line

RATES = (1, 10, 50)


def test_table_3_curves_of_fds_agree(evidence: Evidence) -> None:
    lines = {}
    for beta in RATES:
        curve = reference("fds", f"tga_table3_{beta}K")
        curve = curve[curve["mass_fraction"] > 0.01]
        temperature = curve["T_C"].to_numpy() + 273.15
        ours = tga_fraction(table_3(), beta, temperature)
        lines[f"{beta} K/min"] = Line(temperature, ours, curve["mass_fraction"].to_numpy())
    evidence.curve("Table 3 kinetics", TEMPERATURE, MASS, lines, "FDS 6.7.4", 3e-5)


def test_table_3_curves_of_gpyro_agree(evidence: Evidence) -> None:
    def reaction(name: str) -> dict[str, Any]:
        kinetics = KINETICS[name]
        return {"reactant": name, **kinetics, "E_J_mol": kinetics["E_J_mol"] * E_SCALE}

    composition = {"A": 0.024975, "B": 0.974025, "R": 0.001}
    material = powder("ABR", composition, reaction("A"), reaction("B"))
    lines = {}
    for beta in RATES:
        curve = reference("gpyro", f"tga_base_{beta}K")
        temperature = curve["T_K"].to_numpy()
        ours = tga_fraction(material, beta, temperature)
        lines[f"{beta} K/min"] = Line(temperature, ours, curve["mass_fraction"].to_numpy())
    evidence.curve("Table 3 kinetics", TEMPERATURE, MASS, lines, "Gpyro 0.82", 1.2e-4)
