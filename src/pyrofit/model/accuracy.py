"""Numerical settings of the two solvers."""

from typing import Self

from pydantic import Field

from pyrofit.model.base import Part


class Accuracy(Part):
    """How finely the slab and TGA equations are solved."""

    cells: int | None = Field(
        None, ge=2, le=5000, description="cells of the slab; none = as the reaction zone needs"
    )
    cells_factor: float = Field(
        1.0, ge=0.1, le=100.0, description="multiplies the cells that the reaction zone needs"
    )
    most_cells: int = Field(
        2000, ge=50, le=5000, description="largest number of cells, if the reaction zone needs more"
    )
    tolerance: float = Field(
        2e-3,
        gt=0.0,
        le=0.1,
        description="allowed error of a time step; smaller is slower and more accurate",
    )
    first_step_s: float = Field(0.01, gt=0.0, description="first time step [s]")
    longest_step_s: float = Field(10.0, gt=0.0, description="longest time step [s]")
    most_steps: int = Field(20000, ge=100, description="steps after which a run is given up")
    tga_step_K: float = Field(1.0, gt=0.0, description="largest temperature rise of a TGA step [K]")

    def refined(self) -> Self:
        """Return settings with twice the cells and half the steps: a quarter of the error."""
        return self.model_copy(
            update={
                "cells": None if self.cells is None else 2 * self.cells,
                "cells_factor": 2.0 * self.cells_factor,
                "tolerance": 0.25 * self.tolerance,
                "first_step_s": 0.5 * self.first_step_s,
                "longest_step_s": 0.5 * self.longest_step_s,
                "most_steps": 4 * self.most_steps,
                "tga_step_K": 0.5 * self.tga_step_K,
            }
        )

    def coarsened(self) -> Self:
        """Return settings with fewer cells and steps, for searches whose noise hides the error.

        A run takes a third of the time; its error is about five times as large.
        """
        return self.model_copy(
            update={
                "cells": None if self.cells is None else max(2, round(0.6 * self.cells)),
                "cells_factor": max(0.1, 0.6 * self.cells_factor),
                "tolerance": min(0.1, 2.0 * self.tolerance),
                "first_step_s": 30.0 * self.first_step_s,
                "longest_step_s": 2.0 * self.longest_step_s,
            }
        )


class Resolution(Part):
    """How finely the reference solver solves the slab and TGA equations.

    The error of the mass loss rate falls with the square of the element size. It is larger at
    higher flux and for materials of lower conductivity.
    """

    elements: int = Field(400, ge=2, le=5000, description="finite elements of the slab")
    tolerance: float = Field(
        1e-6,
        gt=0.0,
        le=1e-2,
        description="error of a step, relative to T and to the mass of an element",
    )
    most_steps: int = Field(200000, ge=100, description="steps after which a run is given up")
    tga_tolerance: float = Field(
        1e-10, gt=0.0, le=1e-3, description="error of a TGA step, relative to the sample's mass"
    )
