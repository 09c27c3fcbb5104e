"""How figures look: one style, colours and line styles that differ in grey, widths."""

import io
import textwrap
from collections.abc import Sequence
from typing import Any

import numpy as np

from pyrofit.config import Study
from pyrofit.results.files import Results, write_bytes
from pyrofit.show.drawn import Axes, Canvas, DrawStyle, Line2D, Patch

MM = 1.0 / 25.4


ONE_COLUMN = 85.0


TWO_COLUMNS = 170.0


LAYOUT_DIGITS = 6
"""Digits of the places of panels, as fractions of a figure."""
DPI = 200
"""Resolution of the PNG files [1/inch]."""


MEASURED = "black"


BAND = "0.82"


PUBLISHED = "0.5"


# Blue, red and ochre as in Tol's scheme of high contrast, darkened: apart in grey and for
# colour-blind readers, darker than the band. Then colours of Okabe and Ito, apart by dashes.
ESTIMATES = "#D55E00"
"""Colour of the estimates, which no cost function has."""
COLOURS = ("#004488", "#BB3344", "#CC8800", "#009E73", "#CC79A7", "#56B4E9")


DASHES: tuple[Any, ...] = (
    "-",
    (0, (5, 1.5)),
    (0, (5, 1.5, 1, 1.5)),
    (0, (1, 1)),
    (0, (9, 2)),
    (0, (3, 1, 1, 1, 1, 1)),
)


STYLE: dict[str, Any] = {
    # DejaVu Sans comes with Matplotlib: the same figure on every machine.
    "font.family": "DejaVu Sans",
    "font.size": 8,
    "mathtext.default": "regular",
    "axes.formatter.use_mathtext": True,
    "axes.titlesize": 8,
    "axes.labelsize": 8,
    "figure.titlesize": 9,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "legend.fontsize": 7.5,
    "legend.frameon": False,
    "legend.handlelength": 2.8,
    "legend.borderaxespad": 0.2,
    "lines.linewidth": 1.2,
    "lines.dash_capstyle": "butt",
    "hatch.linewidth": 0.4,
    "axes.linewidth": 0.5,
    "axes.axisbelow": True,
    "axes.xmargin": 0.0,
    "xtick.major.width": 0.5,
    "ytick.major.width": 0.5,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "xtick.minor.size": 1.5,
    "ytick.minor.size": 1.5,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "figure.constrained_layout.use": True,
    "figure.constrained_layout.h_pad": 0.03,
    "figure.constrained_layout.w_pad": 0.03,
    "savefig.dpi": DPI,
    "svg.fonttype": "path",
    "svg.hashsalt": "pyrofit",
}


MANY, MOST_COLUMNS = 12, 3
"""Panels beyond which a figure has more columns, and how many."""


OF_AXES_MM, LETTER_MM = (24.0, 15.0), 1.5
"""Width and height of a panel that its ticks and labels take, and width of a letter."""
LONGEST_LABEL = 30
"""Letters of a line of a label: at 8 points they are as long as the axis of a panel."""


def colour(i: int) -> str:
    """Return the colour of the i-th curve."""
    return COLOURS[i % len(COLOURS)]


def dashes(i: int) -> Any:
    """Return the line style of the i-th curve."""
    return DASHES[i % len(DASHES)]


def cost_styles(study: Study) -> dict[str, DrawStyle]:
    """Return colour and line style of each cost function."""
    return {
        cost: {"color": colour(i), "linestyle": dashes(i)} for i, cost in enumerate(study.imp.costs)
    }


