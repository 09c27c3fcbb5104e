"""The first picture: measured files as they were understood, side by side."""

import base64
import html
import io
from pathlib import Path
from typing import Any

from pyrofit.errors import DataError
from pyrofit.quantities.base import Shown
from pyrofit.quantities.units import ICE_POINT_K
from pyrofit.results.files import write_bytes
from pyrofit.show import style
from pyrofit.show.drawn import Axes, Canvas
from pyrofit_files.looked import Looked, Series, abscissa_values, derivative

ENDINGS = (".png", ".svg", ".html")
LONGEST, OF_REPEAT = 40, 14
"""Letters of a name, of that of a repeat ..."""
OF_TITLE, OF_LABEL = 54, 28
"""... and of a line of a title, and of a label."""
ROW, IN_A_COLUMN = 50.0, 10
"""Height of a row of panels [mm], and repeats in a column of a legend."""
OF_SAMPLE = {
    "mass": Shown("g", 1e3),
    "mass rate": Shown("g/s", 1e3),
    "heat rate": Shown("kW", 1e-3),
    "power": Shown("mW", 1e3),
}
"""Units of values of a whole sample: a study gives its area or mass."""


def draw_look(looked: Looked) -> Canvas:
    """Draw a panel for each quantity of each test; beside that of a mass, its derivative.

    Repeats have different colours and dashes. Masses come first, so that each stands in one row
    with its derivative.

    Raises
    ------
    DataError
        Nothing is recognised in the files.
    """
    tests = sorted(looked.tests, key=lambda test: not test.loses)
    panels = [(test, own) for test in tests for own in (False, True)[: 1 + test.loses]]
    if not panels:
        raise DataError(
            "nothing is recognised in these files; `pyrofit data doctor FOLDER` says why"
        )
    canvas, axes = style.panels(len(panels), 2, style.TWO_COLUMNS, ROW, smaller=False)
    for ax, (test, is_rate) in zip(axes, panels, strict=True):
        _panel(ax, test, is_rate)
    return canvas


def _panel(ax: Axes, test: Series, is_rate: bool) -> None:
    quantity = test.quantity
    against = quantity is not None and quantity.against_temperature
    unit = _shown(test)
    for i, (name, signal) in enumerate(test.records):
        at, values = abscissa_values(test, signal), test.values(signal)
        if is_rate:
            at, values = derivative(at, values)
        values = unit.factor * values + (0.0 if is_rate else unit.offset)
        dashes = style.dashes(i + i // len(style.COLOURS))  # other ones when colours return
        look: dict[str, Any] = {"color": style.colour(i), "linestyle": dashes}
        label = _short(name.removeprefix(test.name).strip("_- ") or name, OF_REPEAT)
        ax.plot(at - ICE_POINT_K if against else at, values, label=label, linewidth=0.9, **look)
    ax.set_xlabel("temperature [°C]" if against else "time [s]", fontsize=6.5)
    ax.set_ylabel(_label(test, is_rate), fontsize=6.5)
    ax.tick_params(labelsize=6.5)
    ax.set_title(_title(test, is_rate), loc="left", fontsize=7.0)
    if len(test.records) > 1:
        # Beside the panel: repeats cover the whole of it.
        columns = -(-len(test.records) // IN_A_COLUMN)
        beside: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0)}
        ax.legend(fontsize=6.0, handlelength=1.5, frameon=False, ncols=columns, **beside)


def _short(name: str, letters: int) -> str:
    """Return a name, cut if it is long; its end tells repeats apart."""
    return name if len(name) <= letters else f"…{name[1 - letters :]}"


def _title(test: Series, is_rate: bool) -> str:
    """Return name, kind and repeats of a test, and column and unit as they were understood."""
    name = _short(test.name, LONGEST)
    repeats = f", {len(test.records)} repeats" if len(test.records) > 1 else ""
    disagree = " that disagree" if test.disagreements else ""
    columns = dict.fromkeys(f"'{s.header}' [{s.unit or 'no unit'}]" for _, s in test.records)
    below = "derivative" if is_rate else ", ".join(columns)
    return f"{name}\n" + style.in_lines(f"{test.kind}{repeats}{disagree}: {below}", OF_TITLE)


def _shown(test: Series) -> Shown:
    """Return the unit of an axis: that of the quantity, or of a whole sample's value."""
    if test.scale in OF_SAMPLE:
        return OF_SAMPLE[test.scale]
    return test.quantity.shown if test.quantity else Shown("SI unit")


def _label(test: Series, is_rate: bool) -> str:
    quantity = test.quantity
    title = quantity.title if quantity else test.records[0][1].quantity.replace("_", " ")
    unit = _shown(test).unit
    if test.scale in OF_SAMPLE:
        title = f"{test.scale} of the sample"
    if is_rate:
        title = f"loss of {title}"
        per = "K" if quantity is not None and quantity.against_temperature else "s"
        unit = f"{'1' if unit in ('–', '-') else unit}/{per}"
    return style.in_lines(f"{title} [{unit}]", OF_LABEL)


def write(looked: Looked, path: Path) -> None:
    """Write the picture as PNG, SVG, or HTML with what was understood.

    Raises
    ------
    DataError
        The file has another ending, cannot be written, or there is nothing to draw.
    """
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        raise DataError(f"{path}: give a name that ends with {', '.join(ENDINGS)}")
    with style.style():
        canvas, content = draw_look(looked), io.BytesIO()
        canvas.savefig(content, format="svg" if ending == ".svg" else "png")
    made = content.getvalue()
    write_bytes(path, made if ending != ".html" else _page(looked, made).encode())


def _page(looked: Looked, picture: bytes) -> str:
    lines = "\n".join(f"<li>{html.escape(line.strip())}</li>" for line in looked.lines())
    source = f"data:image/png;base64,{base64.b64encode(picture).decode()}"
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        "<title>Measured files</title>"
        "<style>body{font-family:sans-serif;max-width:70em;margin:2em auto}"
        "img{max-width:100%}</style></head>\n<body><h1>Measured files as they were understood</h1>"
        f'\n<img src="{source}" alt="Records of all files">\n<ul>\n{lines}\n</ul>\n</body></html>\n'
    )
