"""Pieces of one material that weigh differently: in a new study each has a factor of its own."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.new_study.draft import MeasuredFile
from pyrofit.quantities import mass

_NEXT = 1.4
"""Ratio of a mass to the next smaller one from which on pieces have another thickness."""
_WHOLE = 0.95
"""Share of this quantile of its values, below which a record does not start with the whole sample.
Its largest value may be one that jumps."""


@dataclass(frozen=True)
class Pieces:
    """Pieces that are described alike, and what differs between them.

    Parameters
    ----------
    masses_kg_m2
        Initial masses by record, of pieces of one thickness each; none where they are nearly equal.
    dense
        Whether the density differs, as of boards of wood; else the thickness, as of sheets of a
        plastic.
    """

    masses_kg_m2: Sequence[Mapping[str, float]]
    dense: bool

    def line(self, name: str) -> str:
        """Return the line of the study on the sample of a record; nothing where it has none."""
        alike = next((masses for masses in self.masses_kg_m2 if name in masses), None)
        if alike is None:
            return ""
        own, mean = alike[name], float(np.mean(list(alike.values())))
        key, other = "density_factor", "thickness"
        if not self.dense:
            key, other = "thickness_factor", "density"
        said = f"{own:.3g} kg/m² over the mean, {mean:.3g}"
        if name == next(iter(alike)):
            said = f"CHANGE where the {other} differs: {said}"
        return f"{key}: {own / mean:.3f} # {said}"


def unequal_masses(tests: Iterable[MeasuredFile]) -> list[dict[str, float]]:
    """Return initial masses [kg/m2] of slabs by record, of each thickness, where they differ."""
    runs = [run for test in tests for run in test.repeats or (test,) if run.of.stage == "imp"]
    masses = {run.name: first for run in runs if (first := _initial(run)) is not None}
    alike, last = list[set[str]](), 0.0
    for name in sorted(masses, key=masses.__getitem__):
        if masses[name] > _NEXT * last:
            alike.append(set())
        alike[-1].add(name)
        last = masses[name]
    found = [{name: masses[name] for name in masses if name in names} for names in alike]
    return [m for m in found if mass.UNEQUAL * min(m.values()) <= max(m.values())]


def _initial(run: MeasuredFile) -> float | None:
    """Return the initial mass [kg/m2] of a record; None where it tells none."""
    frame = run.frames.get("mass")
    if frame is None:
        return None
    values = frame[mass.QUANTITY.column].to_numpy()
    first = float(np.median(values[: mass.ENDS]))
    return first if 0.0 < _WHOLE * float(np.quantile(values, _WHOLE)) <= first else None


def said_of_pieces(tests: Iterable[MeasuredFile]) -> list[str]:
    """Say that pieces weigh differently, and what the study makes of it."""
    lines = []
    for masses in unequal_masses(tests):
        least, most = min(masses.values()), max(masses.values())
        lines.append(
            f"{len(masses)} samples weigh {least:.3g} to {most:.3g} kg/m² at the start. Each has a "
            "factor of its own in the study: its mass over the mean."
        )
    return lines
