"""Namelists of Gpyro, in the order and with the keys of its samples."""

from collections.abc import Sequence

from pyrofit_exchange.fds.exposure import FdsSurroundings
from pyrofit_exchange.fds.layers import FdsLayer
from pyrofit_exchange.fds.namelists import Item, Namelist, unique
from pyrofit_exchange.gpyro.grid import Grid
from pyrofit_exchange.steps import StepReaction

T_REF_K = 300.0
Items = dict[str, Item | Sequence[Item]]


def species(
    name: str,
    k: tuple[float, ...],
    density: float,
    c: tuple[float, ...],
    eps: float,
    kappa: float,
) -> Items:
    """Return the properties of one component, those of a porous body as in Gpyro's samples."""
    return {
        **{"NAME": name, "K0Z": k[0], "NKZ": k[1], "R0": density, "NR": 0.0},
        **{"C0": c[0], "NC": c[1], "EMIS": eps, "KAPPA": kappa},
        **{"TMELT": 3000.0, "DHMELT": 0.0, "SIGMA2MELT": 0.0, "GAMMA": 0.0, "PERMZ": 1e-10},
        **{"RS0": 1.1 * density, "PORE_DIAMETER": 5e-4},
        **{"K0X": k[0], "NKX": k[1], "PERMX": 1e-10, "K0Y": k[0], "NKY": k[1], "PERMY": 1e-10},
    }


def numbered_keys(count: str, parts: Sequence[Items]) -> Items:
    """Return the keys of several parts with their numbers."""
    found: Items = {count: len(parts)}
    for n, part in enumerate(parts, 1):
        for key, value in part.items():
            found[f"{key}({n},1)" if key == "YJINF" else f"{key}({n})"] = value
    return found


def reactions(steps: list[StepReaction], gas_heat: float) -> list[Namelist]:
    """Return reactions: solid products keep all mass (CHI = 0), heat belongs to the gas.

    ``gas_heat`` [J/(kg K)] is the heat that the gas takes up on its way to the front.
    """
    parts: list[Items] = []
    for step in steps:
        per_gas = step.heat_J_kg / step.share if step.product is None else 0.0
        parts.append(
            {
                "CFROM": step.reactant,
                "CTO": step.product or "gases",
                "Z": step.A_1_s,
                "E": 1e-3 * step.E_J_mol,
                **{"DHS": 0.0, "DHV": per_gas, "CHI": 1.0 if step.product is None else 0.0},
                **{"ORDER": step.order, "ORDERO2": 0.0, "IKINETICMODEL": 0, "IO2TYPE": 0},
                **{"M": 0.0, "KCAT": 0.0, "ICAT": 0},
            }
        )
    gas: Items = {"NGSPEC": 1, "IBG": 1, "IO2": 2, "CPG": gas_heat, "NAME(1)": "pyrolysate"}
    gas |= {"M(1)": 44.0, "SIGMA(1)": 5.061, "EPSOK(1)": 254.0, "C0(1)": 1000.0, "NC(1)": 0.0}
    yields: Items = {f"GYIELDS(1,{n + 1})": 1.0 for n in range(len(parts))}
    return [
        Namelist("GPYRO_RXNS", numbered_keys("NRXNS", parts)),
        Namelist("GPYRO_HGRXNS", {"NHGRXNS": 0}),
        Namelist("GPYRO_GPROPS", gas),
        Namelist("GPYRO_GYIELDS", yields),
        Namelist("GPYRO_HGYIELDS", {}),
    ]


def general(step: float, ambient: float, bodies: Sequence[Items]) -> Namelist:
    """Return the settings of the solution, as in Gpyro's sample of a thermoplastic.

    Gpyro conducts along gradients of enthalpy. Where specific heats of components differ, only its
    correction SHYI makes them gradients of temperature.
    """
    heats = {(of["C0"], of["NC"]) for of in bodies}
    on = ("THERMAL_EQUILIBRIUM", "USE_TOFH_NEWTON", "CONSTANT_DHVOL")
    off: tuple[str, ...] = (
        "EXPLICIT_T",
        "SOLVE_GAS_YJ",
        "SOLVE_GAS_ENERGY",
        "SOLVE_PRESSURE",
        "FDSMODE",
    )
    off += (
        "GEOMETRY_IS_UPSIDE_DOWN",
        "CONVENTIONAL_RXN_ORDER",
        "NOCONSUMPTION",
        "BLOWING",
        "FULL_QSG",
    )
    off += ("GASES_PRODUCED_AT_TSOLID",)
    items: Items = {"DT0": step, "TAMB": ambient, "TREF": T_REF_K, "P0": 101300.0}
    items |= {"GX": 0.0, "GZ": 0.0, "GY": 0.0, "VHLC": 0.0, "HCV": 1e6, "NU_A": 2.0, "NU_B": 1.0}
    items |= {"NU_C": 0.5, "NTDMA_ITERATIONS": 2000, "NSSPECIESITERNS": 1, "NCONTINUITYITERNS": 1}
    items |= {"ALPHA": 1.0, "TMPTOL": 1e-4, "HTOL": 1e-9, "YITOL": 1e-8, "PTOL": 1e-4}
    items |= {"YJTOL": 1e-4, "HGTOL": 0.1, "NCOEFF_UPDATE_SKIP": 1, "EPS": 1e-15}
    items |= dict.fromkeys(on, True) | dict.fromkeys(off, False)
    items["SHYI_CORRECTION"] = len(heats) > 1
    return Namelist("GPYRO_GENERAL", items)


