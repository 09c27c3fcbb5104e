"""Fig. 1: quantities that the cost functions measure."""

import numpy as np

from pyrofit.config import Study
from pyrofit.cost import FloatArray, Target, WeightedSum, make_term
from pyrofit.cost.distances import (
    bands_differences,
    bands_limits,
    range_differences,
    range_limits,
    rmse_differences,
)
from pyrofit.numerics import functions
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Axes, Canvas, DrawStyle, Line2D, Patch
from pyrofit.show.figure import Figure

MEAN = {"normalisation": "mean"}
"""Option of the costs of Eq. 4 in the figure: y_N is the mean of the target."""


R = 0.15
"""RANGE's half width [-] in the figure, wider than the usual 0.05, which would hardly be seen."""


RISE_S, POINT_S, FALL_S = 100.0, 460.0, 572.4
"""Times of the threshold, single point, and the same threshold on the way down [s]."""


PLATEAU_S = (160.0, 440.0)
"""Window of BANDS in the weighted sum [s]."""


_TARGET: DrawStyle = {"color": style.COLOURS[0], "linestyle": "-", "linewidth": 1.3}


_MODEL: DrawStyle = {"color": style.COLOURS[1], "linestyle": style.DASHES[1]}


_COUNTED: DrawStyle = {"facecolor": "#7FCEB9", "edgecolor": "#00664A", "linewidth": 0.0}


_HATCH = "////"


_BAR: DrawStyle = {"color": "#00664A", "linewidth": 2.4, "solid_capstyle": "butt"}


_AREA: DrawStyle = {"color": "#C5E0F0"}


_LEVEL: DrawStyle = {"color": "0.3", "linewidth": 0.7, "linestyle": (0, (1, 1.5))}


def example() -> tuple[Target, FloatArray]:
    """Return a target with its uncertainty, and a model at its times: no measurement, no fit.

    Both are mass loss rates [kg/(m² s)] as of an irradiated slab, a rise, a growing plateau and
    burn-out: (a + b t) / ((1 + exp(-(t - t1)/w1)) (1 + exp((t - t2)/w2))).
    """
    time_s = np.linspace(0.0, 700.0, 141)
    value = _slab(time_s, 9.0e-3, 1.6e-5, (100.0, 16.0), (560.0, 14.0))
    model = _slab(time_s, 4.5e-3, 3.3e-5, (150.0, 22.0), (520.0, 14.0))
    return Target(time_s, value, 6e-4 + 0.08 * value), model


def _slab(
    time_s: FloatArray,
    start: float,
    slope: float,
    rise: tuple[float, float],
    fall: tuple[float, float],
) -> FloatArray:
    up = 1.0 + functions.exp(-(time_s - rise[0]) / rise[1])
    down = 1.0 + functions.exp((time_s - fall[0]) / fall[1])
    return np.asarray((start + slope * time_s) / (up * down), dtype=np.float64)


def fig1(study: Study, results: Results) -> Canvas:
    """Fig. 1: the distances that NRSE, THR, RMSE, BANDS, RANGE and their sum count, on an example.

    The curves are the same for every study. Each panel shows the cost that `pyrofit.cost` gives;
    the shaded distances are those of Table 2, the bars the residuals of Eqs 1-3.
    """
    from matplotlib.patches import Patch as Area

    target, model = example()
    canvas, axes = style.panels(6, 3, style.TWO_COLUMNS, 52.0, sharex=True, sharey=True)
    for ax, draw in zip(axes, (_point, _threshold, _rmse, _bands, _range, _sum), strict=True):
        draw(ax, target, model)
        ax.plot(target.time_s, _grams(target.value), **_TARGET)
        ax.plot(target.time_s, _grams(model), **_MODEL)
    titles = ("single point, NRSE", "threshold, THR", "RMSE", "BANDS", f"RANGE, r = {R:g}")
    style.letter(axes, [*titles, "weighted sum, Eq. 5"])
    for i, ax in enumerate(axes):
        ax.set_ylim(0.0, 31.0)
        if i % 3 == 0:
            ax.set_ylabel("mass loss rate [g/(m² s)]")
        if i >= 3:
            ax.set_xlabel("time [s]")
    entries: list[Line2D | Patch] = [
        style.line("example target y", **_TARGET),
        style.line("example model ŷ", **_MODEL),
        Area(
            label="distance that counts",
            hatch=_HATCH,
            facecolor=_COUNTED["facecolor"],
            edgecolor=_COUNTED["edgecolor"],
            linewidth=0.0,
        ),
        style.patch("target area", **_AREA),
    ]
    style.legend_below(canvas, entries)
    return canvas


def _point(ax: Axes, target: Target, model: FloatArray) -> None:
    _at_point(ax, target, model)
    cost = make_term("NRSE", target, time_s=POINT_S)(model)
    _say(ax, f"NRSE = {cost:.3f}")


def _threshold(ax: Axes, target: Target, model: FloatArray) -> None:
    up = _at_threshold(ax, target, model, "THR_above", RISE_S)
    down = _at_threshold(ax, target, model, "THR_below", FALL_S)
    _say(ax, f"THR, rise = {up:.3f}\nTHR, fall = {down:.3f}")