def panels(
    count: int, columns: int, width: float, height: float, smaller: bool = True, **options: Any
) -> tuple[Canvas, list[Axes]]:
    """Return a canvas with ``count`` panels in rows; sizes in mm, the height is a row's.

    Many panels are smaller, three in a row, so that the figure is not too long; not so where they
    are pairs, without ``smaller``.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    if smaller and count > MANY and columns < MOST_COLUMNS:
        columns, height = MOST_COLUMNS, height * columns / MOST_COLUMNS
    columns = min(columns, count)
    rows = -(-count // columns)
    # Text widths do not scale exactly: the layout needs the resolution of the output.
    canvas: Canvas = Figure(figsize=(width * MM, rows * height * MM), dpi=DPI)
    FigureCanvasAgg(canvas)
    grid = canvas.subplots(rows, columns, squeeze=False, **options)
    axes: list[Axes] = list(grid.flat)
    for unused in axes[count:]:
        unused.set_axis_off()
    return canvas, axes[:count]


def letter(axes: Sequence[Axes], titles: Sequence[str]) -> None:
    """Title the panels, in lines as long as these; with a letter in front of several titles."""
    for i, (ax, title) in enumerate(zip(axes, titles, strict=True)):
        text = f"{letters(i)}) {title}" if len(axes) > 1 else title
        most = _letters_along(ax, 0)
        if len(text) > most and "$" not in text:
            text = "\n".join(textwrap.wrap(text, most))
        ax.set_title(text, loc="left")


def label_y(ax: Axes, text: str) -> None:
    """Label the axis of values, in lines that are no longer than a panel is high."""
    ax.set_ylabel(in_lines(text.replace("\n", " "), min(_letters_along(ax, 1), LONGEST_LABEL)))


def _letters_along(ax: Axes, way: int) -> int:
    """Return how many letters of 8 points fit along a panel: 0 = its width, 1 = its height."""
    place, canvas = ax.get_subplotspec(), ax.get_figure()
    if place is None or canvas is None:
        return LONGEST_LABEL
    grid = place.get_gridspec()
    size = canvas.bbox.size[way] / canvas.dpi / MM / (grid.nrows if way else grid.ncols)
    return max(int((size - OF_AXES_MM[way]) / LETTER_MM), 8)


def letters(i: int) -> str:
    """Return the letters of the i-th panel.

    >>> letters(0), letters(25), letters(26), letters(53)
    ('a', 'z', 'aa', 'bb')
    """
    before, last = divmod(i, 26)
    return (letters(before - 1) if before else "") + chr(97 + last)


def line(label: str, **style: Any) -> Line2D:
    """Return a legend entry for a line."""
    from matplotlib.lines import Line2D as Drawn

    return Drawn([], [], label=label, **style)


def patch(label: str, **style: Any) -> Patch:
    """Return a legend entry for an area."""
    from matplotlib.patches import Patch as Drawn

    return Drawn(label=label, linewidth=0.0, **style)


def legend_below(canvas: Canvas, entries: Sequence[Line2D | Patch]) -> None:
    """Put one legend under all panels, where it covers no data; entries run down its columns."""
    longest = max(len(str(entry.get_label())) for entry in entries)
    width = canvas.get_figwidth() / MM
    # An entry takes 14 mm, and 1.4 mm for each letter.
    columns = max(1, min(len(entries), int(width / (14.0 + 1.4 * longest))))
    rows = -(-len(entries) // columns)
    even = -(-len(entries) // rows)
    canvas.legend(handles=list(entries), loc="outside lower center", ncols=even)


def in_lines(text: str, letters: int = LONGEST_LABEL) -> str:
    """Return a label in lines of some letters, so that it is no longer than its axis.

    >>> in_lines("interface temperature (back_temperature_1) [°C]").splitlines()
    ['interface temperature', '(back_temperature_1) [°C]']
    """
    return "\n".join(textwrap.wrap(text, letters, break_long_words=False))


def zero_line(ax: Axes) -> None:
    """Mark zero."""
    ax.axhline(0.0, color="0.3", linewidth=0.5, zorder=1.5)


def save(canvas: Canvas, results: Results, name: str, folder: str = "figures") -> None:
    """Write ``<folder>/<name>.svg`` and ``.png``; equal results give equal SVG bytes."""
    _lay_out(canvas)
    for kind, metadata in (("svg", {"Date": None, "Creator": None}), ("png", {"Software": None})):
        buffer = io.BytesIO()
        canvas.savefig(buffer, format=kind, metadata=metadata)
        write_bytes(results.folder(folder) / f"{name}.{kind}", buffer.getvalue())


def _lay_out(canvas: Canvas) -> None:
    """Give the panels their final places, once and rounded: the last bits of a layout vary."""
    canvas.draw_without_rendering()
    canvas.set_layout_engine("none")
    for ax in canvas.axes:
        ax.set_position(np.round(ax.get_position(original=True).bounds, LAYOUT_DIGITS))


def style() -> Any:
    """Return a context in which the style holds, and Matplotlib's own settings else."""
    import matplotlib as mpl

    settings: dict[Any, Any] = {**mpl.rcParamsDefault, **STYLE, "backend": "agg"}
    return mpl.rc_context(settings)
