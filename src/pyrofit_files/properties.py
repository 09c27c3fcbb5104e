"""Tables of properties that no experiment of a study records: optical and thermal."""

import numpy as np

from pyrofit.data.csvfile import FileTable
from pyrofit.quantities.units import ICE_POINT_K, header_key, unit_key
from pyrofit_files.examined import FileSignal

_PER_METRE = {"cm-1": 100.0, "1/cm": 100.0, "/cm": 100.0}
_DIFFUSIVITY = {"mm2/s": 1e-6, "m2/s": 1.0, "cm2/s": 1e-4}
_TEMPERATURE = {"k": 0.0, "degc": ICE_POINT_K, "c": ICE_POINT_K, "°c": ICE_POINT_K}
_FRACTION = {"-": 1.0, "1": 1.0, "%": 0.01}


def property_signals(table: FileTable) -> tuple[str, dict[str, FileSignal]]:
    """Return kind and signals of a table of a property; nothing where it is none.

    Known are a reflectivity against wavenumber and a thermal diffusivity against temperature.
    """
    by_key = {header_key(name): name for name in table.columns}
    for kind, abscissa, value in (
        ("reflectivity", "wavenumber", "reflectivity"),
        ("diffusivity", "temperature", "diffusivity"),
    ):
        x = by_key.get(abscissa)
        y = next((name for key, name in by_key.items() if key.endswith(value)), None)
        if x is None or y is None:
            continue
        signal = _signal(table, kind, x, y)
        return kind, {} if signal is None else {kind: signal}
    return "", {}


def _signal(table: FileTable, kind: str, x: str, y: str) -> FileSignal | None:
    units = {name: unit_key(table.units[name] or "") for name in (x, y)}
    if kind == "reflectivity":
        factor, scale = _PER_METRE.get(units[x]), _FRACTION.get(units[y])
        offset: float | None = 0.0
    else:
        factor, scale = 1.0, _DIFFUSIVITY.get(units[y])
        offset = _TEMPERATURE.get(units[x])
    if factor is None or scale is None or offset is None:
        return None
    values = table.columns[x] * factor + offset, table.columns[y] * scale
    known = np.isfinite(values).all(axis=0)
    unit = table.units[y] or ""
    return FileSignal(kind, y, unit, kind, values[0][known], values[1][known])
