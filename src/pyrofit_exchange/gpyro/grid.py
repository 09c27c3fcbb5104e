"""Layers on the nodes of Gpyro.

Gpyro has one distance dz between its N nodes, of which the first and the last belong to half a
cell. A layer begins and ends at faces of cells, halfway between nodes. All layers are one
connected body only if no cell lies between them. The first body therefore has the whole depth,
and each further one replaces the material behind its front.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from pyrofit_exchange.fds.layers import FdsLayer

FEWEST, MOST = 201, 801
CLOSE = 5e-3
"""Error of a thickness, relative, at which more nodes are not tried."""


class Grid(NamedTuple):
    """Nodes of a slab.

    Parameters
    ----------
    nodes
        How many.
    depth_m
        From the first node to the last.
    fronts_m
        Where each layer begins, at faces of cells; that of the foil comes last.
    worst
        Largest error of a layer's thickness, over the thickness.
    """

    nodes: int
    depth_m: float
    fronts_m: tuple[float, ...]
    worst: float

    @property
    def foil_m(self) -> float:
        """Thickness of the half cell at the back [m], which a foil takes."""
        return 0.5 * self.depth_m / (self.nodes - 1)


def grid_of(layers: Sequence[FdsLayer], has_foil: bool) -> Grid:
    """Return the fewest nodes with which thicknesses are right, else those that miss them least.

    Raises
    ------
    ValueError
        A layer has no cell of its own even with the most nodes.
    """
    best = None
    for nodes in range(FEWEST, MOST + 1):
        grid = _with(nodes, [layer.thickness_m for layer in layers], has_foil)
        if grid is not None and (best is None or grid.worst < best.worst):
            best = grid
        if best is not None and best.worst <= CLOSE:
            break
    if best is None:
        raise ValueError("a layer is thinner than a cell")
    return best


def _with(nodes: int, thicknesses: list[float], has_foil: bool) -> Grid | None:
    """Return the grid of a number of nodes, none if a layer would have no cell."""
    inside = sum(thicknesses)
    dz = inside / (nodes - 1.5 if has_foil else nodes - 1.0)
    wanted = np.cumsum(thicknesses)[:-1]
    faces = (np.floor(wanted / dz) + 0.5) * dz
    bounds = np.concatenate([[0.0], faces, [inside]])
    sizes = np.diff(bounds)
    if np.any(sizes < 0.9 * dz) and len(thicknesses) > 1:
        return None
    worst = float(np.max(np.abs(sizes / np.array(thicknesses) - 1.0)))
    fronts = bounds if has_foil else bounds[:-1]
    return Grid(nodes, dz * (nodes - 1), tuple(float(z) for z in fronts), worst)
