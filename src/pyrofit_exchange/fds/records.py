"""Records of a deck of a slab, and the places of its surfaces."""

from pyrofit_exchange.fds.namelists import Item, Items, Namelist

CELL_M = 0.1
"""Width of a cell of the gas, which only carries the surface."""
DEVICES: dict[str, dict[str, Item]] = {
    "MLR": {"QUANTITY": "MASS FLUX", "SPEC_ID": "METHANE"},
    "T_front": {"QUANTITY": "WALL TEMPERATURE"},
    "T_back": {"QUANTITY": "BACK WALL TEMPERATURE"},
    "mass": {"QUANTITY": "SURFACE DENSITY"},
    "thickness": {"QUANTITY": "WALL THICKNESS"},
}
"""Records of a deck, by the name of the column; means over the second before."""


def closing(spots: int) -> list[Namelist]:
    """Return surfaces beside each other, open sides, and the records of each surface."""
    cells = max(3, spots)
    found = []
    for n in range(spots):
        mark = "" if spots == 1 else f"_{n + 1}"
        left = CELL_M * ((n - 0.5 * cells) if spots > 1 else -0.5)
        box = [round(x, 9) for x in (left, left + CELL_M, -0.05, 0.05, 0.0, 0.0)]
        found.append(Namelist("VENT", {"XB": box, "SURF_ID": f"SLAB{mark}"}))
    sides = ("XMIN", "XMAX", "YMIN", "YMAX", "ZMAX")
    found += [Namelist("VENT", {"MB": side, "SURF_ID": "OPEN"}) for side in sides]
    found.append(Namelist("DUMP", {"DT_DEVC": 1.0, "DT_RESTART": 1e6, "SMOKE3D": False}))
    for n in range(spots):
        mark = "" if spots == 1 else f"_{n + 1}"
        at = round(CELL_M * (n + 0.5 - 0.5 * cells), 9) if spots > 1 else 0.0
        for name, items in DEVICES.items():
            place: Items = {"ID": f"{name}{mark}", "XYZ": [at, 0.0, 0.0], "IOR": 3}
            found.append(Namelist("DEVC", {**place, **items}))
    return [*found, Namelist("TAIL", {})]
