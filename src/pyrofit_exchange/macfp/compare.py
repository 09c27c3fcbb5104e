"""Predictions of several parameter sets beside each other."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from pyrofit.errors import DataError
from pyrofit_exchange.macfp.material import has_heat
from pyrofit_exchange.macfp.predict import (
    AREA_M2,
    PMMA_CASES,
    WOOD_CASES,
    IdealSlab,
    Metrics,
    SlabCurves,
    material,
    metrics,
    simulate_case,
)
from pyrofit_exchange.macfp.read import read_set

CASES = {"pmma": PMMA_CASES, "wood": WOOD_CASES}
_HEAD = ("set", "peak", "at", "onset", "half", "end", "left", "back")
_UNITS = ("", "g/m2/s", "s", "s", "s", "s", "-", "K")


def comparison_tables(paths: Sequence[Path], cases: str, out: Path | None) -> Iterator[str]:
    """Yield a table for each case: a row for each set, and the spread of all.

    Parameters
    ----------
    paths
        Parameter sets.
    cases
        `pmma` or `wood`, see `pyrofit_exchange.macfp.predict`.
    out
        Folder into which the curves are written; none = they are not.
    """
    sets = {path.stem: read_set(path).strict for path in paths}
    whole = {name: material(given) for name, given in sets.items() if has_heat(given)}
    left = [name for name in sets if name not in whole]
    if left:
        yield f"kinetics alone, no slab: {', '.join(left)}"
    if not whole:
        raise DataError("no set describes a slab; give one with properties of heat transfer.")
    for case in CASES[cases]:
        rows = {}
        for name, of in whole.items():
            curves = simulate_case(of, case)
            rows[name] = metrics(curves)
            if out is not None:
                write_slab_curves(out / f"{name}_Gasification_{case.name}.csv", curves)
        yield from _table(case, rows)


def write_slab_curves(path: Path, curves: SlabCurves) -> None:
    """Write the curves of a slab of 100 mm by 100 mm, mass and mass loss rate both."""
    path.parent.mkdir(parents=True, exist_ok=True)
    columns = (
        curves.time_s,
        1e3 * AREA_M2 * curves.mass_kg_m2,
        1e3 * curves.mlr_kg_m2_s,
        curves.back_K,
        curves.front_K,
    )
    head = "Time (s),Mass (g),MLR (g/m2/s),T Back (K),T Top (K)"
    lines = [
        f"{t:g},{m:.6g},{r:.6g},{b:.6g},{f:.6g}" for t, m, r, b, f in zip(*columns, strict=True)
    ]
    path.write_text("\n".join([head, *lines]) + "\n", encoding="utf-8")


def _table(case: IdealSlab, rows: dict[str, Metrics]) -> Iterator[str]:
    yield ""
    yield f"{case.name} from {case.temperature_K:g} K, back insulated, no convection"
    width = max(len("median"), *map(len, rows))
    for cells in (_HEAD, _UNITS):
        yield "  ".join([f"{cells[0]:<{width}}", *[f"{cell:>7}" for cell in cells[1:]]])
    values = {name: _shown(found) for name, found in rows.items()}
    numbers = np.array(list(values.values()))
    if len(rows) > 2:
        middle = np.array([np.nanmedian(c) if not np.isnan(c).all() else np.nan for c in numbers.T])
        values["median"] = middle.tolist()
    for name, row in values.items():
        shown = [f"{x:7.3f}" if abs(x) < 1.0 else f"{x:7.1f}" for x in row]
        yield "  ".join([f"{name:<{width}}", *shown])


def _shown(found: Metrics) -> list[float]:
    return [
        1e3 * found.peak_kg_m2_s,
        found.time_of_peak_s,
        found.onset_s,
        found.half_s,
        found.end_s,
        found.left,
        found.back_K,
    ]
