"""Pieces of one material that weigh differently: in a new study each has a factor of its own."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from pyrofit.new_study.draft import MeasuredFile
from pyrofit.quantities import mass

_ONE_THICKNESS = 1.9
"""Ratio of the largest to the smallest mass up to which pieces may have one thickness."""
_WHOLE = 0.95
"""Share of its large values, of which `_LARGE` are smaller, below which a record does not start
with the whole sample. Single values jump."""
_LARGE = 0.95


@dataclass(frozen=True)
class Pieces:
    """Pieces that are described alike, and what differs between them.

    Parameters
    ----------
    masses_kg_m2
        Initial masses by record; none where they are nearly equal.
    dense
        Whether the density differs, as of boards of wood; else the thickness, as of sheets of a
        plastic.
    """

    masses_kg_m2: Mapping[str, float]
    dense: bool

    def line(self, name: str) -> str:
        """Return the line of the study on the sample of a record; nothing where it has none."""
        if name not in self.masses_kg_m2:
            return ""
        own, mean = self.masses_kg_m2[name], float(np.mean(list(self.masses_kg_m2.values())))
        key, other = "density_factor", "thickness"
        if not self.dense:
            key, other = "thickness_factor", "density"
        said = f"{own:.3g} kg/m² over the mean, {mean:.3g}"
        if name == next(iter(self.masses_kg_m2)):
            said = f"CHANGE where the {other} differs: {said}"
        return f"{key}: {own / mean:.3f} # {said}"


def unequal_masses(tests: Iterable[MeasuredFile]) -> dict[str, float]:
    """Return the initial masses [kg/m2] of slabs by record; none where they are nearly equal.

    Nor are there any where they differ so much that the slabs have not one thickness.
    """
    runs = [run for test in tests for run in test.repeats or (test,) if run.of.stage == "imp"]
    masses = {run.name: first for run in runs if (first := _initial(run)) is not None}
    least, most = min(masses.values(), default=1.0), max(masses.values(), default=1.0)
    return masses if mass.UNEQUAL * least <= most <= _ONE_THICKNESS * least else {}


def _initial(run: MeasuredFile) -> float | None:
    """Return the initial mass [kg/m2] of a record; None where it tells none."""
    frame = run.frames.get("mass")
    if frame is None:
        return None
    values = frame[mass.QUANTITY.column].to_numpy()
    first = float(np.median(values[: mass.ENDS]))
    return first if 0.0 < _WHOLE * float(np.quantile(values, _LARGE)) <= first else None


def said_of_pieces(tests: Iterable[MeasuredFile]) -> list[str]:
    """Say that pieces weigh differently, and what the study makes of it."""
    masses = unequal_masses(tests).values()
    if not masses:
        return []
    return [
        f"The samples weigh {min(masses):.3g} to {max(masses):.3g} kg/m² at the start. Each has a "
        "factor of its own in the study: its mass over the mean."
    ]
