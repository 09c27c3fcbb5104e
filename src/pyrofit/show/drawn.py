"""Types of Matplotlib, which takes half a second to import: only who draws a figure does.

The workflow reads titles, captions and names of all figures each time that it starts.
"""

from typing import TYPE_CHECKING, Any

__all__ = ["Axes", "Canvas", "Line2D", "Patch"]

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Canvas
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch
else:
    Axes = Canvas = Line2D = Patch = Any
