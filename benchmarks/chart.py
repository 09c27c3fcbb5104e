"""Figure: error against evaluations per second."""

from pathlib import Path

from case import FLUXES
from cost import Point, front

from pyrofit.results.files import Results
from pyrofit.show.style import (
    MEASURED,
    PUBLISHED,
    TWO_COLUMNS,
    colour,
    dashes,
    legend_below,
    letter,
    line,
    panels,
    save,
    style,
)

DOCS = Path(__file__).parents[1] / "docs"
MARKS = {"default, lanes": "s", "default, scalar": "o", "0.2 %, lanes": "D", "0.2 %, scalar": "^"}
SHOWN_CELLS = (16, 24, 32, 48, 64, 128)


def draw(
    curves: dict[str, list[Point]],
    settings: dict[str, dict[str, tuple[float, float]]],
    peers: dict[str, tuple[float, float]],
) -> None:
    """Write docs/figures/benchmarks.svg and .png.

    ``settings`` and ``peers`` (those of the first panel) hold rate and error.
    """
    with style():
        canvas, axes = panels(len(curves), 2, TWO_COLUMNS, 72.0)
        for ax, (name, points) in zip(axes, curves.items(), strict=True):
            for i, cells in enumerate(SHOWN_CELLS):
                of = sorted((p for p in points if p.cells == cells), key=lambda p: p.tolerance)
                ax.loglog(
                    [p.rate for p in of],
                    [100 * p.error for p in of],
                    color=colour(i),
                    linestyle=dashes(i),
                )
            best = front(points)
            ax.loglog([p.rate for p in best], [100 * p.error for p in best], ".", color="0.3", ms=3)
            for label, mark in MARKS.items():
                rate, error = settings[name][label]
                ax.loglog(rate, 100 * error, mark, color=MEASURED, mfc="none", ms=5)
            ax.axhline(0.2, color=PUBLISHED, linewidth=0.5)
            ax.set_xlabel("evaluations per second on one core")
            ax.margins(0.06)
        for label, (rate, error) in peers.items():
            axes[0].loglog(rate, 100 * error, "*", color=PUBLISHED, ms=7)
            axes[0].annotate(label, (rate, 100 * error), (5, 4), textcoords="offset points")
        axes[0].set_ylabel("error of the mass loss rate [%]")
        letter(axes, [f"{FLUXES[name]} kW/m²" for name in curves])
        entries = [
            line(f"{cells} cells, in lanes", color=colour(i), linestyle=dashes(i))
            for i, cells in enumerate(SHOWN_CELLS)
        ]
        entries.append(
            line("no other one better in both", color="0.3", marker=".", linestyle="none", ms=3)
        )
        entries += [
            line(label, color=MEASURED, marker=mark, linestyle="none", mfc="none", ms=5)
            for label, mark in MARKS.items()
        ]
        legend_below(canvas, entries)
        save(canvas, Results(DOCS), "benchmarks")
