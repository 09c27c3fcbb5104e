"""Types of Matplotlib, which takes half a second to import: only who draws a figure does.

The workflow reads titles, captions and names of all figures each time that it starts.
"""

from typing import TYPE_CHECKING, Any, Literal, TypedDict

__all__ = ["Axes", "Canvas", "DrawStyle", "Line2D", "Patch"]

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Canvas
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch
else:
    Axes = Canvas = Line2D = Patch = Any


class DrawStyle(TypedDict, total=False):
    """How lines, markers, areas and words are drawn, by Matplotlib's names; sizes in points."""

    color: str
    alpha: float
    linestyle: str | tuple[float, tuple[float, ...]]
    linewidth: float
    solid_capstyle: Literal["butt", "round"]
    drawstyle: Literal["steps-post"]
    marker: str
    markersize: float
    markerfacecolor: str
    markeredgewidth: float
    markevery: int | tuple[float, float]
    facecolor: str
    edgecolor: str
    hatch: str
    step: Literal["post"]
    transform: Any
    ha: Literal["left", "center", "right"]
    va: Literal["top", "center", "bottom"]
    fontsize: float