def _rmse(ax: Axes, target: Target, model: FloatArray) -> None:
    _shade(ax, target.time_s, model, rmse_differences(target, model))
    _say(ax, f"RMSE = {make_term('RMSE', target, **MEAN)(model):.3f}")


def _bands(ax: Axes, target: Target, model: FloatArray) -> None:
    _around(ax, target.time_s, bands_limits(target))
    _shade(ax, target.time_s, model, bands_differences(target, model))
    _say(ax, f"BANDS = {make_term('BANDS', target, **MEAN)(model):.3f}")


def _range(ax: Axes, target: Target, model: FloatArray) -> None:
    _around(ax, target.time_s, range_limits(target, R))
    _shade(ax, target.time_s, model, range_differences(target, model, R))
    _say(ax, f"RANGE = {make_term('RANGE', target, r=R, **MEAN)(model):.3f}")


def _sum(ax: Axes, target: Target, model: FloatArray) -> None:
    """Draw BANDS over the plateau, NRSE near the peak and THR of the rise as one cost."""
    weighted = combined(target)
    plateau = weighted.terms[0][1].target
    there = model[np.isin(target.time_s, plateau.time_s)]
    _around(ax, plateau.time_s, bands_limits(plateau))
    _shade(ax, plateau.time_s, there, bands_differences(plateau, there))
    _at_point(ax, target, model)
    _at_threshold(ax, target, model, "THR_above", RISE_S)
    parts = weighted.parts([there, model, model])
    names = [f"{weight:g} × {term.kind.split('_')[0]}" for weight, term in weighted.terms]
    lines = [f"{name} = {part:.3f}" for name, part in zip(names, parts, strict=True)]
    _say(ax, "\n".join([*lines, f"sum E = {sum(parts):.3f}"]))


def combined(target: Target) -> WeightedSum:
    """Eq. 5 as in the last panel: BANDS over a window, NRSE at a point, THR of the rise."""
    return WeightedSum(
        [
            (0.5, make_term("BANDS", target.window(*PLATEAU_S), **MEAN)),
            (0.25, make_term("NRSE", target, time_s=POINT_S)),
            (0.25, make_term("THR_above", target, time_s=RISE_S)),
        ]
    )


def _at_point(ax: Axes, target: Target, model: FloatArray) -> None:
    """Draw Eq. 1's distance: the relative difference times |y|, from y upwards."""
    y = float(np.interp(POINT_S, target.time_s, target.value))
    difference = float(make_term("NRSE", target, time_s=POINT_S).residuals(model)[0]) * abs(y)
    ax.plot([POINT_S, POINT_S], _grams([y, y + difference]), **_BAR)
    ax.plot(POINT_S, _grams(y), marker="o", markersize=3.5, color=_TARGET["color"], zorder=4)


def _at_threshold(ax: Axes, target: Target, model: FloatArray, kind: str, t0: float) -> float:
    """Draw Eq. 2's or 3's distance, from t0 to the time t that the cost finds; return the cost."""
    term = make_term(kind, target, time_s=t0)
    t = t0 * (1.0 + float(term.residuals(model)[0]))
    level = 1e3 * float(np.interp(t0, target.time_s, target.value))
    ax.axhline(level, **_LEVEL)
    ax.plot([t0, t], [level, level], **_BAR)
    ax.plot(t0, level, marker="o", markersize=3.5, color=_TARGET["color"], zorder=4)
    return term(model)


def _around(ax: Axes, time_s: FloatArray, limits: tuple[FloatArray, FloatArray]) -> None:
    lower, upper = limits
    ax.fill_between(time_s, _grams(lower), _grams(upper), linewidth=0.0, **_AREA)


def _shade(ax: Axes, time_s: FloatArray, model: FloatArray, difference: FloatArray) -> None:
    """Shade the differences of Table 2, from the model back to where they count from."""
    ax.fill_between(time_s, _grams(model - difference), _grams(model), hatch=_HATCH, **_COUNTED)


def _say(ax: Axes, text: str) -> None:
    ax.text(0.03, 0.97, text, transform=ax.transAxes, va="top", fontsize=7.5, linespacing=1.35)


def _grams(kilograms: object) -> FloatArray:
    return np.asarray(kilograms, dtype=np.float64) * 1e3


FIGURE = Figure(
    place=10,
    make=fig1,
    title="Cost functions: the compared differences",
    paper="Figure 1",
    caption="An example, the same for every study: target (solid) and model (dashed). Green, "
    "hatched: the difference that counts; green bars: a single point and a threshold. "
    "Light blue: the tolerance within which the cost is zero. The numbers are the costs "
    "of this example. a) Relative difference at one time. b) Time at which the model "
    "passes a level that the target passes at the dot. c) to e) Root mean square of "
    "the shaded differences divided by the mean of the target. The differences are "
    f"those to the target, to its band of uncertainty, and to {100 * R:g} % about it "
    "(usually 5 %). f) Three of them added with weights, BANDS over part of the time.",
)
