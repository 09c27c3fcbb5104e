"""A thin sample on a hot plate: one temperature, one reaction. An example of an external program.

    m c dT/dt = eps (q - sigma (T^4 - T0^4)) + dh dm/dt,    dm/dt = -A m exp(-E / (R T))

Usage: python3 hotplate.py INPUT. It writes hotplate.csv with time, mass loss rate, temperature.
"""

import math
import sys

SIGMA, GAS_CONSTANT, ROOM_K = 5.670374419e-8, 8.314462618, 293.15


def read(path):
    """Return the numbers of an input file by name."""
    found = {}
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.strip() and not line.startswith("!"):
                name, _, value = line.partition("=")
                found[name.strip()] = float(value)
    return found


def run(given):
    """Yield time [s], mass loss rate [g/(m2 s)] and temperature [C] at every output."""
    start = given["density_kg_m3"] * given["thickness_m"]
    factor = 10.0 ** given["log10_A"]
    mass, temperature, step = start, ROOM_K, given["step_s"]
    every = round(given["output_s"] / step)
    for n in range(round(given["end_s"] / step) + 1):
        rate = (
            factor
            * mass
            * math.exp(-given["activation_energy_J_mol"] / (GAS_CONSTANT * temperature))
        )
        if n % every == 0:
            yield n * step, 1e3 * rate, temperature - 273.15
        lost = mass * (1.0 - math.exp(-rate / mass * step)) if mass > 0.0 else 0.0
        heat = given["emissivity"] * (given["flux_W_m2"] - SIGMA * (temperature**4 - ROOM_K**4))
        gained = heat * step - given["heat_of_reaction_J_kg"] * lost
        # The remaining heat capacity is that of the plate: a tenth of the sample's.
        temperature += gained / ((mass + 0.1 * start) * given["specific_heat_J_kgK"])
        mass -= lost


def main():
    """Run an input file."""
    with open("hotplate.csv", "w", encoding="utf-8") as out:
        out.write("Time (s),MLR (g/m2/s),T (C)\n")
        for row in run(read(sys.argv[1])):
            out.write(",".join(f"{number:.9g}" for number in row) + "\n")


if __name__ == "__main__":
    main()