def output(name: str, quantities: list[str], depths: list[float]) -> Namelist:
    """Return the recorded quantities, each at a depth [m]."""
    case = unique([name], 40)[name]
    items: Items = {"CASENAME": case, "N_POINT_QUANTITIES": len(quantities)}
    items |= {"N_PROFILE_QUANTITIES": 0, "N_SMOKEVIEW_QUANTITIES": 0, "DTDUMP_GA": 1.0}
    items |= {"DTDUMP_POINT": 1.0, "DTDUMP_PROFILE": 1.0, "DTDUMP_SMOKEVIEW": 1.0}
    items |= {"TMP_REDUCED_DTDUMP": 5000.0, "REDUCED_DTDUMP": 1e-4, "DTMIN_KILL": 1e-7}
    for n, (quantity, z) in enumerate(zip(quantities, depths, strict=True), 1):
        items |= {f"POINT_QUANTITY({n})": quantity, f"POINT_QUANTITY_INDEX({n})": 0}
        items |= {f"POINT_IMESH({n})": 0, f"POINT_Z({n})": z}
        items |= {f"POINT_X({n})": 0.0, f"POINT_Y({n})": 0.0}
    return Namelist("GPYRO_OUTPUT", items)


def initial(layers: list[FdsLayer], present: list[str], start: float) -> Namelist:
    """Return the initial state of every layer."""
    items: Items = {"NIC": len(layers)}
    for n, layer in enumerate(layers, 1):
        items |= {f"TMP_INITIAL({n})": start, f"TMPG_INITIAL({n})": start}
        items |= {f"P_INITIAL({n})": 101300.0}
        items |= {f"YI0({n},{i})": layer.shares.get(s, 0.0) for i, s in enumerate(present, 1)}
        items |= {f"YJ0({n},1)": 1.0}
    return Namelist("GPYRO_IC", items)


def boundaries(outside: FdsSurroundings) -> list[Items]:
    """Return the front, whose flux is linear between its times, and the back."""

    def side(index: int, t: float, q: float, h: float, T: float, radiates: bool) -> Items:
        return {
            **{"SURF_IDX": index, "T": t, "QE": q, "HC": h, "NHC": 0.0, "TINF": T},
            **{"RERADIATION": radiates, "TFIXED": -1.0, "MDOTPP": 0.0},
            **{"PRES": 101300.0 if index == 1 else -1000.0, "QEG": 0.0, "HCG": 12.0},
            **{"TINFG": T, "TFIXEDG": -1000.0, "HM": 0.01 if index == 1 else 0.0, "YJINF": 1.0},
        }

    front = [
        side(1, float(t), float(q), outside.h_front, outside.gas_K, True)
        for t, q in zip(*outside.flux, strict=True)
    ]
    radiates = outside.emissivity_back > 0.0
    return [*front, side(2, 0.0, 0.0, outside.h_back or 0.0, outside.back_K, radiates)]


def geometry(grid: Grid, sides: tuple[int, ...]) -> Items:
    """Return the mesh, and each layer as a body from its front to the back, over those before."""
    back = grid.depth_m
    items: Items = {"NMESH": 1, "NOBST": len(grid.fronts_m), "ZDIM(1)": back}
    items |= {"NCELLZ(1)": grid.nodes, "XDIM(1)": 1.0, "NCELLX(1)": 1, "YDIM(1)": 1.0}
    items |= {"NCELLY(1)": 1, "GEOMETRY_FILE(1)": "null", "DEFAULT_IC(1)": 1}
    items |= {f"DEFAULT_SURF_IDX(1,{n})": s for n, s in enumerate(sides, 1)}
    items |= {"OFFSETZ(1)": 0.0, "OFFSETX(1)": 0.0, "OFFSETY(1)": 0.0}
    for n, front in enumerate(grid.fronts_m, 1):
        items |= {f"IMESH({n})": 1, f"Z1({n})": front, f"Z2({n})": back}
        items |= {f"X1({n})": 0.0, f"X2({n})": 1.0, f"Y1({n})": 0.0, f"Y2({n})": 1.0}
        items |= {f"ICNUM({n})": n}
        items |= {f"SURF_IDX2D({n},{m})": s for m, s in enumerate(sides, 1)}
        items |= {f"HCR({n},{m})": 9e9 for m in range(1, 7)}
    return items


def unused() -> list[Namelist]:
    """Return the groups of Gpyro's own optimiser, which its reader wants to find."""
    return [
        Namelist("GA_GENINPUT", {}),
        Namelist("GA_PHI", {"NPHI": 0}),
        Namelist("GA_VARS", {"NGENE": 0}),
    ]
